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
vec3 stereo_dubois(vec3 one, vec3 two) {
    return one * mat3(0.456, 0.500, 0.176, -0.040, -0.038, -0.016, -0.015, -0.021, -0.005)
        + two * mat3(-0.043, -0.088, -0.002, 0.378, 0.734, -0.018, -0.072, -0.113, 1.226);
}

vec4 stereo_mixed(vec4 first, vec4 second, int format) {
    vec4 one = finite(first), two = finite(second);
    if (format == FORMAT_INTERLACED) return (pixel.y & 1) == 0 ? one : two;
    const vec3 gray = vec3(0.2126, 0.7152, 0.0722);  // Rec. 709
    vec3 color = vec3(one.r, two.gb);
    if (format == FORMAT_HALF_COLOR_ANAGLYPH) color.r = dot(one.rgb, gray);
    if (format == FORMAT_GRAY_ANAGLYPH) color = vec3(dot(one.rgb, gray), vec2(dot(two.rgb, gray)));
    if (format == FORMAT_DUBOIS) color = stereo_dubois(one.rgb, two.rgb);
    return finite(vec4(color, max(one.a, two.a)));
}
