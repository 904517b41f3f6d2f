// The color that a cookie gives a light, in passes that read `throws`, a table of how each light throws its cookie, and
// the pictures `cookie_1` to `cookie_4`.
#include "lib/environment.glsl"
#include "lib/footprint.glsl"
#include "lib/geometry.glsl"
#include "lib/pi.glsl"

const int COOKIE_CONE = 1, COOKIE_BEAM = 2, COOKIE_ROUND = 3;  // by a spot, by a sun, in all directions; 0 is none

// A place in a cookie, and how far it is from there to the next pixel of the render; both as fractions of the cookie.
struct CookiePlace { vec2 uv, step; };

// The size of a cookie in pixels.
ivec2 cookie_size(int number) {
    if (number == 1) return cookie_1_size;
    if (number == 2) return cookie_2_size;
    if (number == 3) return cookie_3_size;
    return cookie_4_size;
}

// The light of a pixel of a cookie.
vec3 cookie_texel(int number, ivec2 at) {
    if (number == 1) return cookie_1_at(at).rgb;
    if (number == 2) return cookie_2_at(at).rgb;
    if (number == 3) return cookie_3_at(at).rgb;
    return cookie_4_at(at).rgb;
}

// Where the light that falls on a place of the scene, `pitch` wide, came through the cookie.
CookiePlace cookie_place(int light, int kind, vec2 size, vec3 place, float pitch) {
    vec3 way = place - throws_at(ivec2(0, light)).xyz;
    vec4 along = throws_at(ivec2(1, light)), across = throws_at(ivec2(2, light)), ahead = throws_at(ivec2(3, light));
    vec2 at = vec2(dot(way, along.xyz), dot(way, across.xyz)), sides = vec2(1.0);
    if (kind == COOKIE_ROUND) {
        float reach = max(length(way), 1e-9);
        vec2 angles = pitch / reach * vec2(0.5, 1.0) / PI;
        return CookiePlace(environment_uv(way / reach, false, 0.0), angles);
    }
    float apart = 1.0, aspect = size.x / size.y;
    if (kind == COOKIE_CONE) {
        apart = dot(way, ahead.xyz);
        sides = aspect > 1.0 ? vec2(aspect, 1.0) : vec2(1.0, 1.0 / aspect);
        if (apart <= 0.0) return CookiePlace(vec2(-1.0), vec2(0.0));
    } else {
        sides = vec2(1.0, 1.0 / aspect);
    }
    vec2 step = pitch / (2.0 * apart * along.w * sides);
    vec2 uv = 0.5 - at / (2.0 * apart * along.w * sides);
    return CookiePlace(kind == COOKIE_BEAM ? fract(uv) : uv, step);
}

// Between four pixels of a cookie. That of a spot has darkness around it, that of a sun repeats, and that of a ball is
// joined all around.
vec3 cookie_near(int number, vec2 uv, ivec2 size, int kind) {
    if (kind == COOKIE_CONE && (any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0))))) return vec3(0.0);
    vec2 at = uv * vec2(size) - 0.5, part = at - floor(at);
    ivec2 first = ivec2(floor(at));
    vec3 sum = vec3(0.0);
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 offset = ivec2(corner & 1, corner >> 1), texel = first + offset;
        vec2 share = mix(1.0 - part, part, vec2(offset));
        if (kind == COOKIE_CONE) texel = clamp(texel, ivec2(0), size - 1);
        if (kind == COOKIE_BEAM) texel = (texel % size + size) % size;
        if (kind == COOKIE_ROUND) texel = edge_panorama(texel, size);
        sum += share.x * share.y * cookie_texel(number, texel);
    }
    return sum;
}

// What a light is multiplied by at a place: the mean of its cookie over what a pixel `pitch` wide shows of the scene.
vec3 cookie_color(int light, vec3 place, float pitch) {
    int kind = int(throws_at(ivec2(0, light)).w), number = int(throws_at(ivec2(2, light)).w);
    if (kind == 0) return vec3(1.0);
    ivec2 size = cookie_size(number);
    CookiePlace through = cookie_place(light, kind, vec2(size), place, pitch);
    vec2 span = through.step * vec2(size);
    int many = footprint_samples(vec2(span.x, 0.0), vec2(0.0, span.y));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < many * many; ++i)
        sum += cookie_near(number, through.uv + footprint_at(i, many) * through.step, size, kind);
    return max(sum / float(many * many), 0.0);
}
