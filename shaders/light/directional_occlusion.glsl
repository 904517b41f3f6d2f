#include "lib/alpha.glsl"
#include "lib/coverage.glsl"
#include "lib/denoise.glsl"
#include "lib/environment.glsl"
#include "lib/finite.glsl"
#include "lib/occlusion.glsl"
#include "lib/pi.glsl"
#include "lib/prefiltered_near.glsl"
#include "light/ambient_occlusion.glsl"
#include "light/image_based_light.glsl"

// Parts of the hidden light on each side of a slice. With 8, 1 % of the pixels of the preset sky_bounce change by more
// than 1 / 255; with 2, 4 %.
const int DIRECTIONAL_OCCLUSION_PARTS = 4;
const float DIRECTIONAL_OCCLUSION_FOOTPRINT = 0.2;  // of the width of a sample: how wide the mean is that it takes
// Pixels: the surroundings with which a lamp is compared. A choice: with 32, 3 % of the pixels of the node on the
// sample frame change by more than 1 / 255.
const float DIRECTIONAL_OCCLUSION_AROUND = 64.0;
// What is so many times as bright as these is a lamp. A choice: with 1 or 4, 5 % of those pixels change so.
const float DIRECTIONAL_OCCLUSION_LAMP = 2.0;
const float DIRECTIONAL_OCCLUSION_BLUR = 0.25;      // of the radius: how far the filter may look
const float DIRECTIONAL_OCCLUSION_BRIGHTEST = 65504.0;  // the largest half float: more could overflow in sums

vec3 directional_occlusion_normal(const vec4 rows[3]) { return ambient_occlusion_normal(rows); }

vec4 directional_occlusion_sky() { return image_based_light_sky(); }

vec4 directional_occlusion_irradiance() { return image_based_light_irradiance(); }

vec3 directional_occlusion_from(vec3 way, int up, float rotation) {
    return image_based_light_in_sky(environment_uv(way, up == UP_Y, rotation));
}

// The sky light that is hidden on one side of a slice, from the horizon, which lets `passes` of the light through, to
// the surface at angle `end`: from several directions, each for an equal part of the light.
vec3 directional_occlusion_hidden(
    Seen here, Slice slice, float end, float passes, float start, int up, float rotation
) {
    float all = slice_light(slice.tilt, end), hidden = all - passes;
    if (hidden <= 1e-5) return vec3(0.0);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < DIRECTIONAL_OCCLUSION_PARTS; ++i) {
        float part = (float(i) + start) / float(DIRECTIONAL_OCCLUSION_PARTS);
        float angle = slice_reach(slice.tilt, end, mix(passes, all, part) / all);
        sum += directional_occlusion_from(sin(angle) * slice.along + cos(angle) * here.view, up, rotation);
    }
    return sum * hidden / float(DIRECTIONAL_OCCLUSION_PARTS);
}

// How many pixels wide a part of a slice is: its step along, and its share of the circle across.
float directional_occlusion_width(vec2 away, int slices, vec2 pace) {
    return DIRECTIONAL_OCCLUSION_FOOTPRINT * sqrt(length(pace) * length(away) * PI / float(slices));
}

// The luminance above which a pixel counts as a lamp.
float directional_occlusion_limit(ivec2 at) {
    vec3 around = prefiltered_near(vec2(at) + 0.5, DIRECTIONAL_OCCLUSION_AROUND, depth_size).rgb;
    return DIRECTIONAL_OCCLUSION_LAMP * luminance(max(around, 0.0));
}

// The light of a pixel up to the limit, and the rest, which is the mean over a square `width` pixels wide.
mat2x3 directional_occlusion_parts(ivec2 at, float limit, float width) {
    vec3 here = clamp(levels_at(at).rgb, 0.0, DIRECTIONAL_OCCLUSION_BRIGHTEST);
    vec3 near = prefiltered_near(vec2(at) + 0.5, width, depth_size).rgb;
    near = clamp(near, 0.0, DIRECTIONAL_OCCLUSION_BRIGHTEST);
    return mat2x3(
        here * min(1.0, limit / max(luminance(here), 1e-9)), near * max(0.0, 1.0 - limit / max(luminance(near), 1e-9))
    );
}

