// Pixels are counted along one axis. The picture may start `shift` pixels before the result does.
vec4 box_blur_pixel(int axis, int i) {
    return image_at(axis == 0 ? ivec2(i, pixel.y) : ivec2(pixel.x, i));
}

// The mean of every block of `stride` pixels.
vec4 box_blur_blocks(int axis, int first, int stride) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < stride; ++i) sum += box_blur_pixel(axis, first + pixel[axis] * stride + i) / float(stride);
    return sum;
}

// The row of blocks that comes closest to the box; then what it lacks or has too much at both ends.
vec4 box_blur(int axis, int shift, int whole, float part, int stride, int count, int lead) {
    int first = pixel[axis] - whole, end = pixel[axis] + whole + 1;
    int block = (first + lead + stride / 2) / stride;
    int block_first = block * stride - lead, block_end = block_first + count * stride;
    float total = float(2 * whole + 1) + 2.0 * part;

    ivec2 middle = pixel;
    middle[axis] = block + count / 2;
    vec4 mean = windows_at(middle) * (float(count * stride) / total);

    for (int i = first; i < block_first; ++i) mean += box_blur_pixel(axis, shift + i) / total;
    for (int i = block_first; i < first; ++i) mean -= box_blur_pixel(axis, shift + i) / total;
    for (int i = block_end; i < end; ++i) mean += box_blur_pixel(axis, shift + i) / total;
    for (int i = end; i < block_end; ++i) mean -= box_blur_pixel(axis, shift + i) / total;
    if (part > 0.0)
        mean += (box_blur_pixel(axis, shift + first - 1) + box_blur_pixel(axis, shift + end)) * (part / total);
    return mean;
}
