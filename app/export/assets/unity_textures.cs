// The textures of a look: pictures and tables from files, and lists of numbers that follow the controls.
/*HEAD*/
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Experimental.Rendering;
using UnityEngine.Rendering;

namespace /*NAMESPACE*/
{
    public sealed class LookTextures : IDisposable
    {
        readonly string folder;
        readonly LookData data;
        readonly Dictionary<int, Texture> sources = new Dictionary<int, Texture>();
        readonly Dictionary<int, Texture> tables = new Dictionary<int, Texture>();
        readonly Dictionary<string, Texture2D> lists = new Dictionary<string, Texture2D>();

        public LookTextures(string folder, LookData data)
        {
            this.folder = folder;
            this.data = data;
        }

        public void Dispose()
        {
            foreach (Texture texture in sources.Values)
                CoreUtils.Destroy(texture);
            foreach (Texture texture in tables.Values)
                CoreUtils.Destroy(texture);
            foreach (Texture2D texture in lists.Values)
                CoreUtils.Destroy(texture);
        }

        /// <summary>The format of a texture that passes draw into.</summary>
        public static GraphicsFormat FindFormat(string format)
        {
            switch (format)
            {
                case "r16f": return GraphicsFormat.R16_SFloat;
                case "rg16f": return GraphicsFormat.R16G16_SFloat;
                case "rgba16f": return GraphicsFormat.R16G16B16A16_SFloat;
                case "r32f": return GraphicsFormat.R32_SFloat;
                case "rg32f": return GraphicsFormat.R32G32_SFloat;
                default: return GraphicsFormat.R32G32B32A32_SFloat;
            }
        }

        static TextureFormat FindFileFormat(string format)
        {
            switch (format)
            {
                case "r16f": return TextureFormat.RHalf;
                case "rg16f": return TextureFormat.RGHalf;
                case "rgba16f": return TextureFormat.RGBAHalf;
                case "r32f": return TextureFormat.RFloat;
                case "rg32f": return TextureFormat.RGFloat;
                default: return TextureFormat.RGBAFloat;
            }
        }

        /// <summary>A picture from a file.</summary>
        public Texture FindSource(int number)
        {
            if (!sources.TryGetValue(number, out Texture texture))
            {
                texture = Load(data.sources[number]);
                sources[number] = texture;
            }
            return texture;
        }

        /// <summary>A table of colors; its sampler in the shader filters as the texture says.</summary>
        public Texture FindTable(int number)
        {
            if (!tables.TryGetValue(number, out Texture texture))
            {
                texture = Load(data.tables[number]);
                tables[number] = texture;
            }
            return texture;
        }

        Texture Load(PictureData record)
        {
            byte[] pixels = Resources.Load<TextAsset>(folder + "/pixels/" + record.blob).bytes;
            Texture texture;
            if (record.depth > 1)
            {
                var deep = new Texture3D(
                    record.width, record.height, record.depth, FindFileFormat(record.format), false);
                deep.SetPixelData(pixels, 0);
                deep.Apply(false, true);
                texture = deep;
            }
            else
            {
                Texture2D flat = MakeFlat(record.width, record.height, record.format);
                flat.SetPixelData(pixels, 0);
                flat.Apply(false, true);
                texture = flat;
            }
            texture.wrapMode = TextureWrapMode.Clamp;
            texture.filterMode = record.linear ? FilterMode.Bilinear : FilterMode.Point;
            return texture;
        }

        static Texture2D MakeFlat(int width, int height, string format)
        {
            return new Texture2D(width, height, FindFileFormat(format), false, true);
        }

        /// <summary>A table that a node made of its values: height, width, channels, and the numbers.</summary>
        public Texture FillList(int slot, string format, double[] knobs)
        {
            double[] numbers = LookNumbers.FindNumbers(data, slot, knobs);
            int height = (int)Math.Round(numbers[0]);
            int width = (int)Math.Round(numbers[1]);
            int channels = (int)Math.Round(numbers[2]);
            int given = format.Length - 3;
            string key = slot + " " + width + " " + height;
            if (!lists.TryGetValue(key, out Texture2D texture))
            {
                texture = MakeFlat(width, height, format.Replace("16f", "32f"));
                lists[key] = texture;
            }
            var pixels = new float[width * height * given];
            for (int pixel = 0; pixel < width * height; pixel++)
            {
                for (int channel = 0; channel < channels; channel++)
                    pixels[pixel * given + channel] = (float)numbers[3 + pixel * channels + channel];
            }
            texture.SetPixelData(pixels, 0);
            texture.Apply(false, false);
            return texture;
        }
    }
}
