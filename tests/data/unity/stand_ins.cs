// What Unity 6 and its Universal Render Pipeline declare, as far as exported looks use it: signatures without a body, from
// Unity's reference of scripting and of the packages core and universal 17. The compiler checks exported scripts by them.
using System;

namespace UnityEngine
{
    public class Object { public string name { get; set; } }
    public class ScriptableObject : Object { }
    public class Material : Object { }
    public class Shader : Object { public static int PropertyToID(string name) => 0; }
    public class Camera : Object { }
    public class TextAsset : Object { public byte[] bytes => null; public string text => null; }
    public enum TextureWrapMode { Repeat, Clamp }
    public enum FilterMode { Point, Bilinear }
    public enum TextureFormat { RHalf, RGHalf, RGBAHalf, RFloat, RGFloat, RGBAFloat }
    public enum CameraType { Game = 1, SceneView = 2, Preview = 4, VR = 8, Reflection = 16 }
    public enum MeshTopology { Triangles, Quads = 2 }
    public class Texture : Object
    {
        public TextureWrapMode wrapMode { get; set; }
        public FilterMode filterMode { get; set; }
    }
    public class Texture2D : Texture
    {
        public Texture2D(int width, int height, TextureFormat textureFormat, bool mipChain, bool linear) { }
        public void SetPixelData<T>(T[] data, int mipLevel, int sourceDataStartIndex = 0) { }
        public void Apply(bool updateMipmaps, bool makeNoLongerReadable) { }
    }
    public class Texture3D : Texture
    {
        public Texture3D(int width, int height, int depth, TextureFormat textureFormat, bool mipChain) { }
        public void SetPixelData<T>(T[] data, int mipLevel, int sourceDataStartIndex = 0) { }
        public void Apply(bool updateMipmaps, bool makeNoLongerReadable) { }
    }
    public class RenderTexture : Texture
    {
        public RenderTexture(int width, int height, int depth, Experimental.Rendering.GraphicsFormat format) { }
    }
    public struct Vector2 { public float x, y; public Vector2(float x, float y) { this.x = x; this.y = y; } }
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }
    public struct Vector4
    {
        public float x, y, z, w;
        public Vector4(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
        public static Vector4 zero => default(Vector4);
    }
    public struct Color
    {
        public float r, g, b, a;
        public Color(float r, float g, float b) { this.r = r; this.g = g; this.b = b; a = 1f; }
        public Color(float r, float g, float b, float a) { this.r = r; this.g = g; this.b = b; this.a = a; }
    }
    public struct Matrix4x4 { public static Matrix4x4 identity => default(Matrix4x4); }
    public sealed class MaterialPropertyBlock
    {
        public void SetTexture(int nameID, Texture value) { }
        public void SetVector(int nameID, Vector4 value) { }
        public void SetVectorArray(int nameID, Vector4[] values) { }
    }
    public static class Resources { public static T Load<T>(string path) where T : Object => null; }
    public static class JsonUtility { public static T FromJson<T>(string json) => default(T); }
    public static class Debug { public static void LogError(object message) { } }
    public static class Time { public static double realtimeSinceStartupAsDouble => 0.0; }
    public class PropertyAttribute : Attribute { }
    [AttributeUsage(AttributeTargets.Field)]
    public sealed class RangeAttribute : PropertyAttribute { public RangeAttribute(float min, float max) { } }
    [AttributeUsage(AttributeTargets.Field)]
    public class TooltipAttribute : PropertyAttribute { public TooltipAttribute(string tooltip) { } }
    [AttributeUsage(AttributeTargets.Field)]
    public sealed class ColorUsageAttribute : PropertyAttribute { public ColorUsageAttribute(bool showAlpha, bool hdr) { } }
    [AttributeUsage(AttributeTargets.Field)]
    public class InspectorNameAttribute : PropertyAttribute { public InspectorNameAttribute(string displayName) { } }
}

namespace UnityEngine.Experimental.Rendering
{
    public enum GraphicsFormat
    {
        R16_SFloat, R16G16_SFloat, R16G16B16A16_SFloat, R32_SFloat, R32G32_SFloat, R32G32B32A32_SFloat
    }
}

