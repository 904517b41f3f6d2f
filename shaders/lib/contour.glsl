// The contour of a mask, where it crosses one half. First every pixel learns the nearest row within its column that holds
// a pixel of the mask (x) and one outside of it (y), by jump flooding (Rong and Tan 2006), which is exact along a line.

const float CONTOUR_NONE = -1.0;

vec2 contour_seeds(float mask, float row) { return mask >= 0.5 ? vec2(row, CONTOUR_NONE) : vec2(CONTOUR_NONE, row); }

float contour_nearer(float a, float b, float row) {
    if (a < 0.0 || b < 0.0) return max(a, b);
    return abs(b - row) < abs(a - row) ? b : a;
}

vec2 contour_nearer(vec2 a, vec2 b, float row) {
    return vec2(contour_nearer(a.x, b.x, row), contour_nearer(a.y, b.y, row));
}

// From the nearest pixel of the other kind one step back, to a pixel of our own.
ivec2 contour_step(ivec2 way) {
    return abs(way.x) > abs(way.y) ? ivec2(sign(way.x), 0) : ivec2(0, sign(way.y));
}

// How far before the center of the nearest pixel of the other kind the contour lies: as its own coverage says, or if
// that is whole, the coverage of the pixel one step back. Both count what the other kind covers.
float contour_before(float covered, float covered_back) {
    return covered < 1.0 ? covered - 0.5 : 0.5 + covered_back;
}

float contour_covered(float mask, bool kind) { return kind ? clamp(mask, 0.0, 1.0) : 1.0 - clamp(mask, 0.0, 1.0); }
