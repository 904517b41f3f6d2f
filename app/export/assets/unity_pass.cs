// Runs the passes of a look in the render graph of Unity 6: each is one triangle over its targets.
/*HEAD*/
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.Rendering.RenderGraphModule;
using UnityEngine.Rendering.Universal;

namespace /*NAMESPACE*/
{
    public sealed class LookPass : ScriptableRenderPass, IDisposable
    {
        // The passes of the shader before those of the look.
        const int TakePicture = 0;
        const int TakeDepth = 1;
        const int TakeNormal = 2;
        const int Show = 3;
        const int Copy = 4;

        static readonly int Numbers = Shader.PropertyToID("_Numbers");
        static readonly int Target = Shader.PropertyToID("_Target");
        static readonly int Given = Shader.PropertyToID("_Given");

        /// <summary>What a pass is given when it is drawn.</summary>
        sealed class DrawData
        {
            public Material material;
            public int pass;
            public MaterialPropertyBlock block;
            public Vector4[] rows;
            public Vector4 target;
            public readonly List<KeyValuePair<int, TextureHandle>> drawn = new List<KeyValuePair<int, TextureHandle>>();
            public readonly List<KeyValuePair<int, Texture>> known = new List<KeyValuePair<int, Texture>>();
        }

        /// <summary>What one camera keeps for its next frame; two sets, one read and one written in turn.</summary>
        sealed class Memory
        {
            public readonly RTHandle[][] sets = { null, null };
            public int turn;
            public bool isFilled;
        }

        readonly LookData data;
        readonly LookTextures textures;
        readonly Material material;
        readonly Dictionary<Camera, Memory> memories = new Dictionary<Camera, Memory>();
        readonly Dictionary<PassData, MaterialPropertyBlock> blocks = new Dictionary<PassData, MaterialPropertyBlock>();
        double[] knobs;
        int heldFrame;

        public LookPass(LookData data, LookTextures textures, Material material)
        {
            this.data = data;
            this.textures = textures;
            this.material = material;
            requiresIntermediateTexture = true;
            var input = ScriptableRenderPassInput.Color;
            foreach (PictureData source in data.sources)
            {
                if (source.role == "depth")
                    input |= ScriptableRenderPassInput.Depth;
                if (source.role == "normal")
                    input |= ScriptableRenderPassInput.Normal;
            }
            ConfigureInput(input);
        }

        public void Dispose()
        {
            foreach (Memory memory in memories.Values)
            {
                foreach (RTHandle[] set in memory.sets)
                    Release(set);
            }
            memories.Clear();
        }

        static void Release(RTHandle[] set)
        {
            foreach (RTHandle handle in set ?? new RTHandle[0])
            {
                RenderTexture texture = handle.rt;
                handle.Release();
                CoreUtils.Destroy(texture);
            }
        }

        public void SetKnobs(double[] values, int frame)
        {
            knobs = values;
            heldFrame = frame;
        }

        public override void RecordRenderGraph(RenderGraph graph, ContextContainer frameData)
        {
            var resources = frameData.Get<UniversalResourceData>();
            Camera camera = frameData.Get<UniversalCameraData>().camera;
            if (resources.isActiveTargetBackBuffer)
                return;
            if (!memories.TryGetValue(camera, out Memory memory))
                memories[camera] = memory = new Memory();
            double[] values = JoinFrame();
            PlanData plan = LookNumbers.ChoosePlan(data, values, !memory.isFilled);
            var drawn = new TextureHandle[plan.surfaces.Length];
            var known = new Texture[plan.surfaces.Length];
            for (int at = 0; at < plan.surfaces.Length; at++)
                FindSurface(graph, resources, plan.surfaces[at], at, memory, values, drawn, known);
            foreach (PassData pass in plan.passes)
                RecordPass(graph, plan, pass, values, drawn, known);
            Keep(graph, plan, memory, drawn, known);
            TextureHandle screen = resources.activeColorTexture;
            TextureDesc size = screen.GetDescriptor(graph);
            int channels = plan.surfaces[plan.output].format.Length - 3;
            var target = new Vector4(size.width, size.height, channels == 1 ? 1f : 0f, 0f);
            RecordOwn(graph, "Look", Show, drawn[plan.output], known[plan.output], screen, target);
        }

