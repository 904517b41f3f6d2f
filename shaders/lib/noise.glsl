// Lattice noises. Every cell is hashed once and gives three independent noises, each within -1..1.
#include "lib/hash.glsl"

// Far out, where floats have no fractions left, the lattice ends instead of overflowing.
ivec3 lattice_cell(vec3 p) { return ivec3(floor(clamp(p, -1e9, 1e9))); }

vec3 white_noise(vec3 p, uvec3 seed) { return hash3(lattice_cell(p), seed) * 2.0 - 1.0; }

// Smooth to the second derivative (Perlin 2002, "Improving Noise").
vec3 quintic(vec3 t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

vec3 value_noise(vec3 p, uvec3 seed) {
    ivec3 cell = lattice_cell(p);
    vec3 t = quintic(fract(p));
    vec3 corners[8];
    for (int i = 0; i < 8; i++) corners[i] = hash3(cell + ivec3(i & 1, (i >> 1) & 1, i >> 2), seed);
    for (int i = 0; i < 4; i++) corners[i] = mix(corners[2 * i], corners[2 * i + 1], t.x);
    vec3 near = mix(corners[0], corners[1], t.y), far = mix(corners[2], corners[3], t.y);
    return mix(near, far, t.z) * 2.0 - 1.0;
}

// The dot product with one of Perlin's twelve cube edges (four appear twice), picked by the top four bits.
float edge_gradient(uint bits, vec3 d) {
    uint h = bits >> 28u;
    float u = h < 8u ? d.x : d.y;
    float v = h < 4u ? d.y : (h == 12u || h == 14u) ? d.x : d.z;
    return ((h & 1u) == 0u ? u : -u) + ((h & 2u) == 0u ? v : -v);
}

// Perlin 2002, scaled by the largest value that it can reach: zero at every lattice point.
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
