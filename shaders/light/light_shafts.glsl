#include "lib/bright.glsl"
#include "lib/march.glsl"
#include "lib/occlusion.glsl"
#include "lib/seam.glsl"

vec4 light_shafts_planes() { return march_planes(); }
vec4 light_shafts_bounds() { return march_bounds(); }
vec4 light_shafts_surfaces() { return march_surfaces(); }

// The phase function of Henyey and Greenstein (1941), 1 for isotropic haze. At a cosine of 1 light continues straight
// ahead.
float light_shafts_phase(float cosine, float ahead) {
    return (1.0 - ahead * ahead) * pow(1.0 + ahead * ahead - 2.0 * ahead * cosine, -1.5);
}

// The part of the light that reaches a point on the ray of this pixel. `way` is the direction from there to the light.
float light_shafts_open(const vec4 rows[3], vec2 uv, float depth, vec3 way, float reach, bool endless, float thickness) {
    March ray = march_start(rows, uv, depth, way, reach, endless, vec2(extent));
    ray.at = 0.0;  // the ray starts in the air: this pixel's surface may block it
    return march(ray, extent, thickness, march_longest(extent)) && !ray.endless ? 1.0 - ray.sure : 1.0;
}

// Single scattering of a light of intensity 1. `to` is the direction to a sun, or the position of a lamp.
float light_shafts_haze(
    const vec4 rows[3], const vec4 rays[3], int light, vec3 to, vec2 source, float density, float ahead, float longest,
    float thickness, int count
) {
    const float least = 0.02;  // least radius of a lamp, for rays through its center
    vec2 uv = camera_uv(pixel, extent);
    vec3 ray = camera_ray(rays, uv), eye = camera_eye(rays);
    float stretch = length(ray), near = surfaces_at(pixel).x, end = longest;
    vec3 view = ray / stretch;
    if (near > 0.0) end = min(end, stretch / near);
    if (light == LIGHT_PICTURE) to = normalize(camera_ray(rays, source));
    float noise = occlusion_noise(pixel, true).x, sum = 0.0;

    if (light != LIGHT_LAMP) {
        // Samples are distributed by the light that is scattered there.
        float lost = 1.0 - exp(-density * end);
        for (int i = 0; i < count; ++i) {
            float part = (float(i) + noise) / float(count);
            float away = lost > 1e-4 ? -log(1.0 - part * lost) / density : part * end;
            sum += light_shafts_open(rows, uv, max(away / stretch, 1e-6), to, longest, true, thickness);
        }
        return finite(sum / float(count) * lost * light_shafts_phase(dot(to, view), ahead));
    }
    float closest = dot(to - eye, view), side = max(length(to - eye - closest * view), least);
    vec2 angle = atan(vec2(-closest, end - closest) / side);
    for (int i = 0; i < count; ++i) {
        float turn = mix(angle.x, angle.y, (float(i) + noise) / float(count));
        float away = clamp(closest + side * tan(turn), 0.0, end);
        vec3 way = to - eye - away * view;
        float reach = max(length(way), 1e-6);
        way /= reach;
        float arrives = exp(-density * (away + reach)) * light_shafts_phase(dot(way, view), ahead);
        sum += arrives * light_shafts_open(rows, uv, max(away / stretch, 1e-6), way, reach, false, thickness);
    }
    return finite(sum / float(count) * density * (angle.y - angle.x) / side);
}

// The mean over 4 x 4 pixels, one period of the noise, of pixels at a similar depth: haze has no other edges.
float light_shafts_denoise() {
    float here = surfaces_at(pixel).x, sum = 0.0, total = 0.0;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            ivec2 at = pixel + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent))) continue;
            float weight = (abs(x) == 2 ? 0.5 : 1.0) * (abs(y) == 2 ? 0.5 : 1.0), there = surfaces_at(at).x;
            weight *= clamp(2.0 - 10.0 * abs(here - there) / max(max(here, there), 1e-30), 0.0, 1.0);
            sum += weight * haze_at(at);
            total += weight;
        }
    return sum / total;
}

// Seams to the right and below where the depth jumps. On a plane its nearness does not bend, however steep it is.
vec3 light_shafts_seams() {
    const float jump = 0.1;  // of the nearer depth
    vec3 seams = vec3(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 along = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
        if (pixel[axis] >= extent[axis] - 1) continue;
        vec4 near = vec4(
            surfaces_at(max(pixel - along, 0)).x, surfaces_at(pixel).x, surfaces_at(pixel + along).x,
            surfaces_at(min(pixel + 2 * along, extent - 1)).x
        );
        float bend = min(abs(near.x - 2.0 * near.y + near.z), abs(near.y - 2.0 * near.z + near.w));
        seams[axis] = float(bend > jump * max(near.y, near.z));
    }
    return seams;
}

vec3 light_shafts_right() { return seam_rounds(0); }
vec3 light_shafts_below() { return seam_rounds(1); }
vec3 light_shafts_runs() { return seam_runs(); }

// Haze is that before the surface in the middle of a pixel. At a contour, that of both sides is mixed by their areas.
float light_shafts_smooth() {
    ivec2 beyond;
    float share = seam_share(beyond);
    return mix(haze_at(beyond), haze_at(pixel), share);
}

vec4 light_shafts_alone(vec4 image, float haze, vec3 light) { return glow_alone(vec4(0.0), haze * light); }
vec4 light_shafts(vec4 image, float haze, vec3 light) { return with_glow(image, haze * light); }
