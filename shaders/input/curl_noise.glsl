#include "lib/finite.glsl"
#include "lib/noise.glsl"

void curl_noise(
    float size, int octaves, float lacunarity, float gain, float strength, int seed, float evolution,
    out vec2 vector, out float stream
) {
    vec3 position = vec3((vec2(pixel) + 0.5) / max(finite(size), 1e-3), finite(evolution)), sum = vec3(0.0);
    float height = 1.0, density = 1.0, total = 0.0;
    for (int octave = 0; octave < min(octaves, 16); octave++) {
        vec4 layer = simplex_slope(position * density, pcg3d(uvec3(uint(seed), uint(octave), 0u)));
        float speed = height * density;  // chain rule: the slope of a layer grows with its frequency
        sum += vec3(speed * layer.y, -speed * layer.x, height * layer.w);
        total += speed;
        height *= finite(gain);
        density *= finite(lacunarity);
    }
    sum = finite(sum * (finite(strength) / (total * SIMPLEX_STEEPEST)));
    vector = sum.xy;
    stream = sum.z;
}
