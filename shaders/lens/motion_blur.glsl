#include "lib/blue_noise.glsl"
#include "lib/geometry.glsl"

// A path is kept as xy, from the frame before to now, and zw, from now to the frame after, in pixels; time 0 is now.
// `times` are when the shutter opens and closes.

const float motion_blur_still = 1e-3;  // shorter paths are none
const float motion_blur_apart = 50.0;  // what is nearer by 1 / 100 of the depth is fully in front

// Where it is at a time, on the parabola through the three places.
vec2 motion_blur_place(vec4 path, float time) {
    return 0.5 * time * (path.xy + path.zw + time * (path.zw - path.xy));
}

// How far it gets while the shutter is open, from where it is now to both sides.
float motion_blur_length(vec4 path, vec2 times) {
    return length(motion_blur_place(path, times.x)) + length(motion_blur_place(path, times.y));
}

bool motion_blur_alike(float a, float b) { return motion_blur_apart * abs(a - b) < max(a, b) || a == b; }

// At antialiased edges velocities are averages of what is in front and what is behind, and nothing moves like that:
// such pixels take after those of their own surface that lie one further in.
vec4 motion_blur_clean() {
    float near[25], here = nearness(depth_at(pixel));
    for (int i = 0; i < 25; ++i) near[i] = nearness(depth_at(pixel + ivec2(i % 5, i / 5) - 2));
    vec4 sum = vec4(0.0);
    float count = 0.0;
    bool edge = false;
    for (int i = 0; i < 9; ++i) {
        int at = 5 * (i / 3) + i % 3 + 6;
        bool inside = motion_blur_alike(near[at], here);
        for (int side = 0; side < 4; ++side) {
            bool same = motion_blur_alike(near[at + int[4](-5, -1, 1, 5)[side]], here);
            edge = edge || i == 4 && !same;
            inside = inside && same;
        }
        vec4 velocity = velocity_at(pixel + ivec2(i % 3, i / 3) - 1);
        if (!inside || !is_finite(velocity)) continue;
        sum += velocity;
        count += 1.0;
    }
    return edge && count > 0.0 ? sum / count : velocity_at(pixel);
}

// The path of a pixel, shortened to `longest`, and so that nothing gets farther from its place than `reach`.
vec4 motion_blur_path(vec4 velocity, int path, vec2 times, float longest, float reach) {
    vec4 safe = is_finite(velocity) ? clamp(velocity, -1e5, 1e5) * proxy : vec4(0.0);
    if (path == PATH_STRAIGHT || safe.zw == vec2(0.0)) safe.zw = safe.xy;
    vec2 far = vec2(length(motion_blur_place(safe, times.x)), length(motion_blur_place(safe, times.y)));
    return safe * min(1.0, min(longest / max(far.x + far.y, 1e-9), reach / max(max(far.x, far.y), 1e-9)));
}

vec4 motion_blur_faster(vec4 a, vec4 b, vec2 times) {
    return motion_blur_length(b, times) > motion_blur_length(a, times) ? b : a;
}

// The longest path of so many pixels along an axis.
vec4 motion_blur_fastest(int axis, int count, vec2 times) {
    ivec2 along = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), first = pixel * (along * (count - 1) + 1);
    vec4 found = paths_at(first);
    for (int i = 1; i < count; ++i) found = motion_blur_faster(found, paths_at(first + i * along), times);
    return found;
}

// The longest path of a tile and its neighbors; those at its corners count only if they point here (Guertin 2014).
vec4 motion_blur_around(vec2 times) {
    vec4 found = tiles_at(pixel);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec4 other = tiles_at(pixel + ivec2(x, y));
            vec2 way = motion_blur_place(other, times.y) - motion_blur_place(other, times.x);
            if (x * y != 0 && abs(dot(way, vec2(x, y))) < length(way)) continue;
            found = motion_blur_faster(found, other, times);
        }
    return found;
}

