// Rays through the picture, in screen space (McGuire and Mara 2014). Along a ray, the position in the picture and
// nearness (1 / depth) are both linear in `at` = t / depth, where t is the distance from its start. On a plane,
// nearness is linear in the position. So every pixel counts as a small plane, which rays meet exactly, and no plane
// hides itself. Cells of 4, 16 and 64 pixels hold bounds, so that rays skip empty space (Uludag 2014).
#include "lib/camera.glsl"
#include "lib/geometry.glsl"

const int MARCH_LEVELS = 3;  // cells of 4, 16 and 64 pixels
// Rays start in front of the surface by this part of the depth: a choice between surfaces that shade themselves and gaps
// at contacts. Half or twice the number changes up to 3 % of the pixels of contact_shadows on the sample frame by more
// than 1 / 255.
const float MARCH_LIFT = 1e-4;
const float MARCH_NUDGE = 1e-3;    // pixels: a step beyond a border, into the next cell
// Pixels: how far a ray moves into an object after it met its edge, whose pixels mix two surfaces. The preset wet_floor
// depends on it: with 1 or 4, a tenth of its pixels change by more than 1 / 255.
const float MARCH_INSIDE = 2.0;
const float MARCH_ENDLESS = 1e18;  // beyond all pictures; its square is still a float
// The sine of the angle by which a ray leaves the plane of its pixel at least: a tenth of a degree. With half or twice the
// number no pixel of wet_floor changes by 1 / 255.
const float MARCH_OUT = 2e-3;

struct March {
    vec2 from, pace;   // start position in pixels, and its change with `at`
    float near, gain;  // start nearness, and its change with `at`
    float at, last, nudge;
    vec3 plane;        // the plane of the last pixel, or 0, and
    vec2 middle;       // the center of that pixel
    int level;         // cells have 4^level pixels to a side
    float gap;         // the distance of the ray behind the visible surface
    bool behind;       // true if the ray is behind the whole object at this pixel
    bool endless;      // true if it is infinitely far away at `last`
    float fade;        // the part of a solid object's depth, from its back, over which its confidence fades
    float sure;        // confidence: 1 if it met a visible surface, less the deeper it entered an object from the side
    vec2 grazed;       // confidence and `at` where it most likely met an object that may be thinner than that
};

// The nearness of the ray at a place along it.
float march_near(March ray, float at) { return ray.near + ray.gain * at; }
// The position of the end of the ray in the picture.
vec2 march_place(March ray) { return ray.from + ray.pace * ray.at; }

// The length of the ray so far, in world units.
float march_distance(March ray) { return ray.at / max(march_near(ray, ray.at), 1e-30); }

// The `at` where the ray leaves a box.
float march_leaves(March ray, vec2 low, vec2 high) {
    vec2 wall = mix(low, high, greaterThan(ray.pace, vec2(0.0)));
    vec2 way = mix((wall - ray.from) / ray.pace, vec2(MARCH_ENDLESS), equal(ray.pace, vec2(0.0)));
    return min(way.x, way.y);
}

// A ray from the surface at `uv` and `depth`, with the length `reach` in world units, or endless. It starts at the next
// pixel.
March march_start(const vec4 rows[3], vec2 uv, float depth, vec3 way, float reach, bool endless, vec2 size) {
    vec3 moved = vec3(dot(rows[0].xyz, way), dot(rows[1].xyz, way), dot(rows[2].xyz, way));
    March ray;
    depth *= 1.0 - MARCH_LIFT;
    ray.from = uv * size;
    ray.pace = (moved.xy - uv * moved.z) * size;
    ray.near = 1.0 / depth;
    ray.gain = -moved.z / depth;
    float whole = depth + reach * moved.z;
    ray.last = whole > 0.0 ? reach / whole : MARCH_ENDLESS;
    if (endless) ray.last = moved.z > 0.0 ? 1.0 / moved.z : MARCH_ENDLESS;
    float border = march_leaves(ray, vec2(0.0), size);
    ray.endless = endless && moved.z > 0.0 && ray.last < border;
    ray.last = min(ray.last, border);
    ray.nudge = MARCH_NUDGE / max(max(abs(ray.pace.x), abs(ray.pace.y)), 1e-12);
    vec2 own = floor(ray.from);
    ray.at = max(march_leaves(ray, own, own + 1.0), 0.0);
    ray.plane = vec3(0.0);
    ray.middle = own + 0.5;
    ray.level = 0;
    ray.gap = 0.0;
    ray.behind = false;
    ray.fade = 0.0;
    ray.sure = 0.0;
    ray.grazed = vec2(0.0);
    return ray;
}

