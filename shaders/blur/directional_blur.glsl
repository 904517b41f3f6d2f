// Averages samples along a line (midpoint rule). A picture that is blurred toward one direction reads in the opposite
// one.
vec4 directional_blur(float angle, float spread, float shift) {
    vec2 line = spread * vec2(cos(angle), -sin(angle));
    int count = max(int(ceil(spread)), 1);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < count; ++i) {
        float t = (float(i) + 0.5) / float(count) - 0.5 + shift;
        sum += image_near(vec2(pixel) + 0.5 - t * line) / float(count);
    }
    return sum;
}
