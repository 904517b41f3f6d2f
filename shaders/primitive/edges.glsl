// Edge modes: the position inside a picture that is read for a position outside. And holes: pixels that are not finite.

ivec2 edge_clamp(ivec2 p, ivec2 size) { return clamp(p, ivec2(0), size - 1); }

// Repeats the picture. GLSL's % is undefined for negative numbers.
ivec2 edge_wrap(ivec2 p, ivec2 size) { return p - size * ivec2(floor((vec2(p) + 0.5) / vec2(size))); }

// Mirrors the picture, with the border pixel repeated: c b a | a b c | c b a
ivec2 edge_reflect(ivec2 p, ivec2 size) {
    ivec2 q = edge_wrap(p, 2 * size);
    return min(q, 2 * size - 1 - q);
}

// Mirrors the picture at the border pixel: c b | a b c | b a
ivec2 edge_mirror(ivec2 p, ivec2 size) {
    ivec2 period = max(2 * size - 2, ivec2(1)), q = edge_wrap(p, period);
    return min(q, period - q);
}

// Continues a picture by longitude and latitude: around the world, and across a pole to its other side.
ivec2 edge_panorama(ivec2 p, ivec2 size) {
    int y = edge_wrap(p, 2 * size).y;
    bool across_pole = y >= size.y;
    return edge_wrap(ivec2(p.x + (across_pole ? size.x / 2 : 0), across_pole ? 2 * size.y - 1 - y : y), size);
}

bool inside(ivec2 p, ivec2 size) { return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, size)); }

// True for NaN and infinity. Bits are tested, because drivers may assume that isnan() is always false.
bool is_hole(float c) { return (floatBitsToUint(c) & 0x7fffffffu) >= 0x7f800000u; }
bool is_hole(vec2 c) { return is_hole(c.x) || is_hole(c.y); }
bool is_hole(vec3 c) { return is_hole(c.xy) || is_hole(c.z); }
bool is_hole(vec4 c) { return is_hole(c.xy) || is_hole(c.zw); }

// True for what no mean can be made of: holes, and numbers from 2^127 on, of which two may add up to infinity.
bool is_too_large(float c) { return (floatBitsToUint(c) & 0x7fffffffu) >= 0x7f000000u; }
bool is_too_large(vec2 c) { return is_too_large(c.x) || is_too_large(c.y); }
bool is_too_large(vec3 c) { return is_too_large(c.xy) || is_too_large(c.z); }
bool is_too_large(vec4 c) { return is_too_large(c.xy) || is_too_large(c.zw); }
