// Makes numbers finite: NaN becomes 0 and infinity the largest half float, so that one bad pixel does not spread. Bits
// are tested, because drivers may assume that isnan() is always false.

// True if a number, or every channel, is neither NaN nor infinite.
bool is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
bool is_finite(vec2 v) { return is_finite(v.x) && is_finite(v.y); }
bool is_finite(vec3 v) { return is_finite(v.xy) && is_finite(v.z); }
bool is_finite(vec4 v) { return is_finite(v.xy) && is_finite(v.zw); }

// The number, or 0 for NaN and the largest half float for infinity.
float finite(float x) {
    if (is_finite(x)) return x;
    uint bits = floatBitsToUint(x);
    if ((bits & 0x007fffffu) != 0u) return 0.0;
    return (bits >> 31) == 0u ? 65504.0 : -65504.0;
}

vec2 finite(vec2 v) { return vec2(finite(v.x), finite(v.y)); }
vec3 finite(vec3 v) { return vec3(finite(v.xy), finite(v.z)); }
vec4 finite(vec4 v) { return vec4(finite(v.xy), finite(v.zw)); }
