#include "lib/finite.glsl"

// Each half of the frame is a whole picture: every pixel is the mean of two.
vec4 stereo_packed(int format) {
    int axis = format == FORMAT_SIDE_BY_SIDE ? 0 : 1;
    vec2 at = vec2(pixel) + 0.5;
    float middle = 0.5 * float(extent[axis]);
    bool is_second = at[axis] > middle;
    at[axis] = 2.0 * (is_second ? at[axis] - middle : at[axis]);
    return finite(is_second ? second_near(at) : first_near(at));
}

// The least squares of Dubois (2001) for red and cyan glasses, by rows.
vec3 stereo_dubois(vec3 left_eye, vec3 right_eye) {
    return left_eye * mat3(0.456, 0.500, 0.176, -0.040, -0.038, -0.016, -0.015, -0.021, -0.005)
        + right_eye * mat3(-0.043, -0.088, -0.002, 0.378, 0.734, -0.018, -0.072, -0.113, 1.226);
}

vec4 stereo_mixed(vec4 first, vec4 second, int format) {
    vec4 left_eye = finite(first), right_eye = finite(second);
    if (format == FORMAT_INTERLACED) return (pixel.y & 1) == 0 ? left_eye : right_eye;
    const vec3 gray = vec3(0.2126, 0.7152, 0.0722);  // Rec. 709
    vec3 color = vec3(left_eye.r, right_eye.gb);
    if (format == FORMAT_HALF_COLOR_ANAGLYPH) color.r = dot(left_eye.rgb, gray);
    if (format == FORMAT_GRAY_ANAGLYPH) color = vec3(dot(left_eye.rgb, gray), vec2(dot(right_eye.rgb, gray)));
    if (format == FORMAT_DUBOIS) color = stereo_dubois(left_eye.rgb, right_eye.rgb);
    return finite(vec4(color, max(left_eye.a, right_eye.a)));
}
