// Shapes as signed distances, in pixels, below 0 inside. Distances of polygons and boxes after Quilez 2019,
// "2D distance functions". Coverage is the mean over a grid inside of each pixel that an edge crosses.

// Splines are drawn by lib/paths.glsl.

#include "lib/finite.glsl"
#include "lib/paths.glsl"
#include "lib/pi.glsl"

const int SHAPE_GRID = 24;  // samples across a pixel: coverage is within 2e-3 of clipped polygons; 16 gave 3e-3

float shape_box(vec2 p, vec2 half_size, float corner) {
    vec2 q = abs(p) - half_size + corner;
    return length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - corner;
}

// The distance to an ellipse, to first order near its edge: the value of the implicit function over its slope.
float shape_ellipse(vec2 p, vec2 half_size) {
    vec2 r = max(half_size, vec2(1e-3));
    float k = length(p / r), slope = length(p / (r * r));
    return k < 1e-6 ? -min(r.x, r.y) : k * (k - 1.0) / slope;
}

// Corner `number` of a polygon, or of a star, whose odd corners lie further in; the first is at the top.
vec2 shape_corner(int number, int count, bool is_star, float inner, vec2 half_size) {
    float turn = 2.0 * PI * float(number) / float(count);
    float radius = is_star && (number & 1) == 1 ? inner : 1.0;
    return radius * half_size * vec2(sin(turn), -cos(turn));
}

float shape_polygon(vec2 p, int count, bool is_star, float inner, vec2 half_size) {
    float nearest = 1e30, side = 1.0;
    vec2 before = shape_corner(count - 1, count, is_star, inner, half_size);
    for (int number = 0; number < count; ++number) {
        vec2 corner = shape_corner(number, count, is_star, inner, half_size);
        vec2 edge = before - corner, to = p - corner;
        vec2 away = to - edge * clamp(dot(to, edge) / max(dot(edge, edge), 1e-12), 0.0, 1.0);
        nearest = min(nearest, dot(away, away));
        bvec3 crossed = bvec3(p.y >= corner.y, p.y < before.y, edge.x * to.y > edge.y * to.x);
        if (all(crossed) || all(not(crossed))) side = -side;
        before = corner;
    }
    return side * sqrt(nearest);
}

float shape_distance(vec2 p, int shape, vec2 size, float roundness, int points, float inner) {
    vec2 half_size = 0.5 * size;
    float shorter = min(half_size.x, half_size.y);
    if (shape == SHAPE_ELLIPSE) return shape_ellipse(p, half_size);
    if (shape == SHAPE_POLYGON) return shape_polygon(p, points, false, 1.0, half_size);
    if (shape == SHAPE_STAR) return shape_polygon(p, 2 * points, true, inner, half_size);
    if (shape == SHAPE_LINE) {
        vec2 away = vec2(max(abs(p.x) - half_size.x, 0.0), p.y);
        return length(away) - half_size.y;
    }
    return shape_box(p, half_size, roundness * shorter);
}

// How much is covered at a distance from the edge; a hard edge is as wide as `finest`.
float shape_cover(float away, float softness, float finest) {
    float t = clamp(0.5 - away / max(softness, finest), 0.0, 1.0);
    return softness > finest ? t * t * (3.0 - 2.0 * t) : t;
}

void shape(
    int shape, vec2 center, vec2 size, float rotation, float roundness, int points, float inner, float softness,
    bool invert, vec4 color, out vec4 result, out float mask
) {
    vec2 place = vec2(pixel) + 0.5 - finite(center) * vec2(extent);
    vec2 turn = vec2(cos(finite(rotation)), sin(finite(rotation)));
    vec2 sides = max(finite(size), vec2(0.0));
    int count = clamp(points, 3, 64), grid = 1;
    float soft = max(finite(softness), 0.0), finest = 1.0 / float(SHAPE_GRID);
    float bend = clamp(finite(roundness), 0.0, 1.0), deep = clamp(finite(inner), 0.01, 1.0);
    vec2 p = vec2(dot(place, turn), dot(place, vec2(-turn.y, turn.x)));
    float away = shape_distance(p, shape, sides, bend, count, deep);
    bool is_thin = min(sides.x, sides.y) < 4.0;
    float cover = shape_cover(away, soft, finest);
    if (abs(away) < 1.0 + 0.5 * soft || (is_thin && shape == SHAPE_ELLIPSE)) {
        cover = 0.0;
        grid = soft < 4.0 ? SHAPE_GRID : 4;
        for (int y = 0; y < grid; ++y)
            for (int x = 0; x < grid; ++x) {
                vec2 q = place + (vec2(x, y) + 0.5) / float(grid) - 0.5;
                q = vec2(dot(q, turn), dot(q, vec2(-turn.y, turn.x)));
                cover += shape_cover(shape_distance(q, shape, sides, bend, count, deep), soft, finest);
            }
        cover /= float(grid * grid);
    }
    mask = invert ? 1.0 - cover : cover;
    result = finite(color) * mask;
}

vec4 shape_fill(float mask, vec4 color) { return finite(color) * mask; }
