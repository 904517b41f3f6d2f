#include "geometry/normal_from_depth.glsl"
#include "lib/alpha.glsl"
#include "lib/area_light.glsl"
#include "lib/brdf.glsl"
#include "lib/camera.glsl"
#include "lib/coverage.glsl"
#include "lib/finite.glsl"
#include "lib/geometry.glsl"
#include "lib/light_cookie.glsl"
#include "lib/light_shadow.glsl"
#include "lib/light_window.glsl"
#include "lib/pi.glsl"
#include "lib/solid.glsl"
#include "lib/working.glsl"

const int DEFERRED_LIGHTING_TILE = 16;            // pixels along each side
const int DEFERRED_LIGHTING_BITS = 24;            // lights per channel: the bits that a float holds exactly
const float DEFERRED_LIGHTING_EVERYWHERE = 1e18;  // larger than every coordinate
const float DEFERRED_LIGHTING_SMOOTH = 0.0016;    // least alpha: keeps highlights of point lights finite

struct LitSurface {
    vec3 place, normal, view, mirror, f0;
    float nv, alpha;
};

// 1 / depth, or if there is no depth, 1 / distance from the camera.
float deferred_lighting_near(vec3 place, float depth, vec4 rays[3]) {
    return is_surface(depth) ? 1.0 / depth : 1.0 / max(length(place - camera_eye(rays)), 1e-9);
}

// The position in the world; w is the nearness of surfaces, 0 on the background.
vec4 deferred_lighting_place(float depth, vec3 position, vec4 rays[3], bool placed) {
    vec3 place = placed ? position : camera_place(rays, camera_uv(pixel, extent), depth);
    bool there = is_finite(place) && all(lessThan(abs(place), vec3(GEOMETRY_FAR)));
    return there && (placed ? is_place(place) : is_surface(depth)) ? vec4(place, deferred_lighting_near(place, depth, rays)) : vec4(0.0);
}

float deferred_lighting_nearness(vec4 place) { return place.w; }

vec3 deferred_lighting_coverage() { return coverage_found_by_color(); }

vec3 deferred_lighting_normal(const vec4 rows[3]) { return normal_from_depth(rows); }

// A texel of the table of lights: the color of a light with a temperature is multiplied by that of a black body.
vec4 deferred_lighting_tint() {
    vec4 texel = table_at(pixel);
    ivec2 light = ivec2(0, pixel.y);
    if (pixel.x != 1 || heated_at(light).x == 0.0) return texel;
    return vec4(texel.rgb * from_rec709(tints_at(light).rgb), texel.a);
}

// --- tiles ---------------------------------------------------------------------------------------------------------

// The corner of a tile's bounding box with the lowest coordinates; with a `side` of -1, that with the highest.
vec4 deferred_lighting_corner(float side) {
    vec3 least = vec3(DEFERRED_LIGHTING_EVERYWHERE);
    for (int y = 0; y < DEFERRED_LIGHTING_TILE; ++y)
        for (int x = 0; x < DEFERRED_LIGHTING_TILE; ++x) {
            vec4 place = place_at(pixel * DEFERRED_LIGHTING_TILE + ivec2(x, y));
            if (place.w > 0.0) least = min(least, side * place.xyz);
        }
    return vec4(side * least, 0.0);
}

// The lights that can reach a tile: bit b of channel c of the tile's texel k stands for light 24 (4 k + c) + b.
vec4 deferred_lighting_tile(int count, int texels) {
    ivec2 tile = ivec2(pixel.x / texels, pixel.y);
    vec3 low = low_at(tile).xyz, high = high_at(tile).xyz;
    vec4 words = vec4(0.0);
    if (low.x > high.x) return words;
    int first = 4 * DEFERRED_LIGHTING_BITS * (pixel.x % texels);
    for (int c = 0; c < 4; ++c, first += DEFERRED_LIGHTING_BITS) {
        uint bits = 0u;
        for (int b = 0; b < min(DEFERRED_LIGHTING_BITS, count - first); ++b) {
            vec4 ball = balls_at(ivec2(0, first + b));
            vec3 apart = max(max(low - ball.xyz, ball.xyz - high), 0.0);
            if (dot(apart, apart) <= ball.w * ball.w) bits |= 1u << b;
        }
        words[c] = float(bits);
    }
    return words;
}

