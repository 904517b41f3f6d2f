// Reduces the picture `image` to a fraction of its size and enlarges it again, for pictures so soft that fewer pixels
// are enough.

// The mean of the pixels that one smaller pixel covers.
vec4 shrunk(int factor) {
    vec4 sum = vec4(0.0);
    for (int y = 0; y < factor; ++y)
        for (int x = 0; x < factor; ++x)
            sum += image_at(factor * pixel + ivec2(x, y));
    return sum / float(factor * factor);
}

// A pixel of the enlarged picture, by bilinear interpolation.
vec4 enlarged(int factor) { return image_near((vec2(pixel) + 0.5) / float(factor)); }
