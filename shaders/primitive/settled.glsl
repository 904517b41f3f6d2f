// Keeps the driver's compiler from optimizing across the border between two fused functions, so that fused and unfused
// passes give the same bits. `seam` is always zero, but the driver does not know that. It has a part for each channel,
// so that channels that are equal are not simplified together.

float settled(float v, uvec4 seam) { return uintBitsToFloat(floatBitsToUint(v) ^ seam.x); }
vec2 settled(vec2 v, uvec4 seam) { return uintBitsToFloat(floatBitsToUint(v) ^ seam.xy); }
vec3 settled(vec3 v, uvec4 seam) { return uintBitsToFloat(floatBitsToUint(v) ^ seam.xyz); }
vec4 settled(vec4 v, uvec4 seam) { return uintBitsToFloat(floatBitsToUint(v) ^ seam); }
