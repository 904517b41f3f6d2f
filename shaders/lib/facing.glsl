// How much surfaces face the camera, in a pass that reads `normal`.
#include "lib/camera.glsl"
#include "lib/geometry.glsl"

// 1 straight on, 0 where it turns away, and on the background.
float facing_one(ivec2 at, const vec4 rays[3]) {
    vec3 ray = camera_ray(rays, camera_uv(at, extent));
    return clamp(-dot(unit_normal(normal_at(at)), ray) / max(length(ray), 1e-9), 0.0, 1.0);
}

// Where normals of several surfaces are mixed, their mean may look anywhere: there, the mean of what the neighbors that
// are of one surface say.
float facing_found(const vec4 rays[3]) {
    float sum = 0.0, count = 0.0;
    if (is_mixed(normal_at(pixel)))
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), extent - 1);
                if (!is_mixed(normal_at(at))) {
                    sum += facing_one(at, rays);
                    ++count;
                }
            }
    return count > 0.0 ? sum / count : facing_one(pixel, rays);
}
