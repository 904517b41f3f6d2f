#include "lib/geometry.glsl"

// Radii are those of the circles of confusion, in pixels of the picture that is drawn. They grow with depth: negative
// in front of the focus, positive behind it. `lens` holds the distance of a blade's middle from the axis, the area,
// both for an aperture of radius 1, and the strength of cat's eye bokeh.

const float depth_of_field_least = 0.5;    // a disc of this radius covers its own pixel only
const float depth_of_field_seam = 0.85;    // share of a level's largest radius at which its crossfade begins
const float depth_of_field_slack = 1.015;  // discs of square pixels do not have exactly the area of discs
// The weight of guessed light, relative to light that is visible. A choice: with half or twice the number, under 1 % of
// the pixels of the preset shallow_focus change by more than 1 / 255.
const float depth_of_field_unseen = 0.05;

// --- circles of confusion ---

float depth_of_field_sharp(vec2 point) {
    return nearness(depth_at(ivec2(clamp(point, 0.0, 1.0) * vec2(depth_size - 1) + 0.5)));
}

float depth_of_field_radius(
    float depth, float mask, float sharp, float scale, float bend, float largest
) {
    float radius = scale * (sharp - nearness(depth)) / max(1.0 - bend * sharp, 1e-3);
    return clamp(clamp(finite(mask), 0.0, 1.0) * radius, -largest, largest);
}

// Beyond its border the picture is mirrored, so that as much light comes in as goes out.
ivec2 depth_of_field_fold(ivec2 at, ivec2 size) {
    at = max(at, -1 - at);
    return min(at, 2 * size - 1 - at);
}

float depth_of_field_coc(float radius) { return 2.0 * radius / proxy; }

// At an antialiased edge a pixel mixes the light of two surfaces. `own` is the mean light of the pixel's own surface
// away from the edge, over `owns` pixels, and `sharp` that of a surface in focus in front of it, over `sharps` pixels.
// True at the edge of a blurred surface in front.
bool depth_of_field_edge(out vec4 own, out float owns, out vec4 sharp, out float sharps) {
    float radii[25], here = radius_at(pixel);
    for (int i = 0; i < 25; ++i) radii[i] = radius_at(pixel + ivec2(i % 5, i / 5) - 2);
    own = sharp = vec4(0.0), owns = sharps = 0.0;
    bool blurred = false;
    for (int i = 0; i < 9; ++i) {
        int at = 5 * (i / 3) + i % 3 + 6;
        vec4 light = finite(image_at(pixel + ivec2(i % 3, i / 3) - 1));
        bool inside = abs(radii[at] - here) < 1.0;
        if (here - radii[at] >= 1.0 && abs(radii[at]) < 1.0) sharp += light, sharps += 1.0;
        for (int side = 0; side < 4; ++side) {
            float other = radii[at + int[4](-5, -1, 1, 5)[side]];
            bool before = here - other >= 1.0;
            blurred = blurred || i == 4 && before && abs(other) >= 1.0;
            inside = inside && !before;
        }
        if (inside) own += light, owns += 1.0;
    }
    own /= max(owns, 1.0), sharp /= max(sharps, 1.0);
    return blurred && owns > 0.0;
}

// Separates the light at the edge of a sharp surface: its share stays in place, or it would spread with the blur
// behind. The rest is clean. At the edge of a blurred surface the pixel takes the light of its own surface, or a line
// around the blurred one would stay.
void depth_of_field_apart(out vec4 stays, out vec4 clean) {
    vec4 own, sharp;
    float owns, sharps;
    bool blurred = depth_of_field_edge(own, owns, sharp, sharps);
    stays = vec4(0.0);
    if (!blurred && owns > 0.0 && sharps > 0.0) {
        vec4 change = sharp - own;
        float size = dot(change, change);
        if (size > 0.0) stays = change * clamp(dot(finite(image_at(pixel)) - own, change) / size, 0.0, 1.0);
    }
    clean = blurred ? own : image_at(pixel) - (is_hole(stays) ? vec4(0.0) : stays);
}

