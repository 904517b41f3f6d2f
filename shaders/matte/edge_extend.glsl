#include "lib/alpha.glsl"
#include "lib/diffusion.glsl"
#include "lib/morphology.glsl"

float edge_extend_known(vec4 inside, float solid) { return finite(inside.a) >= solid ? 1.0 : 0.0; }

vec4 edge_extend_color(vec4 image) { return straight(finite(image)); }

vec4 edge_extend(vec4 image, vec4 filled, int alpha) {
    float cover = alpha == ALPHA_OPAQUE ? 1.0 : finite(image.a);
    return vec4(cover * finite(filled.rgb), cover);
}
