#include "light/ambient_occlusion.glsl"
#include "light/image_based_light.glsl"
#include "lib/alpha.glsl"
#include "lib/environment.glsl"
#include "lib/finite.glsl"
#include "lib/occlusion.glsl"

const int DIRECTIONAL_OCCLUSION_PARTS = 4;  // parts of the hidden light on each side of a slice
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

// The light divided by pi that a white surface gets from its neighbors, minus the sky light that they hide.
vec4 directional_occlusion_seen(
    const vec4 rows[3], const vec4 rays[3], int factor, int slices, int steps, float radius, float falloff,
    float intensity, float bounce, float rotation, int up, bool matched
) {
    ivec2 at = pixel * factor;
    if (!is_surface(depth_at(at))) return AMBIENT_OCCLUSION_OPEN;
    Seen here = ambient_occlusion_seen(rays, at);
    vec2 noise = occlusion_noise(pixel, matched);
    float fade = 1.0 / max(falloff * radius, 1e-6 * radius), open = 0.0, whole = 0.0;
    vec3 light = vec3(0.0);
    for (int s = 0; s < slices; ++s) {
        Slice slice = slice_at(rows, rays, here, vec2(depth_size), OCCLUSION_PI * (float(s) + noise.x) / float(slices));
        vec2 next = OCCLUSION_NEXT * normalize(slice.pace);
        // Horizons ahead along the slice and behind: cosines to the view, and the light that passes up to them.
        vec2 ends = slice.tilt + vec2(0.5, -0.5) * OCCLUSION_PI, surface = cos(ends), horizon = surface;
        vec2 passes = vec2(slice_light(slice.tilt, ends.x), slice_light(slice.tilt, ends.y));
        vec3 bounced = vec3(0.0);
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
                if (dot(normal_at(other), ambient_occlusion_place(rays, other) - here.place) < 0.0)
                    bounced += (passes[side] - left) * clamp(image_at(other).rgb, 0.0, DIRECTIONAL_OCCLUSION_BRIGHTEST);
                passes[side] = left;
            }
        }
        whole += slice.share * slice_whole(slice.tilt);
        open += slice.share * (passes.x + passes.y);
        float start = fract(noise.y + float(s) * OCCLUSION_GOLDEN);
        vec3 hidden = directional_occlusion_hidden(here, slice, ends.x, passes.x, start, up, rotation)
            + directional_occlusion_hidden(here, slice, ends.y, passes.y, start, up, rotation);
        light += slice.share * (bounce * bounced - intensity * hidden);
    }
    return finite(vec4(light, open) / whole);
}

vec4 directional_occlusion_denoise(const vec4 rays[3], int factor) { return ambient_occlusion_denoise(rays, factor); }

vec4 directional_occlusion_enlarge(const vec4 rays[3], int factor) {
    return ambient_occlusion_between(rays, factor, AMBIENT_OCCLUSION_OPEN);
}

vec4 directional_occlusion_light(const vec4 rays[3], float intensity, float rotation, int up) {
    float depth = depth_at(pixel);
    if (!is_surface(depth)) return vec4(0.0, 0.0, 0.0, 1.0);
    Seen here = ambient_occlusion_seen(rays, pixel);
    vec3 light = max(intensity * directional_occlusion_from(here.normal, up, rotation) + gathered_at(pixel).rgb, 0.0);
    return finite(vec4(light * clamp(straight(albedo_at(pixel)).rgb, 0.0, 1.0), 1.0));
}

vec4 directional_occlusion(vec4 image, vec4 light) {
    vec4 safe = finite(image);
    return vec4(safe.rgb + light.rgb * safe.a, safe.a);
}
