#include "lib/finite.glsl"
#include "lib/hash.glsl"

vec4 glitch(float amount, float shift, float colors, float band, int hold, int seed) {
    vec2 at = vec2(pixel) + 0.5;
    int moment = int(floor(float(frame) / float(hold)));
    float moved = 0.0, apart = 0.0;
    for (int level = 0; level < 2; ++level) {
        int row = int(floor(at.y / (level == 0 ? band : 0.25 * band)));
        vec3 dice = hash3(ivec3(row, moment, level), uvec3(uint(seed), 0u, 0u));
        if (dice.x >= amount) continue;
        moved += shift * (2.0 * dice.y - 1.0);
        apart += colors * (2.0 * dice.z - 1.0);
    }
    vec4 middle = image_near(at + vec2(moved, 0.0));
    float red = image_near(at + vec2(moved + apart, 0.0)).r, blue = image_near(at + vec2(moved - apart, 0.0)).b;
    return vec4(red, middle.g, blue, middle.a);
}
