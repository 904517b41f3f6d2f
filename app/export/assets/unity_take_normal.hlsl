// Normals as the camera sees them: x right, y up, z toward the camera. Unity stores those of the world.
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/DeclareNormalsTexture.hlsl"
float4 _Target;  // width and height of the target
float4 Draw(float4 place : SV_Position) : SV_Target
{
    float3 world = SampleSceneNormals(float2(place.x / _Target.x, 1.0 - place.y / _Target.y));
    float3 seen = mul((float3x3)UNITY_MATRIX_V, world);
    return float4(dot(world, world) > 0.0 ? normalize(seen) : float3(0.0, 0.0, 0.0), 1.0);
}
