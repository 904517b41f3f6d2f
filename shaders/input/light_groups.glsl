#include "lib/finite.glsl"
#include "lib/working.glsl"

// A picture without the light that is in no group, or with it: its alpha stays.
vec4 light_groups_rest(vec4 total, bool rest) { return rest ? total : vec4(0.0, 0.0, 0.0, total.a); }

// Adds a group as bright as `gain`, in the color of a lamp if it is `heated`. The total has `kept` of it already.
vec4 light_groups_add(vec4 total, vec4 light, vec3 gain, vec3 tint, bool heated, float kept) {
    vec3 color = heated ? gain * from_rec709(tint) : gain;
    return vec4(finite(total).rgb + (color - kept) * finite(light).rgb, total.a);
}

vec4 light_groups(vec4 total) { return finite(total); }
