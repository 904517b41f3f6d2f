#include "lib/camera.glsl"
#include "lib/geometry.glsl"

const float camera_velocity_most = 1e5;  // in pixels: faster means that a surface passes the other camera closely

// The motion of a point from this camera's picture to the other camera's, in fractions of the picture. `change` is the
// other camera's projection minus this one's, applied to (u d, v d, d, 1). The background is infinitely deep: its depth
// counts as 1, and only the rotation of the camera moves it.
vec2 camera_velocity_step(const vec4 change[3], vec2 uv, float depth) {
    vec4 seen = depth > 0.0 ? vec4(uv * depth, depth, 1.0) : vec4(uv, 1.0, 0.0);
    float deeper = dot(change[2], seen), there = seen.z + deeper;
    // Points behind the other camera have no place in its picture.
    if (there <= 0.0) return vec2(0.0);
    return (vec2(dot(change[0], seen), dot(change[1], seen)) - uv * deeper) / there;
}

vec4 camera_velocity(float depth, vec4 before[3], vec4 after[3], bool ahead) {
    vec2 uv = camera_uv(pixel, extent), size = vec2(extent) / proxy;
    float deep = is_surface(depth) ? depth : 0.0;
    vec2 past = -size * camera_velocity_step(before, uv, deep);
    vec2 next = ahead ? size * camera_velocity_step(after, uv, deep) : past;
    return clamp(finite(vec4(past, next)), -camera_velocity_most, camera_velocity_most);
}
