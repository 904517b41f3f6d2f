// Lattice noises. Each cell is hashed once and gives three independent noises, each within -1..1.
#include "lib/hash.glsl"

// The cell of a position. The lattice ends where floats have no fractions left, before integers overflow.
ivec3 lattice_cell(vec3 p) { return ivec3(floor(clamp(p, -1e9, 1e9))); }

const int LATTICE_ENDLESS = 1 << 30;  // the period of a lattice that does not repeat: beyond all cells, exact as a float
const ivec3 LATTICE_PLAIN = ivec3(LATTICE_ENDLESS);

// How many cells of a layer repeat along each axis, from the cells of the first layer (0: it does not repeat) and how
// much denser this one is: a multiple of `steps`, so that the pattern closes.
ivec3 lattice_period(vec3 tiles, float density, int steps) {
    vec3 counts = clamp(round(tiles * density / float(steps)), 1.0, 1e8) * float(steps);
    return ivec3(mix(vec3(LATTICE_PLAIN), counts, greaterThan(tiles, vec3(0.0))));
}

// How much denser a layer is along each axis, so that its period is a whole number of cells.
vec3 lattice_density(vec3 tiles, float density, ivec3 period) {
    return mix(vec3(density), vec3(period) / max(tiles, 1e-6), greaterThan(tiles, vec3(0.0)));
}

// A place in the first layer. Along an axis that repeats it lies within the period, and is the same to the bit one
// period further. `at` and `period` are in pixels, `loop` in units of `evolution`; 0 does not repeat.
vec3 lattice_place(vec2 at, float size, vec2 period, float evolution, float loop) {
    vec3 place = vec3(at, evolution), turn = vec3(period, loop);
    bvec3 repeats = greaterThan(turn, vec3(0.0));
    place -= mix(vec3(0.0), turn * floor(place / max(turn, 1e-6)), repeats);
    return vec3(place.xy / size, place.z);
}

// The place within the period of a layer, where warps and rounding have moved it beyond.
vec3 lattice_inside(vec3 p, ivec3 period) {
    bvec3 repeats = notEqual(period, LATTICE_PLAIN);
    return p - mix(vec3(0.0), vec3(period) * floor(p / vec3(period)), repeats);
}

// The cells after `cell`, which lies within the period.
ivec3 lattice_next(ivec3 cell, ivec3 period) {
    ivec3 next = cell + 1;
    return ivec3(next.x == period.x ? 0 : next.x, next.y == period.y ? 0 : next.y, next.z == period.z ? 0 : next.z);
}

// A cell at most one beside the period, as that within it.
ivec3 lattice_wrap(ivec3 cell, ivec3 period) {
    cell += ivec3(lessThan(cell, ivec3(0))) * ivec3(notEqual(period, LATTICE_PLAIN)) * period;
    return cell - ivec3(greaterThanEqual(cell, period)) * period;
}

// Corner `i` of a cell, from 0 to 7.
ivec3 lattice_corner(ivec3 cell, ivec3 next, int i) {
    return ivec3((i & 1) == 0 ? cell.x : next.x, (i & 2) == 0 ? cell.y : next.y, (i & 4) == 0 ? cell.z : next.z);
}

// A random value for each cell.
vec3 white_noise(vec3 p, uvec3 seed, ivec3 period) {
    return hash3(lattice_cell(lattice_inside(p, period)), seed) * 2.0 - 1.0;
}

