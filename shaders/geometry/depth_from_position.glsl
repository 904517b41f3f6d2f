#include "lib/camera.glsl"
#include "lib/geometry.glsl"

float depth_from_position(vec3 position, vec4 rows[3]) {
    float depth = is_place(position) ? camera_project(rows, position).z : 0.0;
    return is_surface(depth) ? depth : GEOMETRY_NOTHING;
}
