// A picture upside down, at another size: Unity's first row is the lowest one, that of the look the highest.
float4 _Target;  // width and height of the target; 1 if the picture has one channel alone
Texture2D<float4> _Given;
SamplerState sampler_linear_clamp;
float4 Draw(float4 place : SV_Position) : SV_Target
{
    float2 uv = float2(place.x / _Target.x, 1.0 - place.y / _Target.y);
    float4 given = _Given.SampleLevel(sampler_linear_clamp, uv, 0.0);
    return float4(_Target.z > 0.0 ? given.rrr : given.rgb, 1.0);
}
