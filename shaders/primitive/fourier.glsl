// Fast Fourier transforms of four real pictures at once: red + i green and blue + i alpha are two complex ones.

vec2 fourier_times(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

// One step of Horner's scheme, for the sum of x[k] root^k.
vec4 fourier_step(vec4 sum, vec2 root, vec4 x) {
    return x + vec4(fourier_times(sum.xy, root), fourier_times(sum.zw, root));
}

vec2 fourier_root(int frequency, int points, float direction) {
    if (2 * frequency > points) frequency -= points;  // small angles are exact ones
    float angle = direction * 6.283185307179586 * float(frequency) / float(points);
    return vec2(cos(angle), sin(angle));
}

// a / b, exact for all positions: dividing integers would cost the software rasterizer more than the rest of a stage.
int fourier_quotient(int a, int b) { return int((float(a) + 0.5) / float(b)); }

// The first stage along an axis: transforms of every `apart`-th pixel. NaN counts as black, and so does
// what lies behind the first `terms` of them.
vec4 fourier_first(int axis, int terms, int radix, int apart) {
    int start = fourier_quotient(pixel[axis], radix);
    vec2 root = fourier_root(pixel[axis] - start * radix, radix, -1.0);
    ivec2 p = pixel, along = axis == 0 ? ivec2(apart, 0) : ivec2(0, apart);
    p[axis] = start + (terms - 1) * apart;
    vec4 sum = image_at(p);
    for (int k = 1; k < terms; ++k) sum = fourier_step(sum, root, image_at(p -= along));
    return sum;
}

// One more stage (Stockham's, decimated in time): `radix` transforms of `span` points become one of all. Pixels from
// `first` on are wanted.
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

// The product of two real pictures' spectra for a pair of channels: what is even in frequency belongs to the first
// channel, what is odd to i times the second.
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
