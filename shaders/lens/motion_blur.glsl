#include "lib/blue_noise.glsl"
#include "lib/geometry.glsl"

// A path holds in xy the motion from the previous frame to this one, in zw from this one to the next, in pixels. Time 0
// is this frame; `times` are when the shutter opens and closes.

const float motion_blur_still = 1e-3;  // pixels: shorter paths count as no motion
const float motion_blur_apart = 50.0;  // nearer by 1 / 100: in front. 25 or 100 changes 0.1 % of moving_ball

// The position at a time, on the parabola through the positions in three frames.
vec2 motion_blur_place(vec4 path, float time) {
    return 0.5 * time * (path.xy + path.zw + time * (path.zw - path.xy));
}

// The length of the path while the shutter is open.
float motion_blur_length(vec4 path, vec2 times) {
    return length(motion_blur_place(path, times.x)) + length(motion_blur_place(path, times.y));
}

// --- antialiased edges ---

// At an antialiased edge a pixel shows two surfaces, and counts as a part of the nearer one. A `layer` is the nearness
// (1 / depth) of that surface, and how much of the pixel it covers: negative at edges, 1 everywhere else.

// The nearness of the two surfaces at an edge; 0 where there is no edge. Nearness is linear on a plane; beside an edge
// its step on one side is far larger than on the other.
vec2 motion_blur_edge(float here) {
    const float steeper = 4.0;
    float jump = 0.0;
    vec2 bounds = vec2(here);
    for (int axis = 0; axis < 4; ++axis) {
        ivec2 next = axis < 2 ? ivec2(1 - axis, axis) : ivec2(1, 2 * axis - 5);
        vec2 beside = vec2(nearness(depth_at(pixel - next)), nearness(depth_at(pixel + next)));
        vec2 steps = abs(beside - here);
        bounds = vec2(max(bounds.x, max(beside.x, beside.y)), min(bounds.y, min(beside.x, beside.y)));
        float most = max(steps.x, steps.y);
        if (most > steeper * min(steps.x, steps.y)) jump = max(jump, most);
    }
    return jump > 0.0 && motion_blur_apart * jump > here ? bounds : vec2(0.0);
}

ivec2 motion_blur_beside(int i) { return ivec2(i % 5, i / 5) - 2; }

// The weight of one of the 5 x 5 pixels around: nearer pixels are more alike.
float motion_blur_nearby(int i) {
    ivec2 away = motion_blur_beside(i);
    float square = float(away.x * away.x + away.y * away.y);
    return 1.0 / max(square * square, 1.0);
}

// The pixels of a 5 x 5 set of bits whose four neighbors are in the set too; pixels outside of the 5 x 5 count as
// members.
uint motion_blur_inside(uint side) {
    uint across = (side << 1 | 0x0108421u) & (side >> 1 | 0x1084210u);
    uint down = (side << 5 | 0x000001fu) & (side >> 5 | 0x1f00000u);
    return side & across & down & ~(1u << 12);
}

// The pixels of 5 x 5 inside the nearer and the farther surface of an edge, without those at the edge; none where there
// is no edge.
uvec2 motion_blur_sides(vec2 bounds) {
    uint front = 0u;
    int count = bounds.x > 0.0 ? 25 : 0;
    for (int i = 0; i < count; ++i)
        if (2.0 * nearness(depth_at(pixel + motion_blur_beside(i))) > bounds.x + bounds.y) front |= 1u << i;
    return count > 0 ? uvec2(motion_blur_inside(front), motion_blur_inside(~front & 0x1ffffffu)) : uvec2(0u);
}

// The mean velocity of the pixels whose bits are set.
vec4 motion_blur_motion(uint side) {
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (; side != 0u; side &= side - 1u) {
        int i = findLSB(side);
        vec4 velocity = velocity_at(pixel + motion_blur_beside(i));
        if (!is_finite(velocity)) continue;
        sum += motion_blur_nearby(i) * velocity;
        total += motion_blur_nearby(i);
    }
    return total > 0.0 ? sum / total : velocity_at(pixel);
}

