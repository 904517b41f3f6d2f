#include "lib/alpha.glsl"
#include "lib/brdf.glsl"
#include "lib/coverage.glsl"
#include "lib/denoise.glsl"
#include "lib/march.glsl"
#include "lib/occlusion.glsl"
#include "lib/pi.glsl"
#include "lib/prefiltered_near.glsl"
#include "lib/solid.glsl"

const float SCREEN_REFLECTIONS_SHARP = 1e-3;  // with a smaller alpha, GGX counts as a mirror
// The side of the square whose mean a ray takes, as a part of what it stands for. With more, light leaks past objects:
// of 0, 0.1 and 0.25 this had the least error in a room with small lamps.
const float SCREEN_REFLECTIONS_FOOTPRINT = 0.1;

// The part of an object's thickness, from its back, over which rays fade out that pass behind its front.
const float SCREEN_REFLECTIONS_FADE = 0.5;

vec4 screen_reflections_planes() { return march_planes(); }
vec4 screen_reflections_neighbors(const vec4 rays[3]) { return solid_neighbors(rays); }
vec4 screen_reflections_runs(int reach) { return solid_runs(reach); }
// What lies in front of a surface can only be guessed to its other side: rays are sure to meet an object as deep as it is
// wide, and do not at twice that, nor beyond the thickness that the user gave.
vec4 screen_reflections_solid(const vec4 rays[3], float thickness) {
    vec4 plane = solid_planes(rays);
    return vec4(plane.xyz, min(plane.w / (1.0 - SCREEN_REFLECTIONS_FADE), thickness));
}
vec4 screen_reflections_bounds() { return march_bounds(); }
vec4 screen_reflections_surfaces() { return march_surfaces(); }

// The unit normal, facing the camera; 0 on the background.
vec3 screen_reflections_normal(const vec4 rows[3], const vec4 rays[3]) {
    float near = surfaces_at(pixel).x;
    if (near <= 0.0) return vec3(0.0);
    vec3 normal = unit_normal(normal_at(pixel));
    // The mean of several surfaces' normals is unreliable.
    if (is_mixed(normal_at(pixel))) normal = march_normal(rows, pixel, extent);
    return finite(seen_at(rays, camera_uv(pixel, extent), 1.0 / near, normal).normal);
}

float screen_reflections_roughness(vec2 material, bool linked, float roughness) {
    return clamp(linked ? finite(material).y : roughness, 0.0, 1.0);
}

// The result of a ray: the position that it meets in the picture, the distance in the world, and the confidence.
vec4 screen_reflections_ray(
    const vec4 rows[3], vec3 way, vec3 plane, float longest, float fade, float border, bool sky,
    int steps
) {
    vec2 size = vec2(extent);
    March ray = march_start(
        rows, camera_uv(pixel, extent), 1.0 / surfaces_at(pixel).x, march_out(way, plane), longest, sky, size
    );
    ray.fade = SCREEN_REFLECTIONS_FADE;
    if (!march(ray, extent, 0.0, steps)) return vec4(0.0);
    vec2 place = march_place(ray), inside = min(place, size - place);
    float sure = ray.sure * smoothstep(0.0, max(border, 1e-6), min(inside.x, inside.y)), far = longest;
    if (!ray.endless) {
        far = march_distance(ray);
        sure *= clamp((longest - far) / max(fade * longest, 1e-6 * longest), 0.0, 1.0);
    }
    return finite(vec4(place, far, sure));
}

vec4 screen_reflections_half() { return prefiltered_half(); }
vec4 screen_reflections_levels() { return prefiltered_levels(); }
vec4 screen_reflections_guide() { return vec4(normal_at(pixel), surfaces_at(pixel).x); }
void screen_reflections_period(const vec4 rays[3], int count, out vec4 light, out vec3 spread) {
    denoise_period(rays, count, light, spread);
}
void screen_reflections_level(const vec4 rays[3], int stride, float contrast, out vec4 light, out vec3 spread) {
    denoise_level(rays, stride, contrast, light, spread);
}

// The light of the surface that a mirrored ray meets, times the confidence.
vec4 screen_reflections_sharp(
    const vec4 rows[3], const vec4 rays[3], float longest, float fade, float border, bool sky,
    int steps
) {
    vec3 normal = normal_at(pixel);
    if (normal == vec3(0.0)) return vec4(0.0);
    vec3 way = reflect(normalize(camera_ray(rays, camera_uv(pixel, extent))), normal);
    vec3 plane = march_normal(rows, pixel, extent);
    vec4 met = screen_reflections_ray(rows, way, plane, longest, fade, border, sky, steps);
    return met.w > 0.0 ? met.w * finite(image_near(met.xy)) : vec4(0.0);
}

// The same, where the ray stands for a solid angle: the mean over what the picture shows of it.
vec4 screen_reflections_met(const vec4 rays[3], vec4 met, float solid) {
    if (met.w <= 0.0) return vec4(0.0);
    float near = surfaces_at(ivec2(met.xy)).x, depth = near > 0.0 ? 1.0 / near : met.z;
    float width = sqrt(solid) * met.z / pixel_pitch(rays, depth, vec2(extent));
    return met.w * prefiltered_near(met.xy, SCREEN_REFLECTIONS_FOOTPRINT * width, extent);
}

// The part of microfacets that faces a direction and is not hidden by others, for GGX (Smith 1967).
float screen_reflections_open(float cosine, float alpha) {
    float square = cosine * cosine;
    return 2.0 * cosine / (cosine + sqrt(mix(square, 1.0, alpha * alpha)));
}

