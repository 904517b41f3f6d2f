// The mean of 16 pixels along the way to the next frame, half before and half behind.
vec4 smear(
    vec4 image,    // clamp
    vec4 velocity  // vector, clamp: pixels to the frame before (x, y) and to the next (z, w)
) {
    vec2 way = velocity_at(pixel).zw;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 16; ++i) {
        ivec2 at = pixel + ivec2(round(way * ((float(i) + 0.5) / 16.0 - 0.5)));
        sum += image_at(clamp(at, ivec2(0), image_size - 1));
    }
    return sum / 16.0;
}
