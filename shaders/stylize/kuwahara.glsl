#include "lib/display.glsl"
#include "lib/pi.glsl"
#include "lib/structure.glsl"

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

// The window is an ellipse along the stroke, with the axes r (1 + A) and r / (1 + A) for the anisotropy A (Kyprianidis et
// al. 2009). A sector is where along + zeta > eta across^2 (Kyprianidis et al. 2010); its edges cross at 3/16 of a half
// turn.
struct kuwahara_Window {
    mat2 to_disc;
    ivec2 reach;
    float zeta, eta;
};

kuwahara_Window kuwahara_window(vec3 change, int kind, float radius) {
    float anisotropy = kind == KIND_ANISOTROPIC ? structure_anisotropy(change) : 0.0;
    vec2 along = anisotropy > 0.0 ? structure_across(change).yx * vec2(-1.0, 1.0) : vec2(1.0, 0.0);
    vec2 axes = radius * vec2(1.0 + anisotropy, 1.0 / (1.0 + anisotropy));
    mat2 to_disc = mat2(along.x / axes.x, -along.y / axes.y, along.y / axes.x, along.x / axes.y);
    const float edge_turn = 0.1875 * PI;
    float zeta = 2.0 / radius, eta = (zeta + cos(edge_turn)) / (sin(edge_turn) * sin(edge_turn));
    return kuwahara_Window(to_disc, ivec2(length(axes * along), length(axes * along.yx)), zeta, eta);
}

// Weighted sums over each of the eight sectors: of tones, of their squares, of weights. Sectors along the axes of the
// ellipse come first, those between them second.
struct kuwahara_Sectors {
    mat4 sums[2];
    vec4 squares[2], totals[2];
};

kuwahara_Sectors kuwahara_empty() {
    kuwahara_Sectors sectors;
    for (int turn = 0; turn < 2; ++turn) {
        sectors.sums[turn] = mat4(0.0);
        sectors.squares[turn] = sectors.totals[turn] = vec4(0.0);
    }
    return sectors;
}

// How much of a place lies in each of four sectors, which are a quarter turn apart.
vec4 kuwahara_inside(kuwahara_Window window, vec2 v) {
    vec4 inside = max(vec4(v, -v) + window.zeta - window.eta * (v * v).yxyx, 0.0);
    return inside * inside;
}

// Adds `count` pixels around `away`, whose mean differs by `other` and which vary by `variance`.
void kuwahara_add(
    inout kuwahara_Sectors sectors, kuwahara_Window window, vec2 away, vec4 other, float variance, float count
) {
    vec2 v = window.to_disc * away;
    float distance_squared = dot(v, v);
    if (distance_squared > 1.0) return;
    vec4 inside[2];
    inside[0] = kuwahara_inside(window, v);
    inside[1] = kuwahara_inside(window, sqrt(0.5) * vec2(v.x + v.y, v.y - v.x));
    float share = dot(inside[0] + inside[1], vec4(1.0));
    float weight = count * exp(-3.125 * distance_squared) / share;  // a Gaussian whose sigma is 0.4 of the radius
    float square = dot(other.rgb, other.rgb) + variance;
    for (int turn = 0; turn < 2; ++turn) {
        vec4 weights = weight * inside[turn];
        sectors.sums[turn] += outerProduct(other, weights);
        sectors.squares[turn] += weights * square;
        sectors.totals[turn] += weights;
    }
}

// The mean of all sectors, which count less the more they vary.
vec4 kuwahara_calmest(kuwahara_Sectors sectors, float sharpness) {
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int turn = 0; turn < 2; ++turn)
        for (int k = 0; k < 4; ++k) {
            vec4 mean = sectors.sums[turn][k] / sectors.totals[turn][k];
            float variance = sectors.squares[turn][k] / sectors.totals[turn][k] - dot(mean.rgb, mean.rgb);
            float calm = 1.0 / (1.0 + pow(min(255.0 * sqrt(max(variance, 0.0)), 1e3), sharpness));
            sum += calm * mean;
            total += calm;
        }
    return sum / total;
}

vec4 kuwahara_sectors(int kind, float radius, float sharpness) {
    kuwahara_Window window = kuwahara_window(changes_at(pixel), kind, radius);
    kuwahara_Sectors sectors = kuwahara_empty();
    vec4 here = tones_at(pixel);
    for (int y = -window.reach.y; y <= window.reach.y; ++y)
        for (int x = -window.reach.x; x <= window.reach.x; ++x)
            kuwahara_add(sectors, window, vec2(x, y), tones_at(pixel + ivec2(x, y)) - here, 0.0, 1.0);
    return here + kuwahara_calmest(sectors, sharpness);
}

// The mean and the variance of the tones in a square.
void kuwahara_cells(int cell, out vec4 mean, out float variance) {
    vec4 here = tones_at(cell * pixel), sum = vec4(0.0);
    float squares = 0.0, count = float(cell * cell);
    for (int y = 0; y < cell; ++y)
        for (int x = 0; x < cell; ++x) {
            vec4 other = tones_at(cell * pixel + ivec2(x, y)) - here;
            sum += other;
            squares += dot(other.rgb, other.rgb);
        }
    sum /= count;
    mean = here + sum;
    variance = max(squares / count - dot(sum.rgb, sum.rgb), 0.0);
}

// As above, but only the cells that are at most `near` away are read pixel by pixel. `margin` was added around the cells.
vec4 kuwahara_sectors_of_cells(int kind, float radius, float sharpness, int cell, int margin, int near) {
    kuwahara_Window window = kuwahara_window(changes_at(pixel), kind, radius);
    kuwahara_Sectors sectors = kuwahara_empty();
    vec4 here = tones_at(pixel);
    ivec2 middle = pixel + margin;
    ivec2 first_near = (middle - near) / cell, last_near = (middle + near) / cell;
    for (int y = first_near.y * cell - middle.y; y < (last_near.y + 1) * cell - middle.y; ++y)
        for (int x = first_near.x * cell - middle.x; x < (last_near.x + 1) * cell - middle.x; ++x)
            kuwahara_add(sectors, window, vec2(x, y), tones_at(pixel + ivec2(x, y)) - here, 0.0, 1.0);
    ivec2 first = (middle - window.reach) / cell, last = (middle + window.reach) / cell;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            ivec2 place = ivec2(x, y);
            if (all(greaterThanEqual(place, first_near)) && all(lessThanEqual(place, last_near))) continue;
            vec2 away = (vec2(place) + 0.5) * float(cell) - vec2(middle) - 0.5;
            kuwahara_add(
                sectors, window, away, means_at(place) - here, variances_at(place), float(cell * cell)
            );
        }
    return here + kuwahara_calmest(sectors, sharpness);
}
