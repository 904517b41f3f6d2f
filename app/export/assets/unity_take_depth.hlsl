// The distance along the view in meters, 1e10 for the sky.
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/DeclareDepthTexture.hlsl"
float4 _Target;  // width and height of the target
float4 Draw(float4 place : SV_Position) : SV_Target
{
    float depth = SampleSceneDepth(float2(place.x / _Target.x, 1.0 - place.y / _Target.y));
#if UNITY_REVERSED_Z
    float part = 1.0 - depth;
#else
    float part = depth;
#endif
    float flat = lerp(_ProjectionParams.y, _ProjectionParams.z, part);
    float distance = unity_OrthoParams.w > 0.0 ? flat : LinearEyeDepth(depth, _ZBufferParams);
    return float4(part < 1.0 ? distance : 1e10, 0.0, 0.0, 1.0);
}
