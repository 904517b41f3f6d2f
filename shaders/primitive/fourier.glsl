// Fast Fourier transforms of four real pictures at once: red + i green and blue + i alpha are two complex pictures.
#include "lib/pi.glsl"

vec2 fourier_times(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

// One step of Horner's scheme, for the sum of x[k] root^k.
vec4 fourier_step(vec4 sum, vec2 root, vec4 x) {
    return x + vec4(fourier_times(sum.xy, root), fourier_times(sum.zw, root));
}

vec2 fourier_root(int frequency, int points, float direction) {
    if (2 * frequency > points) frequency -= points;  // the smaller of two equal angles is more exact
    float angle = direction * 2.0 * PI * float(frequency) / float(points);
    return vec2(cos(angle), sin(angle));
}

// a / b, exact for all positions. Integer division would take the software rasterizer longer than the rest of a stage.
int fourier_quotient(int a, int b) { return int((float(a) + 0.5) / float(b)); }

// The first stage along an axis: transforms of every `apart`-th pixel. NaN counts as black, and so do all but the first
// `terms` pixels.
vec4 fourier_first(int axis, int terms, int radix, int apart) {
    int start = fourier_quotient(pixel[axis], radix);
    vec2 root = fourier_root(pixel[axis] - start * radix, radix, -1.0);
    ivec2 p = pixel, along = axis == 0 ? ivec2(apart, 0) : ivec2(0, apart);
    p[axis] = start + (terms - 1) * apart;
    vec4 sum = image_at(p);
    for (int k = 1; k < terms; ++k) sum = fourier_step(sum, root, image_at(p -= along));
    return sum;
}

// One more stage (Stockham, decimation in time): `radix` transforms of `span` points become one. Only pixels from
// `first` on are computed.
vec4 fourier_stage(int axis, int radix, int span, int apart, int first, float direction) {
    int at = pixel[axis] + first, points = span * radix;
    int group = fourier_quotient(at, points), frequency = at - group * points;
    vec2 root = fourier_root(frequency, points, direction);
    ivec2 p = pixel, along = axis == 0 ? ivec2(apart, 0) : ivec2(0, apart);
    p[axis] = group * span + frequency - fourier_quotient(frequency, span) * span + (radix - 1) * apart;
    vec4 sum = image_raw(p);
    for (int k = 1; k < radix; ++k) sum = fourier_step(sum, root, image_raw(p -= along));
    return sum;
}

// The product of the spectra of two real pictures, for a pair of channels. The even part in frequency belongs to the
// first channel, the odd part to i times the second.
vec2 fourier_pair(vec2 a, vec2 a_back, vec2 b, vec2 b_back) {
    a_back.y = -a_back.y, b_back.y = -b_back.y;
    vec2 even = 0.5 * (b + b_back), odd = 0.5 * (b - b_back);
    return fourier_times(0.5 * (a + a_back), even) + fourier_times(0.5 * (a - a_back), vec2(odd.y, -odd.x));
}

vec4 fourier_product(float scale) {
    ivec2 back = ivec2(pixel.x == 0 ? 0 : image_size.x - pixel.x, pixel.y == 0 ? 0 : image_size.y - pixel.y);
    vec4 a = image_raw(pixel), a_back = image_raw(back), b = kernel_raw(pixel), b_back = kernel_raw(back);
    return scale * vec4(fourier_pair(a.xy, a_back.xy, b.xy, b_back.xy), fourier_pair(a.zw, a_back.zw, b.zw, b_back.zw));
}
