#include "lib/display.glsl"

vec4 oil_tones(vec4 image) { return to_display(image); }
vec4 oil(vec4 tones) { return from_display(tones); }

vec4 oil_dab(int reach, float radius, int levels) {
    vec4 sums[32];
    float counts[32];
    for (int i = 0; i < levels; ++i) sums[i] = vec4(0.0), counts[i] = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            if (float(x * x + y * y) > radius * radius) continue;
            vec4 color = tones_at(pixel + ivec2(x, y));
            int level = int(clamp(luminance(straight(color).rgb), 0.0, 1.0) * float(levels));
            level = min(level, levels - 1);
            sums[level] += color;
            counts[level] += 1.0;
        }
    int fullest = 0;
    for (int i = 1; i < levels; ++i)
        if (counts[i] > counts[fullest]) fullest = i;
    return finite(sums[fullest] / counts[fullest]);
}