// --- light ---------------------------------------------------------------------------------------------------------

// Adds one light: the light that falls on the surface, and the light that it reflects to the camera. A sun is a point
// at distance 1.
void deferred_lighting_add(int model, int light, LitSurface at, inout vec3 fallen, inout vec3 mirrored) {
    vec4 origin = lights_at(ivec2(0, light)), glow = lights_at(ivec2(1, light));
    float size = max(glow.w, 0.0);
    vec3 way = glow.w < 0.0 ? origin.xyz : origin.xyz - at.place;
    float square = max(dot(way, way), max(size * size, 1e-8));
    float window = light_window(square, origin.w);
    if (window == 0.0) return;
    vec4 cone = lights_at(ivec2(2, light));
    vec3 l = way / sqrt(square);
    float spot = clamp(dot(cone.xyz, l) + cone.w, 0.0, 1.0), ball = size * size / square;
    vec3 power = glow.rgb * (window * window * spot * spot / square);
    fallen += power * ball_cosine(dot(at.normal, l), min(ball, 0.999999));

    if (size > 0.0) {  // the point of the sphere nearest to the mirrored view (Karis 2013)
        vec3 off = dot(l, at.mirror) * at.mirror - l;
        l = normalize(l + off * min(1.0, sqrt(ball) / max(length(off), 1e-9)));
    }
    float nl = dot(at.normal, l);
    if (nl <= 0.0) return;
    // The highlight of a sphere is wider: the variances add. Its brightness falls by the same factor, so that a mirror
    // shows the sphere as bright as it is.
    float square_alpha = at.alpha * at.alpha;
    if (model == MODEL_PHONG) {
        float paled = square_alpha / (square_alpha + 0.25 * ball * nl);
        mirrored += power * at.f0 * (phong_lobe(dot(at.mirror, l), at.alpha) * paled * nl);
    } else {
        vec3 h = normalize(at.view + l);
        float vh = max(dot(at.view, h), 1e-4), paled = square_alpha / (square_alpha + 0.25 * ball / vh);
        float facets = ggx_facets(at.normal, h, at.alpha) * ggx_visible(at.nv, nl, at.alpha);
        mirrored += power * fresnel(at.f0, vh) * (facets * paled * nl);
    }
}

// Adds all lights of a tile, in order.
void deferred_lighting_sum(
    int model, int texels, ivec2 tile, LitSurface at, inout vec3 fallen, inout vec3 mirrored
) {
    for (int k = 0, first = 0; k < texels; ++k) {
        vec4 words = words_at(ivec2(tile.x * texels + k, tile.y));
        for (int c = 0; c < 4; ++c, first += DEFERRED_LIGHTING_BITS)
            for (uint bits = uint(words[c]); bits != 0u; bits &= bits - 1u)
                deferred_lighting_add(model, first + findLSB(bits), at, fallen, mirrored);
    }
}

// One surface of a pixel: the pixel that stands for it, its place and normal, its part of the color, and how much less
// light falls on it because its normal turns within the pixel.
struct LitPart {
    ivec2 at;
    vec3 place, normal;
    vec4 color;
    float turned;
};

// What reflects light at a surface: its colors, and how rough it is.
struct LitMaterial {
    vec4 color;
    vec3 scatter;
    LitSurface surface;
};

