#include "lib/alpha.glsl"
#include "lib/finite.glsl"

vec4 clip(vec4 image, float low, float high) {
    vec4 color = straight(finite(image));
    // Transparent pixels stay black.
    float lowest = color.a > ALPHA_NONE ? finite(low) : min(finite(low), 0.0);
    color.rgb = max(min(color.rgb, vec3(finite(high))), vec3(lowest));
    return finite(premultiplied(color));
}
