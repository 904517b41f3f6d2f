#include "lib/bright.glsl"
#include "lib/noise.glsl"
#include "lib/shrinking.glsl"

const int ghosts_most = 12;  // as many as have a magnification

// Magnifications of the ghosts: negative ones lie on the other side of the axis. Their order is mixed, so that any
// number of them looks varied. Chosen by eye.
const float ghosts_magnification[ghosts_most] =
    float[](-0.45, -1.0, 0.3, -1.8, -0.25, 0.55, -0.7, 1.4, -2.6, -0.35, 0.8, -1.3);

// The color of the coating of ghost i. Steps of the golden ratio make neighbors differ.
vec3 ghosts_coating(int i, float colors) {
    return mix(vec3(1.0), with_hue(vec3(0.2, 0.5, 1.0), fract(0.12 + 0.618034 * float(i))), colors);
}

// Lights fade out within a tenth of the height before they leave the picture, so that ghosts do not have hard edges.
float ghosts_inside(vec2 at, vec2 size) {
    vec2 border = min(at, size - at);
    return smoothstep(0.0, 0.1 * size.y, min(border.x, border.y));
}

vec4 ghosts_light(vec4 image, float threshold, float knee, float limit) {
    return bright_light(image, threshold, knee, limit);
}

vec4 ghosts_shrink() { return shrunk(2); }

// One channel of the light at a place.
float ghosts_seen(vec2 at, int channel) {
    return image_near(at)[channel] * ghosts_inside(at, vec2(image_size));
}

vec4 ghosts_flare(
    vec2 center, int count, float spread, float ghosts, float halo, float veil, float radius, float chromatic,
    float colors
) {
    vec2 away = vec2(pixel) + 0.5 - center;
    vec2 outward = away / max(length(away), 1e-6);
    vec3 sum = veil * wide_at(pixel).rgb;
    for (int channel = 0; channel < 3; ++channel) {
        float larger = 1.0 + chromatic * float(1 - channel);
        for (int i = 0; i < min(count, ghosts_most); ++i) {
            float magnified = ghosts_magnification[i] * spread * larger;
            float share = ghosts * ghosts_coating(i, colors)[channel] / (magnified * magnified);
            sum[channel] += share * ghosts_seen(center + away / magnified, channel);
        }
        sum[channel] += halo * ghosts_seen(center + away - radius * larger * outward, channel);
    }
    return vec4(sum, 1.0);
}

vec4 ghosts_enlarge() { return enlarged(2); }

vec4 ghosts_dirt(vec4 image, vec4 dirt) { return clamp(finite(dirt), 0.0, 65504.0); }

// Out-of-focus discs of dust, one per cell, with random sizes and strengths; brighter at the rim. All numbers of the dirt
// are chosen by eye.
float ghosts_dust(vec2 at, uint seed) {
    vec3 place = hash3(ivec3(floor(at), 0), uvec3(seed)), look = hash3(ivec3(floor(at), 1), uvec3(seed));
    float size = mix(0.08, 0.35, look.x * look.x);
    float far = length(fract(at) - mix(vec2(size), vec2(1.0 - size), place.xy)) / size;
    return look.y * look.y * look.z * smoothstep(1.0, 0.85, far) * mix(0.6, 1.0, far);
}

// Smudges of wiped grease and dust of three sizes, as values 0..1. Places are in heights of the picture.
vec4 ghosts_smudges(vec4 image) {
    vec2 at = (vec2(pixel) + 0.5) / float(extent.y);
    vec2 wiped = mat2(0.8, 0.6, -0.6, 0.8) * at * vec2(3.0, 9.0);
    float grease = gradient_noise(vec3(wiped, 0.5), uvec3(7u)).x;
    grease += 0.5 * gradient_noise(vec3(2.3 * wiped, 1.5), uvec3(7u)).y;
    float dust = ghosts_dust(at * 6.0, 1u) + ghosts_dust(at * 11.0, 2u) + 0.7 * ghosts_dust(at * 23.0, 3u);
    return vec4(vec3(clamp(0.25 + 0.25 * grease + dust, 0.0, 1.0)), 1.0);
}

vec4 ghosts_glow(vec4 image, vec4 flare, vec4 dirt, float amount, vec4 tint) {
    return glow_alone(image, flare.rgb * mix(vec3(1.0), dirt.rgb, amount) * tint.rgb);
}

vec4 ghosts(vec4 image, vec4 glow) { return with_glow(image, glow.rgb); }
