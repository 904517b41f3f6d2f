#include "lib/contour.glsl"
#include "lib/coverage.glsl"
#include "lib/geometry.glsl"
#include "lib/seam.glsl"

// The angle between two unit vectors, exact for small angles too (Kahan 2006). Between a surface and the background it
// is 180 degrees.
float geometry_edges_angle(vec3 a, vec3 b) {
    if (a == b) return 0.0;
    return a == vec3(0.0) || b == vec3(0.0) ? radians(180.0) : 2.0 * atan(length(a - b), length(a + b));
}

// The second difference of 1 / depth, relative to the largest of the three. It is 0 on a plane.
float geometry_edges_bend(float before, float here, float after) {
    float most = max(here, max(before, after));
    return most > 0.0 ? abs(before - 2.0 * here + after) / most : 0.0;
}

// The larger of the second differences along the row and the column, except at the border of the picture.
float geometry_edges_bends() {
    float near = nearness(depth_at(pixel)), most = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 along = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), before = pixel - along, after = pixel + along;
        if (pixel[axis] > 0 && pixel[axis] < extent[axis] - 1)
            most = max(most, geometry_edges_bend(nearness(depth_at(before)), near, nearness(depth_at(after))));
    }
    return most;
}

// The gap in depth, the fold in radians, and 1 where ids differ, the largest of rows and columns. At the border of the
// picture depth is not compared.
vec3 geometry_edges_found() {
    float id = ids_at(pixel);
    vec3 normal = unit_normal(normal_at(pixel)), differences = vec3(geometry_edges_bends(), 0.0, 0.0);
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 along = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), before = pixel - along, after = pixel + along;
        differences.y = max(differences.y, geometry_edges_angle(unit_normal(normal_at(before)), normal));
        differences.y = max(differences.y, geometry_edges_angle(unit_normal(normal_at(after)), normal));
        if (ids_at(before) != id || ids_at(after) != id) differences.z = 1.0;
    }
    return differences;
}

float geometry_edges_gap(vec3 differences) { return differences.x; }

float geometry_edges_crease(vec3 differences) { return degrees(differences.y); }

float geometry_edges_border(vec3 differences) { return differences.z; }

float geometry_edges_strength(float difference, float threshold, float softness) {
    return difference > threshold ? clamp((difference - threshold) / max(threshold * softness, 1e-9), 0.0, 1.0) : 0.0;
}

// The strongest line by depth, normals and ids.
float geometry_edges_strongest(vec3 differences, vec3 amounts, float gap, float crease, float softness) {
    float depth = geometry_edges_strength(differences.x, gap, softness);
    float normal = geometry_edges_strength(differences.y, crease, softness);
    vec3 strength = amounts * vec3(depth, normal, differences.z);
    return max(max(strength.x, strength.y), strength.z);
}

// How near the surface of a pixel is, or 1 where only its normal says that there is one.
float geometry_edges_near(float depth, vec3 normal, bool deep) {
    return deep ? nearness(depth) : float(length(normal) > COVERAGE_NOTHING);
}

// The surfaces of a pixel, where its normal differs from one beside it by half the angle of a line. A loop of one round
// or none: see coverage_found().
vec3 geometry_edges_coverage(float crease) {
    float least = cos(0.5 * crease), alike = 1.0;
    vec3 here = normal_at(pixel), shares = vec3(1.0, 0.0, 0.0);
    for (int side = 0; side < 4; ++side) {
        ivec2 along = (side & 1) == 0 ? ivec2(1, 0) : ivec2(0, 1);
        vec3 there = normal_at((side & 2) == 0 ? pixel + along : pixel - along);
        alike = min(alike, dot(here, there) - least * sqrt(dot(here, here) * dot(there, there)));
    }
    for (int rounds = alike < 1e-6 ? 1 : 0; rounds > 0; --rounds) shares = coverage_found();
    return shares;
}

// The normal of the surface in the middle of a pixel. A filtered normal between two flat surfaces belongs to neither, and
// would be an edge on both of its sides. On a curved surface it is no mean of those beside it: it would be shorter.
vec3 geometry_edges_pure(bool deep) {
    const float misfit = 0.05;
    vec3 mean = normal_at(pixel);
    if (deep && near_at(pixel) <= 0.0) return vec3(0.0);
    Coverage shares = coverage_of(coverage_at(pixel));
    if (!coverage_is_sure(shares)) return mean;
    vec3 front_normal = coverage_normal(shares.front), back_normal = coverage_normal(shares.back);
    float front_share = coverage_share(mean, back_normal);  // of flat surfaces, whose normals are those beside it
    if (back_normal != vec3(0.0) && length(mean - mix(back_normal, front_normal, front_share)) > misfit) return mean;
    vec2 apart = abs(near_at(pixel) - vec2(near_at(shares.front), near_at(shares.back)));
    bool front = deep && apart.x != apart.y ? apart.x < apart.y : front_share > 0.5;
    return front ? front_normal : back_normal;
}

