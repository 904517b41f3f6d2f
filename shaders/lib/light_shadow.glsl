// How much of each of four lights a pixel sees, in passes that read `lamps`, a table of lights, `surfaces` and `normal`.
#include "lib/pi.glsl"
#include "lib/shadow.glsl"

const int LAMP_SUN = 0, LAMP_BALL = 1, LAMP_DISC = 2;  // others are rectangles, from the middle along two half axes
const float LAMP_ENDLESS = 1e8;  // units of the scene: the distance of a sun

// The way from a place to a random point of a light, and as w the distance.
vec4 lamp_way(int row, vec3 place, vec2 random) {
    vec4 origin = lamps_at(ivec2(0, row)), along = lamps_at(ivec2(1, row)), across = lamps_at(ivec2(2, row));
    int kind = int(origin.w);
    vec3 to = kind == LAMP_SUN ? origin.xyz : origin.xyz - place;
    float turn = 2.0 * PI * random.x;
    vec2 part = sqrt(random.y) * vec2(cos(turn), sin(turn));
    if (kind <= LAMP_BALL) {
        vec3 side = normalize(cross(to, abs(to.z) < 0.7 * length(to) ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
        to += along.w * (part.x * side + part.y * cross(normalize(to), side));
    } else {
        if (kind != LAMP_DISC) part = 2.0 * random - 1.0;
        to += part.x * along.xyz + part.y * across.xyz;
    }
    return vec4(normalize(to), kind == LAMP_SUN ? LAMP_ENDLESS : length(to));
}

// The part of each light that is not hidden, by `count` rays for a light with a size; 1 for lights without shadows.
vec4 lamps_open(const vec4 rows[3], const vec4 rays[3], int lights, float reach, float thickness, int count) {
    const vec2 lattice = vec2(0.75487767, 0.56984029);  // R2 sequence (Roberts 2018)
    vec4 open = vec4(1.0);
    float near = surfaces_at(pixel).x;
    if (near <= 0.0) return open;
    vec2 uv = camera_uv(pixel, extent), noise = occlusion_noise(pixel, true);
    vec3 normal = shadow_normal(rows, pixel), plane = march_normal(rows, pixel, extent);
    vec3 place = camera_place(rays, uv, 1.0 / near);
    for (int light = 0; light < lights; ++light) {
        float kind = lamps_at(ivec2(0, light)).w, sum = 0.0, total = 0.0;
        int many = lamps_at(ivec2(2, light)).w > 0.0 ? count : 1;
        for (int i = 0; i < many && kind >= 0.0; ++i) {
            vec4 way = lamp_way(light, place, fract(noise + float(i) * lattice));
            if (dot(normal, way.xyz) <= 0.0) continue;
            sum += shadow_open(rows, uv, 1.0 / near, way.xyz, plane, min(reach, way.w), thickness, vec2(extent));
            total += 1.0;
        }
        if (total > 0.0) open[light] = sum / total;
    }
    return finite(open);
}

// The mean of `open` over the pixels of the same surface, for lights that are `soft`, 1 and not 0.
vec4 lamps_smooth(const vec4 rows[3], const vec4 rays[3], vec4 soft) {
    float near = surfaces_at(pixel).x, total = 0.0;
    if (near <= 0.0) return vec4(1.0);
    vec4 sum = vec4(0.0);
    vec3 normal = shadow_normal(rows, pixel), here = camera_ray(rays, camera_uv(pixel, extent)) / near;
    float apart = pixel_pitch(rays, 1.0 / near, vec2(extent));
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            float weight = shadow_weight(rows, rays, ivec2(x, y), normal, here, apart);
            if (weight <= 0.0) continue;
            sum += weight * open_at(pixel + ivec2(x, y));
            total += weight;
        }
    return finite(mix(open_at(pixel), sum / total, soft));
}

// Limits lights to mattes: `choices` has the number of the matte of each light, below 0 for all outside of it.
vec4 lamps_limit(vec4 open, vec4 mattes, vec4 choices) {
    for (int light = 0; light < 4; ++light) {
        int number = int(abs(choices[light]));
        if (number == 0) continue;
        float matte = clamp(finite(mattes[number - 1]), 0.0, 1.0);
        open[light] *= choices[light] > 0.0 ? matte : 1.0 - matte;
    }
    return open;
}
