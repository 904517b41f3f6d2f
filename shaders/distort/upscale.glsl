// FSR 1 (AMD 2021, ffx_fsr1.h 1.20210629), with exact divisions where it approximates them.

#include "lib/color.glsl"
#include "lib/finite.glsl"

// What FSR filters: square roots of light within 0..1. Light of a scene fits by FsrSrtm.
vec4 upscale_encode(vec4 image, int light) {
    vec4 code = max(finite(image), 0.0);
    if (light == LIGHT_SCENE) code.rgb /= 1.0 + largest(code.rgb);
    return sqrt(clamp(code, 0.0, 1.0));
}

vec4 upscale_decode(vec4 code, int light) {
    vec4 result = code * code;
    if (light == LIGHT_SCENE) result.rgb /= max(1.0 - largest(result.rgb), 1.0 / 65536.0);
    return result;
}

// Twice the luma of a color, as FSR has it.
float upscale_luma(vec4 code) { return 0.5 * code.r + code.g + 0.5 * code.b; }

// FsrEasuSet along one axis: the slope at the middle one of three lumas (x), and whether it runs on in one direction,
// from 0 for a ridge to 1 for an edge (y).
vec2 upscale_slope(float before, float here, float after) {
    float slope = after - before, steepest = max(max(abs(after - here), abs(here - before)), 1e-9);
    float runs_on = clamp(abs(slope) / steepest, 0.0, 1.0);
    return vec2(slope, runs_on * runs_on);
}

// Adds the edge at a pixel: its direction (xy) and how clear it is (z).
vec3 upscale_edge(float up, float left, float here, float right, float down, float weight) {
    vec2 across = upscale_slope(left, here, right), along = upscale_slope(up, here, down);
    return weight * vec3(across.x, along.x, across.y + along.y);
}

// FsrEasuTap: the weight of a pixel, an approximation of Lanczos with 2 lobes without sines.
float upscale_weight(vec2 away, vec2 direction, vec2 stretch, float lobe) {
    vec2 turned = vec2(dot(away, direction), dot(away, vec2(-direction.y, direction.x))) * stretch;
    float square = min(dot(turned, turned), 1.0 / lobe);
    float base = 0.4 * square - 1.0, window = lobe * square - 1.0;
    return (1.5625 * base * base - 0.5625) * window * window;
}

vec4 upscale_easu(int light) {
    vec2 place = (vec2(pixel) + 0.5) * vec2(image_size) / vec2(extent) - 0.5;
    ivec2 corner = ivec2(floor(place));
    vec2 t = place - vec2(corner), u = 1.0 - t;
    vec4 code[16];  // four rows of four; FSR leaves out the corners
    float luma[16];
    for (int i = 0; i < 16; ++i) {
        code[i] = upscale_encode(image_at(corner + ivec2(i & 3, i >> 2) - 1), light);
        luma[i] = upscale_luma(code[i]);
    }
    vec3 edge = vec3(0.0);
    edge += upscale_edge(luma[1], luma[4], luma[5], luma[6], luma[9], u.x * u.y);
    edge += upscale_edge(luma[2], luma[5], luma[6], luma[7], luma[10], t.x * u.y);
    edge += upscale_edge(luma[5], luma[8], luma[9], luma[10], luma[13], u.x * t.y);
    edge += upscale_edge(luma[6], luma[9], luma[10], luma[11], luma[14], t.x * t.y);
    float steep = dot(edge.xy, edge.xy), clear = 0.25 * edge.z * edge.z;
    vec2 direction = steep < 1.0 / 32768.0 ? vec2(1.0, edge.y) : edge.xy * inversesqrt(steep);
    float longer = dot(direction, direction) / max(abs(direction.x), abs(direction.y));
    vec2 stretch = vec2(1.0 + (longer - 1.0) * clear, 1.0 - 0.5 * clear);
    float lobe = 0.5 - 0.29 * clear, total = 0.0;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 16; ++i) {
        if (i == 0 || i == 3 || i == 12 || i == 15) continue;
        float weight = upscale_weight(vec2(i & 3, i >> 2) - 1.0 - t, direction, stretch, lobe);
        sum += weight * code[i];
        total += weight;
    }
    vec4 least = min(min(code[5], code[6]), min(code[9], code[10]));
    vec4 most = max(max(code[5], code[6]), max(code[9], code[10]));
    return clamp(sum / total, least, most);
}

// FsrRcas: subtracts as much of the four neighbors as leaves the result within 0..1.
vec4 upscale_rcas(float sharpness, int light) {
    vec4 here = codes_at(pixel);
    vec3 up = codes_at(pixel - ivec2(0, 1)).rgb, left = codes_at(pixel - ivec2(1, 0)).rgb;
    vec3 right = codes_at(pixel + ivec2(1, 0)).rgb, down = codes_at(pixel + ivec2(0, 1)).rgb;
    vec3 least = min(min(up, left), min(right, down)), most = max(max(up, left), max(right, down));
    vec3 to_black = least / max(4.0 * most, 1e-9), to_white = (1.0 - most) / max(4.0 - 4.0 * least, 1e-9);
    float lobe = clamp(largest(-min(to_black, to_white)), -0.1875, 0.0) * clamp(finite(sharpness), 0.0, 1.0);
    vec3 sharp = (lobe * (up + left + right + down) + here.rgb) / (4.0 * lobe + 1.0);
    // Codes near 1 stand for very bright light of a scene: what goes beyond its neighbors would become a firefly.
    if (light == LIGHT_SCENE) sharp = clamp(sharp, min(least, here.rgb), max(most, here.rgb));
    return upscale_decode(vec4(clamp(sharp, 0.0, 1.0), here.a), light);
}
