// Functions that early versions of ReShade FX lack.
int lowest_bit(uint x) { int at = -1; for (int i = 31; i >= 0; --i) { if ((x >> uint(i)) & 1u) { at = i; } } return at; }
int highest_bit(uint x) { int at = -1; for (int i = 0; i < 32; ++i) { if ((x >> uint(i)) & 1u) { at = i; } } return at; }
uint count_bits(uint x) { uint count = 0; for (int i = 0; i < 32; ++i) { count += (x >> uint(i)) & 1u; } return count; }

// One triangle over all pixels.
void cover(in uint id : SV_VertexID, out float4 position : SV_Position) {
    float2 corner = float2(id == 1 ? 2.0 : 0.0, id == 2 ? 2.0 : 0.0);
    position = float4(corner * float2(2.0, -2.0) + float2(-1.0, 1.0), 0.0, 1.0);
}

// The part of a slider between two points.
float part(float x, float low, float high) { return clamp(x - low, 0.0, high - low); }
float4 relative(float4 row, float4 base) {
    return float4(base.x != 0.0 ? row.x / base.x : 1.0, base.y != 0.0 ? row.y / base.y : 1.0,
                  base.z != 0.0 ? row.z / base.z : 1.0, base.w != 0.0 ? row.w / base.w : 1.0);
}

// A number from the four bytes that a pixel of a PNG file holds.
float join_bytes(float4 texel) {
    uint4 bytes = uint4(texel * 255.0 + 0.5);
    return asfloat(bytes.x | (bytes.y << 8) | (bytes.z << 16) | (bytes.w << 24));
}

// The codes of an sRGB screen (IEC 61966-2-1) as light, and back.
float3 decode_srgb(float3 c) { return c <= 0.04045 ? c / 12.92 : pow(abs(c + 0.055) / 1.055, 2.4); }
float3 encode_srgb(float3 c) {
    c = saturate(c);
    return c <= 0.0031308 ? c * 12.92 : 1.055 * pow(abs(c), 1.0 / 2.4) - 0.055;
}
