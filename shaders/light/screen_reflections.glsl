#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/march.glsl"
#include "lib/occlusion.glsl"

const float SCREEN_REFLECTIONS_SHARP = 1e-3;  // with a smaller alpha, GGX counts as a mirror
const float SCREEN_REFLECTIONS_LAMP = 3.0;    // most light of a pixel, as a multiple of its neighbors' mean

vec3 screen_reflections_planes() { return march_planes(); }
vec3 screen_reflections_bounds() { return march_bounds(); }
vec3 screen_reflections_surfaces() { return march_surfaces(); }

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
    const vec4 rows[3], vec3 way, vec3 plane, float thickness, float longest, float fade, float border, bool sky,
    int steps
) {
    vec2 size = vec2(extent);
    March ray = march_start(
        rows, camera_uv(pixel, extent), 1.0 / surfaces_at(pixel).x, march_out(way, plane), longest, sky, size
    );
    if (!march(ray, extent, thickness, steps)) return vec4(0.0);
    vec2 place = march_place(ray), inside = min(place, size - place);
    float sure = ray.sure * smoothstep(0.0, max(border, 1e-6), min(inside.x, inside.y)), far = longest;
    if (!ray.endless) {
        far = march_distance(ray);
        sure *= clamp((longest - far) / max(fade * longest, 1e-6 * longest), 0.0, 1.0);
    }
    return finite(vec4(place, far, sure));
}

vec4 screen_reflections_mirror(
    const vec4 rows[3], const vec4 rays[3], float thickness, float longest, float fade, float border, bool sky,
    int steps
) {
    vec3 normal = normal_at(pixel);
    if (normal == vec3(0.0)) return vec4(0.0);
    vec3 way = reflect(normalize(camera_ray(rays, camera_uv(pixel, extent))), normal);
    vec3 plane = march_normal(rows, pixel, extent);
    return screen_reflections_ray(rows, way, plane, thickness, longest, fade, border, sky, steps);
}

// The light of the surface that a ray met, times the confidence.
vec4 screen_reflections_met(vec4 found) { return found.w > 0.0 ? found.w * finite(image_near(found.xy)) : vec4(0.0); }

vec4 screen_reflections_sharp() { return screen_reflections_met(mirror_at(pixel)); }

// The part of microfacets that faces a direction and is not hidden by others, for GGX (Smith 1967).
float screen_reflections_open(float cosine, float alpha) {
    float square = cosine * cosine;
    return 2.0 * cosine / (cosine + sqrt(mix(square, 1.0, alpha * alpha)));
}

vec4 screen_reflections_scattered(
    const vec4 rows[3], const vec4 rays[3], float thickness, float longest, float fade, float border, bool sky,
    int steps, int count
) {
    vec3 normal = normal_at(pixel);
    if (normal == vec3(0.0)) return vec4(0.0);
    float alpha = rough_at(pixel) * rough_at(pixel);
    if (alpha < SCREEN_REFLECTIONS_SHARP) return screen_reflections_met(mirror_at(pixel));
    const vec2 lattice = vec2(0.75487767, 0.56984029);  // R2 sequence (Roberts 2018)
    vec3 plane = march_normal(rows, pixel, extent);
    vec3 across = normalize(cross(normal, abs(normal.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    mat3 frame = mat3(across, cross(normal, across), normal);
    vec3 view = -normalize(camera_ray(rays, camera_uv(pixel, extent))) * frame;
    vec2 noise = occlusion_noise(pixel, true);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < count; ++i) {
        // A visible microfacet with its probability (Heitz 2018, in the form of Dupuy and Benyoub 2023).
        vec2 random = fract(noise + float(i) * lattice);
        vec3 stretched = normalize(vec3(alpha * view.xy, view.z));
        float turn = 2.0 * OCCLUSION_PI * random.x, z = 1.0 - random.y * (1.0 + stretched.z);
        float side = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
        vec3 bump = vec3(side * cos(turn), side * sin(turn), z) + stretched;
        bump = normalize(vec3(alpha * bump.xy, max(bump.z, 1e-6)));
        vec3 way = reflect(-view, bump);
        if (way.z <= 0.0) continue;
        float weight = screen_reflections_open(way.z, alpha);
        total += weight;
        sum += weight * screen_reflections_met(
            screen_reflections_ray(rows, frame * way, plane, thickness, longest, fade, border, sky, steps)
        );
    }
    return total > 0.0 ? sum / total : vec4(0.0);
}

// The mean over 4 x 4 pixels of the same surface, one period of the noise; over fewer pixels where the reflection is
// sharper.
vec4 screen_reflections_denoise(const vec4 rays[3]) {
    vec4 found = scattered_at(pixel), met = mirror_at(pixel);
    float alpha = rough_at(pixel) * rough_at(pixel);
    vec3 normal = normal_at(pixel);
    if (normal == vec3(0.0) || alpha < SCREEN_REFLECTIONS_SHARP) return found;
    float depth = 1.0 / surfaces_at(pixel).x, apart = pixel_pitch(rays, depth, vec2(extent));
    // The width of a point's reflection in pixels: the reflected point appears as far behind the surface as it is in
    // front.
    float reach = met.w > 0.0 ? 2.0 * alpha * met.z / (depth + met.z) * depth / apart : 4.0;
    reach = max(reach, 40.0 * alpha);  // wide lobes reach beyond the mirrored ray
    vec3 here = depth * camera_ray(rays, camera_uv(pixel, extent));
    vec4 sum = vec4(0.0);
    float weights[25], total = 0.0;
    for (int i = 0; i < 25; ++i) {
        ivec2 off = ivec2(i % 5, i / 5) - 2, at = pixel + off;
        weights[i] = 0.0;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent))) continue;
        float near = surfaces_at(at).x, weight = clamp(reach + 1.0 - float(max(abs(off.x), abs(off.y))), 0.0, 1.0);
        if (near <= 0.0 || weight <= 0.0) continue;
        weight *= (abs(off.x) == 2 ? 0.5 : 1.0) * (abs(off.y) == 2 ? 0.5 : 1.0);
        vec3 away = camera_ray(rays, camera_uv(at, extent)) / near - here;
        weight *= at == pixel ? 1.0 : same_surface(normal, normal_at(at), away, apart);
        weight *= clamp(1.0 - 8.0 * abs(rough_at(at) - rough_at(pixel)), 0.0, 1.0);
        weights[i] = weight;
        sum += weight * scattered_at(at);
        total += weight;
    }
    // A single ray that meets a lamp would make a bright dot: no pixel may be much brighter than the mean.
    float most = SCREEN_REFLECTIONS_LAMP * luminance(max(sum.rgb, 0.0)) / total;
    sum = vec4(0.0);
    for (int i = 0; i < 25; ++i) {
        if (weights[i] == 0.0) continue;
        vec4 light = scattered_at(pixel + ivec2(i % 5, i / 5) - 2);
        light.rgb *= min(1.0, most / max(luminance(light.rgb), 1e-9));
        sum += weights[i] * light;
    }
    return finite(sum / total);
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
