// How eyes and cameras adapt to the light of a scene.
#include "lib/alpha.glsl"
#include "lib/finite.glsl"

// The light of a pixel without its alpha, and how much it counts: by what it covers, 0 where it is NaN.
vec4 metered(vec4 image) {
    if (!is_finite(image) || image.a <= ALPHA_NONE) return vec4(0.0);
    return vec4(max(straight(image).rgb, 0.0), image.a);
}

// What middle gray a scene of this luminance (cd/m2) calls for: dark for night, bright for day (Krawczyk et al. 2005).
float natural_key(float nits) { return 1.03 - 2.0 / (2.0 + log(max(nits, 0.0) + 1.0) / log(10.0)); }
