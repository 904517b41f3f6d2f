#include "geometry/normal_from_depth.glsl"
#include "lib/alpha.glsl"
#include "lib/finite.glsl"
#include "lib/occlusion.glsl"
#include "lib/pi.glsl"

// Smaller pictures hold every `factor`-th pixel: their pixel p is pixel p * factor of depth. Their xyz is the mean
// direction of open sky, which is shorter the wider the sky is spread; w is the open part.
const vec4 AMBIENT_OCCLUSION_OPEN = vec4(0.0, 0.0, 0.0, 1.0);

vec3 ambient_occlusion_normal(const vec4 rows[3]) {
    vec3 normal = unit_normal(normal_at(pixel));
    return normal != vec3(0.0) ? normal : normal_from_depth(rows);
}

bool ambient_occlusion_outside(ivec2 at, ivec2 size) {
    return any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size));
}

vec3 ambient_occlusion_place(const vec4 rays[3], ivec2 at) {
    return depth_at(at) * camera_ray(rays, camera_uv(at, depth_size));
}

Seen ambient_occlusion_seen(const vec4 rays[3], ivec2 at) {
    return seen_at(rays, camera_uv(at, depth_size), depth_at(at), normal_at(at));
}

// Horizon-based methods: slices through the view vector, each with a horizon on both sides. `mode` is the formula: GTAO
// (Jimenez et al. 2016), HBAO (Bavoil and Sainz 2008), or visibility bitmasks (Therrien et al. 2023).
vec4 ambient_occlusion_horizons(
    int mode, const vec4 rows[3], const vec4 rays[3], int factor, int slices, int steps, float radius, float falloff,
    float thickness, bool matched
) {
    ivec2 at = pixel * factor;
    if (!is_surface(depth_at(at))) return AMBIENT_OCCLUSION_OPEN;
    Seen here = ambient_occlusion_seen(rays, at);
    vec2 noise = occlusion_noise(pixel, matched);
    float fade = 1.0 / max(falloff * radius, 1e-6 * radius), open = 0.0, whole = 0.0;
    vec3 bent = vec3(0.0);
    for (int s = 0; s < slices; ++s) {
        Slice slice = slice_at(rows, rays, here, vec2(depth_size), PI * (float(s) + noise.x) / float(slices));
        vec2 next = OCCLUSION_NEXT * normalize(slice.pace);
        float tilt = slice.tilt, all = slice.share * slice_whole(tilt);
        // Horizons are cosines to the view, ahead along the slice and behind. They start at the surface itself.
        vec2 surface = cos(tilt + vec2(0.5, -0.5) * PI), horizon = surface, lost = vec2(0.0);
        float first = -slice_light(tilt, tilt - 0.5 * PI);
        uint sectors = 0u;
        for (int k = 0; k < steps; ++k) {
            float part = (float(k) + fract(noise.y + float(s + k * steps) * OCCLUSION_GOLDEN)) / float(steps);
            vec2 away = part * radius * slice.pace + next;
            for (int side = 0; side < 2; ++side, away = -away) {
                ivec2 other = at + ivec2(round(away));
                float depth = depth_at(other);
                if (ambient_occlusion_outside(other, depth_size) || !is_surface(depth)) continue;
                vec3 way = place_beside(rays, here, other, vec2(at) + 0.5 + away, vec2(depth_size), depth) - here.place;
                float size = length(way), weight = clamp((radius - size) * fade, 0.0, 1.0);
                if (weight == 0.0) continue;
                float rise = dot(way, here.view) / size;
                if (mode == MODE_GTAO) {
                    horizon[side] = max(horizon[side], mix(surface[side], rise, weight));
                } else if (mode == MODE_HBAO) {
                    if (rise <= horizon[side]) continue;
                    lost[side] += weight * (rise - horizon[side]);
                    horizon[side] = rise;
                } else {
                    // The angles from the front to the back of the sample, in 32 sectors with equal light.
                    vec3 back = way - thickness * here.view;
                    vec2 ends = acos(clamp(vec2(rise, dot(back, here.view) / length(back)), -1.0, 1.0));
                    ends = side == 0 ? ends : -ends.yx;
                    ends = clamp(ends, tilt - 0.5 * PI, tilt + 0.5 * PI);
                    vec2 light = vec2(slice_light(tilt, ends.x), slice_light(tilt, ends.y)) * sign(ends);
                    uvec2 bounds = uvec2(clamp(32.0 * (light - first) / slice_whole(tilt), 0.0, 32.0) + 0.5);
                    uint taken = bounds.y - bounds.x;
                    uint added = (taken > 31u ? ~0u : (1u << taken) - 1u) << bounds.x;
                    if (taken == 0u || (added &= ~sectors) == 0u) continue;
                    sectors |= added;
                    float middle = 0.5 * (ends.x + ends.y);
                    bent -= all * float(bitCount(added)) / 32.0
                        * (slice.along * sin(middle) + here.view * cos(middle));
                }
            }
        }
        if (mode == MODE_BITMASK) {
            whole += all;
            open += all * float(bitCount(~sectors)) / 32.0;
            bent += all * here.normal;
            continue;
        }
        vec2 angle = vec2(1.0, -1.0) * acos(clamp(horizon, -1.0, 1.0));
        if (mode == MODE_GTAO) {
            angle = clamp(angle, tilt - 0.5 * PI, tilt + 0.5 * PI);
            whole += all;
            open += slice.share * (slice_light(tilt, angle.x) + slice_light(tilt, angle.y));
            vec2 toward = slice.share * (slice_direction(tilt, angle.x) + slice_direction(tilt, angle.y));
            bent += toward.x * slice.along + toward.y * here.view;
        } else {
            whole += 2.0;
            open += 2.0 - lost.x - lost.y;
            vec2 up = sin(angle), toward = angle - up * cos(angle);
            bent += 0.5 * ((toward.x + toward.y) * slice.along + dot(up, up) * here.view);
        }
    }
    return finite(vec4(bent / whole, open / whole));
}

