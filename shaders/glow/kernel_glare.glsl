#include "lib/bright.glsl"
#include "lib/color.glsl"
#include "lib/glare.glsl"
#include "lib/pi.glsl"
#include "lib/spectrum.glsl"

const float kernel_glare_nm = 550.0;  // nm: the wavelength for which the pattern of an iris is computed

vec4 kernel_glare_light(vec4 image, float threshold, float knee, float limit) {
    return glare_light(threshold > 0.0 || limit < GLARE_BRIGHTEST ? bright_light(image, threshold, knee, limit) : image);
}

vec4 kernel_glare_shrink(int factor) { return glare_shrunk(factor); }

vec4 kernel_glare_grow(int factor) { return small_near(glare_grown(factor)) / float(factor * factor); }

// Resizes the kernel: each pixel is the mean of the area that it covers, or an interpolation where that is less than a
// pixel.
vec4 kernel_glare_fit() {
    vec2 scale = vec2(kernel_size) / vec2(extent), covered = 0.5 * max(scale, 1.0);
    vec2 middle = (vec2(pixel) + 0.5) * scale, low = middle - covered, high = middle + covered;
    vec3 sum = vec3(0.0);
    for (int y = int(floor(low.y)); y < int(ceil(high.y)); ++y)
        for (int x = int(floor(low.x)); x < int(ceil(high.x)); ++x) {
            vec2 share = min(high, vec2(x + 1, y + 1)) - max(low, vec2(x, y));
            sum += share.x * share.y * clamp(kernel_at(ivec2(x, y)).rgb, 0.0, GLARE_BRIGHTEST);
        }
    return vec4(sum, 0.0);
}

// The diffraction pattern of a regular polygon of radius 1 for one wavelength: the square of its Fourier transform,
// computed by the divergence theorem as a sum over the edges. It is 1 in the center.
float kernel_glare_diffracted(vec2 k, int blades, float angle) {
    float part = 2.0 * PI / float(blades), square = dot(k, k);
    float side = 2.0 * sin(0.5 * part), inner = cos(0.5 * part), area = 0.5 * float(blades) * sin(part);
    if (square < 1e-3) return 1.0;
    vec2 sum = vec2(0.0);
    for (int i = 0; i < blades; ++i) {
        vec2 normal = vec2(cos(angle + part * float(i)), sin(angle + part * float(i)));
        float across = dot(k, normal), along = 0.5 * side * (k.y * normal.x - k.x * normal.y);
        float amount = across * side * (abs(along) < 1e-3 ? 1.0 : sin(along) / along);
        sum += amount * vec2(cos(across * inner), sin(across * inner));
    }
    return dot(sum, sum) / (square * square * area * area);
}

// The diffraction pattern of an iris with `pitch` units of the transform per pixel. A `falloff` below 1 makes its rays
// brighter.
float kernel_glare_iris(float pitch, int blades, float angle, float falloff) {
    int n = int(clamp(ceil(pitch), 2.0, 8.0));
    float sum = 0.0;
    for (int i = 0; i < n * n; ++i) {
        vec2 inside = (vec2(i % n, i / n) + 0.5) / float(n) - 0.5;
        sum += pow(kernel_glare_diffracted(pitch * (vec2(pixel - extent / 2) + inside), blades, angle), falloff);
    }
    return sum / float(n * n);
}

// The pattern for white light: longer wavelengths give larger, fainter patterns. It fades out toward a circle within
// the kernel's borders.
vec4 kernel_glare_dispersed() {
    vec2 way = vec2(pixel - extent / 2), middle = 0.5 * vec2(iris_size);
    vec3 sum = vec3(0.0), white = vec3(0.0);
    for (float nm = 400.0; nm <= 700.0; nm += 5.0) {
        vec3 color = spectrum_color(nm);
        float scale = kernel_glare_nm / nm;
        sum += color * scale * scale * iris_near(middle + scale * way);
        white += color;
    }
    float end = 2.0 * length(way) / float(extent.y);
    return vec4(sum / white * (1.0 - smoothstep(0.2, 1.0, end)), 0.0);
}

// A kernel with sum 1, in luminance or in each channel. Its alpha is its luminance: convolved with the light's alpha,
// which is 1, it gives the part of the kernel that lies within the picture.
vec4 kernel_glare_normalized(vec4 kernel, vec4 sum, bool white) {
    float light = luminance(sum.rgb);
    vec3 even = light > 0.0 ? kernel.rgb / (white ? max(sum.rgb, 1e-20) : vec3(light)) : vec3(0.0);
    return vec4(even, luminance(even));
}

vec4 kernel_glare_glow(vec4 image, vec4 glare) { return vec4(glare.rgb, finite(image.a)); }

// In the mode mix, a pixel loses the light that its glare spreads within the picture.
vec4 kernel_glare(vec4 image, vec4 light, vec4 glare, float intensity, int mode) {
    vec3 taken = mode == MODE_MIX ? glare.a * light.rgb : vec3(0.0);
    return vec4(finite(image.rgb) + intensity * (glare.rgb - taken), finite(image.a));
}
