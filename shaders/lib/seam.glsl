// The line behind a staircase of pixels, in passes that read `seams`: how strong the seam to the right of a pixel is (x),
// and the one below it (y). 0 is no seam.
//
// Ids and depth are not filtered: they are those of the middle of a pixel, so a contour is a staircase of seams between
// pixels. A seam is followed to both sides, at most one pixel up or down for each pixel along, which gives the height of
// the contour along an axis. The true contour is within half a pixel of all of them. A parabola through them, over the
// longest way on which it stays that near, finds the true height: within 0.1 of a pixel (RMS) for straight lines and
// circles of 12 pixels and more, where the staircase itself is off by 0.29.

const int SEAM_REACH = 12;      // pixels: how far a contour is followed to each side
const int SEAM_WINDOWS = 3;     // so many are tried, the longest first
const int SEAM_SHORTER = 4;     // pixels: windows reach 12, 8 and 4 pixels to each side
const int SEAM_SHORTEST = 4;    // pixels: what is shorter may be noise, and stays where it is
const float SEAM_MISFIT = 0.8;  // pixels: 0.5, and the error of the parabola itself
const float SEAM_MINOR = 3.0;   // steps of a staircase are so much shorter than its run

// Where the contour goes on beside a seam, or 2 where it ends or forks: 0 straight on, or one pixel to either side.
int seam_step(ivec2 at, ivec2 across, int axis) {
    bvec3 goes = bvec3(seams_at(at - across)[axis] > 0.0, seams_at(at)[axis] > 0.0, seams_at(at + across)[axis] > 0.0);
    ivec3 ways = ivec3(goes);
    return ways.x + ways.y + ways.z == 1 ? ways.z - ways.x : 2;
}

// The parabola through heights from `first` to `last`: its height and slope at 0. A line where one side is short.
vec2 seam_parabola(const float heights[2 * SEAM_REACH + 1], int first, int last, int reach) {
    mat3 squares = mat3(0.0);
    vec3 sums = vec3(0.0);
    for (int i = first; i <= last; ++i) {
        float x = float(i), part = x / float(reach + 1), weight = 1.0 - part * part;
        vec3 powers = vec3(1.0, x, x * x);
        squares += weight * outerProduct(powers, powers);
        sums += weight * heights[i + SEAM_REACH] * powers;
    }
    if (last < 2 || first > -2) squares[2] = vec3(0.0, 0.0, 1.0), squares[0].z = squares[1].z = sums.z = 0.0;
    vec3 fit = inverse(squares) * sums;
    for (int i = first; i <= last; ++i) {
        float x = float(i);
        if (abs(fit.x + x * (fit.y + x * fit.z) - heights[i + SEAM_REACH]) > SEAM_MISFIT) return vec2(1e9, 0.0);
    }
    return fit.xy;
}

// How far from the seam the contour lies, toward larger coordinates, its slope there, and how far it was followed.
vec3 seam_line(ivec2 at, int axis) {
    ivec2 along = axis == 0 ? ivec2(0, 1) : ivec2(1, 0), across = 1 - along;
    float heights[2 * SEAM_REACH + 1];
    heights[SEAM_REACH] = 0.0;
    ivec2 ends = ivec2(0);
    for (int side = 0; side < 2; ++side) {
        int way = 2 * side - 1, height = 0;
        for (int i = 1; i <= SEAM_REACH; ++i) {
            int next = seam_step(at + way * i * along + height * across, across, axis);
            if (next == 2) break;
            height += next, ends[side] = i;
            heights[way * i + SEAM_REACH] = float(height);
        }
    }
    if (ends.x + ends.y < SEAM_SHORTEST) return vec3(0.0, 0.0, ends.x + ends.y);
    vec2 fit = vec2(0.0);
    for (int window = 0; window < SEAM_WINDOWS; ++window) {
        int reach = SEAM_REACH - window * SEAM_SHORTER;
        fit = seam_parabola(heights, max(-ends.x, -reach), min(ends.y, reach), reach);
        if (fit.x < 1e8) break;
    }
    if (fit.x > 1e8) fit = vec2(0.0);
    return vec3(clamp(fit.x, -0.5, 0.5), clamp(fit.y, -1.0, 1.0), ends.x + ends.y);
}

