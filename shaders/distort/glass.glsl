#include "lib/finite.glsl"
#include "lib/noise.glsl"
#include "lib/spectrum.glsl"

const float glass_steepest = 1e3;  // keeps the slopes of wild surfaces finite

// The offset at which the picture is seen through a surface of this slope (Snell's law).
vec2 glass_shift(vec2 slope, float thickness, float index) {
    slope = clamp(slope, -glass_steepest, glass_steepest);
    vec3 ray = refract(vec3(0.0, 0.0, -1.0), normalize(vec3(-slope, 1.0)), 1.0 / max(index, 1.0));
    return thickness * ray.xy / -ray.z;
}

// The picture through a surface. `light.x` is the index of refraction for green, `light.y` the difference between blue
// and red.
vec4 glass_through(vec2 slope, float thickness, vec2 light, int samples) {
    vec2 at = vec2(pixel) + 0.5;
    if (samples == 1) return image_near(at + glass_shift(slope, thickness, light.x));
    vec4 sum = vec4(0.0), total = vec4(0.0);
    for (int i = 0; i < samples; ++i) {
        float place = 2.0 * float(i) / float(samples - 1) - 1.0;
        vec4 response = spectrum_response(place);
        sum += response * image_near(at + glass_shift(slope, thickness, light.x + 0.5 * place * light.y));
        total += response;
    }
    return finite(sum / total);
}

// Beyond the border the surface continues with its last pixels, whatever edge mode the picture has.
float glass_surface(ivec2 p) { return surface_at(clamp(p, ivec2(0), surface_size - 1)); }

vec4 glass(float relief, float thickness, vec2 light, int samples) {
    vec2 rise = vec2(
        glass_surface(pixel + ivec2(1, 0)) - glass_surface(pixel - ivec2(1, 0)),
        glass_surface(pixel + ivec2(0, 1)) - glass_surface(pixel - ivec2(0, 1))
    );
    return glass_through(0.5 * relief * finite(rise), thickness, light, samples);
}

float glass_bump(vec2 at, float size, int seed) {
    return 0.5 + 0.5 * gradient_noise(vec3(at / size, 0.5), uvec3(uint(seed), 0u, 0u)).x;
}

vec4 glass_hammered(float relief, float thickness, vec2 light, int samples, float bump, int seed) {
    vec2 at = vec2(pixel) + 0.5, right = vec2(0.5, 0.0), down = right.yx;
    vec2 rise = vec2(
        glass_bump(at + right, bump, seed) - glass_bump(at - right, bump, seed),
        glass_bump(at + down, bump, seed) - glass_bump(at - down, bump, seed)
    );
    return glass_through(relief * rise, thickness, light, samples);
}
