#pragma target 4.5
#pragma vertex Cover
#pragma fragment Draw

// One triangle over all pixels.
float4 Cover(uint id : SV_VertexID) : SV_Position
{
    return float4(float2((id << 1) & 2, id & 2) * 2.0 - 1.0, 0.5, 1.0);
}