        /// <summary>The values of the controls, and the frame behind them.</summary>
        double[] JoinFrame()
        {
            int count = data.lastFrame - data.firstFrame + 1;
            int played = (int)((long)(Time.realtimeSinceStartupAsDouble * data.rate) % count);
            int frame = heldFrame < data.firstFrame ? data.firstFrame + played : Math.Min(heldFrame, data.lastFrame);
            var values = new double[knobs.Length + 1];
            knobs.CopyTo(values, 0);
            values[knobs.Length] = frame;
            return values;
        }

        // --- textures -----------------------------------------------------------------------------------------------

        /// <summary>The texture of a surface: drawn in this frame, or known before.</summary>
        void FindSurface(
            RenderGraph graph, UniversalResourceData resources, SurfaceData surface, int at, Memory memory,
            double[] values, TextureHandle[] drawn, Texture[] known)
        {
            if (surface.memory >= 0)
            {
                drawn[at] = graph.ImportTexture(memory.sets[memory.turn][surface.memory]);
                return;
            }
            if (surface.numbers >= 0)
            {
                known[at] = textures.FillList(surface.numbers, surface.format, values);
                return;
            }
            string role = surface.source >= 0 ? data.sources[surface.source].role : "";
            if (surface.source >= 0 && string.IsNullOrEmpty(role))
            {
                known[at] = textures.FindSource(surface.source);
                return;
            }
            drawn[at] = graph.CreateTexture(new TextureDesc(surface.width, surface.height)
            {
                colorFormat = LookTextures.FindFormat(surface.format),
                name = "Look " + at,
                filterMode = FilterMode.Point,
                wrapMode = TextureWrapMode.Clamp,
            });
            if (surface.source >= 0)
                RecordTake(graph, resources, role, drawn[at], surface);
        }

        /// <summary>Copies of what the next frame reads, in textures of their own.</summary>
        void Keep(RenderGraph graph, PlanData plan, Memory memory, TextureHandle[] drawn, Texture[] known)
        {
            if (data.memories == 0)
                return;
            int next = 1 - memory.turn;
            if (memory.sets[next] == null)
                memory.sets[next] = MakeSet(plan);
            for (int at = 0; at < data.memories; at++)
            {
                TextureHandle kept = graph.ImportTexture(memory.sets[next][at]);
                RecordOwn(graph, "Look keeps a picture", Copy, drawn[plan.kept[at]], known[plan.kept[at]], kept, Vector4.zero);
            }
            memory.turn = next;
            memory.isFilled = true;
        }

        static RTHandle[] MakeSet(PlanData plan)
        {
            var set = new RTHandle[plan.kept.Length];
            for (int at = 0; at < set.Length; at++)
            {
                SurfaceData surface = plan.surfaces[plan.kept[at]];
                var texture = new RenderTexture(
                    surface.width, surface.height, 0, LookTextures.FindFormat(surface.format));
                set[at] = RTHandles.Alloc(texture);
            }
            return set;
        }

        // --- passes -------------------------------------------------------------------------------------------------