// The coverage from color; -1 where the color is not on the line between those of the two surfaces.
float motion_blur_cover(uvec2 sides) {
    const float astray = 0.02;  // of the squared contrast, as for the textures of a surface
    mat2x4 sum = mat2x4(0.0);
    vec2 total = vec2(1e-9);
    for (int i = 0; i < (sides.x == 0u ? 0 : 25); ++i) {
        vec2 weight = motion_blur_nearby(i) * vec2(sides >> uint(i) & 1u);
        sum += outerProduct(finite(image_at(pixel + motion_blur_beside(i))), weight), total += weight;
    }
    vec4 back = sum[1] / total.y, apart = sum[0] / total.x - back, here = finite(image_at(pixel)) - back;
    float square = dot(apart, apart), cover = dot(here, apart) / max(square, 1e-9);
    vec4 off = here - cover * apart;
    return square > 0.0 && dot(off, off) < astray * square ? clamp(cover, 0.0, 1.0) : -1.0;
}

// Finds the coverage from the velocity, if the renderer filters velocity like color: velocity varies less over a
// surface than color does. Cycles leaves the background out of the mean, so before the background color tells it.
vec2 motion_blur_layer() {
    const float slow = 0.5, hardly = 0.01;  // least difference of motion, in pixels; least coverage
    float here = nearness(depth_at(pixel)), cover = 0.0;
    vec2 bounds = motion_blur_edge(here);
    uvec2 sides = motion_blur_sides(bounds);
    if (sides.x == 0u || sides.y == 0u) sides = uvec2(0u);
    vec4 back = motion_blur_motion(sides.y), apart = motion_blur_motion(sides.x) - back;
    float square = dot(apart, apart);
    if (square > slow * slow) cover = dot(velocity_at(pixel) - back, apart) / square;
    bool open = bounds.x > 0.0 && bounds.y <= 0.0 && sides.x != 0u;
    if (open && cover >= 1.0 - hardly) cover = motion_blur_cover(sides);
    if (!(cover > hardly && cover < 1.0 - hardly)) return vec2(here, bounds.x > 0.0 ? -1.0 : 1.0);
    return vec2(2.0 * here > bounds.x + bounds.y ? here : bounds.x, -cover);
}

// The velocity of a pixel at an edge is an average that no surface has. It is replaced by the velocity of the same
// surface beside the edge.
vec4 motion_blur_clean() {
    vec2 layer = layer_at(pixel), bounds = motion_blur_edge(nearness(depth_at(pixel)));
    uvec2 sides = motion_blur_sides(layer.y < 0.0 ? bounds : vec2(0.0));
    return motion_blur_motion(2.0 * layer.x > bounds.x + bounds.y ? sides.x : sides.y);
}

// The light of the nearer surface in a pixel: the pixel's light minus the share of the surface behind.
vec4 motion_blur_front() {
    vec4 light = finite(image_at(pixel)), back = vec4(0.0);
    vec2 here = layer_at(pixel);
    int count = abs(here.y) < 1.0 ? 25 : 0;
    float split = here.x, total = 0.0;
    for (int i = 0; i < min(count, 9); ++i) split = min(split, layer_at(pixel + ivec2(i % 3, i / 3) - 1).x);
    split = 0.5 * (split + here.x);
    for (int i = 0; i < count; ++i) {
        ivec2 at = pixel + motion_blur_beside(i);
        vec2 other = layer_at(at);
        if (abs(other.y) < 1.0 || other.x > split) continue;
        back += motion_blur_nearby(i) * finite(image_at(at));
        total += motion_blur_nearby(i);
    }
    if (count == 0) return light;
    return clamp(light - (1.0 + here.y) / max(total, 1e-9) * back, vec4(0.0), max(light, 0.0));
}

// --- paths ---

// How far a path leads along either axis before it turns back while the shutter is open; 0 if it does not.
float motion_blur_turn(vec4 path, vec2 times) {
    vec2 even = path.xy + path.zw, bend = path.zw - path.xy, far = vec2(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        float when = bend[axis] != 0.0 ? -0.5 * even[axis] / bend[axis] : times.x;
        if (when > times.x && when < times.y) far[axis] = abs(motion_blur_place(path, when)[axis]);
    }
    return max(far.x, far.y);
}

// The path of a pixel, limited to the length `longest` and to the distance `reach` from the pixel.
vec4 motion_blur_path(vec4 velocity, int path, vec2 times, float longest, float reach) {
    vec4 safe = is_finite(velocity) ? clamp(velocity, -1e5, 1e5) * proxy : vec4(0.0);
    if (path == PATH_STRAIGHT || safe.zw == vec2(0.0)) safe.zw = safe.xy;
    vec2 far = vec2(length(motion_blur_place(safe, times.x)), length(motion_blur_place(safe, times.y)));
    return safe * min(1.0, min(longest / max(far.x + far.y, 1e-9), reach / max(max(max(far.x, far.y), motion_blur_turn(safe, times)), 1e-9)));
}

