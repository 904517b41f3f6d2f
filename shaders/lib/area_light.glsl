// Light of rectangles, discs and tubes on matte and on shiny surfaces, in passes that read `areas`, the table of lights.
//
// Each light is a polygon here: its outline as the surface sees it. A light is convex and equally bright everywhere, so
// nothing but its outline counts. For matte surfaces the integral has a closed form (Lambert 1760), in which edges are
// summed.
//
// The light that visible facets of GGX mirror lies evenly on a cap of a sphere (Dupuy and Benyoub 2023). So the outline
// is mapped to that cap: the area it encloses there is the part of the lobe that the light covers, whatever the
// roughness. What is left, Fresnel's term and the part of facets that light reaches, is smooth on the cap. Edges are
// mapped at places that lie evenly in a cosine, which a matrix turns into about the lobe (Heitz et al. 2016).

#include "lib/brdf.glsl"
#include "lib/light_window.glsl"
#include "lib/pi.glsl"

const int AREA_RECTANGLE = 0, AREA_DISC = 1;  // a tube is neither
const int AREA_RIM = 16;                      // corners of a disc: with its area, within 1e-3 of the integral
const int AREA_ARC = 9;                       // corners at each end of a tube
// The longest piece of an edge, in the cosine that is about the lobe: of a light, of one that the horizon cuts, where
// less is mirrored within a short way, and on the horizon, along which the outline turns quickly. Choices between time
// and error, as are those below: with pi / 6, pi / 6 and pi / 12 one in a hundred close rectangles that the horizon cuts,
// seen at a grazing angle on polished metal, is off by 0.01 of its radiance and the worst by 0.06.
const float AREA_PIECE = PI / 6.0, AREA_CUT_PIECE = PI / 18.0, AREA_LOW_PIECE = PI / 30.0;
// Where the eye is farther than 60 degrees from the normal, outlines near the horizon turn as quickly on the cap, so pieces
// are shorter: by this number times the cosine, at least by the second. Without it two of 8,000 reflections of close
// rectangles were off by 0.02 and 0.04, with it the worst by 0.007.
const float AREA_GRAZING = 2.0, AREA_SHORTEST = 0.2;
// Heights of parts of the cap, up to which one place stands for the way from the middle to the edge, or two.
const float AREA_FLAT = 0.1, AREA_ROUND = 0.5;
// How much narrower than the lobe that cosine is. With 2, lights were found that it sees from a side, off by 0.3.
const float AREA_WIDE = 1.5;
// Places along a way at which the mean is taken, as parts of the height, and their weights (Gauss and Legendre).
const vec3 AREA_PLACES[3] = vec3[](vec3(0.5, 0.0, 0.0), vec3(0.21132487, 0.78867513, 0.0), vec3(0.11270167, 0.5, 0.88729833));
const vec3 AREA_SHARES[3] = vec3[](vec3(1.0, 0.0, 0.0), vec3(0.5, 0.5, 0.0), vec3(0.27777778, 0.44444444, 0.27777778));

// The axes of a surface, in which the eye is in the direction `view`, and the normal is z. `stretched` is that
// direction where facets form half a ball. The lobe is from those axes to about a cosine, and `back` its inverse. Pieces
// of edges are shorter by `piece`.
struct AreaSurface { vec3 view, stretched; mat3 frame, lobe, back; float alpha, piece; };

// A light as a surface sees it: its middle and half axes from there, and its radiance toward it. For a tube `across` is
// the side that faces the surface, and `arc` the angle from there to its rim. For a disc `arc` is half of the angle of
// its rim that is above the horizon, which begins at `start` where the horizon cuts it.
struct AreaLight { int kind; vec3 middle, along, across, deep, radiance; float arc, start; bool cut; ivec2 far; };

// The sum over the edges of a polygon above the horizon, z = 0. `entry` and `leave` are where it crosses the horizon,
// and `from` and `to` the ends of the last edge above it.
struct AreaSum { vec3 last, entry, leave, from, to, total; bool enters, leaves; };

// The sum over the pieces of an outline on the cap, as seen from a place `middle` within it; `at` is the place that was
// reached. The sums are those of the area, and of what is reflected at a reflectance of 0 and of 1 straight on.
struct AreaCap { vec3 middle, at, sums; };

// The place on the cap of the direction of `to`.
vec3 area_cap(AreaSurface surface, vec3 to) {
    vec3 facet = surface.view + normalize(to);
    facet = normalize(vec3(facet.xy, surface.alpha * facet.z));
    return 2.0 * dot(facet, surface.stretched) * facet - surface.stretched;
}

