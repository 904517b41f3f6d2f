#include "lib/display.glsl"
#include "lib/structure.glsl"

const float kuwahara_pi = 3.14159265;

vec4 kuwahara_tones(vec4 image) { return to_display(image); }
vec4 kuwahara(vec4 tones) { return from_display(tones); }

// The mean of the quadrant with the least variance (Kuwahara 1976). Variances are relative to the pixel's own color:
// the numbers are small and their difference loses no digits.
vec4 kuwahara_quadrants(int radius) {
    vec4 here = tones_at(pixel), best = vec4(0.0);
    float least = 3.4e38, count = float((radius + 1) * (radius + 1));
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
        ivec2 first = pixel - radius * (1 - ivec2(quadrant & 1, quadrant >> 1));
        vec4 sum = vec4(0.0);
        float squares = 0.0;
        for (int y = 0; y <= radius; ++y)
            for (int x = 0; x <= radius; ++x) {
                vec4 other = tones_at(first + ivec2(x, y)) - here;
                sum += other;
                squares += dot(other.rgb, other.rgb);
            }
        vec4 mean = sum / count;
        float variance = squares / count - dot(mean.rgb, mean.rgb);
        if (variance < least) least = variance, best = mean;
    }
    return here + best;
}

// The structure tensor of the Sobel gradient, summed over all channels.
vec3 kuwahara_changes() {
    vec3 falling = tones_at(pixel + ivec2(1, 1)).rgb - tones_at(pixel - ivec2(1, 1)).rgb;
    vec3 rising = tones_at(pixel + ivec2(1, -1)).rgb - tones_at(pixel + ivec2(-1, 1)).rgb;
    vec3 across = 2.0 * (tones_at(pixel + ivec2(1, 0)).rgb - tones_at(pixel - ivec2(1, 0)).rgb) + falling + rising;
    vec3 down = 2.0 * (tones_at(pixel + ivec2(0, 1)).rgb - tones_at(pixel - ivec2(0, 1)).rgb) + falling - rising;
    return vec3(dot(across, across), dot(across, down), dot(down, down)) / 16.0;
}

vec4 kuwahara_sectors(int kind, float radius, float sharpness) {
    // The window is an ellipse along the stroke, with the axes r (1 + A) and r / (1 + A) for the anisotropy A
    // (Kyprianidis et al. 2009).
    vec3 change = changes_at(pixel);
    float anisotropy = kind == KIND_ANISOTROPIC ? structure_anisotropy(change) : 0.0;
    vec2 along = anisotropy > 0.0 ? structure_across(change).yx * vec2(-1.0, 1.0) : vec2(1.0, 0.0);
    vec2 axes = radius * vec2(1.0 + anisotropy, 1.0 / (1.0 + anisotropy));
    vec2 reach = vec2(length(axes * along), length(axes * along.yx));
    mat2 to_disc = mat2(along.x / axes.x, -along.y / axes.y, along.y / axes.x, along.x / axes.y);

    // A sector is where along + zeta > eta across^2 (Kyprianidis et al. 2010); its edges cross at 3/16 of a half turn.
    const float edge_turn = 0.1875 * kuwahara_pi;
    float zeta = 2.0 / radius, eta = (zeta + cos(edge_turn)) / (sin(edge_turn) * sin(edge_turn));
    const mat2 eighth = mat2(0.70710678, -0.70710678, 0.70710678, 0.70710678);

    vec4 here = tones_at(pixel), sums[8];
    float totals[8], squares[8], shares[8];
    for (int k = 0; k < 8; ++k) sums[k] = vec4(0.0), totals[k] = squares[k] = 0.0;
    for (int y = -int(reach.y); y <= int(reach.y); ++y)
        for (int x = -int(reach.x); x <= int(reach.x); ++x) {
            vec2 v = to_disc * vec2(x, y);
            float square = dot(v, v), share = 0.0;
            if (square > 1.0) continue;
            for (int k = 0; k < 8; ++k) {
                float inside = max(v.x + zeta - eta * v.y * v.y, 0.0);
                shares[k] = inside * inside;
                share += shares[k];
                v = eighth * v;
            }
            vec4 other = tones_at(pixel + ivec2(x, y)) - here;
            float weight = exp(-3.125 * square) / share;  // a Gaussian whose sigma is 0.4 of the radius
            for (int k = 0; k < 8; ++k) {
                sums[k] += weight * shares[k] * other;
                squares[k] += weight * shares[k] * dot(other.rgb, other.rgb);
                totals[k] += weight * shares[k];
            }
        }

    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int k = 0; k < 8; ++k) {
        vec4 mean = sums[k] / totals[k];
        float deviation = sqrt(max(squares[k] / totals[k] - dot(mean.rgb, mean.rgb), 0.0));
        float calm = 1.0 / (1.0 + pow(min(255.0 * deviation, 1e3), sharpness));
        sum += calm * mean;
        total += calm;
    }
    return here + sum / total;
}
