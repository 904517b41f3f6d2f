#include "lib/coverage.glsl"
#include "lib/pi.glsl"
#include "lib/shadow.glsl"
#include "lib/solid.glsl"

vec4 contact_shadows_planes() { return march_planes(); }
vec4 contact_shadows_neighbors(const vec4 rays[3]) { return solid_neighbors(rays); }
vec4 contact_shadows_runs(int reach) { return solid_runs(reach); }
vec4 contact_shadows_solid(const vec4 rays[3]) { return solid_planes(rays); }
vec4 contact_shadows_bounds() { return march_bounds(); }
vec4 contact_shadows_surfaces() { return march_surfaces(); }

// The part of a light that a pixel sees. `to` is the direction to a sun, or the position of a lamp; `spread` is its
// size, as the tangent of its angular radius.
float contact_shadows_open(
    const vec4 rows[3], const vec4 rays[3], int light, vec3 to, float reach, float spread, float thickness, int count
) {
    float near = surfaces_at(pixel).x, open = 0.0;
    if (near <= 0.0) return 1.0;
    vec2 uv = camera_uv(pixel, extent), size = vec2(extent);
    vec3 normal = shadow_normal(rows, pixel), plane = march_normal(rows, pixel, extent);
    if (light == LIGHT_LAMP) {
        to -= camera_place(rays, uv, 1.0 / near);
        reach = min(reach, length(to));
        to = normalize(to);
    }
    if (dot(normal, to) <= 0.0) return 1.0;
    vec3 across = normalize(cross(to, abs(to.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    const vec2 lattice = vec2(0.75487767, 0.56984029);  // R2 sequence (Roberts 2018)
    vec2 noise = occlusion_noise(pixel, true);
    for (int i = 0; i < count; ++i) {
        vec2 random = fract(noise + float(i) * lattice);
        float turn = 2.0 * PI * random.x, away = spread * sqrt(random.y);
        vec3 way = normalize(to + away * (cos(turn) * across + sin(turn) * cross(to, across)));
        open += shadow_open(rows, uv, 1.0 / near, way, plane, reach, thickness, size);
    }
    return finite(open / float(count));
}

// The mean over 4 x 4 pixels of the same surface, which is one period of the noise.
float contact_shadows_denoise(const vec4 rows[3], const vec4 rays[3]) {
    float depth = 1.0 / surfaces_at(pixel).x, sum = 0.0, total = 0.0;
    if (surfaces_at(pixel).x <= 0.0) return 1.0;
    vec3 normal = shadow_normal(rows, pixel), here = depth * camera_ray(rays, camera_uv(pixel, extent));
    float apart = pixel_pitch(rays, depth, vec2(extent));
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            float weight = shadow_weight(rows, rays, ivec2(x, y), normal, here, apart);
            if (weight <= 0.0) continue;
            sum += weight * open_at(pixel + ivec2(x, y));
            total += weight;
        }
    return finite(sum / total);
}

float contact_shadows_near(float depth) { return nearness(depth); }
vec3 contact_shadows_coverage() { return coverage_found(); }

// The part of the light of a pixel that its surfaces see together: each as it is beside the edge, by how much of the
// pixel it covers and by the cosine of its angle to the light. A surface that faces away has no part in it.
float contact_shadows_shared(const vec4 rays[3], int light, vec3 to) {
    float open = open_at(pixel);
    Coverage shares = coverage_of(coverage_at(pixel));
    for (int rounds = coverage_is_mixed(shares) ? 1 : 0; rounds > 0; --rounds) {
        if (light == LIGHT_LAMP) to = normalize(to - camera_place(rays, camera_uv(pixel, extent), 1.0 / near_at(pixel)));
        vec3 front, back;
        coverage_normals(shares, front, back);
        vec2 lit = vec2(shares.front_share, 1.0 - shares.front_share) * max(vec2(dot(front, to), dot(back, to)), 0.0);
        if (lit.x + lit.y > 0.0)
            open = (lit.x * open_at(shares.front) + lit.y * open_at(shares.back)) / (lit.x + lit.y);
    }
    return finite(open);
}

vec4 contact_shadows(vec4 image, float shadow, vec4 color) {
    vec4 safe = finite(image);
    return vec4(safe.rgb * mix(vec3(1.0), color.rgb, color.a * (1.0 - shadow)), safe.a);
}