// The cell that contains the end of the ray.
ivec2 march_cell(March ray, ivec2 size) {
    vec2 ahead = ray.from + ray.pace * (ray.at + ray.nudge);
    return ivec2(clamp(floor(ahead), vec2(0.0), vec2(size - 1))) >> (2 * ray.level);
}

// The number of cells of a level.
ivec2 march_cells(ivec2 size, int level) { return (size + (1 << (2 * level)) - 1) >> (2 * level); }

// The place of a cell in the picture `surfaces`: pixels at the top, below them the larger cells side by side.
ivec2 march_texel(ivec2 cell, ivec2 size, int level) {
    for (int i = 1; i < level; ++i) cell.x += march_cells(size, i).x;
    return level > 0 ? cell + ivec2(0, size.y) : cell;
}

// The distance by which a ray is behind a surface, from the nearness of both.
float march_gap(float near, float surface) { return max(1.0 / max(near, 1e-30) - 1.0 / max(surface, 1e-30), 0.0); }

// Advances the ray by one cell. `seen` is the content of the cell: for a pixel the nearness at its center and the
// slopes to the right and down, and the depth of a solid object; for a larger cell the largest nearness of surfaces and
// the smallest of the backs of solid objects. True where the ray meets a surface.
bool march_step(inout March ray, ivec2 cell, vec4 seen, float thickness) {
    const float rounding = 1e-6;
    vec2 low = vec2(cell << (2 * ray.level)), high = low + float(1 << (2 * ray.level));
    float next = min(max(march_leaves(ray, low, high), ray.at + ray.nudge), ray.last);
    float near_now = march_near(ray, ray.at), near_next = march_near(ray, next);
    if (ray.level > 0) {
        bool before = min(near_now, near_next) > seen.x || seen.x <= 0.0;
        bool hidden = max(near_now, near_next) < seen.y / (1.0 + thickness * seen.y);
        if (!before && !hidden) {
            --ray.level;
            return false;
        }
        ray.gap = hidden ? thickness : 0.0;
        ray.behind = hidden;
        ray.plane = vec3(0.0);
    } else if (seen.x <= 0.0) {
        ray.gap = 0.0;
        ray.behind = false;
    } else {
        vec2 middle = low + 0.5;
        float now = seen.x + dot(seen.yz, ray.from + ray.pace * ray.at - middle);
        float then = seen.x + dot(seen.yz, ray.from + ray.pace * next - middle);
        float ahead = near_now - now, after = near_next - then, least = -rounding * seen.x;
        if (ahead >= least && after < least) {
            ray.at = mix(ray.at, next, clamp(ahead / (ahead - after), 0.0, 1.0));
            ray.sure = 1.0;
            return true;
        }
        if (ahead < least) {
            // The ray is behind the surface. It came from the side, or from behind a nearer object, if the surface
            // changed suddenly: by more than the surface and the ray can change within a pixel.
            float gap = march_gap(near_now, now), step = abs(ray.gain) * ray.nudge / MARCH_NUDGE;
            float crack = (abs(seen.y) + abs(seen.z)) / (seen.x * seen.x) + step / (near_now * near_now);
            float front = seen.w - min(gap, march_gap(near_next, then));
            bool inside = front > 0.0;
            float whole = clamp(front / max(ray.fade * seen.w, 1e-9), 0.0, 1.0);
            ray.sure = max(whole, clamp(2.0 - 2.0 * gap / max(thickness, 1e-9), 0.0, 1.0));
            // If each of two pixels lies behind the plane of the other, there is a convex edge. It does not hide a ray
            // that leaves it: the planes only extend too far.
            vec2 away = middle - ray.middle;
            bool bulges = seen.x < ray.plane.x + dot(away, ray.plane.yz) && ray.plane.x < seen.x - dot(away, seen.yz);
            if (bulges && after > ahead && gap <= 2.0 * crack) ray.sure = 0.0;
            if ((ray.gap == 0.0 || ray.gap > gap + crack || ray.behind && inside) && ray.sure > 0.0) {
                // Move inside the object, unless it is just a crease: at its border, interpolated colors would mix two
                // surfaces.
                if (gap > crack) ray.at = min(ray.at + MARCH_INSIDE / MARCH_NUDGE * ray.nudge, ray.last);
                if (seen.w == 0.0 || ray.sure == 1.0) return true;
                if (ray.sure > ray.grazed.x) ray.grazed = vec2(ray.sure, ray.at);
            }
        }
        ray.gap = after < least ? march_gap(near_next, then) : 0.0;
        ray.behind = ray.gap > (1.0 - ray.fade) * seen.w;
    }
    if (ray.level == 0) ray.plane = seen.xyz, ray.middle = low + 0.5;
    ray.at = next;
    ray.level = min(ray.level + 1, MARCH_LEVELS);
    return false;
}