// The light divided by pi that a white surface gets from its neighbors, minus the sky light that they hide; `visible`
// also has the open part. Few samples meet a lamp, so what is much brighter than its surroundings is kept apart as
// `lamps`, with the mean of its squares in `spread`, and is blurred farther.
void directional_occlusion_seen(
    const vec4 rows[3], const vec4 rays[3], int factor, int slices, int steps, float radius, float falloff,
    float intensity, float bounce, float rotation, int up, bool matched, out vec4 visible, out vec4 lamps,
    out vec3 spread
) {
    visible = AMBIENT_OCCLUSION_OPEN, lamps = vec4(0.0, 0.0, 0.0, 1.0), spread = vec3(0.0, 0.0, 1.0);
    ivec2 at = pixel * factor;
    if (!is_surface(depth_at(at))) return;
    Seen here = ambient_occlusion_seen(rays, at);
    vec2 noise = occlusion_noise(pixel, matched);
    float fade = 1.0 / max(falloff * radius, 1e-6 * radius), open = 0.0, whole = 0.0, squares = 0.0, reach = 0.0;
    float limit = directional_occlusion_limit(at);
    vec3 light = vec3(0.0), sum = vec3(0.0);
    for (int s = 0; s < slices; ++s) {
        Slice slice = slice_at(rows, rays, here, vec2(depth_size), PI * (float(s) + noise.x) / float(slices));
        vec2 next = OCCLUSION_NEXT * normalize(slice.pace);
        // Horizons ahead along the slice and behind: cosines to the view, and the light that passes up to them.
        vec2 ends = slice.tilt + vec2(0.5, -0.5) * PI, surface = cos(ends), horizon = surface;
        vec2 passes = vec2(slice_light(slice.tilt, ends.x), slice_light(slice.tilt, ends.y));
        vec3 bounced = vec3(0.0), caught = vec3(0.0);
        for (int k = 0; k < steps; ++k) {
            float part = (float(k) + fract(noise.y + float(s + k * steps) * OCCLUSION_GOLDEN)) / float(steps);
            vec2 away = part * radius * slice.pace + next;
            for (int side = 0; side < 2; ++side, away = -away) {
                ivec2 other = at + ivec2(round(away));
                float depth = depth_at(other);
                if (ambient_occlusion_outside(other, depth_size) || !is_surface(depth)) continue;
                vec3 way = place_beside(rays, here, other, vec2(at) + 0.5 + away, vec2(depth_size), depth) - here.place;
                float size = length(way), weight = clamp((radius - size) * fade, 0.0, 1.0);
                float rise = mix(surface[side], dot(way, here.view) / size, weight);
                if (rise <= horizon[side]) continue;
                horizon[side] = rise;
                float angle = acos(clamp(rise, -1.0, 1.0));
                float left = slice_light(slice.tilt, side == 0 ? angle : -angle);
                // A sample above the horizon is visible. It emits light if it faces this surface.
                if (dot(normal_at(other), ambient_occlusion_place(rays, other) - here.place) < 0.0) {
                    float width = directional_occlusion_width(away, slices, radius / float(steps) * slice.pace);
                    mat2x3 parts = directional_occlusion_parts(other, limit, width);
                    bounced += (passes[side] - left) * parts[0];
                    caught += (passes[side] - left) * parts[1];
                }
                passes[side] = left;
            }
        }
        whole += slice.share * slice_whole(slice.tilt);
        open += slice.share * (passes.x + passes.y);
        float start = fract(noise.y + float(s) * OCCLUSION_GOLDEN);
        vec3 hidden = directional_occlusion_hidden(here, slice, ends.x, passes.x, start, up, rotation)
            + directional_occlusion_hidden(here, slice, ends.y, passes.y, start, up, rotation);
        light += slice.share * (bounce * bounced - intensity * hidden);
        sum += slice.share * caught;
        float bright = luminance(slice.share * caught);
        squares += bright * bright;
        reach = max(reach, radius * length(slice.pace));
    }
    float mean = whole / float(slices);
    visible = finite(vec4(light, open) / whole);
    lamps = finite(vec4(sum / whole, 1.0));
    reach *= DIRECTIONAL_OCCLUSION_BLUR / float(factor);
    spread = finite(vec3(squares / (float(slices) * mean * mean), reach, 1.0));
}

