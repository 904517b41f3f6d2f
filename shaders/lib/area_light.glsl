// Light of rectangles, discs and tubes by linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016), in passes
// that read `areas`, the table of lights, and `cosines`, the table of matrices.
//
// A matrix turns the lobe of GGX into a cosine. The light that a cosine reflects from a polygon has a closed form (Lambert
// 1760), in which edges are summed. Each light is a polygon here: its outline as the surface sees it. A light is convex
// and equally bright everywhere, so nothing but its outline counts.

#include "lib/brdf.glsl"
#include "lib/light_window.glsl"
#include "lib/pi.glsl"

const int AREA_RECTANGLE = 0, AREA_DISC = 1;  // a tube is neither
const int AREA_CELLS = 64;                    // roughnesses, and angles of the eye, in the table of matrices
const int AREA_RIM = 16;                      // corners of a disc: with its area, within 1e-3 of the integral
const int AREA_ARC = 9;                       // corners at each end of a tube
// From the world to the axes of a surface, on from there into a cosine, and back to the world; and the part of white
// light that GGX reflects with a Fresnel reflectance of 1.
struct AreaSurface { vec3 view; mat3 frame, lobe, back; float share; };

// A light as a surface sees it: its middle and half axes from there, and its radiance toward it. For a tube `across` is
// the side that faces the surface, and `arc` the angle from there to its rim.
struct AreaLight { int kind; vec3 middle, along, across, deep, radiance; float arc; ivec2 far; };

// The sum over the edges of a polygon above the horizon, z = 0. `entry` and `leave` are where it crosses the horizon,
// and `from` and `to` the ends of the last edge above it.
struct AreaSum { vec3 last, entry, leave, from, to, total; bool enters, leaves; };