// The draws that make the picture `surfaces`. This one reads `depth`.
vec4 march_planes() {
    float here = nearness(depth_at(pixel));
    if (here == 0.0) return vec4(0.0);
    vec2 slope;
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 next = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
        vec2 next_to = vec2(nearness(depth_at(pixel - next)), nearness(depth_at(pixel + next)));
        vec2 beyond = vec2(nearness(depth_at(pixel - 2 * next)), nearness(depth_at(pixel + 2 * next)));
        slope[axis] = nearness_slope(here, next_to, beyond);
        // A surface that bends on both sides as much as it rises there is an edge, or thinner than a pixel: it counts as
        // facing the camera. Its neighbors are other surfaces, and a plane through them would hide rays beside it.
        vec2 rise = abs(next_to - here), bend = mix(abs(beyond - 2.0 * next_to + here), rise, equal(beyond, vec2(0.0)));
        vec2 bent = bend / max(rise, 1e-9 * here);
        slope[axis] *= clamp(3.0 - 3.0 * min(bent.x, bent.y), 0.0, 1.0);
    }
    return vec4(here * vec3(1.0, slope), 0.0);
}

// The largest nearness of the planes in 4 x 4 pixels, and the smallest of the backs of objects; the background counts
// as 0.
vec4 march_bounds() {
    vec2 bounds = vec2(0.0, 1e30);
    for (int i = 0; i < 16; ++i) {
        ivec2 at = 4 * pixel + ivec2(i & 3, i >> 2);
        if (any(greaterThanEqual(at, planes_size))) continue;
        vec4 plane = planes_at(at);
        float most = 0.5 * (abs(plane.y) + abs(plane.z)), back = max(plane.x - most, 0.0);
        bounds = vec2(max(bounds.x, plane.x + most), min(bounds.y, back / (1.0 + plane.w * back)));
    }
    return vec4(bounds, 0.0, 0.0);
}

// The last draw, which reads `planes` and `bounds`: all levels in one picture.
vec4 march_surfaces() {
    ivec2 size = planes_size;
    if (pixel.y < size.y) return all(lessThan(pixel, size)) ? planes_at(pixel) : vec4(0.0);
    ivec2 cell = pixel - ivec2(0, size.y);
    int level = 1;
    while (level < MARCH_LEVELS && cell.x >= march_cells(size, level).x) cell.x -= march_cells(size, level++).x;
    if (any(greaterThanEqual(cell, march_cells(size, level)))) return vec4(0.0);
    int side = 1 << (2 * (level - 1));
    vec2 joined = vec2(0.0, 1e30);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            ivec2 at = side * cell + ivec2(x, y);
            if (any(greaterThanEqual(at, bounds_size))) continue;
            vec2 bound = bounds_at(at).xy;
            joined = vec2(max(joined.x, bound.x), min(joined.y, bound.y));
        }
    return vec4(joined, 0.0, 0.0);
}

// As many steps as the longest ray through a picture needs: for each pixel on its way one forward, and one to a smaller
// cell.
int march_longest(ivec2 size) { return 2 * (size.x + size.y) + 2 * MARCH_LEVELS; }

// Follows a ray through the picture `surfaces`, in at most `steps` steps. True where it meets a surface, and where it
// reaches infinity at a background pixel: then it is still `endless`.
bool march(inout March ray, ivec2 size, float thickness, int steps) {
    ray.plane = surfaces_at(ivec2(ray.from)).xyz;
    for (int i = 0; i < steps && ray.at < ray.last; ++i) {
        ivec2 cell = march_cell(ray, size);
        if (march_step(ray, cell, surfaces_at(march_texel(cell, size, ray.level)), thickness)) {
            ray.endless = false;
            return true;
        }
    }
    if (ray.grazed.x > 0.0) {
        ray.sure = ray.grazed.x, ray.at = ray.grazed.y, ray.endless = false;
        return true;
    }
    if (ray.at < ray.last || !ray.endless || ray.gap > 0.0) return false;
    ray.sure = 1.0;
    return surfaces_at(ivec2(clamp(march_place(ray), vec2(0.0), vec2(size - 1)))).x <= 0.0;
}

// The normal of the plane of a pixel, toward the camera.
vec3 march_normal(const vec4 rows[3], ivec2 at, ivec2 size) {
    vec3 plane = surfaces_at(at).xyz;
    return plane.x > 0.0 ? camera_normal(rows, camera_uv(at, size), plane.yz / plane.x * vec2(size)) : vec3(0.0);
}

// Bends a direction out of the plane of a pixel: with smoothed normals, rays could start below the surface.
vec3 march_out(vec3 way, vec3 plane) {
    return normalize(way + max(MARCH_OUT - dot(way, plane), 0.0) * plane);
}
