// Fast Fourier transforms of four real pictures at once: red + i green and blue + i alpha are two complex ones.

vec2 fourier_times(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

// One stage along an axis (Stockham's, decimated in time): `radix` transforms of `span` points become one of all. The
// input may be shorter than `count`, the rest of it is 0; of the result, pixels from `first` on are wanted.
vec4 fourier_stage(int axis, int radix, int span, int count, int first, float direction) {
    int at = pixel[axis] + first, points = span * radix, frequency = at % points, apart = count / radix;
    ivec2 p = pixel, along = axis == 0 ? ivec2(apart, 0) : ivec2(0, apart);
    p[axis] = at / points * span + at % span + (radix - 1) * apart;
    if (2 * frequency > points) frequency -= points;  // small angles are exact ones
    float angle = direction * 6.283185307179586 * float(frequency) / float(points);
    vec2 root = vec2(cos(angle), sin(angle));
    // Horner's scheme: the sum of x[k] root^k.
    vec4 sum = image_at(p);
    for (int k = 1; k < radix; ++k) {
        p -= along;
        sum = image_at(p) + vec4(fourier_times(sum.xy, root), fourier_times(sum.zw, root));
    }
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
    ivec2 back = (image_size - pixel) % image_size;
    vec4 a = image_at(pixel), a_back = image_at(back), b = kernel_at(pixel), b_back = kernel_at(back);
    return scale * vec4(fourier_pair(a.xy, a_back.xy, b.xy, b_back.xy), fourier_pair(a.zw, a_back.zw, b.zw, b_back.zw));
}
