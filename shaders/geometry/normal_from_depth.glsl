#include "lib/camera.glsl"
#include "lib/finite.glsl"
#include "lib/geometry.glsl"

float normal_from_depth_near(int x, int y) { return nearness(depth_at(pixel + ivec2(x, y))); }

vec3 normal_from_depth(const vec4 rows[3]) {
    float here = normal_from_depth_near(0, 0);
    if (here == 0.0) return vec3(0.0);
    vec2 slope = vec2(
        nearness_slope(
            here, vec2(normal_from_depth_near(-1, 0), normal_from_depth_near(1, 0)),
            vec2(normal_from_depth_near(-2, 0), normal_from_depth_near(2, 0))
        ),
        nearness_slope(
            here, vec2(normal_from_depth_near(0, -1), normal_from_depth_near(0, 1)),
            vec2(normal_from_depth_near(0, -2), normal_from_depth_near(0, 2))
        )
    );
    return finite(camera_normal(rows, camera_uv(pixel, extent), slope * vec2(extent)));
}

vec3 normal_from_depth_place(const vec4 rays[3], ivec2 at) {
    return depth_at(at) * camera_ray(rays, camera_uv(at, extent));
}

// How position and normal change along an axis, from one neighbor to the other. A neighbor on another surface is left
// out.
void normal_from_depth_change(const vec4 rays[3], ivec2 reach, out vec3 along, out vec3 turn) {
    vec3 place = normal_from_depth_place(rays, pixel), normal = normal_at(pixel);
    vec2 apart = vec2(reach) / vec2(extent);
    // On the same surface, also across a crease, one of the two points is close to the tangent plane of the other.
    vec3 pace = camera_ray(rays, camera_uv(pixel, extent) + apart) - camera_ray(rays, camera_uv(pixel, extent));
    float most = depth_at(pixel) * length(pace);
    vec3 ends[2] = vec3[2](vec3(0.0), vec3(0.0)), turns[2] = vec3[2](vec3(0.0), vec3(0.0));
    for (int side = 0; side < 2; ++side) {
        ivec2 at = pixel + (2 * side - 1) * reach;
        vec3 other = normal_at(at), way = normal_from_depth_place(rays, at) - place;
        if (other == vec3(0.0) || min(abs(dot(way, normal)), abs(dot(way, other))) > most) continue;
        ends[side] = way, turns[side] = other - normal;
    }
    along = ends[1] - ends[0], turn = turns[1] - turns[0];
}

// Mean curvature: half the trace of the shape operator, from the first and second fundamental forms (do Carmo 1976).
float normal_from_depth_curvature(const vec4 rays[3], int reach) {
    if (normal_at(pixel) == vec3(0.0)) return 0.0;
    vec3 across, down, across_turn, down_turn;
    normal_from_depth_change(rays, ivec2(reach, 0), across, across_turn);
    normal_from_depth_change(rays, ivec2(0, reach), down, down_turn);
    float e = dot(across, across), f = dot(across, down), g = dot(down, down), area = e * g - f * f;
    if (area <= 1e-6 * e * g) {  // one axis has no neighbor: use the curvature along the other
        float size = e + g;
        return size > 0.0 ? finite((dot(across, across_turn) + dot(down, down_turn)) / size) : 0.0;
    }
    float bend = dot(across, across_turn) * g - (dot(across, down_turn) + dot(down, across_turn)) * f
        + dot(down, down_turn) * e;
    return finite(bend / (2.0 * area));
}