// The direction of a random ray from a surface with the normal z, and the solid angle that it stands for among `count`:
// by a visible microfacet with its probability (Heitz 2018, in the form of Dupuy and Benyoub 2023).
vec4 screen_reflections_way(vec3 view, float alpha, vec2 random, int count) {
    vec3 stretched = normalize(vec3(alpha * view.xy, view.z));
    float turn = 2.0 * PI * random.x, z = 1.0 - random.y * (1.0 + stretched.z);
    float side = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3 bump = vec3(side * cos(turn), side * sin(turn), z) + stretched;
    bump = normalize(vec3(alpha * bump.xy, max(bump.z, 1e-6)));
    float facets = screen_reflections_open(view.z, alpha) * ggx_facets(vec3(0.0, 0.0, 1.0), bump, alpha);
    return vec4(reflect(-view, bump), 4.0 * view.z / max(facets * float(count), 1e-9));
}

// The light from many random directions, with the variance of its mean and the width in pixels over which it blurs a
// point: the reflected point appears as far behind the surface as it is in front.
void screen_reflections_scattered(
    const vec4 rows[3], const vec4 rays[3], float longest, float fade, float border, bool sky,
    int steps, int count, out vec4 light, out vec3 spread
) {
    vec3 normal = normal_at(pixel);
    float rough = rough_at(pixel), alpha = rough * rough;
    light = vec4(0.0), spread = vec3(0.0, 0.0, rough);
    if (normal == vec3(0.0)) return;
    bool sharp = alpha < SCREEN_REFLECTIONS_SHARP;
    if (sharp) count = 1;
    const vec2 lattice = vec2(0.75487767, 0.56984029);  // R2 sequence (Roberts 2018)
    vec3 plane = march_normal(rows, pixel, extent);
    vec3 across = normalize(cross(normal, abs(normal.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    mat3 frame = mat3(across, cross(normal, across), normal);
    vec3 view = -normalize(camera_ray(rays, camera_uv(pixel, extent))) * frame;
    vec2 noise = occlusion_noise(pixel, true);
    float depth = 1.0 / surfaces_at(pixel).x, total = 0.0, squares = 0.0, away = 1e-6, shines = 1e-6;
    for (int i = 0; i < count; ++i) {
        vec4 way = screen_reflections_way(view, alpha, fract(noise + float(i) * lattice), count);
        if (sharp) way = vec4(-view.xy, view.z, 0.0);
        if (way.z <= 0.0) continue;
        float weight = screen_reflections_open(way.z, alpha);
        vec4 met = screen_reflections_ray(
            rows, frame * way.xyz, plane, longest, fade, border, sky, steps
        );
        vec4 reflected = screen_reflections_met(rays, met, way.w);
        float bright = luminance(reflected.rgb);
        light += weight * reflected;
        squares += weight * bright * bright;
        float shine = weight * met.w * (abs(bright) + 1e-3);
        away += shine * met.z / (depth + met.z);
        shines += shine;
        total += weight;
    }
    if (total <= 0.0) return;
    light /= total;
    if (sharp) return;
    float reach = 2.0 * alpha * away / shines * depth / pixel_pitch(rays, depth, vec2(extent));
    spread = finite(vec3(squares / total, reach, rough));
}

float screen_reflections_near() { return surfaces_at(pixel).x; }

// Pixels that two surfaces share: the light of both by their coverage, and the normal of the one that covers more.
void screen_reflections_shared(out vec4 light, out vec3 normal) {
    Coverage shares = coverage_seen(coverage_of(coverage_found()));
    light = mix(light_at(shares.back), light_at(shares.front), shares.front_share);
    normal = facing_at(shares.front_share > 0.5 ? shares.front : shares.back);
}

// The Fresnel reflectance (Schlick 1994), reduced for rough surfaces at grazing angles (Lagarde 2011).
vec3 screen_reflections_fresnel(
    vec3 normal, float rough, vec2 material, vec4 albedo, float mask, const vec4 rays[3], float reflectance,
    float strength
) {
    if (normal == vec3(0.0)) return vec3(0.0);
    float cosine = clamp(-dot(normal, normalize(camera_ray(rays, camera_uv(pixel, extent)))), 0.0, 1.0);
    float metal = clamp(finite(material).x, 0.0, 1.0);
    vec3 straight_on = mix(vec3(reflectance), clamp(finite(straight(albedo)).rgb, 0.0, 1.0), metal);
    vec3 grazing = max(vec3(1.0 - rough), straight_on);
    vec3 part = straight_on + (grazing - straight_on) * pow(1.0 - cosine, 5.0);
    return strength * clamp(finite(mask), 0.0, 1.0) * part;
}

vec4 screen_reflections_light(
    vec4 light, vec3 normal, float rough, vec2 material, vec4 albedo, float mask, vec4 rays[3], float reflectance,
    float strength
) {
    vec3 part = screen_reflections_fresnel(normal, rough, material, albedo, mask, rays, reflectance, strength);
    return vec4(part * light.rgb, min(dot(part, vec3(1.0 / 3.0)), 1.0) * light.a);
}

vec4 screen_reflections(
    vec4 image, vec4 light, vec3 normal, float rough, vec2 material, vec4 albedo, float mask, vec4 rays[3],
    float reflectance, float strength
) {
    vec4 safe = finite(image);
    vec3 part = screen_reflections_fresnel(normal, rough, material, albedo, mask, rays, reflectance, strength);
    // Reflected light does not enter the surface.
    return vec4(safe.rgb * (1.0 - min(part, 1.0) * light.a) + safe.a * part * light.rgb, safe.a);
}

float screen_reflections_confidence(vec4 light) { return clamp(light.a, 0.0, 1.0); }