namespace UnityEngine.Rendering
{
    public static class CoreUtils
    {
        public static void Destroy(Object obj) { }
        public static Material CreateEngineMaterial(Shader shader) => null;
    }
    public class RTHandle { public RenderTexture rt => null; public void Release() { } }
    public static class RTHandles { public static RTHandle Alloc(RenderTexture tex) => null; }
    public class ContextItem { }
    public class ContextContainer { public T Get<T>() where T : ContextItem, new() => null; }
    public class RasterCommandBuffer
    {
        public void DrawProcedural(
            Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, int vertexCount,
            int instanceCount, MaterialPropertyBlock properties) { }
    }
}

namespace UnityEngine.Rendering.RenderGraphModule
{
    [Flags] public enum AccessFlags { None = 0, Read = 1, Write = 2 }
    public struct TextureHandle
    {
        public static TextureHandle nullHandle => default(TextureHandle);
        public TextureDesc GetDescriptor(RenderGraph renderGraph) => default(TextureDesc);
        public static implicit operator Texture(TextureHandle texture) => null;
    }
    public struct TextureDesc
    {
        public int width, height;
        public string name;
        public FilterMode filterMode;
        public TextureWrapMode wrapMode;
        public Experimental.Rendering.GraphicsFormat colorFormat { get; set; }
        public TextureDesc(int width, int height, bool dynamicResolution = false, bool xrReady = false) : this() { }
    }
    public struct RasterGraphContext { public RasterCommandBuffer cmd; }
    public delegate void BaseRenderFunc<PassData, ContextType>(PassData data, ContextType renderGraphContext)
        where PassData : class, new();
    public interface IBaseRenderGraphBuilder : IDisposable
    {
        void UseTexture(in TextureHandle input, AccessFlags flags = AccessFlags.Read);
        void UseAllGlobalTextures(bool enable);
    }
    public interface IRasterRenderGraphBuilder : IBaseRenderGraphBuilder
    {
        void SetRenderAttachment(TextureHandle tex, int index, AccessFlags flags = AccessFlags.Write);
        void SetRenderFunc<PassData>(BaseRenderFunc<PassData, RasterGraphContext> renderFunc) where PassData : class, new();
    }
    public class RenderGraph
    {
        public TextureHandle ImportTexture(RTHandle rt) => default(TextureHandle);
        public TextureHandle CreateTexture(in TextureDesc desc) => default(TextureHandle);
        public IRasterRenderGraphBuilder AddRasterRenderPass<PassData>(string passName, out PassData passData)
            where PassData : class, new() { passData = null; return null; }
    }
}

namespace UnityEngine.Rendering.Universal
{
    using UnityEngine.Rendering.RenderGraphModule;
    public enum RenderPassEvent { BeforeRenderingPostProcessing = 550 }
    [Flags] public enum ScriptableRenderPassInput { None = 0, Depth = 1, Normal = 2, Color = 4, Motion = 8 }
    public abstract class ScriptableRenderPass
    {
        public RenderPassEvent renderPassEvent { get; set; }
        public bool requiresIntermediateTexture { get; set; }
        public void ConfigureInput(ScriptableRenderPassInput passInput) { }
        public virtual void RecordRenderGraph(RenderGraph renderGraph, ContextContainer frameData) { }
    }
    public struct CameraData { public CameraType cameraType; }
    public struct RenderingData { public CameraData cameraData; }
    public abstract class ScriptableRenderer { public void EnqueuePass(ScriptableRenderPass pass) { } }
    public abstract class ScriptableRendererFeature : ScriptableObject, IDisposable
    {
        public abstract void Create();
        public abstract void AddRenderPasses(ScriptableRenderer renderer, ref RenderingData renderingData);
        public void Dispose() { }
        protected virtual void Dispose(bool disposing) { }
    }
    public class UniversalCameraData : ContextItem { public Camera camera; }
    public class UniversalResourceData : ContextItem
    {
        public TextureHandle activeColorTexture => default(TextureHandle);
        public TextureHandle cameraDepthTexture => default(TextureHandle);
        public TextureHandle cameraNormalsTexture => default(TextureHandle);
        public bool isActiveTargetBackBuffer => false;
    }
}
