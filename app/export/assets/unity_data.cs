// What Passes.json says: which programs of the shader run in which order, what they read and write, and how numbers
// follow the controls. Knobs are numbers of controls, in the order in which the feature lists them; the frame is the
// last one. -1 is what is not there.
/*HEAD*/
using System;

namespace /*NAMESPACE*/
{
    [Serializable]
    public sealed class LookData
    {
        public int firstFrame;
        public int lastFrame;
        public double rate;
        /// <summary>How many textures the next frame reads.</summary>
        public int memories;
        public AxisData[] axes;
        public SlotData[] slots;
        public PictureData[] sources;
        public PictureData[] tables;
        /// <summary>The passes of the first frame, where later ones read it; one plan for each span of the axes.</summary>
        public PlanData[] openings;
        public PlanData[] plans;
    }

    /// <summary>A knob that changes which passes there are, and the values between which they are others.</summary>
    [Serializable]
    public sealed class AxisData
    {
        public int knob;
        public double[] edges;
    }

    /// <summary>Numbers of a uniform, and the curve of each knob that changes them.</summary>
    [Serializable]
    public sealed class SlotData
    {
        public double[] start;
        public bool multiplies;
        public bool whole;
        public CurveData[] curves;
        public GridData[] grids;
    }

    /// <summary>Rows of numbers at places of a knob, one row after another.</summary>
    [Serializable]
    public sealed class CurveData
    {
        public int knob;
        public bool snaps;
        public double[] at;
        public double[] values;
    }

    /// <summary>What two knobs change together: rows of numbers; those of the second knob follow each other.</summary>
    [Serializable]
    public sealed class GridData
    {
        public int first;
        public int second;
        public double[] firstAt;
        public double[] secondAt;
        public double[] values;
    }

    /// <summary>A picture or a table of colors in a file.</summary>
    [Serializable]
    public sealed class PictureData
    {
        public int width;
        public int height;
        public int depth;
        public string format;
        public bool linear;
        public int blob;
        /// <summary>What Unity gives in its place: picture, depth, normal, or nothing.</summary>
        public string role;
    }

    [Serializable]
    public sealed class PlanData
    {
        public SurfaceData[] surfaces;
        public PassData[] passes;
        public int output;
        /// <summary>The surface that each memory keeps for the next frame.</summary>
        public int[] kept;
    }

    /// <summary>A texture: drawn by passes, or a source, a list of numbers (a slot) or a memory by its number.</summary>
    [Serializable]
    public sealed class SurfaceData
    {
        public int width;
        public int height;
        public string format;
        public int source;
        public int numbers;
        public int memory;
    }

    [Serializable]
    public sealed class PassData
    {
        public string name;
        /// <summary>The pass of the shader.</summary>
        public int pass;
        /// <summary>Vectors that the program is given.</summary>
        public int rows;
        public int[] targets;
        public UniformData[] uniforms;
        public BindingData[] pictures;
        public BindingData[] tables;
    }

    /// <summary>Where numbers of a slot go: so many in each vector, from a row on.</summary>
    [Serializable]
    public sealed class UniformData
    {
        public int row;
        public int group;
        public int slot;
    }

    /// <summary>A property of the shader, and the surface or table that it reads.</summary>
    [Serializable]
    public sealed class BindingData
    {
        public string property;
        public int number;
    }
}
