#include "lib/alpha.glsl"
#include "lib/finite.glsl"

vec4 lut_file_color(vec4 image) { return straight(finite(image)); }

vec4 lut_file(vec4 image, vec4 changed, float amount) {
    vec4 color = straight(finite(image));
    color.rgb = mix(color.rgb, finite(changed.rgb), amount);
    return finite(premultiplied(color));
}