// The frames of a surface point in which light is integrated: that of matte and that of shiny reflection.
AreaSurface area_surface(vec3 normal, vec3 view, float nv, float roughness) {
    vec3 side = view - normal * dot(normal, view);
    if (dot(side, side) < 1e-10) side = abs(normal.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    side = normalize(side - normal * dot(normal, side));
    float last = float(AREA_CELLS - 1);
    vec2 cell = vec2(roughness, sqrt(1.0 - nv)) * last + 0.5;
    vec4 parts = cosines_near(cell);
    AreaSurface surface;
    surface.frame = transpose(mat3(side, cross(normal, side), normal));
    surface.lobe = mat3(parts.x, 0.0, parts.z, 0.0, 1.0, 0.0, parts.y, 0.0, parts.w);
    surface.back = inverse(surface.lobe * surface.frame);
    surface.share = cosines_near(cell + vec2(0.0, AREA_CELLS)).x;
    surface.view = view;
    return surface;
}

// The light of a row of the table, from a place in the world. Its radiance is 0 where it does not shine.
AreaLight area_light(int row, vec3 place) {
    vec4 origin = areas_at(ivec2(0, row)), glow = areas_at(ivec2(1, row));
    vec4 first_axis = areas_at(ivec2(2, row)), second_axis = areas_at(ivec2(3, row));
    AreaLight lamp;
    lamp.kind = int(glow.w), lamp.middle = origin.xyz - place, lamp.along = first_axis.xyz, lamp.across = second_axis.xyz;
    lamp.deep = vec3(0.0), lamp.arc = 0.0, lamp.far = ivec2(0);
    float window = light_window(dot(lamp.middle, lamp.middle), origin.w);
    lamp.radiance = glow.rgb * window * window;
    if (lamp.kind <= AREA_DISC) {
        if (dot(cross(lamp.along, lamp.across), lamp.middle) >= 0.0) lamp.radiance = vec3(0.0);
        return lamp;
    }
    float half_length = first_axis.w, radius = second_axis.w;
    vec3 axis = first_axis.xyz / half_length;
    float at = -dot(lamp.middle, axis);
    vec3 away = lamp.middle + at * axis;
    float apart = length(away);
    lamp.across = apart > 1e-6 * half_length ? -away / apart : normalize(cross(axis, abs(axis.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    lamp.deep = radius * cross(axis, lamp.across);
    lamp.across *= radius;
    lamp.far = ivec2(greaterThan(vec2(at, -at), vec2(half_length)));
    lamp.arc = acos(min(radius / max(apart, 1e-9), 1.0));
    if (apart <= radius && lamp.far == ivec2(0)) lamp.radiance = vec3(0.0);  // within the tube
    return lamp;
}

// What an edge between two directions adds to the light of a polygon, as a vector: z is what a cosine reflects. By a fit
// of the angle over its sine (Hill and Heitz 2016).
vec3 area_edge(vec3 from, vec3 to) {
    float scale = inversesqrt(max(dot(from, from) * dot(to, to), 1e-30)), x = dot(from, to) * scale, y = abs(x);
    float fit = (0.8543985 + (0.4965155 + 0.0145206 * y) * y) / (3.4175940 + (4.1616724 + y) * y);
    float angle = x > 0.0 ? fit : 0.5 * inversesqrt(max(1.0 - x * x, 1e-7)) - fit;
    return angle * scale * cross(from, to - from);
}

// The start of a walk around the edges of a lamp, at one of its corners.
AreaSum area_begin(vec3 corner) {
    const vec3 none = vec3(0.0);
    return AreaSum(corner, none, none, none, none, none, false, false);
}

// Adds the edge to the next corner, or the part of it above the horizon. False where it has none.
bool area_next(inout AreaSum sum, vec3 corner) {
    vec3 from = sum.last, to = corner;
    sum.last = corner;
    if (from.z <= 0.0 && to.z <= 0.0) return false;
    vec3 crossing = mix(from, to, from.z / (from.z - to.z));
    if (from.z < 0.0) sum.entry = from = crossing, sum.enters = true;
    if (to.z < 0.0) sum.leave = to = crossing, sum.leaves = true;
    sum.total += area_edge(from, to);
    sum.from = from, sum.to = to;
    return true;
}

// The mean direction of the polygon, with the part of a cosine that it covers as z.
vec3 area_end(AreaSum sum) {
    vec3 total = sum.enters && sum.leaves ? sum.total + area_edge(sum.leave, sum.entry) : sum.total;
    return total.z < 0.0 ? -total : total;
}

// How many corners the outline of a light has.
int area_corners(AreaLight lamp) {
    return lamp.kind == AREA_RECTANGLE ? 4 : lamp.kind == AREA_DISC ? AREA_RIM : 2 * AREA_ARC;
}

// A corner of the outline. The corners of a round one lie outside of it, so that both have the same area.
vec3 area_corner(AreaLight lamp, int corner) {
    if (lamp.kind == AREA_RECTANGLE) {
        vec2 side = vec2(((corner + 1) & 2) - 1, (corner & 2) - 1);
        return lamp.middle - side.x * lamp.along - side.y * lamp.across;
    }
    if (lamp.kind == AREA_DISC) {
        float step = 2.0 * PI / float(AREA_RIM), turn = float(corner) * step;
        return lamp.middle + sqrt(step / sin(step)) * (cos(turn) * lamp.along + sin(turn) * lamp.across);
    }
    int end = corner / AREA_ARC, number = corner - end * AREA_ARC;
    float side = end == 0 ? 1.0 : -1.0, whole = lamp.far[end] != 0 ? 2.0 * (lamp.arc - PI) : 2.0 * lamp.arc;
    float edges = float(AREA_ARC - 1), step = whole / edges, turn = side * (float(number) * step - lamp.arc);
    bool between = number > 0 && number < AREA_ARC - 1;
    float wide = between ? 1.0 + step * step / 12.0 * edges / (edges - 1.0) : 1.0;
    return lamp.middle + side * lamp.along + wide * (cos(turn) * lamp.across + sin(turn) * lamp.deep);
}

// Adds a light: the part of the diffuse lobe that it covers, and what is reflected. The horizon cuts the outline first:
// a lobe near the horizon becomes a cosine that would see below it. Fresnel's term is that of the mean
// direction in the lobe: its mean over the whole lobe, as in the paper, is twice too bright for small lights.
void area_add(AreaLight lamp, AreaSurface surface, vec3 f0, inout vec3 fallen, inout vec3 mirrored) {
    if (lamp.radiance == vec3(0.0)) return;
    int corners = area_corners(lamp);
    vec3 first = area_corner(lamp, 0);
    AreaSum matte = area_begin(surface.frame * first), shiny = matte;
    bool begun = false;
    vec3 start = vec3(0.0);
    for (int number = 1; number <= corners; ++number) {
        bool below = matte.last.z < 0.0;
        if (!area_next(matte, surface.frame * area_corner(lamp, number == corners ? 0 : number))) continue;
        if (!begun) shiny = area_begin(surface.lobe * matte.from), start = matte.from, begun = true;
        else if (below) area_next(shiny, surface.lobe * matte.from);
        area_next(shiny, surface.lobe * matte.to);
    }
    if (!begun) return;
    area_next(shiny, surface.lobe * start);
    fallen += lamp.radiance * area_end(matte).z;
    vec3 lobe = area_end(shiny), way = surface.back * lobe;
    if (lobe.z <= 0.0) return;
    vec3 halfway = normalize(surface.view + normalize(way));
    mirrored += lamp.radiance * fresnel(f0, dot(surface.view, halfway)) * (surface.share * lobe.z);
}