vec4 motion_blur_faster(vec4 a, vec4 b, vec2 times) {
    return motion_blur_length(b, times) > motion_blur_length(a, times) ? b : a;
}

// The longest path of `count` pixels along an axis.
vec4 motion_blur_fastest(int axis, int count, vec2 times) {
    ivec2 along = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), first = pixel * (along * (count - 1) + 1);
    vec4 fastest = paths_at(first);
    for (int i = 1; i < count; ++i) fastest = motion_blur_faster(fastest, paths_at(first + i * along), times);
    return fastest;
}

// The longest path of a tile and its neighbors; diagonal neighbors count only if their path points here (Guertin 2014).
vec4 motion_blur_around(vec2 times) {
    vec4 fastest = tiles_at(pixel);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec4 other = tiles_at(pixel + ivec2(x, y));
            vec2 way = motion_blur_place(other, times.y) - motion_blur_place(other, times.x);
            if (x * y != 0 && abs(dot(way, vec2(x, y))) < length(way)) continue;
            fastest = motion_blur_faster(fastest, other, times);
        }
    return fastest;
}

// How much the paths within a tile differ from its longest one; then how much those of its neighbors differ from the
// longest of all.
float motion_blur_spread(int tile, vec2 times) {
    vec4 longest = tiles_at(pixel);
    float most = 0.0;
    for (int y = 0; y < tile; ++y)
        for (int x = 0; x < tile; ++x)
            most = max(most, motion_blur_length(paths_at(tile * pixel + ivec2(x, y)) - longest, times));
    return most;
}

float motion_blur_variety(vec2 times) {
    vec4 longest = around_at(pixel);
    float most = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 at = pixel + ivec2(i % 3, i / 3) - 1;
        most = max(most, spread_at(at) + motion_blur_length(tiles_at(at) - longest, times));
    }
    return most;
}

// The part of the shutter time that a surface spends between two offsets, if its path leads there. Its speed is taken
// as constant.
float motion_blur_share(vec4 path, vec2 times, vec2 from, vec2 to) {
    vec2 start = motion_blur_place(path, times.x), way = motion_blur_place(path, times.y) - start;
    float span = dot(way, way);
    if (span < motion_blur_still * motion_blur_still) return 0.0;
    vec2 passed = clamp(vec2(dot(from - start, way), dot(to - start, way)) / span, 0.0, 1.0);
    vec2 apart = 0.5 * (from + to) - motion_blur_place(path, mix(times.x, times.y, 0.5 * (passed.x + passed.y)));
    float beside = abs(way.x * apart.y - way.y * apart.x) * inversesqrt(span);
    return abs(passed.y - passed.x) * max(1.0 - beside, 0.0);
}

// How much a surface at one nearness is in front of another one; half if they are equally deep.
float motion_blur_before(float other, float here) {
    float near = max(other, here);
    return near > 0.0 ? clamp(0.5 + motion_blur_apart * (other - here) / near, 0.0, 1.0) : 0.5;
}

// How different two motions are, from the difference of their paths and the length `far` of one: 0 for parts of one
// surface, 1 for unrelated surfaces.
float motion_blur_unlike(float apart, float far) {
    return clamp(4.0 * apart / max(far, motion_blur_still) - 1.0, 0.0, 1.0);
}

// The samples along a path, at equal steps of time from `first` to `last`.
struct MotionBlurRun { vec4 path; float step, shift; bool sparse; int first, last; vec2 gains; };

// Steps of one pixel, so that no pixel is missed, or longer ones with a random start if those would be too many.
MotionBlurRun motion_blur_run(vec4 path, vec2 times, int samples, float noise) {
    vec2 middle = 0.5 * (path.xy + path.zw), bend = path.zw - path.xy;
    vec2 speed = max(abs(middle + times.x * bend), abs(middle + times.y * bend));
    float exact = 1.0 / max(max(speed.x, speed.y), 1e-6), longer = (times.y - times.x) / float(samples);
    MotionBlurRun run;
    run.path = path;
    run.step = max(exact, longer);
    run.sparse = longer > exact;
    run.shift = run.sparse ? noise * run.step : 0.0;
    run.first = int(round((times.x - run.shift) / run.step));
    run.last = int(round((times.y - run.shift) / run.step));
    // On a short path the pixels at its ends count as if it led to their centers. These gains of the middle and the ends
    // make the variance that of the path, length^2 / 12.
    float span = (times.y - times.x) / run.step, ends = span * span * span / (12.0 * max(span - 1.0, 1e-6));
    bool blunt = span > 1.0 && ends < 1.0 && times.x == -times.y && !run.sparse;
    run.gains = blunt ? vec2(span * (1.0 - span * span / 12.0), ends) : vec2(1.0);
    return run;
}