// Finds surface `k` of a pixel, the front one first. False where nothing is lit.
bool deferred_lighting_part(int k, bool mixed, Coverage shares, vec4 color, const vec4 rays[3], bool seen, out LitPart part) {
    part.at = k == 0 ? shares.front : shares.back;
    vec4 place = place_at(part.at);
    part.color = color;
    part.normal = unit_normal(normal_at(part.at));
    part.turned = mixed ? 1.0 : shares.front_share;
    for (int rounds = mixed ? 1 : 0; rounds > 0; --rounds) {
        part.color = coverage_part(
            color, finite(albedo_at(shares.front)), finite(albedo_at(shares.back)), shares.front_share
        );
        if (seen) place.xyz = coverage_place(rays, place.xyz, part.normal);
        part.normal = coverage_side(shares, k);
        if (k == 0) part.turned = coverage_turned(shares);
        else part.color = color - part.color;
    }
    part.place = place.xyz;
    return place.w != 0.0 && part.normal != vec3(0.0) && part.color != vec4(0.0);
}

LitMaterial deferred_lighting_material(
    LitPart part, bool mapped, float metal, float roughness, float specular, bool seen, vec3 eye
) {
    LitMaterial lit;
    lit.color = straight(part.color);
    vec2 material = clamp(mapped ? finite(material_at(part.at)) : vec2(metal, roughness), 0.0, 1.0);

    LitSurface surface;
    surface.place = part.place, surface.normal = part.normal;
    surface.view = seen ? normalize(eye - part.place) : part.normal;
    surface.mirror = reflect(-surface.view, part.normal);
    surface.nv = clamp(dot(part.normal, surface.view), 1e-4, 1.0);
    surface.alpha = max(material.y * material.y, DEFERRED_LIGHTING_SMOOTH);
    // Of non-metals up to 8 % are reflected, as in Disney's model (Burley 2012): 4 % at 0.5.
    surface.f0 = mix(vec3(0.08 * specular), lit.color.rgb, material.x);
    lit.scatter = lit.color.rgb * (1.0 - material.x);
    lit.surface = surface;
    return lit;
}

// `share` scales diffuse (x) and specular light (y).
vec4 deferred_lighting_lit(
    int texels, bool tiled, int model, vec3 ambient, vec2 share, bool mapped, float metal, float roughness,
    float specular, const vec4 rays[3], bool seen, vec3 eye
) {
    vec4 color = finite(albedo_at(pixel)), sum = vec4(0.0);
    Coverage shares = coverage_of(coverage_at(pixel));
    bool mixed = coverage_is_mixed(shares);
    for (int k = 0; k < (mixed ? 2 : 1); ++k) {
        LitPart part;
        if (!deferred_lighting_part(k, mixed, shares, color, rays, seen, part)) continue;
        LitMaterial material = deferred_lighting_material(part, mapped, metal, roughness, specular, seen, eye);
        LitSurface surface = material.surface;
        vec3 sky = ambient * clamp(finite(occlusion_at(part.at)), 0.0, 1.0);
        vec3 fallen = vec3(0.0), mirrored = sky * ggx_sky(surface.f0, surface.nv, surface.alpha);
        ivec2 tile = tiled ? part.at / DEFERRED_LIGHTING_TILE : ivec2(0);
        deferred_lighting_sum(model, texels, tile, surface, fallen, mirrored);
        vec3 lit = share.x * material.scatter * (sky + part.turned * fallen / PI) + share.y * mirrored;
        sum += premultiplied(vec4(lit, material.color.a));
    }
    return finite(vec4(sum.rgb, color.a));
}

// Adds the light of rectangles, discs and tubes to what is lit already.
vec4 deferred_lighting_areas(
    int count, vec2 share, bool mapped, float metal, float roughness, float specular, const vec4 rays[3], bool seen,
    vec3 eye
) {
    vec4 color = finite(albedo_at(pixel)), before = lit_at(pixel);
    Coverage shares = coverage_of(coverage_at(pixel));
    bool mixed = coverage_is_mixed(shares);
    for (int k = 0; k < (mixed ? 2 : 1); ++k) {
        LitPart part;
        if (!deferred_lighting_part(k, mixed, shares, color, rays, seen, part)) continue;
        LitMaterial material = deferred_lighting_material(part, mapped, metal, roughness, specular, seen, eye);
        LitSurface surface = material.surface;
        AreaSurface lobes = area_surface(surface.normal, surface.view, surface.nv, surface.alpha);
        vec3 fallen = vec3(0.0), mirrored = vec3(0.0);
        for (int light = 0; light < count; ++light)
            area_add(area_light(light, surface.place), lobes, surface.f0, fallen, mirrored);
        vec3 lit = share.x * part.turned * material.scatter * fallen + share.y * mirrored;
        before.rgb += premultiplied(vec4(lit, material.color.a)).rgb;
    }
    return finite(before);
}

