#include "lib/finite.glsl"
#include "lib/hash.glsl"

// The picture as the bands at a height show it.
vec4 glitch_at(vec2 at, int moment, float amount, float shift, float colors, float band, int seed) {
    float moved = 0.0, apart = 0.0;
    for (int level = 0; level < 2; ++level) {
        int row = int(floor(at.y / (level == 0 ? band : 0.25 * band)));
        vec3 dice = hash3(ivec3(row, moment, level), uvec3(uint(seed), 0u, 0u));
        if (dice.x >= amount) continue;
        moved += shift * (2.0 * dice.y - 1.0);
        apart += colors * (2.0 * dice.z - 1.0);
    }
    vec2 here = vec2(at.x + moved, float(pixel.y) + 0.5);
    vec4 middle = image_near(here);
    float red = image_near(here + vec2(apart, 0.0)).r, blue = image_near(here - vec2(apart, 0.0)).b;
    return vec4(red, middle.g, blue, middle.a);
}

// Where two bands meet within a row of pixels, the mean of both by what they cover. Bands thinner than a pixel are seen
// in the middle of the row.
vec4 glitch(float amount, float shift, float colors, float band, int hold, int seed) {
    int moment = int(floor(float(frame) / float(hold)));
    float top = float(pixel.y), thin = 0.25 * band, edge = thin * ceil(top / thin);
    float covered = thin > 1.0 ? clamp(edge - top, 0.0, 1.0) : 1.0;
    vec4 sum = vec4(0.0);
    for (int part = 0; part < 2; ++part) {
        float weight = part == 0 ? covered : 1.0 - covered;
        if (weight <= 0.0) continue;
        float row = thin > 1.0 ? edge + (part == 0 ? -0.5 : 0.5) * thin : top + 0.5;
        sum += weight * glitch_at(vec2(float(pixel.x) + 0.5, row), moment, amount, shift, colors, band, seed);
    }
    return sum;
}
