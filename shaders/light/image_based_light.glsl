#include "lib/alpha.glsl"
#include "lib/brdf.glsl"
#include "lib/camera.glsl"
#include "lib/coverage.glsl"
#include "lib/environment.glsl"
#include "lib/finite.glsl"
#include "lib/geometry.glsl"
#include "lib/normal_turn.glsl"
#include "lib/pi.glsl"

const float IMAGE_BASED_LIGHT_BRIGHTEST = 65504.0;  // the largest half float: more could overflow in sums
// Samples of a reflection lobe: a choice between time and error. The preset studio_light differs from the one with 256
// by 0.02 (RMS), the one with 64 by 0.03.
const int IMAGE_BASED_LIGHT_SAMPLES = 128;
// Samples for each entry of the reflection table. With 2048 no pixel of studio_light changes by 1 / 255.
const int IMAGE_BASED_LIGHT_FACETS = 1024;

// Reduces the environment: means over all pixels that one smaller pixel covers, weighted by solid angle.
vec4 image_based_light_sky() {
    ivec2 first = pixel * environment_size / extent, end = max((pixel + 1) * environment_size / extent, first + 1);
    vec4 sum = vec4(0.0);
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            vec3 light = clamp(environment_at(ivec2(x, y)).rgb, 0.0, IMAGE_BASED_LIGHT_BRIGHTEST);
            sum += environment_angle(y, environment_size) * vec4(light, 1.0);
        }
    return vec4(sum.rgb / sum.a, 1.0);
}

// The cosine-weighted mean of the sky around the direction of this pixel.
vec4 image_based_light_irradiance() {
    vec3 normal = environment_way((vec2(pixel) + 0.5) / vec2(extent), false, 0.0);
    float turn = 2.0 * PI / float(sky_size.x);
    mat2 turned = mat2(cos(turn), -sin(turn), sin(turn), cos(turn));
    vec4 sum = vec4(0.0);
    for (int y = 0; y < sky_size.y; ++y) {
        float below = PI * (float(y) + 0.5) / float(sky_size.y), angle = environment_angle(y, sky_size);
        vec2 around = -vec2(cos(0.5 * turn), -sin(0.5 * turn));
        for (int x = 0; x < sky_size.x; ++x, around = turned * around) {
            float facing = sin(below) * dot(around, normal.xy) + cos(below) * normal.z;
            sum += max(facing, 0.0) * angle * vec4(sky_at(ivec2(x, y)).rgb, 1.0);
        }
    }
    return sum / sum.a;
}

// Light from a direction. GLSL cannot pass pictures to functions, so each picture has its own function.
vec3 image_based_light_in_sky(vec2 uv) {
    Corners c = environment_corners(uv, sky_size);
    return (mat4(sky_at(c.at[0]), sky_at(c.at[1]), sky_at(c.at[2]), sky_at(c.at[3])) * c.weight).rgb;
}
vec3 image_based_light_in_level0(vec2 uv) {
    Corners c = environment_corners(uv, level0_size);
    return (mat4(level0_at(c.at[0]), level0_at(c.at[1]), level0_at(c.at[2]), level0_at(c.at[3])) * c.weight).rgb;
}
vec3 image_based_light_in_level1(vec2 uv) {
    Corners c = environment_corners(uv, level1_size);
    return (mat4(level1_at(c.at[0]), level1_at(c.at[1]), level1_at(c.at[2]), level1_at(c.at[3])) * c.weight).rgb;
}
vec3 image_based_light_in_level2(vec2 uv) {
    Corners c = environment_corners(uv, level2_size);
    return (mat4(level2_at(c.at[0]), level2_at(c.at[1]), level2_at(c.at[2]), level2_at(c.at[3])) * c.weight).rgb;
}
vec3 image_based_light_in_level3(vec2 uv) {
    Corners c = environment_corners(uv, level3_size);
    return (mat4(level3_at(c.at[0]), level3_at(c.at[1]), level3_at(c.at[2]), level3_at(c.at[3])) * c.weight).rgb;
}
vec3 image_based_light_in_level4(vec2 uv) {
    Corners c = environment_corners(uv, level4_size);
    return (mat4(level4_at(c.at[0]), level4_at(c.at[1]), level4_at(c.at[2]), level4_at(c.at[3])) * c.weight).rgb;
}

// Interpolates between two of five pictures of the sky, each blurrier than the one before.
vec3 image_based_light_level(vec2 uv, float level) {
    float part = fract(level);
    if (level < 1.0) return mix(image_based_light_in_level0(uv), image_based_light_in_level1(uv), part);
    if (level < 2.0) return mix(image_based_light_in_level1(uv), image_based_light_in_level2(uv), part);
    if (level < 3.0) return mix(image_based_light_in_level2(uv), image_based_light_in_level3(uv), part);
    if (level < 4.0) return mix(image_based_light_in_level3(uv), image_based_light_in_level4(uv), part);
    return image_based_light_in_level4(uv);
}

