// Integer hashes: the same bits with every driver.
#include "lib/pi.glsl"

// The hash pcg3d (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering").
uvec3 pcg3d(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Numbers in 0 <= u < 1 with 24 bits, the precision of a float.
vec3 unit_float(uvec3 bits) { return vec3(bits >> 8u) * (1.0 / 16777216.0); }

// Three independent uniform random numbers for a lattice cell.
vec3 hash3(ivec3 cell, uvec3 seed) { return unit_float(pcg3d(uvec3(cell) + seed)); }

// Three independent normally distributed numbers for a lattice cell, mean 0 and variance 1 (Box and Muller 1958).
vec3 normal3(ivec3 cell, uvec3 seed) {
    uvec3 bits = pcg3d(uvec3(cell) + seed);
    return sqrt(-2.0 * log(1.0 - unit_float(bits))) * cos(2.0 * PI * unit_float(pcg3d(bits)));
}
