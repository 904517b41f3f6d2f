// Light meters: how eyes and cameras adapt to a scene.
#include "lib/alpha.glsl"
#include "lib/finite.glsl"

// The light of a pixel without its alpha, and its weight: its coverage, 0 for NaN.
vec4 metered(vec4 image) {
    if (!is_finite(image) || image.a <= ALPHA_NONE) return vec4(0.0);
    return vec4(max(straight(image).rgb, 0.0), image.a);
}

// The middle gray that suits a scene of this luminance in cd/m2: dark at night, bright by day (Krawczyk et al. 2005).
float natural_key(float nits) { return 1.03 - 2.0 / (2.0 + log(max(nits, 0.0) + 1.0) / log(10.0)); }