vec4 directional_occlusion_half() { return prefiltered_half(); }
vec4 directional_occlusion_levels() { return prefiltered_levels(); }
vec4 directional_occlusion_guide(int factor) {
    return vec4(normal_at(pixel * factor), nearness(depth_at(pixel * factor)));
}
void directional_occlusion_period(const vec4 rays[3], int count, out vec4 light, out vec3 spread) {
    denoise_period(rays, count, light, spread);
}
void directional_occlusion_level(const vec4 rays[3], int stride, float contrast, out vec4 light, out vec3 spread) {
    denoise_level(rays, stride, contrast, light, spread);
}

vec4 directional_occlusion_denoise(const vec4 rays[3], int factor) { return ambient_occlusion_denoise(rays, factor); }

vec4 directional_occlusion_enlarge(const vec4 rays[3], int factor) {
    return ambient_occlusion_between(rays, factor, AMBIENT_OCCLUSION_OPEN);
}

float directional_occlusion_near(float depth) { return nearness(depth); }

// The surfaces of a pixel, or one where it is not sure that there are two.
vec3 directional_occlusion_coverage() {
    vec3 stored = coverage_found();
    return coverage_is_sure(coverage_of(stored)) ? stored : vec3(1.0, 0.0, 0.0);
}

// The light that a white surface gets in a pixel that is wholly in it.
vec3 directional_occlusion_white(
    const vec4 rays[3], ivec2 at, float intensity, float bounce, float rotation, int up
) {
    if (!is_surface(depth_at(at))) return vec3(0.0);
    Seen here = ambient_occlusion_seen(rays, at);
    vec3 light = intensity * directional_occlusion_from(here.normal, up, rotation) + gathered_at(at).rgb;
    return max(light + bounce * lamps_at(at).rgb, 0.0);
}

vec3 directional_occlusion_color(ivec2 at) { return clamp(straight(albedo_at(at)).rgb, 0.0, 1.0); }

// The light on the surfaces of a pixel, each as it is beside an edge, by coverage.
vec4 directional_occlusion_light(const vec4 rays[3], float intensity, float bounce, float rotation, int up) {
    Coverage shares = coverage_of(coverage_at(pixel));
    vec3 color = directional_occlusion_color(pixel), sum = vec3(0.0);
    bool mixed = coverage_is_mixed(shares);
    for (int k = 0; k < (mixed ? 2 : 1); ++k) {
        ivec2 at = k == 0 ? shares.front : shares.back;
        vec3 light = directional_occlusion_white(rays, at, intensity, bounce, rotation, up), part = color;
        if (mixed) {
            vec4 front = vec4(directional_occlusion_color(shares.front), 0.0);
            vec4 back = vec4(directional_occlusion_color(shares.back), 0.0);
            if (!is_surface(depth_at(shares.back))) back = vec4(0.0);
            vec3 ours = coverage_part(vec4(color, 0.0), front, back, shares.front_share).rgb;
            part = k == 0 ? ours : color - ours;
        }
        sum += light * part;
    }
    return finite(vec4(sum, 1.0));
}

vec4 directional_occlusion(vec4 image, vec4 light) {
    vec4 safe = finite(image);
    return vec4(safe.rgb + light.rgb * safe.a, safe.a);
}