// True if a surface with radius `other` lies in front of one with radius `here`, and is blurred.
bool depth_of_field_hides(float other, float here) { return here - other >= 1.0 && abs(other) >= 1.0; }

// The light that pixels at edges lose goes to the nearer surface beside them: small lamps consist mostly of edges.
// Light that they gain, such as at a lamp behind a dark object, is taken from no other pixel.
vec4 depth_of_field_whole() {
    const ivec2 beside[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
    float here = radius_at(pixel);
    vec4 sum = clean_at(pixel);
    for (int i = 0; i < 4; ++i) {
        ivec2 at = pixel + beside[i];
        float there = radius_at(at), takers = 0.0;
        if (!depth_of_field_hides(here, there)) continue;
        for (int j = 0; j < 4; ++j) takers += float(depth_of_field_hides(radius_at(at + beside[j]), there));
        sum += max(finite(image_at(at)) - kept_at(at) - clean_at(at), 0.0) / takers;
    }
    return sum;
}

// Adds the light that stayed in place. No light becomes negative.
vec4 depth_of_field_with(vec4 seen, vec4 kept) { return max(seen + kept, min(seen, 0.0)); }

// --- levels: large discs are made from smaller pictures ---

float depth_of_field_rise(float radius, float edge) {
    return clamp((abs(radius) / edge - depth_of_field_seam) / (1.0 - depth_of_field_seam), 0.0, 1.0);
}

float depth_of_field_member(float radius, float side, float low, float high) {
    if (radius * side <= 0.0) return 0.0;
    return depth_of_field_rise(radius, low) * (1.0 - depth_of_field_rise(radius, high));
}

// One level of discs on one side of the focus, in blocks of pixels: its light, and in `extents` the part of the block
// that belongs to it, the radius in blocks, and the part that is nearer. Averaging and interpolation blur as well, with
// a variance of 0.354 square blocks along each axis, so discs are drawn smaller and keep their second moment.
void depth_of_field_level(int block, float side, float low, float high, out vec4 light, out vec3 extents) {
    float count = 0.0, sum = 0.0, nearer = 0.0, whole = float(block * block);
    light = vec4(0.0);
    for (int y = 0; y < block; ++y)
        for (int x = 0; x < block; ++x) {
            ivec2 at = block * pixel + ivec2(x, y);
            float radius = radius_at(at), part = depth_of_field_member(radius, side, low, high);
            light += part * image_at(at);
            count += part;
            sum += part * abs(radius);
            nearer += radius * side <= 0.0 ? 1.0 : 1.0 - depth_of_field_rise(radius, low);
        }
    light /= whole;
    extents = vec3(0.0, 0.0, nearer / whole);
    if (count == 0.0) return;
    float radius = sum / count / float(block);
    float squared = radius * radius + 1.0 / (3.0 * whole) - 4.0 * 0.354;
    extents.xy = vec2(count / whole, sqrt(max(squared, depth_of_field_least * depth_of_field_least)));
}

// --- tiles: the search radius ---

float depth_of_field_most_sharp(int tile, float sharpest) {
    float most = 0.0;
    for (int y = 0; y < tile; ++y)
        for (int x = 0; x < tile; ++x) {
            float radius = abs(radius_at(tile * pixel + ivec2(x, y)));
            most = max(most, radius < sharpest ? radius : 0.0);
        }
    return most;
}

float depth_of_field_most(int tile) {
    float most = 0.0;
    for (int y = 0; y < tile; ++y)
        for (int x = 0; x < tile; ++x) most = max(most, extents_at(tile * pixel + ivec2(x, y)).y);
    return most;
}

float depth_of_field_reach() {
    float most = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) most = max(most, most_at(pixel + ivec2(x, y)));
    return most;
}

// --- the shape of bokeh ---

vec4 depth_of_field_nothing() { return vec4(0.0); }