// The picture of the sky for a roughness. Below 0.25 pictures are interpolated by its square: in a dark sky with soft
// lamps that halves the error and more. Above, roughness itself does better.
float image_based_light_blur(float roughness) {
    return roughness < 0.25 ? 16.0 * roughness * roughness : 4.0 * roughness;
}

// The i-th microfacet around z, distributed by GGX (Walter et al. 2007).
vec3 image_based_light_facet(int i, int count, float alpha) {
    float part = (float(i) + 0.5) / float(count);
    float turn = 2.0 * PI * fract(float(i) * 0.61803399);
    float lift = sqrt((1.0 - part) / (1.0 + (alpha * alpha - 1.0) * part));
    return vec3(sqrt(1.0 - lift * lift) * vec2(cos(turn), sin(turn)), lift);
}

// The mean of the sky that a rough surface reflects when seen straight on, by the GGX distribution. Fewer samples read
// a coarser sky (Krivanek and Colbert 2008); each level has half the size.
vec4 image_based_light_lobe(float roughness) {
    vec3 normal = environment_way((vec2(pixel) + 0.5) / vec2(extent), false, 0.0);
    vec3 across = normalize(cross(normal, abs(normal.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    vec3 beside = cross(normal, across), sum = vec3(0.0);
    float total = 0.0, alpha = roughness * roughness, finest = 2.0 * PI / float(level0_size.x);
    for (int i = 0; i < IMAGE_BASED_LIGHT_SAMPLES; ++i) {
        vec3 facet = image_based_light_facet(i, IMAGE_BASED_LIGHT_SAMPLES, alpha);
        vec3 way = 2.0 * facet.z * (facet.x * across + facet.y * beside + facet.z * normal) - normal;
        float weight = dot(way, normal);
        if (weight <= 0.0) continue;
        float dense = ggx_facets(vec3(0.0, 0.0, 1.0), facet, alpha) * float(IMAGE_BASED_LIGHT_SAMPLES) / 4.0;
        float level = clamp(1.0 - 0.5 * log2(dense * finest * finest), 0.0, 4.0);
        sum += weight * image_based_light_level(environment_uv(way, false, 0.0), level);
        total += weight;
    }
    return vec4(sum / total, 1.0);
}

// The place of a direction in a picture of the sky made with z up and without rotation.
vec2 image_based_light_uv(vec3 way, int up, float rotation) { return environment_uv(way, up == UP_Y, rotation); }

// Nearness tells surfaces apart; without depth a normal tells them from the background.
float image_based_light_nearness(vec3 normal, float depth, bool linked) {
    const float half_covered = 0.5;
    return linked ? nearness(depth) : float(length(finite(normal)) > half_covered);
}

vec3 image_based_light_coverage() { return coverage_found_by_color(); }

// One surface of a pixel: the normal, and its part of the color with alpha for its share of the pixel.
struct ImageBasedLightSurface { ivec2 at; vec3 normal; vec4 part; };

// The front surface (k = 0) or the one behind it.
ImageBasedLightSurface image_based_light_surface(Coverage halves, int k) {
    ivec2 at = k == 0 ? halves.front : halves.back;
    vec4 color = clamp(straight(finite(albedo_at(pixel))), 0.0, 1.0);
    ImageBasedLightSurface surface = ImageBasedLightSurface(at, unit_normal(normal_at(at)), vec4(color.rgb, 1.0));
    for (int rounds = coverage_is_mixed(halves) ? 1 : 0; rounds > 0; --rounds) {
        vec4 whole = vec4(finite(albedo_at(pixel)).rgb, 1.0);
        vec4 front = vec4(finite(albedo_at(halves.front)).rgb, 1.0), back = vec4(finite(albedo_at(halves.back)).rgb, 1.0);
        vec4 part = coverage_part(whole, front, back, halves.front_share);
        surface.normal = coverage_side(halves, k);
        surface.part = clamp(k == 0 ? part : whole - part, 0.0, 1.0);
    }
    return surface;
}

vec4 image_based_light_diffuse(float intensity, float rotation, int up) {
    Coverage halves = coverage_of(coverage_at(pixel));
    vec4 sum = vec4(0.0);
    for (int k = 0; k < (coverage_is_mixed(halves) ? 2 : 1); ++k) {
        ImageBasedLightSurface surface = image_based_light_surface(halves, k);
        if (surface.normal == vec3(0.0)) continue;
        vec3 color = surface.part.rgb * (1.0 - clamp(metallic_at(surface.at), 0.0, 1.0));
        vec3 light = image_based_light_in_sky(image_based_light_uv(surface.normal, up, rotation));
        sum += vec4(intensity * clamp(occlusion_at(surface.at), 0.0, 1.0) * color * light, surface.part.a);
    }
    return finite(sum);
}

// The i-th visible microfacet for a `view` in the xz plane (Heitz 2018).
vec3 image_based_light_seen(int i, int count, vec3 view, float alpha) {
    float part = (float(i) + 0.5) / float(count), turn = 2.0 * PI * fract(float(i) * 0.61803399);
    vec3 stretched = normalize(vec3(alpha * view.x, 0.0, view.z)), across = vec3(0.0, 1.0, 0.0);
    vec2 at = sqrt(part) * vec2(cos(turn), sin(turn));
    at.y = mix(sqrt(1.0 - at.x * at.x), at.y, 0.5 * (1.0 + stretched.z));
    float lift = sqrt(max(1.0 - dot(at, at), 0.0));
    vec3 facet = at.x * across + at.y * cross(stretched, across) + lift * stretched;
    return normalize(vec3(alpha * facet.xy, max(facet.z, 0.0)));
}

// The reflection of a uniform sky, as scale and bias of the color that facets have straight on: the second half of the
// split sum (Karis 2013). x is the cosine to the camera, y the roughness.
vec2 image_based_light_shares() {
    vec2 at = max(vec2(pixel) / vec2(extent - 1), 1e-3);
    vec3 view = vec3(sqrt(1.0 - at.x * at.x), 0.0, at.x);
    float alpha = at.y * at.y, along = sqrt(at.x * at.x * (1.0 - alpha * alpha) + alpha * alpha);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < IMAGE_BASED_LIGHT_FACETS; ++i) {
        vec3 facet = image_based_light_seen(i, IMAGE_BASED_LIGHT_FACETS, view, alpha);
        float seen = dot(view, facet), lit = 2.0 * seen * facet.z - view.z;
        if (seen <= 0.0 || lit <= 0.0) continue;
        float part = 2.0 * lit * (at.x + along) * ggx_visible(at.x, lit, alpha);  // the lit part of the visible part
        sum += part * mix(vec2(1.0, 0.0), vec2(0.0, 1.0), fresnel(vec3(0.0), seen).x);
    }
    return sum / float(IMAGE_BASED_LIGHT_FACETS);
}

// The light that a surface of the color `f0` mirrors, the mean over the places of a pixel. `covered` is its part of it.
vec3 image_based_light_mirrored(
    Turn turn, vec3 view, float roughness, vec3 f0, float covered, float rotation, int up
) {
    int places = turn_places(turn, roughness * roughness);
    float wide = sqrt(turn_alpha(turn, places, roughness * roughness)), total = 0.0;
    vec3 sum = vec3(0.0);
    for (int place = 0; place < places; ++place) {
        vec3 normal = turn_normal(turn, place, places);
        vec2 share = shares_near(vec2(clamp(dot(normal, view), 0.0, 1.0), wide) * vec2(shares_size - 1) + 0.5);
        vec2 uv = image_based_light_uv(reflect(-view, normal), up, rotation);
        vec3 part = clamp(f0 * share.x + covered * share.y, 0.0, 1.0);
        float weight = turn_weight(normal, view);
        sum += weight * part * image_based_light_level(uv, image_based_light_blur(wide)), total += weight;
    }
    return sum / total;
}

vec4 image_based_light_reflection(const vec4 rays[3], float intensity, float rotation, int up, float specular) {
    Coverage halves = coverage_of(coverage_at(pixel));
    bool mixed = coverage_is_mixed(halves);
    vec3 view = -normalize(camera_ray(rays, camera_uv(pixel, extent)));
    vec4 sum = vec4(0.0);
    for (int k = 0; k < (mixed ? 2 : 1); ++k) {
        ImageBasedLightSurface surface = image_based_light_surface(halves, k);
        if (surface.normal == vec3(0.0)) continue;
        float metal = clamp(metallic_at(surface.at), 0.0, 1.0), covered = surface.part.a;
        // Of non-metals up to 8 % are reflected, as in Disney's model (Burley 2012): 4 % at 0.5.
        vec3 f0 = mix(vec3(0.08 * specular * covered), surface.part.rgb, metal);
        Turn turn = turn_of(surface.at, surface.normal, mixed);
        float roughness = clamp(roughness_at(surface.at), 0.0, 1.0);
        vec3 light = image_based_light_mirrored(turn, view, roughness, f0, covered, rotation, up);
        sum += vec4(intensity * clamp(occlusion_at(surface.at), 0.0, 1.0) * light, covered);
    }
    return finite(sum);
}

vec4 image_based_light(vec4 diffuse, vec4 reflection) { return vec4(diffuse.rgb + reflection.rgb, diffuse.a); }
