// What all looks have in common: a feature of the Universal Render Pipeline, which draws a look over each camera.
/*HEAD*/
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.Rendering.Universal;

namespace /*NAMESPACE*/
{
    public abstract class LookFeature : ScriptableRendererFeature
    {
        LookPass pass;
        LookTextures textures;
        Material material;

        /// <summary>The folder in Resources that has the shader, the passes and the pixels.</summary>
        protected abstract string Folder { get; }

        /// <summary>The values of the controls, in the order of the knobs of Passes.json, without the frame.</summary>
        protected abstract double[] ListKnobs();

        /// <summary>The frame that is held, or a lower number than the first one to let time run.</summary>
        protected virtual int ChooseFrame()
        {
            return int.MinValue;
        }

        public override void Create()
        {
            Dispose(true);
            var text = Resources.Load<TextAsset>(Folder + "/Passes");
            var shader = Resources.Load<Shader>(Folder + "/Look");
            if (text == null || shader == null)
            {
                Debug.LogError("The files of " + Folder + " are in no folder named Resources");
                return;
            }
            var data = JsonUtility.FromJson<LookData>(text.text);
            textures = new LookTextures(Folder, data);
            material = CoreUtils.CreateEngineMaterial(shader);
            pass = new LookPass(data, textures, material) { renderPassEvent = RenderPassEvent.BeforeRenderingPostProcessing };
        }

        public override void AddRenderPasses(ScriptableRenderer renderer, ref RenderingData renderingData)
        {
            CameraType camera = renderingData.cameraData.cameraType;
            if (pass == null || camera == CameraType.Preview || camera == CameraType.Reflection)
                return;
            pass.SetKnobs(ListKnobs(), ChooseFrame());
            renderer.EnqueuePass(pass);
        }

        protected override void Dispose(bool disposing)
        {
            pass?.Dispose();
            textures?.Dispose();
            CoreUtils.Destroy(material);
            pass = null;
            textures = null;
            material = null;
        }
    }
}