// The radius of the aperture at which its edge reaches an offset. The corners of a polygon lie on the circle.
float depth_of_field_blades(int middle, int blades, float roundness, float rotation, vec2 stretch) {
    vec2 away = vec2(pixel - middle) * stretch;
    float reached = -1e9;
    for (int i = 0; i < blades; ++i) {
        float angle = rotation + radians(360.0) * (float(i) + 0.5) / float(blades);
        reached = max(reached, dot(away, vec2(cos(angle), -sin(angle))));
    }
    return mix(reached, length(away), roundness);
}

// How the lens barrel cuts the aperture at a place in the picture: the opening is the intersection of two discs at this
// distance (cat's eye).
vec2 depth_of_field_eye(vec3 lens, ivec2 at) {
    vec2 size = vec2(extent);
    return lens.z * (2.0 * vec2(at) + 1.0 - size) / length(size);
}

// The area of a disc of radius 1 at this pixel; and that of a disc of any radius with its soft rim.
float depth_of_field_unit(vec3 lens) {
    float apart = min(length(depth_of_field_eye(lens, pixel)), 1.99);  // at 2 nothing would be left of the disc
    return lens.y * (2.0 * acos(0.5 * apart) - 0.5 * apart * sqrt(4.0 - apart * apart)) / radians(180.0);
}

float depth_of_field_area(float unit, float radius) { return unit * (radius * radius + 1.0 / 12.0); }

// How far a pixel, `away` from the center of a disc, lies inside it; negative outside. In front of the focus the
// aperture appears upside down.
float depth_of_field_inside(int aperture, vec3 lens, vec2 stretch, vec2 eye, ivec2 away, float radius) {
    vec2 offset = vec2(away) * stretch;
    float size = abs(radius), cut = size * (0.25 * size * dot(eye, eye) + abs(dot(offset, eye)));
    float inside = size - sqrt(dot(offset, offset) + cut);
    if (aperture == APERTURE_ROUND) return inside;
    return min(size * lens.x - shape_at((radius < 0.0 ? -away : away) + shape_size / 2), inside);
}

float depth_of_field_cover(float inside) { return clamp(inside + 0.5, 0.0, 1.0); }

// Half the width of a disc in one row of pixels.
int depth_of_field_chord(float reach, int row) {
    float outer = reach + 0.5;
    return int(sqrt(max(outer * outer - float(row * row), 0.0)));
}

// --- discs in smaller pictures ---

// The light that discs scatter over a block, and the part of the block that they cover. Behind the focus, smaller discs
// are nearer; the parts of a surface that they hide are assumed to look like its visible parts.
float depth_of_field_scattered(int tile, int aperture, vec3 lens, vec2 stretch, float side, out vec4 sum) {
    vec4 front = vec4(0.0), back = vec4(0.0);
    float fronts = 0.0, backs = 0.0, hidden = 0.0, reach = reach_at(pixel / tile), here = extents_at(pixel).y;
    sum = vec4(0.0);
    if (reach == 0.0) return 0.0;
    float unit = depth_of_field_unit(lens), whole = depth_of_field_area(unit, reach);
    for (int y = -int(reach + 0.5); y <= int(reach + 0.5); ++y) {
        int chord = depth_of_field_chord(reach, y);
        for (int x = -chord; x <= chord; ++x) {
            ivec2 at = depth_of_field_fold(pixel + ivec2(x, y), extent);
            vec3 extents = extents_at(at);
            float radius = max(extents.y, depth_of_field_least);
            vec2 eye = depth_of_field_eye(lens, at);
            float inside = depth_of_field_inside(aperture, lens, stretch, eye, -ivec2(x, y), side * radius);
            float weight = depth_of_field_cover(inside) / depth_of_field_area(unit, radius);
            float before = side > 0.0 && extents.y > 0.0 ? clamp(2.0 * (here - radius) - 0.5, 0.0, 1.0) : 0.0;
            vec4 light = weight * own_at(at);
            front += before * light;
            back += (1.0 - before) * light;
            fronts += before * weight * extents.x;
            backs += (1.0 - before) * weight * extents.x;
            float share = depth_of_field_cover(inside + (reach - radius) * lens.x) / whole;
            hidden += share * (extents.z + before * extents.x);
        }
    }
    sum = front + back;
    if (side < 0.0 || fronts + backs == 0.0) return fronts + backs;
    float nearer = min(fronts, 1.0), rest = (1.0 - nearer) * min(backs / max(1.0 - hidden, 1e-3), 1.0);
    sum = vec4(0.0);
    if (fronts > 0.0) sum += front * (nearer / fronts);
    if (backs > 0.0) sum += back * (rest / backs);
    return nearer + rest;
}

