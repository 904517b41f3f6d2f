const float READ_RENDER_NOTHING = 1e10;  // depth of the background
const int READ_RENDER_RADIAL = 1, READ_RENDER_INVERSE = 2;

// Planar depth from the number in the file. Radial depth is measured along the ray through the pixel, which is longer.
float read_render_depth(float stored, int kind, float scale, float offset, vec2 focal, vec2 center) {
    float depth = stored * scale + offset;
    if (kind == READ_RENDER_INVERSE) return depth > 0.0 ? 1.0 / depth : READ_RENDER_NOTHING;
    if (kind != READ_RENDER_RADIAL) return depth;
    vec2 slant = ((vec2(pixel) + 0.5) / vec2(extent) - center) / focal;
    return depth / sqrt(1.0 + dot(slant, slant));
}

// A normal in world space from a normal in camera space (x right, y up, z toward the viewer).
vec3 read_render_normal(vec3 stored, vec3 scale, vec3 offset, vec3 right, vec3 down, vec3 ahead, float towards) {
    vec3 normal = stored * scale + offset;
    if (dot(stored, stored) == 0.0) return vec3(0.0);  // background, in every encoding
    return normal.x * right - normal.y * down - towards * normal.z * ahead;
}

// Motion from the previous frame and to the next one. If a file holds only one of them, it is used for both.
vec4 read_render_velocity(vec4 stored, vec4 scale, bool both, bool to_next) {
    vec4 velocity = stored * scale;
    if (!both) return velocity.xyxy;
    return to_next ? velocity.zwxy : velocity;
}
