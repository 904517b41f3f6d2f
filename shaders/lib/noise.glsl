// Lattice noises. Each cell is hashed once and gives three independent noises, each within -1..1.
#include "lib/hash.glsl"

// The cell of a position. The lattice ends where floats have no fractions left, before integers overflow.
ivec3 lattice_cell(vec3 p) { return ivec3(floor(clamp(p, -1e9, 1e9))); }

// A random value for each cell.
vec3 white_noise(vec3 p, uvec3 seed) { return hash3(lattice_cell(p), seed) * 2.0 - 1.0; }

// Interpolation with continuous second derivative (Perlin 2002, "Improving Noise").
vec3 quintic(vec3 t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

// Smooth interpolation between random values at lattice points.
vec3 value_noise(vec3 p, uvec3 seed) {
    ivec3 cell = lattice_cell(p);
    vec3 t = quintic(fract(p));
    vec3 corners[8];
    for (int i = 0; i < 8; i++) corners[i] = hash3(cell + ivec3(i & 1, (i >> 1) & 1, i >> 2), seed);
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
vec3 gradient_noise(vec3 p, uvec3 seed) {
    ivec3 cell = lattice_cell(p);
    vec3 inside = fract(p), t = quintic(inside);
    vec3 corners[8];
    for (int i = 0; i < 8; i++) {
        ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
        uvec3 bits = pcg3d(uvec3(cell + corner) + seed);
        vec3 d = inside - vec3(corner);
        corners[i] = vec3(edge_gradient(bits.x, d), edge_gradient(bits.y, d), edge_gradient(bits.z, d));
    }
    for (int i = 0; i < 4; i++) corners[i] = mix(corners[2 * i], corners[2 * i + 1], t.x);
    vec3 near = mix(corners[0], corners[1], t.y), far = mix(corners[2], corners[3], t.y);
    return mix(near, far, t.z) * 0.9649214;
}

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

// The fourth root of a corner's weight: 0 from the next tetrahedron on, so that three derivatives are continuous.
float simplex_reach(vec3 away) { return max(0.5 - dot(away, away), 0.0); }

const float SIMPLEX_SCALE = 76.88075;  // 1 / the largest value of the unscaled sum
const float SIMPLEX_DENSITY = 0.5;  // tetrahedra per cell: features become about as large as those of gradient noise
const float SIMPLEX_STEEPEST = 3.44793;  // the steepest slope of simplex_noise within a plane of two axes

// Simplex noise (Perlin 2001), with the gradients and the range of gradient noise.
vec3 simplex_noise(vec3 p, uvec3 seed) {
    ivec3 cells[4];
    vec3 away[4];
    simplex_corners(p * SIMPLEX_DENSITY, cells, away);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        uvec3 bits = pcg3d(uvec3(cells[i]) + seed);
        vec3 d = away[i];
        float reach = simplex_reach(d), square = reach * reach;
        sum += square * square * vec3(edge_gradient(bits.x, d), edge_gradient(bits.y, d), edge_gradient(bits.z, d));
    }
    return sum * SIMPLEX_SCALE;
}

// The first of the three simplex noises in w, its gradient in xyz.
vec4 simplex_slope(vec3 p, uvec3 seed) {
    ivec3 cells[4];
    vec3 away[4];
    simplex_corners(p * SIMPLEX_DENSITY, cells, away);
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