// Combines levels in front of the focus: larger discs are nearer and cover first; smaller ones fill up what is left. No
// pixel is covered more than once.
void depth_of_field_near(
    int tile, float finest, int aperture, vec3 lens, vec2 stretch, out vec4 light, out float covers
) {
    vec4 sum;
    float covered = depth_of_field_scattered(tile, aperture, lens, stretch, -1.0, sum);
    vec2 at = (vec2(pixel) + 0.5) / 2.0;
    float before = cover_near(at), part = min(depth_of_field_slack * covered, 1.0 - before);
    light = light_near(at) + (covered > 0.0 ? sum * (part / covered) : vec4(0.0));
    covers = min(before + depth_of_field_slack * covered, 1.0);
}

// Combines levels behind the focus: there the larger discs are farther away.
void depth_of_field_far(
    int tile, float finest, int aperture, vec3 lens, vec2 stretch, out vec4 light, out float covers
) {
    vec4 sum;
    float covered = depth_of_field_scattered(tile, aperture, lens, stretch, 1.0, sum);
    vec2 at = (vec2(pixel) + 0.5) / 2.0;
    float part = min(depth_of_field_slack * covered, 1.0), more = cover_near(at);
    vec4 own = covered > 0.0 ? sum * (part / covered) : vec4(0.0);
    light = own + (more > 0.0 ? light_near(at) * (min(more, 1.0 - part) / more) : vec4(0.0));
    covers = min(more + depth_of_field_slack * covered, 1.0);
}

// --- what nearer surfaces hide ---

float depth_of_field_kept(float radius, float finest) {
    return radius < 0.0 ? 1.0 - depth_of_field_rise(radius, finest) : 1.0;
}

void depth_of_field_kept_light(int block, float finest, out vec4 light, out float weight) {
    light = vec4(0.0);
    weight = 0.0;
    for (int y = 0; y < block; ++y)
        for (int x = 0; x < block; ++x) {
            ivec2 at = block * pixel + ivec2(x, y);
            float part = depth_of_field_kept(radius_at(at), finest);
            light += part * image_at(at);
            weight += part;
        }
    light /= float(block * block);
    weight /= float(block * block);
}

// Guesses what is hidden: a mean of visible pixels, weighted by nearness; where they are too far away, the picture
// itself.
vec4 depth_of_field_rest(int reach, float block) {
    float here = weight_at(pixel);
    if (here == 1.0) return light_at(pixel);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            float away = float(x * x + y * y) + 0.25, nearby = 1.0 / (away * away);
            total += nearby * weight_at(pixel + ivec2(x, y));
            sum += nearby * light_at(pixel + ivec2(x, y));
        }
    return total > 0.0 ? sum / total : image_near((vec2(pixel) + 0.5) * block);
}

// --- the picture ---

