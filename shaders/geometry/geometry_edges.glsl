#include "lib/contour.glsl"
#include "lib/geometry.glsl"

// The angle between two unit vectors, exact for small angles too (Kahan 2006). Between a surface and the background it
// is 180 degrees.
float geometry_edges_angle(vec3 a, vec3 b) {
    if (a == b) return 0.0;
    return a == vec3(0.0) || b == vec3(0.0) ? radians(180.0) : 2.0 * atan(length(a - b), length(a + b));
}

// The second difference of 1 / depth, relative to the largest of the three. It is 0 on a plane.
float geometry_edges_bend(float before, float here, float after) {
    float most = max(here, max(before, after));
    return most > 0.0 ? abs(before - 2.0 * here + after) / most : 0.0;
}

// The gap in depth, the fold in radians, and 1 where ids differ, the largest of rows and columns. At the border of the
// picture depth is not compared.
vec3 geometry_edges_found() {
    float near = nearness(depth_at(pixel)), id = ids_at(pixel);
    vec3 normal = unit_normal(normal_at(pixel)), found = vec3(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 along = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), before = pixel - along, after = pixel + along;
        if (pixel[axis] > 0 && pixel[axis] < extent[axis] - 1)
            found.x = max(found.x, geometry_edges_bend(nearness(depth_at(before)), near, nearness(depth_at(after))));
        found.y = max(found.y, geometry_edges_angle(unit_normal(normal_at(before)), normal));
        found.y = max(found.y, geometry_edges_angle(unit_normal(normal_at(after)), normal));
        if (ids_at(before) != id || ids_at(after) != id) found.z = 1.0;
    }
    return found;
}

float geometry_edges_gap(vec3 found) { return found.x; }

float geometry_edges_crease(vec3 found) { return degrees(found.y); }

float geometry_edges_border(vec3 found) { return found.z; }

float geometry_edges_strength(float found, float threshold, float softness) {
    return found > threshold ? clamp((found - threshold) / max(threshold * softness, 1e-9), 0.0, 1.0) : 0.0;
}

float geometry_edges(vec3 found, vec3 amounts, float gap, float crease, float softness, float cover) {
    float depth = geometry_edges_strength(found.x, gap, softness);
    float normal = geometry_edges_strength(found.y, crease, softness);
    vec3 strength = amounts * vec3(depth, normal, found.z);
    return cover * max(max(strength.x, strength.y), strength.z);
}

vec2 geometry_edges_seeds(float edges) { return contour_seeds(edges, float(pixel.y)); }

vec2 geometry_edges_columns(int reach) { return contour_columns(seeds_at(pixel), reach); }

float geometry_edges_distance(int reach) { return contour_distance(columns_at(pixel), float(reach)); }

float geometry_edges_line(float contour, float beyond) { return clamp(beyond - contour + 0.5, 0.0, 1.0); }