// Interpolation with continuous second derivative (Perlin 2002, "Improving Noise").
vec3 quintic(vec3 t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

// Smooth interpolation between random values at lattice points.
vec3 value_noise(vec3 p, uvec3 seed, ivec3 period) {
    p = lattice_inside(p, period);
    ivec3 cell = lattice_cell(p), next = lattice_next(cell, period);
    vec3 t = quintic(fract(p));
    vec3 corners[8];
    for (int i = 0; i < 8; i++) corners[i] = hash3(lattice_corner(cell, next, i), seed);
    for (int i = 0; i < 4; i++) corners[i] = mix(corners[2 * i], corners[2 * i + 1], t.x);
    vec3 near = mix(corners[0], corners[1], t.y), far = mix(corners[2], corners[3], t.y);
    return mix(near, far, t.z) * 2.0 - 1.0;
}

// The dot product with one of Perlin's twelve edges of a cube (four appear twice), chosen by the top four bits.
float edge_gradient(uint bits, vec3 d) {
    uint h = bits >> 28u;
    float u = h < 8u ? d.x : d.y;
    float v = h < 4u ? d.y : (h == 12u || h == 14u) ? d.x : d.z;
    return ((h & 1u) == 0u ? u : -u) + ((h & 2u) == 0u ? v : -v);
}

// Gradient noise (Perlin 2002), divided by its largest possible value. It is zero at every lattice point.
vec3 gradient_noise(vec3 p, uvec3 seed, ivec3 period) {
    p = lattice_inside(p, period);
    ivec3 cell = lattice_cell(p), next = lattice_next(cell, period);
    vec3 inside = fract(p), t = quintic(inside);
    vec3 corners[8];
    for (int i = 0; i < 8; i++) {
        ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
        uvec3 bits = pcg3d(uvec3(lattice_corner(cell, next, i)) + seed);
        vec3 d = inside - vec3(corner);
        corners[i] = vec3(edge_gradient(bits.x, d), edge_gradient(bits.y, d), edge_gradient(bits.z, d));
    }
    for (int i = 0; i < 4; i++) corners[i] = mix(corners[2 * i], corners[2 * i + 1], t.x);
    vec3 near = mix(corners[0], corners[1], t.y), far = mix(corners[2], corners[3], t.y);
    return mix(near, far, t.z) * 0.9649214;
}

vec3 gradient_noise(vec3 p, uvec3 seed) { return gradient_noise(p, seed, LATTICE_PLAIN); }

// The corners of the tetrahedron around p, and the vectors from them to p. In a lattice skewed along the diagonal, a
// tetrahedron is a path from one corner of a cube to the opposite one, along the axes in the order in which p is
// farthest (Gustavson and McEwan 2022).
void simplex_corners(vec3 p, out ivec3 cells[4], out vec3 away[4]) {
    p += (p.x + p.y + p.z) / 3.0;
    vec3 inside = fract(p);
    vec3 later = step(inside.xyx, inside.yzz), sooner = 1.0 - later;
    vec3 a = vec3(sooner.z, later.xy), b = vec3(sooner.xy, later.z);
    vec3 path[4] = vec3[4](vec3(0.0), min(a, b), max(a, b), vec3(1.0));
    for (int i = 0; i < 4; i++) {
        cells[i] = lattice_cell(p) + ivec3(path[i]);
        away[i] = inside - path[i];
        away[i] -= (away[i].x + away[i].y + away[i].z) / 6.0;
    }
}

const int SIMPLEX_STEP = 6;  // periods of simplex noise are multiples of this: only then do its tetrahedra meet

// The corners within the period. Six times a corner's place along the axes is a whole number, and one period along an
// axis is a step of the skewed lattice.
void simplex_wrap(inout ivec3 cells[4], ivec3 period) {
    vec3 side = 3.0 * vec3(period);  // 6 times the period in tetrahedra, which are twice as large as cells
    bvec3 repeats = notEqual(period, LATTICE_PLAIN);
    for (int i = 0; i < 4; i++) {
        vec3 place = vec3(6 * cells[i] - (cells[i].x + cells[i].y + cells[i].z));
        ivec3 turns = ivec3(mix(vec3(0.0), floor((place + 0.5) / side), repeats));
        ivec3 away = turns * ivec3(repeats) * (period / SIMPLEX_STEP);
        cells[i] -= 3 * away + away.x + away.y + away.z;
    }
}

// The fourth root of a corner's weight: 0 from the next tetrahedron on, so that three derivatives are continuous.
float simplex_reach(vec3 away) { return max(0.5 - dot(away, away), 0.0); }

const float SIMPLEX_SCALE = 76.88075;  // 1 / the largest value of the unscaled sum
const float SIMPLEX_DENSITY = 0.5;  // tetrahedra per cell: features become about as large as those of gradient noise
const float SIMPLEX_STEEPEST = 3.44793;  // the steepest slope of simplex_noise within a plane of two axes

// Simplex noise (Perlin 2001), with the gradients and the range of gradient noise.
vec3 simplex_noise(vec3 p, uvec3 seed, ivec3 period) {
    ivec3 cells[4];
    vec3 away[4];
    simplex_corners(p * SIMPLEX_DENSITY, cells, away);
    if (period != LATTICE_PLAIN) simplex_wrap(cells, period);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        uvec3 bits = pcg3d(uvec3(cells[i]) + seed);
        vec3 d = away[i];
        float reach = simplex_reach(d), square = reach * reach;
        sum += square * square * vec3(edge_gradient(bits.x, d), edge_gradient(bits.y, d), edge_gradient(bits.z, d));
    }
    return sum * SIMPLEX_SCALE;
}

vec3 simplex_noise(vec3 p, uvec3 seed) { return simplex_noise(p, seed, LATTICE_PLAIN); }

// The first of the three simplex noises in w, its gradient in xyz.
vec4 simplex_slope(vec3 p, uvec3 seed, ivec3 period) {
    ivec3 cells[4];
    vec3 away[4];
    simplex_corners(p * SIMPLEX_DENSITY, cells, away);
    if (period != LATTICE_PLAIN) simplex_wrap(cells, period);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        uint bits = pcg3d(uvec3(cells[i]) + seed).x;
        float reach = simplex_reach(away[i]), cube = reach * reach * reach, along = edge_gradient(bits, away[i]);
        vec3 edge = vec3(
            edge_gradient(bits, vec3(1.0, 0.0, 0.0)), edge_gradient(bits, vec3(0.0, 1.0, 0.0)),
            edge_gradient(bits, vec3(0.0, 0.0, 1.0))
        );
        sum += cube * vec4(reach * edge - 8.0 * along * away[i], reach * along);
    }
    return sum * SIMPLEX_SCALE * vec4(vec3(SIMPLEX_DENSITY), 1.0);
}

vec4 simplex_slope(vec3 p, uvec3 seed) { return simplex_slope(p, seed, LATTICE_PLAIN); }
