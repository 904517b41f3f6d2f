// Enlarges by a whole factor along one axis, with a cubic B-spline. The small picture starts `apron` pixels early.
vec4 enlarge(int axis, int factor, int apron) {
    float at = (float(pixel[axis] + apron) + 0.5) / float(factor) - 0.5;
    float whole = floor(at), t = at - whole, s = 1.0 - t;
    vec4 weight = vec4(s * s * s, 4.0 - 6.0 * t * t + 3.0 * t * t * t, 4.0 - 6.0 * s * s + 3.0 * s * s * s, t * t * t) / 6.0;
    ivec2 along = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
    ivec2 first = pixel;
    first[axis] = int(whole) - 1;
    return weight.x * image_at(first) + weight.y * image_at(first + along)
         + weight.z * image_at(first + 2 * along) + weight.w * image_at(first + 3 * along);
}
