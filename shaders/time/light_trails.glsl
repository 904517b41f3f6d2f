#include "lib/color.glsl"
#include "lib/finite.glsl"

const float light_trails_limit = 65504.0;  // the largest half float: brighter light would hide what follows

// Light that leaves a trail, without alpha. Above the threshold all light counts: nothing is subtracted.
vec4 light_trails_bright(vec4 image, float threshold, float knee) {
    vec3 light = max(finite(image).rgb, 0.0);
    float from = threshold * (1.0 - knee), to = threshold * (1.0 + knee) + 1e-6;
    if (threshold > 0.0) light *= smoothstep(from, to, luminance(light));
    return vec4(min(light, light_trails_limit), 0.0);
}

vec4 light_trails_fade(vec4 bright, vec4 before, float kept) { return max(bright, kept * before); }

vec4 light_trails(vec4 image, vec4 trail, float intensity) {
    vec4 safe = finite(image);
    return finite(vec4(max(safe.rgb, intensity * trail.rgb), safe.a));
}

vec4 light_trails_alone(vec4 trail, float intensity) { return finite(intensity * trail); }
