#include "lib/color.glsl"
#include "lib/finite.glsl"

vec4 saturation(vec4 image, float saturation) {
    image = finite(image);
    return finite(vec4(mix(vec3(luminance(image.rgb)), image.rgb, finite(saturation)), image.a));
}