float motion_blur_time(MotionBlurRun run, int i) { return float(i) * run.step + run.shift; }

// The time span of one sample, within the shutter time.
vec2 motion_blur_open(MotionBlurRun run, int i, vec2 times) {
    return clamp(motion_blur_time(run, i) + vec2(-0.5, 0.5) * run.step, times.x, times.y);
}

// The two pixels between which a sample lies: the first, the step to the second, and the weight of the second. They lie
// side by side across the path; along the path the sample counts as in the middle of its pixel. For `sparse` samples
// they lie along the path.
float motion_blur_between(MotionBlurRun run, int i, out ivec2 cell, out ivec2 side) {
    float time = motion_blur_time(run, i);
    vec2 at = vec2(pixel) + 0.5 - motion_blur_place(run.path, time);
    vec2 way = 0.5 * (run.path.xy + run.path.zw) + time * (run.path.zw - run.path.xy);
    bool steep = abs(way.y) > abs(way.x);
    vec2 slide = (floor(at) + 0.5 - at) / way;
    if (!run.sparse && way != vec2(0.0)) at += (steep ? slide.y : slide.x) * way;
    side = steep == run.sparse ? ivec2(0, 1) : ivec2(1, 0);
    at -= 0.5 * vec2(side);
    cell = ivec2(floor(at));
    return fract(steep == run.sparse ? at.y : at.x);
}

bool motion_blur_outside(ivec2 at) { return any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, image_size)); }

// Empties a run that a pixel does not need. Its loop then ends at once, and the loop itself stays outside of a branch.
MotionBlurRun motion_blur_only(bool is_needed, MotionBlurRun run) {
    run.last = is_needed ? run.last : run.first - 1;
    return run;
}

// Where all surfaces move alike, the result is exactly a box filter along the path.
vec4 motion_blur_box(MotionBlurRun run, vec2 times, vec4 here) {
    vec4 sum = vec4(0.0);
    float total = 0.0;
    bool bent = length(run.path.zw - run.path.xy) > 0.1 * length(run.path);  // half or twice changes no preset
    MotionBlurRun even = motion_blur_only(!bent, run);
    for (int i = even.first; i <= even.last; ++i) {
        ivec2 cell, side;
        vec2 open = motion_blur_open(even, i, times);
        float part = motion_blur_between(even, i, cell, side);
        for (int k = part > 0.0 ? 0 : 1; k < 2; ++k) {
            ivec2 at = cell + (1 - k) * side;
            if (motion_blur_outside(at)) continue;
            float spent = even.gains[min(abs(i), 1)] * (open.y - open.x) * (k == 1 ? 1.0 - part : part);
            sum += spent * finite(fronts_at(at));
            total += spent;
        }
    }
    // On a curved path, equal steps of time pass pixels unevenly, so samples are interpolated.
    run = motion_blur_only(bent, run);
    for (int i = run.first; i <= run.last; ++i) {
        vec2 open = motion_blur_open(run, i, times);
        vec2 at = vec2(pixel) + 0.5 - motion_blur_place(run.path, 0.5 * (open.x + open.y));
        if (motion_blur_outside(ivec2(floor(at)))) continue;
        sum += (open.y - open.x) * finite(fronts_near(at));
        total += open.y - open.x;
    }
    return total > 0.0 ? sum / total : here;
}

// A sample, compared with the surface of this pixel.
struct MotionBlurMet { vec4 light, path; float cover, before, after; };

MotionBlurMet motion_blur_met(ivec2 cell, vec4 own, float far, float near, vec2 times) {
    MotionBlurMet met;
    vec2 layer = layer_at(cell);
    met.light = finite(fronts_at(cell));
    met.path = paths_at(cell);
    met.cover = abs(layer.y);
    float unlike = motion_blur_unlike(motion_blur_length(met.path - own, times), far);
    float before = cell == pixel ? 0.0 : motion_blur_before(layer.x, near);
    met.before = before * unlike;
    met.after = clamp(1.0 - 2.0 * before, 0.0, 1.0) * unlike;
    return met;
}

