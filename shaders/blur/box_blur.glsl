// Reads pixel `i` of the row or column that is blurred. The picture may start `shift` pixels before the result.
vec4 box_blur_pixel(int axis, int i) {
    return image_at(axis == 0 ? ivec2(i, pixel.y) : ivec2(pixel.x, i));
}

// The mean of each block of `stride` pixels along the axis.
vec4 box_blur_blocks(int axis, int first, int stride) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < stride; ++i) sum += box_blur_pixel(axis, first + pixel[axis] * stride + i) / float(stride);
    return sum;
}

// A box blur from means of blocks: sum the blocks that cover the box best, then add or subtract single pixels at both
// ends. So a wide box costs few reads.
vec4 box_blur(int axis, int shift, int whole, float part, int stride, int count, int lead) {
    int first = pixel[axis] - whole, end = pixel[axis] + whole + 1;
    int block = (first + lead + stride / 2) / stride;
    int block_first = block * stride - lead, block_end = block_first + count * stride;
    float total = float(2 * whole + 1) + 2.0 * part;

    ivec2 middle = pixel;
    middle[axis] = block + count / 2;
    vec4 mean = windows_at(middle) * (float(count * stride) / total);

    int start = min(first, block_first), off = abs(block_first - first);
    float missing = (first < block_first ? 1.0 : -1.0) / total;
    for (int i = 0; i < off; ++i) mean += missing * box_blur_pixel(axis, shift + start + i);
    start = min(end, block_end), off = abs(end - block_end);
    missing = (block_end < end ? 1.0 : -1.0) / total;
    for (int i = 0; i < off; ++i) mean += missing * box_blur_pixel(axis, shift + start + i);
    if (part > 0.0)
        mean += (box_blur_pixel(axis, shift + first - 1) + box_blur_pixel(axis, shift + end)) * (part / total);
    return mean;
}
