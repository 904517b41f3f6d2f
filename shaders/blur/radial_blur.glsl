const int radial_blur_most = 512;  // most samples per pixel: longer than the longest streak of a 4K picture

// Averages samples along an arc or a radial line that has the pixel in its middle (midpoint rule).
vec4 radial_blur(int kind, float zoom, float angle, vec2 center) {
    vec2 middle = center * vec2(extent), away = vec2(pixel) + 0.5 - middle;
    float spread = length(away) * (kind == KIND_ZOOM ? zoom : angle);
    int count = clamp(int(ceil(spread)), 1, radial_blur_most);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < count; ++i) {
        float t = (float(i) + 0.5) / float(count) - 0.5, turn = t * angle;
        vec2 moved = kind == KIND_ZOOM ? away * (1.0 + t * zoom) : mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * away;
        sum += image_near(middle + moved) / float(count);
    }
    return sum;
}
