// A picture that the next frame reads.
Texture2D<float4> _Given;
float4 Draw(float4 place : SV_Position) : SV_Target
{
    return _Given.Load(int3(place.xy, 0));
}
