#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

const float split_toning_gray = 0.18;  // middle gray

// A tint as factors for the channels that keep the luminance of gray.
vec3 split_toning_tint(vec4 color) {
    vec3 rgb = max(finite(color.rgb), 0.0);
    float light = luminance(rgb);
    return light > 1e-6 ? rgb / light : vec3(1.0);
}

vec4 split_toning(vec4 image, vec4 shadows, vec4 highlights, float balance, float range, float amount) {
    vec4 color = straight(finite(image));
    float light = luminance(color.rgb);
    if (light <= 0.0) return finite(image);
    float stops = log2(light / split_toning_gray) - finite(balance);
    float bright = smoothstep(-0.5, 0.5, stops / max(finite(range), 0.01));
    vec3 tint = mix(split_toning_tint(shadows), split_toning_tint(highlights), bright);
    vec3 toned = finite(color.rgb * mix(vec3(1.0), tint, finite(amount)));
    // Restore the luminance that a color lost or gained by the tint. 14 is the largest possible loss, that of pure
    // blue: 1 / 0.0722 = 13.9.
    color.rgb = toned * clamp(light / max(luminance(toned), 1e-12), 0.0, 14.0);
    return finite(premultiplied(color));
}
