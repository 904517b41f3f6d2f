#include "lib/facing.glsl"

float rim_light_rim(vec4 rays[3], float power, float focus, vec3 side) {
    vec3 normal = unit_normal(normal_at(pixel)), ray = camera_ray(rays, camera_uv(pixel, extent));
    if (normal == vec3(0.0)) return 0.0;
    float away = 1.0 - facing_found(rays), rim = away > 0.0 ? pow(away, power) : power > 0.0 ? 0.0 : 1.0;
    // The direction of the rim in the picture.
    vec3 across = normal - ray * (dot(normal, ray) / max(dot(ray, ray), 1e-9));
    float towards = dot(across, side) / max(length(across), 1e-6);
    return rim * mix(1.0, 0.5 + 0.5 * clamp(towards, -1.0, 1.0), focus);
}

vec4 rim_light(vec4 image, float rim, float mask, vec3 light) {
    vec4 safe = finite(image);
    float amount = rim * clamp(finite(mask), 0.0, 1.0) * clamp(safe.a, 0.0, 1.0);
    return finite(vec4(safe.rgb + light * amount, safe.a));
}
