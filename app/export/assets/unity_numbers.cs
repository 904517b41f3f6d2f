// Which passes run, and the numbers that they are given: all that follows the controls of a look.
/*HEAD*/
using System;

namespace /*NAMESPACE*/
{
    public static class LookNumbers
    {
        /// <summary>The passes for these values: plans are in the order of the axes, the last one changes fastest.</summary>
        public static PlanData ChoosePlan(LookData data, double[] knobs, bool isFirst)
        {
            int index = 0;
            foreach (AxisData axis in data.axes)
            {
                int span = 0;
                foreach (double edge in axis.edges)
                    span += knobs[axis.knob] > edge ? 1 : 0;
                index = index * (axis.edges.Length + 1) + span;
            }
            return (isFirst && data.memories > 0 ? data.openings : data.plans)[index];
        }

        /// <summary>The numbers of a slot: those at rest, and the curve of each knob that changes them.</summary>
        public static double[] FindNumbers(LookData data, int slot, double[] knobs)
        {
            SlotData record = data.slots[slot];
            var numbers = (double[])record.start.Clone();
            foreach (CurveData curve in record.curves)
            {
                double[] row = curve.snaps
                    ? FindNearest(knobs[curve.knob], curve.at, curve.values, numbers.Length)
                    : Interpolate(knobs[curve.knob], curve.at, curve.values, 0, numbers.Length);
                for (int at = 0; at < numbers.Length; at++)
                {
                    if (record.multiplies && record.start[at] != 0.0)
                        numbers[at] *= row[at] / record.start[at];
                    else
                        numbers[at] += row[at] - record.start[at];
                }
            }
            foreach (GridData grid in record.grids)
                AddGrid(numbers, grid, knobs);
            if (record.whole)
            {
                for (int at = 0; at < numbers.Length; at++)
                    numbers[at] = Math.Floor(numbers[at] + 0.5);
            }
            return numbers;
        }

        static void AddGrid(double[] numbers, GridData grid, double[] knobs)
        {
            int width = numbers.Length;
            int line = grid.secondAt.Length * width;
            var lines = new double[grid.firstAt.Length * width];
            for (int at = 0; at < grid.firstAt.Length; at++)
                Interpolate(knobs[grid.second], grid.secondAt, grid.values, at * line, width).CopyTo(lines, at * width);
            double[] row = Interpolate(knobs[grid.first], grid.firstAt, lines, 0, width);
            for (int at = 0; at < width; at++)
                numbers[at] += row[at];
        }

        /// <summary>The row of numbers at x, between two of the rows that begin at start; beyond the ends the last one.</summary>
        static double[] Interpolate(double x, double[] places, double[] rows, int start, int width)
        {
            int after = 0;
            while (after < places.Length && x > places[after])
                after++;
            int low = Math.Max(after - 1, 0);
            int high = Math.Min(after, places.Length - 1);
            double share = low == high ? 0.0 : (x - places[low]) / (places[high] - places[low]);
            var row = new double[width];
            for (int at = 0; at < width; at++)
            {
                double a = rows[start + low * width + at];
                row[at] = a + (rows[start + high * width + at] - a) * share;
            }
            return row;
        }

        static double[] FindNearest(double x, double[] places, double[] rows, int width)
        {
            int best = 0;
            for (int at = 1; at < places.Length; at++)
                best = Math.Abs(places[at] - x) < Math.Abs(places[best] - x) ? at : best;
            var row = new double[width];
            Array.Copy(rows, best * width, row, 0, width);
            return row;
        }

        /// <summary>The vectors that a program is given: four floats for each row.</summary>
        public static float[] FillRows(LookData data, PassData pass, double[] knobs)
        {
            var rows = new float[4 * pass.rows];
            foreach (UniformData uniform in pass.uniforms)
            {
                double[] numbers = FindNumbers(data, uniform.slot, knobs);
                for (int at = 0; at < numbers.Length; at++)
                {
                    int place = 4 * (uniform.row + at / uniform.group) + at % uniform.group;
                    if (place < rows.Length)
                        rows[place] = (float)numbers[at];
                }
            }
            return rows;
        }
    }
}
