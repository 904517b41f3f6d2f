#include "lib/color.glsl"
#include "lib/finite.glsl"

vec4 rebuild_beauty_none() { return vec4(0.0); }

// Adds light; alpha is the largest of all.
vec4 rebuild_beauty_light(vec4 total, vec4 light) {
    vec4 safe = finite(light);
    return finite(vec4(total.rgb + safe.rgb, max(total.a, safe.a)));
}

vec4 rebuild_beauty_lobe(vec4 total, vec4 color, vec4 direct, vec4 indirect) {
    vec4 safe = finite(direct), more = finite(indirect);
    return rebuild_beauty_light(total, vec4(finite(color).rgb * (safe.rgb + more.rgb), max(safe.a, more.a)));
}

vec4 rebuild_beauty(vec4 total, vec4 beauty, bool known) { return known ? vec4(total.rgb, finite(beauty.a)) : total; }

float rebuild_beauty_difference(vec4 total, vec4 beauty, bool known) {
    return known ? finite(largest(abs(total.rgb - finite(beauty.rgb)))) : 0.0;
}

float rebuild_beauty_error(float most) { return most; }
