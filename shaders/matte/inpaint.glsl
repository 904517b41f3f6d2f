#include "lib/diffusion.glsl"
#include "lib/morphology.glsl"

vec4 inpaint_wide(float hole) { return vec4(clamp(finite(hole), 0.0, 1.0)); }

float inpaint_known(vec4 hole) { return hole.r > 0.0 ? 0.0 : 1.0; }

vec4 inpaint(vec4 image, vec4 hole, vec4 filled, bool opaque) {
    vec4 filling = finite(filled);
    if (opaque) filling.a = 1.0;
    return mix(finite(image), filling, hole.r);
}