// The part of its time that something spends on the stretch between two offsets of its path, which counts as straight
// and evenly run through.
float motion_blur_share(vec4 path, vec2 times, vec2 from, vec2 to) {
    vec2 start = motion_blur_place(path, times.x), way = motion_blur_place(path, times.y) - start;
    float span = dot(way, way);
    if (span < motion_blur_still * motion_blur_still) return 0.0;
    vec2 passed = clamp(vec2(dot(from - start, way), dot(to - start, way)) / span, 0.0, 1.0);
    return abs(passed.y - passed.x);
}

// How much of what lies at one nearness is in front of what lies at another; half, if they are equally deep.
float motion_blur_before(float other, float here) {
    float near = max(other, here);
    return near > 0.0 ? clamp(0.5 + motion_blur_apart * (other - here) / near, 0.0, 1.0) : 0.5;
}

// How differently two things move: 0 for parts of one surface, 1 for what has nothing to do with each other.
float motion_blur_unlike(vec4 a, vec4 b, vec2 times) {
    return clamp(4.0 * motion_blur_length(a - b, times) / motion_blur_length(b, times) - 1.0, 0.0, 1.0);
}

// Times along a path: steps of a pixel, so that nothing is missed, or longer ones if those are too many.
float motion_blur_step(vec4 path, vec2 times, int samples) {
    vec2 middle = 0.5 * (path.xy + path.zw), bend = path.zw - path.xy;
    vec2 speed = max(abs(middle + times.x * bend), abs(middle + times.y * bend));
    float open = times.y - times.x, fastest = max(max(speed.x, speed.y), 1e-6);
    return max(1.0 / fastest, open / float(samples));
}

vec4 motion_blur(vec2 times, int tile, int samples) {
    vec4 fast = around_at(pixel / tile), here = finite(image_at(pixel));
    if (motion_blur_length(fast, times) < 1.0) return here;
    vec4 own = paths_at(pixel);
    float near = nearness(depth_at(pixel)), noise = blue_noise(pixel) - 0.5;
    vec2 middle = vec2(pixel) + 0.5;

    // Loop 0 follows the fastest motion around: what passes before this pixel. Loop 1 follows the pixel's own path:
    // what it shows of itself, and of what is behind it. Together, equal motion is exactly a box filter along its path.
    vec4 front = vec4(0.0), same = vec4(0.0), behind = vec4(0.0);  // sums of light
    float covers = 0.0, stays = 0.0, bares = 0.0, nearby = 0.0;    // sums of the weights
    for (int loop = 0; loop < 2; ++loop) {
        vec4 path = loop == 0 ? fast : own;
        float step = motion_blur_step(path, times, samples), exact = motion_blur_step(path, times, 1 << 20);
        float shift = step > exact ? noise * step : 0.0;
        int first = int(round((times.x - shift) / step)), last = int(round((times.y - shift) / step));
        for (int i = first; i <= last; ++i) {
            float time = float(i) * step + shift;
            vec2 away = motion_blur_place(path, time), at = middle - away;
            ivec2 cell = ivec2(floor(at));
            if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, image_size))) continue;
            vec2 from = motion_blur_place(path, time - 0.5 * step), to = motion_blur_place(path, time + 0.5 * step);
            vec4 light = finite(image_near(at)), other = paths_at(cell);
            float before = cell == pixel ? 0.0 : motion_blur_before(nearness(depth_at(cell)), near);
            float share = motion_blur_share(loop == 0 ? other : own, times, from, to);
            if (loop == 0) {
                front += before * share * light;
                covers += before * share;
                continue;
            }
            share *= 1.0 - before;
            float apart = clamp(1.0 - 2.0 * before, 0.0, 1.0) * motion_blur_unlike(other, own, times);
            same += (1.0 - apart) * share * light;
            stays += (1.0 - apart) * share;
            // What is hidden is most like what is nearest to it.
            float weight = apart * share / max(dot(away, away), 1.0);
            behind += weight * light;
            nearby += weight;
            bares += apart * share;
        }
    }
    vec4 seen = stays + bares > 0.0 ? same : here;
    if (nearby > 0.0) seen += behind * (bares / nearby);
    if (stays + bares > 0.0) seen /= stays + bares;
    return covers > 0.0 ? mix(seen, front / covers, min(covers, 1.0)) : seen;
}
