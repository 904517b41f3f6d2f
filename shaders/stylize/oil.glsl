#include "lib/display.glsl"

vec4 oil_tones(vec4 image) { return to_display(image); }
vec4 oil(vec4 tones) { return from_display(tones); }

int oil_level(vec4 color, int levels) {
    return min(int(clamp(luminance(straight(color).rgb), 0.0, 1.0) * float(levels)), levels - 1);
}

// The mean of the colors of the level that most pixels around have. They are read twice: the software rasterizer
// compiles an array of the sums of all levels three times as long.
vec4 oil_dab(int reach, float radius, int levels) {
    float counts[32];
    for (int i = 0; i < levels; ++i) counts[i] = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x)
            if (float(x * x + y * y) <= radius * radius)
                counts[oil_level(tones_at(pixel + ivec2(x, y)), levels)] += 1.0;
    int fullest = 0;
    for (int i = 1; i < levels; ++i)
        if (counts[i] > counts[fullest]) fullest = i;
    vec4 sum = vec4(0.0);
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            vec4 color = tones_at(pixel + ivec2(x, y));
            if (float(x * x + y * y) <= radius * radius && oil_level(color, levels) == fullest) sum += color;
        }
    return finite(sum / counts[fullest]);
}