// The matrix that turns directions around the middle of the lobe as the cap turns them.
mat3 area_lobe(vec3 view, vec3 stretched, float alpha) {
    vec3 wide = vec3(alpha, alpha, 1.0), facet = normalize(stretched + vec3(0.0, 0.0, 1.0));
    vec3 tilted = normalize(facet * wide), middle = reflect(-view, tilted), along = vec3(middle.z, 0.0, -middle.x);
    float facing = dot(facet, stretched), size = length((view + middle) / wide);
    vec3 turn = along / wide - facet * dot(facet, along / wide);
    float across = 2.0 * (dot(turn, stretched) * facet.x + facing * turn.x) / size;
    return transpose(mat3(along * across, vec3(0.0, 2.0 * facing / (alpha * size), 0.0), AREA_WIDE * middle));
}

// What the integrals need to know of a surface point.
AreaSurface area_surface(vec3 normal, vec3 view, float nv, float alpha) {
    vec3 side = view - normal * dot(normal, view);
    if (dot(side, side) < 1e-10) side = abs(normal.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    side = normalize(side - normal * dot(normal, side));
    AreaSurface surface;
    surface.frame = transpose(mat3(side, cross(normal, side), normal));
    surface.alpha = alpha;
    surface.piece = clamp(AREA_GRAZING * nv, AREA_SHORTEST, 1.0);
    surface.view = vec3(sqrt(1.0 - nv * nv), 0.0, nv);
    surface.stretched = normalize(surface.view * vec3(alpha, alpha, 1.0));
    surface.lobe = area_lobe(surface.view, surface.stretched, alpha);
    surface.back = inverse(surface.lobe);
    return surface;
}

// The light of a row of the table, from a place in the world. Its radiance is 0 where it does not shine.
AreaLight area_light(int row, vec3 place) {
    vec4 origin = areas_at(ivec2(0, row)), glow = areas_at(ivec2(1, row));
    vec4 first_axis = areas_at(ivec2(2, row)), second_axis = areas_at(ivec2(3, row));
    AreaLight lamp;
    lamp.kind = int(glow.w), lamp.middle = origin.xyz - place, lamp.along = first_axis.xyz, lamp.across = second_axis.xyz;
    lamp.deep = vec3(0.0), lamp.arc = PI, lamp.start = 0.0, lamp.cut = false, lamp.far = ivec2(0);
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

// Leaves the part of a disc above the horizon of a surface with this normal: its corners are on the rest of its rim.
void area_cut(inout AreaLight lamp, vec3 normal) {
    vec2 tilt = vec2(dot(lamp.along, normal), dot(lamp.across, normal));
    float up = dot(lamp.middle, normal), size = length(tilt);
    if (up <= -size) lamp.radiance = vec3(0.0);
    if (abs(up) >= size) return;
    lamp.cut = true;
    lamp.arc = acos(-up / size);
    lamp.start = atan(tilt.y, tilt.x) - lamp.arc;
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
    if (from.z <= 0.0) sum.entry = from = crossing, sum.enters = true;
    if (to.z <= 0.0) sum.leave = to = crossing, sum.leaves = true;
    sum.total += area_edge(from, to);
    sum.from = from, sum.to = to;
    return true;
}

// The part of a cosine that the polygon covers, below 0 where its corners go around the other way.
float area_end(AreaSum sum) {
    return sum.total.z + (sum.enters && sum.leaves ? area_edge(sum.leave, sum.entry).z : 0.0);
}

// How many corners the outline of a light has.
int area_corners(AreaLight lamp) {
    return lamp.kind == AREA_RECTANGLE ? 4 : lamp.kind == AREA_DISC ? AREA_RIM + int(lamp.cut) : 2 * AREA_ARC;
}

// A corner of the outline. The corners of a round one lie outside of it, so that both have the same area, unless they are
// to lie `on_arc`.
vec3 area_corner(AreaLight lamp, int corner, bool on_arc) {
    if (lamp.kind == AREA_RECTANGLE) {
        vec2 side = vec2(((corner + 1) & 2) - 1, (corner & 2) - 1);
        return lamp.middle - side.x * lamp.along - side.y * lamp.across;
    }
    bool disc = lamp.kind == AREA_DISC;
    int end = disc ? 0 : corner / AREA_ARC, number = corner - end * AREA_ARC;
    float side = end == 0 ? 1.0 : -1.0, whole = disc ? 2.0 * lamp.arc : lamp.far[end] != 0 ? 2.0 * (lamp.arc - PI) : 2.0 * lamp.arc;
    float edges = float(disc ? AREA_RIM : AREA_ARC - 1), step = whole / edges;
    float turn = disc ? lamp.start + float(number) * step : side * (float(number) * step - lamp.arc);
    bool closed = disc && !lamp.cut;
    float wide = closed ? sqrt(step / sin(step)) : 1.0 + step * step / 12.0 * edges / (edges - 1.0);
    if (on_arc || !closed && (number == 0 || float(number) == edges)) wide = 1.0;
    vec3 middle = disc ? lamp.middle : lamp.middle + side * lamp.along;
    return middle + wide * (cos(turn) * (disc ? lamp.along : lamp.across) + sin(turn) * (disc ? lamp.across : lamp.deep));
}

// Whether a corner and the two after it lie on one arc of a round light.
bool area_is_round(AreaLight lamp, int corner) {
    return lamp.kind == AREA_DISC ? corner + 2 <= AREA_RIM : lamp.kind != AREA_RECTANGLE && corner % AREA_ARC + 2 < AREA_ARC;
}

// The sine and cosine of half of the area of a triangle of directions, which has a sign, times the same number.
vec2 area_triangle(vec3 a, vec3 b, vec3 c) {
    return vec2(dot(a, cross(b - a, c - a)), 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
}

// What a surface reflects of light from a place on the cap, at a reflectance of 0 and of 1 straight on.
vec2 area_reflected(AreaSurface surface, vec3 place) {
    vec3 facet = surface.stretched + place;
    facet = normalize(vec3(surface.alpha * facet.xy, facet.z));
    float vh = dot(facet, surface.view), nv = surface.view.z, nl = 2.0 * vh * facet.z - nv;
    if (nl <= 0.0) return vec2(0.0);
    vec2 c = vec2(nv, nl), square = c * c + surface.alpha * surface.alpha * (1.0 - c * c), far = sqrt(square);
    float lit = nl * (nv + far.x) / (nl * far.x + nv * far.y), x = clamp(1.0 - vh, 0.0, 1.0), x2 = x * x;
    return lit * vec2(x2 * x2 * x, 1.0);
}

// Adds what lies between the middle and a piece of the outline, which goes over a place `by` on to `to`. The piece is a
// parabola, which encloses 4 / 3 of a triangle.
void area_piece(inout AreaCap cap, AreaSurface surface, vec3 by, vec3 to) {
    vec2 whole = area_triangle(cap.middle, cap.at, to), beyond = area_triangle(cap.at, by, to);
    float half_size = atan(whole.x, whole.y) + 4.0 / 3.0 * beyond.x / max(beyond.y, 1e-3);
    cap.at = to;
    float up = dot(by, cap.middle), height = 1.0 - up;
    vec3 away = by - up * cap.middle;
    away *= inversesqrt(max(dot(away, away), 1e-20));
    int last = height < AREA_FLAT ? 0 : height < AREA_ROUND ? 1 : 2;
    vec2 mean = vec2(0.0);
    for (int number = 0; number <= last; ++number) {
        float down = height * AREA_PLACES[last][number];
        vec3 place = (1.0 - down) * cap.middle + sqrt(max(down * (2.0 - down), 0.0)) * away;
        mean += AREA_SHARES[last][number] * area_reflected(surface, place);
    }
    cap.sums += half_size * vec3(1.0, mean);
}

// The cosine of the angle between two directions in the cosine that is about the lobe.
float area_near(AreaSurface surface, vec3 from, vec3 to) {
    vec3 a = surface.lobe * from, b = surface.lobe * to;
    return clamp(dot(a, b) * inversesqrt(dot(a, a) * dot(b, b)), -1.0, 1.0);
}

// The place on a circle that is straight beyond one within it.
vec3 area_onto(vec3 place, vec3 center, float radius) { return center + radius * normalize(place - center); }

// Adds an edge in pieces. With a `radius` it is an arc around `center`: what lies on the edge is moved onto it.
void area_outline(
    inout AreaCap cap, AreaSurface surface, vec3 from, vec3 to, vec3 center, float radius, float longest
) {
    float angle = acos(area_near(surface, from, to)), most = surface.piece * longest;
    float pieces = max(ceil(angle / most), 1.0), step = angle / pieces;
    vec4 ends = vec4(1.0 / length(surface.lobe * from), 1.0 / length(surface.lobe * to), 0.0, 0.0);
    for (float piece = 0.0; piece < pieces; ++piece) {
        vec4 after = step * (piece + vec4(0.5, 0.5, 1.0, 1.0)), turns = vec4(angle, 0.0, angle, 0.0);
        vec4 parts = (pieces > 1.0 ? sin(abs(turns - after)) : vec4(1.0, 1.0, 0.0, 1.0)) * ends.xyxy;
        vec3 by = (parts.x * from + parts.y * to) / (parts.x + parts.y);
        vec3 end = (parts.z * from + parts.w * to) / (parts.z + parts.w);
        if (radius > 0.0) by = area_onto(by, center, radius), end = area_onto(end, center, radius);
        area_piece(cap, surface, area_cap(surface, by), area_cap(surface, end));
    }
}

// A corner in the axes of a surface, of a polygon that has the area of the light; or the place on its arc.
vec3 area_seen(AreaLight lamp, AreaSurface surface, int corner, bool on_arc) {
    int number = corner % area_corners(lamp);
    vec3 seen = surface.frame * area_corner(lamp, number, on_arc);
    if (lamp.cut && number % AREA_RIM == 0) seen.z = 0.0;
    return seen;
}

// The sum over the outline above the horizon, from a direction within it. Arcs go on to every second corner.
vec2 area_mirrored(AreaLight lamp, AreaSurface surface, vec3 within, float longest) {
    int corners = area_corners(lamp);
    AreaSum edges = area_begin(area_seen(lamp, surface, 0, true));
    AreaCap cap = AreaCap(area_cap(surface, within), area_cap(surface, edges.last), vec3(0.0));
    edges.enters = edges.leaves = lamp.cut;
    if (lamp.cut) edges.entry = edges.last, edges.leave = area_seen(lamp, surface, AREA_RIM, true);
    float radius = length(lamp.across);
    for (int number = 0; number < corners;) {
        bool below = edges.last.z <= 0.0, curved = false;
        vec3 from = edges.last, to = area_seen(lamp, surface, number + 1, false), center = vec3(0.0);
        if (area_is_round(lamp, number)) {
            vec3 after = area_seen(lamp, surface, number + 2, true);
            float low = min(from.z, min(area_seen(lamp, surface, number + 1, true).z, after.z));
            curved = lamp.cut || low > 0.0;
            float end = lamp.kind == AREA_DISC ? 0.0 : number < AREA_ARC ? 1.0 : -1.0;
            if (curved) to = after, center = surface.frame * (lamp.middle + end * lamp.along);
        }
        number += curved ? 2 : 1;
        if (curved) edges.last = to;
        else if (area_next(edges, to)) from = edges.from, to = edges.to;
        else continue;
        if (below) cap.at = area_cap(surface, from);
        area_outline(cap, surface, from, to, center, curved ? radius : 0.0, longest);
    }
    if (edges.enters && edges.leaves) {
        cap.at = area_cap(surface, edges.leave);
        area_outline(cap, surface, edges.leave, edges.entry, vec3(0.0), 0.0, AREA_LOW_PIECE);
    }
    return (cap.sums.x < 0.0 ? -1.0 : 1.0) * cap.sums.yz / (PI * (1.0 + surface.stretched.z));
}

// Adds a light: the part of a cosine that it covers, and what is mirrored.
void area_add(AreaLight lamp, AreaSurface surface, vec3 f0, inout vec3 fallen, inout vec3 mirrored) {
    if (lamp.kind == AREA_DISC) area_cut(lamp, transpose(surface.frame)[2]);
    if (lamp.radiance == vec3(0.0)) return;
    int corners = area_corners(lamp);
    AreaSum edges = area_begin(area_seen(lamp, surface, 0, false));
    vec3 within = vec3(0.0);
    for (int number = 1; number <= corners; ++number)
        if (area_next(edges, area_seen(lamp, surface, number, false)))
            within += area_edge(surface.lobe * edges.from, surface.lobe * edges.to);
    if (within == vec3(0.0)) return;
    if (edges.enters && edges.leaves) within += area_edge(surface.lobe * edges.leave, surface.lobe * edges.entry);
    float matte = area_end(edges);
    if (matte == 0.0) return;
    fallen += lamp.radiance * abs(matte);
    float longest = edges.enters && edges.leaves ? AREA_CUT_PIECE : AREA_PIECE;
    vec2 parts = area_mirrored(lamp, surface, surface.back * within * sign(matte), longest);
    mirrored += lamp.radiance * mix(parts.xxx, parts.yyy, f0);
}