vec4 motion_blur(vec2 times, int tile, int samples) {
    const float certain = 4.0;  // weight of light seen behind a layer in this pixel, relative to light one pixel away
    vec4 fast = around_at(pixel / tile), here = finite(image_at(pixel)), own = paths_at(pixel);
    float far = motion_blur_length(own, times), noise = blue_noise(pixel) - 0.5;
    bool still = motion_blur_length(fast, times) < 1.0;
    bool alone = motion_blur_unlike(variety_at(pixel / tile) + motion_blur_length(fast - own, times), far) == 0.0;
    vec2 layer = layer_at(pixel);
    MotionBlurRun run = motion_blur_run(own, times, samples, noise);
    vec4 box = motion_blur_box(motion_blur_only(alone && !still, run), times, here);

    // Along the fastest motion around: surfaces that pass in front of this pixel, and those that move behind it.
    vec4 front = vec4(0.0), moving = vec4(0.0);  // sums of light
    float covers = 0.0, moves = 0.0;             // sums of weights
    MotionBlurRun passing = motion_blur_only(!alone && !still, motion_blur_run(fast, times, samples, noise));
    for (int i = passing.first; i <= passing.last; ++i) {
        ivec2 cell, side;
        float part = motion_blur_between(passing, i, cell, side), time = motion_blur_time(passing, i);
        float half_step = 0.5 * passing.step;
        vec2 from = motion_blur_place(fast, time - half_step), to = motion_blur_place(fast, time + half_step);
        for (int k = part > 0.0 ? 0 : 1; k < 2; ++k) {
            ivec2 at = cell + (1 - k) * side;
            if (motion_blur_outside(at)) continue;
            MotionBlurMet met = motion_blur_met(at, own, far, layer.x, times);
            float share = (k == 1 ? 1.0 - part : part) * motion_blur_share(met.path, times, from, to);
            share *= passing.gains[min(abs(i), 1)];
            front += met.before * share * met.light;
            covers += met.before * share * met.cover;
            moving += met.after * share * met.light;
            moves += met.after * share * met.cover;
        }
    }

    // Along the pixel's own path: its own surface, and the background that this surface uncovers.
    vec4 same = vec4(0.0), behind = vec4(0.0);
    float stays = 0.0, bares = 0.0, nearby = 0.0;
    run = motion_blur_only(!alone && !still, run);
    for (int i = run.first; i <= run.last; ++i) {
        ivec2 cell, side;
        float part = motion_blur_between(run, i, cell, side);
        vec2 open = motion_blur_open(run, i, times), away = motion_blur_place(own, motion_blur_time(run, i));
        float spent = run.gains[min(abs(i), 1)] * (open.y - open.x) / (times.y - times.x);
        for (int k = part > 0.0 ? 0 : 1; k < 2; ++k) {
            ivec2 at = cell + (1 - k) * side;
            if (motion_blur_outside(at)) continue;
            MotionBlurMet met = motion_blur_met(at, own, far, layer.x, times);
            float share = (k == 1 ? 1.0 - part : part) * spent * (1.0 - met.before);
            same += (1.0 - met.after) * share * met.light;
            stays += (1.0 - met.after) * share * met.cover;
            bares += share * (1.0 - (1.0 - met.after) * met.cover);
            // The hidden background is guessed from its nearest visible part.
            // Pixels at edges show a part of it, apart from the surface in front.
            float weight = share / max(dot(away, away), 1.0), beside = weight * (1.0 - met.after);
            behind += weight * met.after * met.light + beside * (finite(image_at(at)) - met.light);
            nearby += weight * met.after * met.cover + beside * (1.0 - met.cover);
        }
    }
    if (still || alone) return still ? here : box;

    if (abs(layer.y) < 1.0) {
        behind += certain * (here - finite(fronts_at(pixel)));
        nearby += certain * (1.0 - abs(layer.y));
    }
    if (nearby > 0.0) behind /= nearby;
    if (moves > 0.0) behind = mix(behind, moving / moves, nearby > 0.0 ? min(2.0 * moves, 1.0) : 1.0);
    vec4 seen = stays > 0.0 ? same : here;
    if (nearby > 0.0 || moves > 0.0) seen = stays > 0.0 ? (same + bares * behind) / (stays + bares) : behind;
    else if (stays > 0.0) seen /= stays;
    return covers > 0.0 ? mix(seen, front / covers, min(covers, 1.0)) : seen;
}
