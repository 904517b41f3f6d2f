// Keeps the compiler from optimizing across the seam between two fused functions, so that fused and unfused passes
// give the same bits. `seam` is always zero, but only we know that; it has a part for every channel, lest channels
// that are known to be equal be simplified together.

float settled(float v, uvec4 seam) { return uintBitsToFloat(floatBitsToUint(v) ^ seam.x); }
vec2 settled(vec2 v, uvec4 seam) { return uintBitsToFloat(floatBitsToUint(v) ^ seam.xy); }
vec3 settled(vec3 v, uvec4 seam) { return uintBitsToFloat(floatBitsToUint(v) ^ seam.xyz); }
vec4 settled(vec4 v, uvec4 seam) { return uintBitsToFloat(floatBitsToUint(v) ^ seam); }