// How strong the seam between a pixel and the next one is. Depth bends on both sides of a step.
float geometry_edges_seam(ivec2 at, int axis, vec3 amounts, float gap, float crease, float softness) {
    ivec2 along = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), after = at + along;
    if (at[axis] < 0 || after[axis] >= extent[axis]) return 0.0;
    vec3 differences = vec3(0.0, geometry_edges_angle(unit_normal(normal_at(at)), unit_normal(normal_at(after))), ids_at(at) != ids_at(after));
    float here = nearness(depth_at(at)), there = nearness(depth_at(after));
    float bend = 1e9;
    if (at[axis] > 0) bend = geometry_edges_bend(nearness(depth_at(at - along)), here, there);
    if (after[axis] < extent[axis] - 1)
        bend = min(bend, geometry_edges_bend(here, there, nearness(depth_at(after + along))));
    differences.x = bend < 1e9 ? bend : 0.0;
    return geometry_edges_strongest(differences, amounts, gap, crease, softness);
}

// The seams to the right and below, and how strong a fold in depth is that runs through the middle of the pixel.
vec3 geometry_edges_seams(vec3 amounts, float gap, float crease, float softness) {
    float right = geometry_edges_seam(pixel, 0, amounts, gap, crease, softness);
    float below = geometry_edges_seam(pixel, 1, amounts, gap, crease, softness);
    vec3 fold = vec3(geometry_edges_bends(), 0.0, 0.0);
    return vec3(right, below, geometry_edges_strongest(fold, amounts, gap, crease, softness));
}

vec3 geometry_edges_right() { return seam_rounds(0); }

vec3 geometry_edges_below() { return seam_rounds(1); }

// The seams without the steps of staircases, and folds where there is no seam.
vec3 geometry_edges_runs() {
    vec3 seams = seams_at(pixel), runs = seam_runs();
    bool alone = max(seams.x, seams.y) + seams_at(pixel - ivec2(1, 0)).x + seams_at(pixel - ivec2(0, 1)).y <= 0.0;
    return vec3(runs.xy, alone ? seams.z : 0.0);
}

// How much of a pixel the lines of the seams near a place cover, from `first` pixels before it to one behind it. Seams
// are listed as bits first: a software rasterizer runs what follows only as often as a pixel has seams.
float geometry_edges_near_by(ivec2 around, int first, float width, bool hard) {
    const int side = 4;
    vec2 place = vec2(pixel) + 0.5;
    uint listed = 0u;
    float cover = 0.0;
    for (int y = first; y < 2; ++y)
        for (int x = first; x < 2; ++x) {
            vec3 seams = runs_at(around + ivec2(x, y));
            if (hard) seams = vec3(greaterThanEqual(seams, vec3(0.5)));
            uint number = uint(2 * (side * (y - first) + x - first));
            listed |= (uint(seams.x > 0.0) + 2u * uint(seams.y > 0.0)) << number;
            float band = clamp(0.5 * width + 0.5 - length(vec2(pixel - around) - vec2(x, y)), 0.0, min(width, 1.0));
            cover = max(cover, seams.z * band);
        }
    while (listed != 0u) {
        uint lowest = listed & (~listed + 1u);
        int number = int(log2(float(lowest)) + 0.5), axis = number & 1, cell = number >> 1;
        listed ^= lowest;
        ivec2 at = around + first + ivec2(cell & (side - 1), cell / side);
        vec2 line = (axis == 0 ? right_at(at) : below_at(at)).xy;
        cover = max(cover, (hard ? 1.0 : runs_at(at)[axis]) * seam_cover(place, at, axis, line, width));
    }
    return cover;
}

float geometry_edges(float width) { return geometry_edges_near_by(pixel, -2, width, false); }

vec2 geometry_edges_seeds(vec3 runs) {
    return contour_seeds(max(max(runs.x, runs.y), runs.z), float(pixel.y));
}

vec2 geometry_edges_columns(int reach) { return contour_columns(seeds_at(pixel), reach); }

// How much of a pixel wide lines cover: by the lines around the nearest pixel with a seam.
float geometry_edges_wide(float width, int reach) {
    ivec2 seed = contour_nearest(pixel, reach);
    float cover = 0.0;
    for (int rounds = seed.x >= 0 ? 1 : 0; rounds > 0; --rounds) cover = geometry_edges_near_by(seed, -1, width, true);
    return cover;
}
