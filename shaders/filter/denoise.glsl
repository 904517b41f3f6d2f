#include "lib/finite.glsl"

// What the library takes: light that is finite and not negative, and display colors up to 1.
vec4 denoise_color(vec4 image, bool hdr) {
    vec4 safe = finite(image);
    return vec4(clamp(safe.rgb, vec3(0.0), vec3(hdr ? 65504.0 : 1.0)), safe.a);
}

// A guide is a picture also where its socket has a constant.
vec4 denoise_albedo(vec4 image, vec4 albedo) { return clamp(finite(albedo), 0.0, 1.0); }

vec3 denoise_normal(vec3 normal) { return clamp(finite(normal), -1.0, 1.0); }

vec4 denoise(vec4 image, vec4 denoised) { return finite(vec4(denoised.rgb, finite(image.a))); }
