// How much surfaces face the camera, in a pass that reads `normal`.
#include "lib/camera.glsl"
#include "lib/geometry.glsl"

// The cosine between the normal and the direction to the camera; 0 where the surface faces away, and on the background.
float facing_one(ivec2 at, const vec4 rays[3]) {
    vec3 ray = camera_ray(rays, camera_uv(at, extent));
    return clamp(-dot(unit_normal(normal_at(at)), ray) / max(length(ray), 1e-9), 0.0, 1.0);
}

// The same for the pixel that is drawn. Where antialiasing has mixed the normals of several surfaces, their mean is
// unreliable, so the mean over those neighbors that show one surface is taken.
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