// The light that small discs scatter over a pixel: from surfaces in front, from its own surface, and from behind, with
// the sums of weights. `shares` is the part of the pixel's own disc that is taken by its own surface, by surfaces
// behind with small discs, and by those with large discs: beyond the end of a surface, so much of the background shows.
void depth_of_field_gathered(
    int tile, float finest, int aperture, vec3 lens, vec2 stretch, float reach, out vec4 front, out vec4 same,
    out vec4 behind, out vec3 weights, out vec3 shares
) {
    front = same = behind = vec4(0.0);
    weights = shares = vec3(0.0);
    float here = radius_at(pixel), own = max(abs(here), depth_of_field_least), unit = depth_of_field_unit(lens);
    float mine = abs(here) < finest ? 1.0 / depth_of_field_area(unit, own) : 0.0;
    for (int y = -int(reach + 0.5); y <= int(reach + 0.5); ++y) {
        int chord = depth_of_field_chord(reach, y);
        for (int x = -chord; x <= chord; ++x) {
            ivec2 at = depth_of_field_fold(pixel + ivec2(x, y), extent);
            float there = radius_at(at), size = max(abs(there), depth_of_field_least);
            float before = clamp(2.0 * (here - there) - 0.5, 0.0, 1.0);
            float after = clamp(2.0 * (there - here) - 0.5, 0.0, 1.0), level = 1.0 - before - after;
            float member = 1.0 - depth_of_field_rise(there, finest);
            vec2 eye = depth_of_field_eye(lens, at);
            float signed_size = there < 0.0 ? -size : size;
            float inside = depth_of_field_inside(aperture, lens, stretch, eye, -ivec2(x, y), signed_size);
            float weight = member * depth_of_field_cover(inside) / depth_of_field_area(unit, size);
            float share = mine * depth_of_field_cover(inside + (own - size) * lens.x);
            float guessed = weight + depth_of_field_unseen * member * share;
            vec4 light = image_at(at);
            front += before * weight * light;
            same += level * weight * light;
            behind += after * guessed * light;
            weights += vec3(before * weight, level * weight, after * guessed);
            shares += share * vec3(level, after * member, after * (1.0 - member));
        }
    }
}

// All discs at full size, for small radii.
vec4 depth_of_field_alone(int tile, float finest, int aperture, vec3 lens, vec2 stretch) {
    float reach = reach_at(pixel / tile);
    if (reach <= depth_of_field_least) return image_at(pixel) + kept_at(pixel);
    vec4 front, same, behind;
    vec3 weights, shares;
    depth_of_field_gathered(
        tile, 4.0 * finest, aperture, lens, stretch, reach, front, same, behind, weights, shares
    );
    vec4 seen = shares.x * same / weights.y;
    if (shares.y > 0.0) seen = (seen + behind * (shares.y / weights.z)) / (shares.x + shares.y);
    else seen /= shares.x;
    seen = depth_of_field_with(seen, kept_at(pixel));
    return weights.x > 0.0 ? mix(seen, front / weights.x, min(weights.x, 1.0)) : seen;
}

vec4 depth_of_field(int tile, float finest, int aperture, vec3 lens, vec2 stretch, float coarsest) {
    vec2 middle = vec2(pixel) + 0.5, at = middle / 2.0;
    float reach = reach_at(pixel / tile), here = radius_at(pixel), hides = hidden_near(at);
    float layered = depth_of_field_rise(here, finest);
    if (reach <= depth_of_field_least && hides == 0.0 && layered == 0.0) return image_at(pixel) + kept_at(pixel);
    vec4 front, same, behind, backdrop = far_near(at);
    vec3 weights, shares;
    depth_of_field_gathered(tile, finest, aperture, lens, stretch, reach, front, same, behind, weights, shares);
    float fills = filled_near(at);
    vec4 beyond = fills > 0.0 ? backdrop / fills : vec4(0.0);

    // A pixel with a small disc: its surface, and the background where that is visible.
    vec4 small = vec4(0.0), large = vec4(0.0);
    if (layered < 1.0) {
        float far = fills > 0.0 ? shares.z : 0.0;
        small = shares.x * same / weights.y + far * beyond;
        if (shares.y > 0.0) small += behind * (shares.y / weights.z);
        small /= shares.x + shares.y + far;
    }
    // A pixel with a large disc, which is in a level: everything else. Behind a near surface some light is guessed.
    if (layered > 0.0) {
        float guessed = here < 0.0 ? depth_of_field_unseen : 0.0;
        float total = weights.y + weights.z + fills + guessed;
        large = same + behind + backdrop + guessed * rest_near(middle / coarsest);
        large = total > 0.0 ? large / total : image_at(pixel);
    }
    vec4 seen = depth_of_field_with(mix(small, large, layered), kept_at(pixel));
    if (weights.x > 0.0) seen = mix(seen, front / weights.x, min(weights.x, 1.0));
    return near_near(at) + (1.0 - hides) * seen;
}
