#include "lib/finite.glsl"

float channel_mixer_mix(vec3 rgb, vec3 parts, bool normalized) {
    parts = finite(parts);
    float total = parts.r + parts.g + parts.b;
    return dot(rgb, parts) / (normalized && abs(total) > 1e-6 ? total : 1.0);
}

vec4 channel_mixer(
    vec4 image, vec3 red, vec3 green, vec3 blue, bool monochrome, vec3 gray, vec3 constant, bool normalized
) {
    image = finite(image);
    vec3 mixed;
    if (monochrome) mixed = vec3(channel_mixer_mix(image.rgb, gray, normalized));
    else mixed = vec3(
        channel_mixer_mix(image.rgb, red, normalized), channel_mixer_mix(image.rgb, green, normalized),
        channel_mixer_mix(image.rgb, blue, normalized)
    );
    return finite(vec4(finite(mixed) + image.a * finite(constant), image.a));
}