        void RecordPass(
            RenderGraph graph, PlanData plan, PassData pass, double[] values, TextureHandle[] drawn, Texture[] known)
        {
            using (var builder = graph.AddRasterRenderPass<DrawData>("Look " + pass.name, out DrawData draw))
            {
                Prepare(draw, pass.pass, FindBlock(pass));
                draw.rows = pass.rows > 0 ? new Vector4[pass.rows] : null;
                float[] numbers = LookNumbers.FillRows(data, pass, values);
                for (int at = 0; at < pass.rows; at++)
                {
                    draw.rows[at] = new Vector4(
                        numbers[4 * at], numbers[4 * at + 1], numbers[4 * at + 2], numbers[4 * at + 3]);
                }
                foreach (BindingData binding in pass.pictures)
                    Bind(builder, draw, Shader.PropertyToID(binding.property), drawn[binding.number], known[binding.number]);
                foreach (BindingData binding in pass.tables)
                    Bind(builder, draw, Shader.PropertyToID(binding.property), TextureHandle.nullHandle, textures.FindTable(binding.number));
                for (int at = 0; at < pass.targets.Length; at++)
                    builder.SetRenderAttachment(drawn[pass.targets[at]], at);
                builder.SetRenderFunc<DrawData>(Draw);
            }
        }

        void RecordTake(
            RenderGraph graph, UniversalResourceData resources, string role, TextureHandle target, SurfaceData surface)
        {
            int pass = role == "depth" ? TakeDepth : role == "normal" ? TakeNormal : TakePicture;
            TextureHandle given = role == "depth" ? resources.cameraDepthTexture
                : role == "normal" ? resources.cameraNormalsTexture : resources.activeColorTexture;
            var size = new Vector4(surface.width, surface.height, 0f, 0f);
            RecordOwn(graph, "Look takes the " + role, pass, given, null, target, size);
        }

        /// <summary>One of the passes before those of the look. Unity's own code reads depth and normals by name.</summary>
        void RecordOwn(
            RenderGraph graph, string name, int pass, TextureHandle given, Texture known, TextureHandle target, Vector4 size)
        {
            using (var builder = graph.AddRasterRenderPass<DrawData>(name, out DrawData draw))
            {
                Prepare(draw, pass, new MaterialPropertyBlock());
                draw.target = size;
                Bind(builder, draw, Given, given, known);
                if (pass == TakeDepth || pass == TakeNormal)
                    builder.UseAllGlobalTextures(true);
                builder.SetRenderAttachment(target, 0);
                builder.SetRenderFunc<DrawData>(Draw);
            }
        }

        void Prepare(DrawData draw, int pass, MaterialPropertyBlock block)
        {
            draw.material = material;  // the graph uses objects of earlier passes again
            draw.pass = pass;
            draw.block = block;
            draw.rows = null;
            draw.target = Vector4.zero;
            draw.drawn.Clear();
            draw.known.Clear();
        }

        /// <summary>A list of numbers keeps the length that it was given first, so each pass has its own.</summary>
        MaterialPropertyBlock FindBlock(PassData pass)
        {
            if (!blocks.TryGetValue(pass, out MaterialPropertyBlock block))
                blocks[pass] = block = new MaterialPropertyBlock();
            return block;
        }

        static void Bind(
            IRasterRenderGraphBuilder builder, DrawData draw, int property, TextureHandle drawn, Texture known)
        {
            if (known != null)
            {
                draw.known.Add(new KeyValuePair<int, Texture>(property, known));
                return;
            }
            builder.UseTexture(drawn);
            draw.drawn.Add(new KeyValuePair<int, TextureHandle>(property, drawn));
        }

        static void Draw(DrawData draw, RasterGraphContext context)
        {
            foreach (KeyValuePair<int, TextureHandle> picture in draw.drawn)
                draw.block.SetTexture(picture.Key, picture.Value);
            foreach (KeyValuePair<int, Texture> picture in draw.known)
                draw.block.SetTexture(picture.Key, picture.Value);
            if (draw.rows != null)
                draw.block.SetVectorArray(Numbers, draw.rows);
            draw.block.SetVector(Target, draw.target);
            context.cmd.DrawProcedural(
                Matrix4x4.identity, draw.material, draw.pass, MeshTopology.Triangles, 3, 1, draw.block);
        }
    }
}
