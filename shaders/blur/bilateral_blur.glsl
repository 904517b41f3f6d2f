#include "lib/finite.glsl"

vec4 bilateral_blur(int radius, float sigma, float sigma_range) {
    float nearness = -0.5 / (sigma * sigma), likeness = -0.5 / (sigma_range * sigma_range);
    vec3 here = guide_at(pixel).rgb;
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) {
            int away = x * x + y * y;
            if (away > radius * radius) continue;
            vec3 other = guide_at(pixel + ivec2(x, y)).rgb - here;
            float weight = exp(float(away) * nearness + dot(other, other) * likeness);
            sum += weight * image_at(pixel + ivec2(x, y));
            total += weight;
        }
    return finite(sum / total);
}
