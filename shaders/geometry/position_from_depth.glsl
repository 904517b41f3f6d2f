#include "lib/camera.glsl"
#include "lib/geometry.glsl"

vec3 position_from_depth(float depth, vec4 rays[3]) {
    return is_surface(depth) ? finite(camera_place(rays, camera_uv(pixel, extent), depth)) : vec3(0.0);
}
