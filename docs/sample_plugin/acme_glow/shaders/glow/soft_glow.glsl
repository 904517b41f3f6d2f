#include "lib/finite.glsl"

vec4 acme_glow_soft_glow(vec4 image, vec4 haze, float amount) {
    return finite(mix(finite(image), finite(haze), finite(amount)));
}
