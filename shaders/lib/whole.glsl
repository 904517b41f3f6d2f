// Integer division with a result for every pair: division by 0 is 0. The divisor is never 0 or -1, since a driver that
// divides the smallest int by -1 while it compiles ends the process. Floats are divided as usual.

int halation_quotient(int a, int b) { return b == 0 ? 0 : b == -1 ? -a : a / (b == 0 || b == -1 ? 1 : b); }
int halation_remainder(int a, int b) { return a % (b == 0 || b == -1 ? 1 : b); }
uint halation_quotient(uint a, uint b) { return b == 0u ? 0u : a / max(b, 1u); }
uint halation_remainder(uint a, uint b) { return a % max(b, 1u); }
uint halation_quotient(int a, uint b) { return halation_quotient(uint(a), b); }
uint halation_quotient(uint a, int b) { return halation_quotient(a, uint(b)); }
ivec2 halation_quotient(ivec2 a, ivec2 b) { return ivec2(halation_quotient(a.x, b.x), halation_quotient(a.y, b.y)); }
ivec2 halation_quotient(ivec2 a, int b) { return halation_quotient(a, ivec2(b)); }
ivec2 halation_quotient(int a, ivec2 b) { return halation_quotient(ivec2(a), b); }
ivec3 halation_quotient(ivec3 a, ivec3 b) { return ivec3(halation_quotient(a.x, b.x), halation_quotient(a.y, b.y), halation_quotient(a.z, b.z)); }
ivec3 halation_quotient(ivec3 a, int b) { return halation_quotient(a, ivec3(b)); }
ivec3 halation_quotient(int a, ivec3 b) { return halation_quotient(ivec3(a), b); }
ivec4 halation_quotient(ivec4 a, ivec4 b) { return ivec4(halation_quotient(a.x, b.x), halation_quotient(a.y, b.y), halation_quotient(a.z, b.z), halation_quotient(a.w, b.w)); }
ivec4 halation_quotient(ivec4 a, int b) { return halation_quotient(a, ivec4(b)); }
ivec4 halation_quotient(int a, ivec4 b) { return halation_quotient(ivec4(a), b); }
uvec2 halation_quotient(uvec2 a, uvec2 b) { return uvec2(halation_quotient(a.x, b.x), halation_quotient(a.y, b.y)); }
uvec2 halation_quotient(uvec2 a, uint b) { return halation_quotient(a, uvec2(b)); }
uvec2 halation_quotient(uint a, uvec2 b) { return halation_quotient(uvec2(a), b); }
uvec3 halation_quotient(uvec3 a, uvec3 b) { return uvec3(halation_quotient(a.x, b.x), halation_quotient(a.y, b.y), halation_quotient(a.z, b.z)); }
uvec3 halation_quotient(uvec3 a, uint b) { return halation_quotient(a, uvec3(b)); }
uvec3 halation_quotient(uint a, uvec3 b) { return halation_quotient(uvec3(a), b); }
uvec4 halation_quotient(uvec4 a, uvec4 b) { return uvec4(halation_quotient(a.x, b.x), halation_quotient(a.y, b.y), halation_quotient(a.z, b.z), halation_quotient(a.w, b.w)); }
uvec4 halation_quotient(uvec4 a, uint b) { return halation_quotient(a, uvec4(b)); }
uvec4 halation_quotient(uint a, uvec4 b) { return halation_quotient(uvec4(a), b); }
uint halation_remainder(int a, uint b) { return halation_remainder(uint(a), b); }
uint halation_remainder(uint a, int b) { return halation_remainder(a, uint(b)); }
ivec2 halation_remainder(ivec2 a, ivec2 b) { return ivec2(halation_remainder(a.x, b.x), halation_remainder(a.y, b.y)); }
ivec2 halation_remainder(ivec2 a, int b) { return halation_remainder(a, ivec2(b)); }
ivec2 halation_remainder(int a, ivec2 b) { return halation_remainder(ivec2(a), b); }
ivec3 halation_remainder(ivec3 a, ivec3 b) { return ivec3(halation_remainder(a.x, b.x), halation_remainder(a.y, b.y), halation_remainder(a.z, b.z)); }
ivec3 halation_remainder(ivec3 a, int b) { return halation_remainder(a, ivec3(b)); }
ivec3 halation_remainder(int a, ivec3 b) { return halation_remainder(ivec3(a), b); }
ivec4 halation_remainder(ivec4 a, ivec4 b) { return ivec4(halation_remainder(a.x, b.x), halation_remainder(a.y, b.y), halation_remainder(a.z, b.z), halation_remainder(a.w, b.w)); }
ivec4 halation_remainder(ivec4 a, int b) { return halation_remainder(a, ivec4(b)); }
ivec4 halation_remainder(int a, ivec4 b) { return halation_remainder(ivec4(a), b); }
uvec2 halation_remainder(uvec2 a, uvec2 b) { return uvec2(halation_remainder(a.x, b.x), halation_remainder(a.y, b.y)); }
uvec2 halation_remainder(uvec2 a, uint b) { return halation_remainder(a, uvec2(b)); }
uvec2 halation_remainder(uint a, uvec2 b) { return halation_remainder(uvec2(a), b); }
uvec3 halation_remainder(uvec3 a, uvec3 b) { return uvec3(halation_remainder(a.x, b.x), halation_remainder(a.y, b.y), halation_remainder(a.z, b.z)); }
uvec3 halation_remainder(uvec3 a, uint b) { return halation_remainder(a, uvec3(b)); }
uvec3 halation_remainder(uint a, uvec3 b) { return halation_remainder(uvec3(a), b); }
uvec4 halation_remainder(uvec4 a, uvec4 b) { return uvec4(halation_remainder(a.x, b.x), halation_remainder(a.y, b.y), halation_remainder(a.z, b.z), halation_remainder(a.w, b.w)); }
uvec4 halation_remainder(uvec4 a, uint b) { return halation_remainder(a, uvec4(b)); }
uvec4 halation_remainder(uint a, uvec4 b) { return halation_remainder(uvec4(a), b); }
vec2 halation_quotient(vec2 a, vec2 b) { return a / b; }
vec2 halation_quotient(vec2 a, float b) { return a / b; }
vec2 halation_quotient(float a, vec2 b) { return a / b; }
vec3 halation_quotient(vec3 a, vec3 b) { return a / b; }
vec3 halation_quotient(vec3 a, float b) { return a / b; }
vec3 halation_quotient(float a, vec3 b) { return a / b; }
vec4 halation_quotient(vec4 a, vec4 b) { return a / b; }
vec4 halation_quotient(vec4 a, float b) { return a / b; }
vec4 halation_quotient(float a, vec4 b) { return a / b; }
mat2 halation_quotient(mat2 a, mat2 b) { return a / b; }
mat2 halation_quotient(mat2 a, float b) { return a / b; }
mat2 halation_quotient(float a, mat2 b) { return a / b; }
mat3 halation_quotient(mat3 a, mat3 b) { return a / b; }
mat3 halation_quotient(mat3 a, float b) { return a / b; }
mat3 halation_quotient(float a, mat3 b) { return a / b; }
mat4 halation_quotient(mat4 a, mat4 b) { return a / b; }
mat4 halation_quotient(mat4 a, float b) { return a / b; }
mat4 halation_quotient(float a, mat4 b) { return a / b; }
float halation_quotient(float a, float b) { return a / b; }