// True for a seam that is a step of a staircase whose run beside it was followed much farther.
bool seam_is_step(ivec2 at, int axis, float followed) {
    ivec2 along = axis == 0 ? ivec2(0, 1) : ivec2(1, 0), across = 1 - along;
    float run = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 beside = at + ((corner & 1) == 0 ? ivec2(0) : across) - ((corner & 2) == 0 ? ivec2(0) : along);
        run = max(run, axis == 0 ? below_at(beside).z : right_at(beside).z);
    }
    return run >= float(SEAM_SHORTEST) && SEAM_MINOR * followed < run;
}

// The seams of this pixel without the steps of staircases.
vec3 seam_runs() {
    vec3 seams = seams_at(pixel);
    for (int rounds = max(seams.x, seams.y) > 0.0 ? 1 : 0; rounds > 0; --rounds) {
        if (seam_is_step(pixel, 0, right_at(pixel).z)) seams.x = 0.0;
        if (seam_is_step(pixel, 1, below_at(pixel).z)) seams.y = 0.0;
    }
    return seams;
}

// The area of a pixel on one side of a line with the unit normal `across`, `away` from the middle of the pixel.
float seam_area(float away, vec2 across) {
    const float upright = 0.01;  // below this sine the line counts as upright: the area is off by 0.0012 at most
    vec2 sides = vec2(max(across.x, across.y), min(across.x, across.y));
    if (sides.y < upright) return clamp(away + 0.5, 0.0, 1.0);
    vec4 corners = 0.5 * vec4(sides.x + sides.y, sides.x - sides.y, sides.y - sides.x, -sides.x - sides.y);
    vec4 parts = max(away + corners, 0.0);
    parts *= 0.5 * parts / (sides.x * sides.y);
    return clamp(parts.x - parts.y - parts.z + parts.w, 0.0, 1.0);
}

// How much of a pixel a band covers whose middle is `away` from that of the pixel. `across` is its unit normal.
float seam_band(float away, vec2 across, float width) {
    return max(seam_area(0.5 * width - away, across) - seam_area(-0.5 * width - away, across), 0.0);
}

// How much of a pixel a band around the piece of contour beside a seam covers.
float seam_cover(vec2 place, ivec2 at, int axis, vec2 line, float width) {
    vec2 middle = vec2(at) + 0.5, along = axis == 0 ? vec2(line.y, 1.0) : vec2(1.0, line.y);
    middle[axis] += 0.5 + line.x;
    vec2 from = place - middle, across = abs(along.yx) * inversesqrt(dot(along, along));
    return seam_band(length(from - along * clamp(dot(from, along) / dot(along, along), -0.5, 0.5)), across, width);
}

// The line of the seam to the right of this pixel, or below it. A loop of one round or none: see coverage_found().
vec3 seam_rounds(int axis) {
    vec3 line = vec3(0.0);
    for (int rounds = seams_at(pixel)[axis] > 0.0 ? 1 : 0; rounds > 0; --rounds) line = seam_line(pixel, axis);
    return line;
}

// The part of this pixel on its own side of the contours beside it, in passes that read `runs`, the seams without steps;
// and the pixel on the other side.
float seam_share(out ivec2 beyond) {
    float share = 1.0;
    beyond = pixel;
    for (int side = 0; side < 4; ++side) {
        int axis = side & 1, before = side >> 1;
        ivec2 across = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), at = pixel - before * across;
        if (runs_at(at)[axis] <= 0.0) continue;
        vec2 line = (axis == 0 ? right_at(at) : below_at(at)).xy;
        float away = 0.5 + (before == 0 ? line.x : -line.x), upright = inversesqrt(1.0 + line.y * line.y);
        float part = seam_area(away * upright, vec2(1.0, abs(line.y)) * upright);
        if (part < share) share = part, beyond = before == 0 ? at + across : at;
    }
    return share;
}