// Point-based methods: points in a ball around the surface (Crytek 2007), in the hemisphere above it, or on a disc
// across the view (Alchemy, McGuire et al. 2011).
vec4 ambient_occlusion_points(
    int mode, const vec4 rows[3], const vec4 rays[3], int factor, int points, float radius, float thickness,
    bool matched
) {
    const float second = 0.75487767;  // of the R2 sequence (Roberts 2018)
    const float bias = 1e-4, least = 1e-2;  // Alchemy's beta and epsilon, the latter in squared radii
    ivec2 at = pixel * factor;
    if (!is_surface(depth_at(at))) return AMBIENT_OCCLUSION_OPEN;
    Seen here = ambient_occlusion_seen(rays, at);
    vec2 noise = occlusion_noise(pixel, matched);
    vec3 pole = mode == MODE_ALCHEMY ? here.view : here.normal, bent = vec3(0.0);
    vec3 across = normalize(cross(pole, abs(pole.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    float open = 0.0, whole = 0.0;
    for (int i = 0; i < points; ++i) {
        float turn = 2.0 * PI * fract(float(i) * OCCLUSION_GOLDEN + noise.y);
        float part = (float(i) + noise.x) / float(points);
        float away = fract(float(i) * second + noise.x + 5.0 * noise.y), lift = part;
        if (mode == MODE_CRYTEK) lift = 2.0 * part - 1.0, away = pow(away, 1.0 / 3.0);
        if (mode == MODE_ALCHEMY) lift = 0.0, away = part;
        vec3 around = cos(turn) * across + sin(turn) * cross(pole, across);
        vec3 way = sqrt(max(1.0 - lift * lift, 0.0)) * around + lift * pole;
        vec3 place = here.place + radius * away * way;
        float deep = dot(rows[2].xyz, place);
        vec2 uv = vec2(dot(rows[0].xyz, place), dot(rows[1].xyz, place)) / deep;
        ivec2 other = ivec2(floor(clamp(uv, -1.0, 2.0) * vec2(depth_size)));
        whole += 1.0;
        if (deep <= 0.0 || ambient_occlusion_outside(other, depth_size)) {
            // Outside of the picture, the surface is assumed to continue.
            if (mode == MODE_HEMISPHERE || mode == MODE_CRYTEK && lift > 0.0) open += 1.0, bent += way;
            continue;
        }
        float depth = depth_at(other);
        vec3 ray = camera_ray(rays, camera_uv(other, depth_size));
        if (mode == MODE_ALCHEMY) {
            if (!is_surface(depth)) continue;
            way = (depth * ray - here.place) / radius;
            float square = dot(way, way);
            if (square >= 1.0) continue;
            float gain = max(dot(way, here.normal) - bias * depth / radius, 0.0) / (square + least);
            open -= gain;
            bent -= gain * way * inversesqrt(max(square, 1e-12));
            continue;
        }
        vec3 front = place_beside(rays, here, other, uv * vec2(depth_size), vec2(depth_size), depth);
        float behind = deep * (1.0 - 1e-5) - dot(rows[2].xyz, front);
        // A point below the surface is always blocked, however thin the surface is.
        float reach = lift < 0.0 ? 1.0 : clamp(2.0 - behind / max(thickness, 1e-9), 0.0, 1.0);
        float blocked = is_surface(depth) && behind > 0.0 ? reach : 0.0;
        open += 1.0 - blocked;
        bent += (1.0 - blocked) * way;
    }
    if (mode == MODE_ALCHEMY) open += whole, bent += whole * here.normal;
    // Half of the ball is below an open surface, so the open points count twice.
    if (mode == MODE_CRYTEK) open *= 2.0, bent *= 2.0;
    return finite(vec4(bent, open) / whole);
}

// The mean over 4 x 4 pixels of the same surface, which is one period of the noise (5 x 5 pixels, the outermost with
// half weight). Pixels without partners, such as rims with mixed normals, take the values of pixels nearby.
vec4 ambient_occlusion_denoise(const vec4 rays[3], int factor) {
    const float enough = 4.0;
    ivec2 at = pixel * factor;
    float depth = depth_at(at);
    if (!is_surface(depth)) return AMBIENT_OCCLUSION_OPEN;
    vec3 place = ambient_occlusion_place(rays, at), normal = normal_at(at);
    float apart = float(factor) * pixel_pitch(rays, depth, vec2(depth_size)), total = 0.0, total_near = 0.0;
    vec4 sum = vec4(0.0), sum_near = vec4(0.0);
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            ivec2 other = pixel + ivec2(x, y);
            if (ambient_occlusion_outside(other, open_size) || !is_surface(depth_at(other * factor))) continue;
            vec3 way = ambient_occlusion_place(rays, other * factor) - place;
            float weight = (abs(x) == 2 ? 0.5 : 1.0) * (abs(y) == 2 ? 0.5 : 1.0);
            float same = weight * same_surface(normal, normal_at(other * factor), way, apart);
            float near = weight / (1.0 + dot(way, way) / (apart * apart));
            vec4 open = open_at(other);
            sum += same * open, total += same;
            sum_near += near * open, total_near += near;
        }
    float lone = clamp((enough - total) / (enough - 1.0), 0.0, 1.0);
    return finite((sum + lone * sum_near) / (total + lone * total_near));
}

// Interpolates the smaller picture, only from pixels of the same surface (Kopf et al. 2007); `lone` where there is
// none.
vec4 ambient_occlusion_between(const vec4 rays[3], int factor, vec4 lone) {
    const float others = 1e-4;  // weight of pixels of other surfaces, if there are no others
    float depth = depth_at(pixel), total = 0.0;
    if (!is_surface(depth)) return AMBIENT_OCCLUSION_OPEN;
    vec3 place = ambient_occlusion_place(rays, pixel), normal = normal_at(pixel);
    float apart = float(factor) * pixel_pitch(rays, depth, vec2(depth_size));
    ivec2 first = pixel / factor;
    vec2 part = vec2(pixel - first * factor) / float(factor);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1), other = first + corner;
        if (ambient_occlusion_outside(other, open_size) || !is_surface(depth_at(other * factor))) continue;
        vec2 near = mix(1.0 - part, part, vec2(corner));
        vec3 way = ambient_occlusion_place(rays, other * factor) - place;
        float same = same_surface(normal, normal_at(other * factor), way, apart);
        float weight = near.x * near.y * (same + others);
        sum += weight * open_at(other);
        total += weight;
    }
    return total > 0.0 ? finite(sum / total) : lone;
}

vec4 ambient_occlusion_enlarge(const vec4 rays[3], int factor) {
    return ambient_occlusion_between(rays, factor, vec4(normal_at(pixel), 1.0));
}

float ambient_occlusion_value(vec4 open, float power) { return pow(clamp(open.w, 0.0, 1.0), power); }

vec3 ambient_occlusion_bent(vec4 open) {
    float size = length(open.xyz);
    return size > 1e-6 ? open.xyz / size : vec3(0.0);
}

// Adds light that bounces between surfaces, more for lighter surfaces (fit of Jimenez et al. 2016).
vec4 ambient_occlusion(vec4 open, vec4 albedo, float power, bool multi_bounce) {
    float once = ambient_occlusion_value(open, power);
    if (!multi_bounce) return vec4(vec3(once), 1.0);
    vec3 color = clamp(finite(straight(albedo)).rgb, 0.0, 1.0);
    vec3 a = 2.0404 * color - 0.3324, b = 0.6417 - 4.7951 * color, c = 2.7552 * color + 0.6903;
    return vec4(max(vec3(once), ((once * a + b) * once + c) * once), 1.0);
}