// Adds lights that a mask limits, each by a channel: first `lamps`, which may have cookies, then `count` areas.
vec4 deferred_lighting_limited(
    int model, int lamps, int count, vec2 share, bool mapped, float metal, float roughness, float specular,
    const vec4 rays[3], bool seen, vec3 eye
) {
    vec4 color = finite(albedo_at(pixel)), before = lit_at(pixel);
    Coverage shares = coverage_of(coverage_at(pixel));
    bool mixed = coverage_is_mixed(shares);
    for (int k = 0; k < (mixed ? 2 : 1); ++k) {
        LitPart part;
        if (!deferred_lighting_part(k, mixed, shares, color, rays, seen, part)) continue;
        LitMaterial material = deferred_lighting_material(part, mapped, metal, roughness, specular, seen, eye);
        LitSurface surface = material.surface;
        vec4 mask = mask_at(part.at);
        vec3 fallen = vec3(0.0), mirrored = vec3(0.0);
        float pitch = seen ? pixel_pitch(rays, 1.0 / place_at(part.at).w, vec2(extent)) : 0.0;
        for (int light = 0; light < lamps; ++light) {
            vec3 matte = vec3(0.0), shiny = vec3(0.0);
            deferred_lighting_add(model, light, surface, matte, shiny);
            vec3 through = mask[light] * cookie_color(light, surface.place, pitch);
            fallen += through * matte / PI, mirrored += through * shiny;
        }
        AreaSurface lobes = area_surface(surface.normal, surface.view, surface.nv, surface.alpha);
        for (int light = 0; light < count; ++light) {
            vec3 matte = vec3(0.0), shiny = vec3(0.0);
            area_add(area_light(light, surface.place), lobes, surface.f0, matte, shiny);
            fallen += mask[lamps + light] * matte, mirrored += mask[lamps + light] * shiny;
        }
        vec3 lit = share.x * part.turned * material.scatter * fallen + share.y * mirrored;
        before.rgb += premultiplied(vec4(lit, material.color.a)).rgb;
    }
    return finite(before);
}

// --- masks of lights -----------------------------------------------------------------------------------------------

vec4 deferred_lighting_planes() { return march_planes(); }
vec4 deferred_lighting_neighbors(const vec4 rays[3]) { return solid_neighbors(rays); }
vec4 deferred_lighting_runs(int reach) { return solid_runs(reach); }
vec4 deferred_lighting_solid(const vec4 rays[3]) { return solid_planes(rays); }
vec4 deferred_lighting_bounds() { return march_bounds(); }
vec4 deferred_lighting_surfaces() { return march_surfaces(); }

// The planar depth of a place in the world, 0 on the background.
float deferred_lighting_depth(vec4 place, const vec4 rows[3]) {
    return place.w > 0.0 ? max(dot(rows[2], vec4(place.xyz, 1.0)), 0.0) : 0.0;
}

vec4 deferred_lighting_open(
    const vec4 rows[3], const vec4 rays[3], int count, float reach, float thickness, int samples
) {
    return lamps_open(rows, rays, count, reach, thickness, samples);
}

vec4 deferred_lighting_smooth(const vec4 rows[3], const vec4 rays[3], vec4 soft) {
    return lamps_smooth(rows, rays, soft);
}

vec4 deferred_lighting_limit(
    float matte_1, float matte_2, float matte_3, float matte_4, vec4 open, vec4 choices
) {
    return lamps_limit(open, vec4(matte_1, matte_2, matte_3, matte_4), choices);
}

vec4 deferred_lighting(vec4 lit, vec4 emission) { return finite(vec4(lit.rgb + finite(emission).rgb, lit.a)); }
