using System;
using System.Runtime.InteropServices;

namespace Wadi
{
    /// <summary>An output in host memory. Good until the second next update of its world, or until a mask of outputs changes.</summary>
    public unsafe struct HostOutput
    {
        public readonly Output Output;
        public readonly int Nx, Ny;
        /// <summary>Address of cell (0, 0), in the south-west.</summary>
        public readonly IntPtr Data;
        /// <summary>Bytes from a row to the one north of it.</summary>
        public readonly long RowPitch;
        /// <summary>Water steps done in the state that it shows.</summary>
        public readonly ulong Step;

        internal HostOutput(Output output, int nx, int ny, float* data, ulong rowPitch, ulong step)
        {
            Output = output;
            Nx = nx;
            Ny = ny;
            Data = (IntPtr)data;
            RowPitch = (long)rowPitch;
            Step = step;
        }

        /// <summary>Bytes of a cell.</summary>
        public int CellBytes { get { return CellBytesOf(Output); } }

        /// <summary>Bytes of a cell: floats of 4 bytes, of PackedHalf four of 2.</summary>
        public static int CellBytesOf(Output output)
        {
            switch (output)
            {
                case Output.Flow:
                case Output.SandVelocity:
                case Output.PackedHalf:
                    return 8;
                case Output.Normal:
                case Output.Packed:
                    return 16;
                default:
                    return 4;
            }
        }

        /// <summary>Floats of a row; PackedHalf has none.</summary>
        public ReadOnlySpan<float> Row(int j)
        {
            if (Output == Output.PackedHalf) throw new InvalidOperationException("PackedHalf has 16-bit floats: use Data");
            if (j < 0 || j >= Ny) throw new ArgumentOutOfRangeException("j", j, "rows are 0 ... " + (Ny - 1));
            return new ReadOnlySpan<float>((byte*)Data + j * RowPitch, Nx * (CellBytes / 4));
        }

        /// <summary>Copies all rows one behind the other, as textures of engines hold them: nx * ny cells.</summary>
        public void CopyTo(float[] values)
        {
            if (values == null) throw new ArgumentNullException("values");
            if (4L * values.LongLength != (long)Nx * Ny * CellBytes)
                throw new ArgumentException("has " + values.LongLength + " floats, the output " + (long)Nx * Ny * CellBytes / 4, "values");
            fixed (float* to = values) CopyTo((IntPtr)to);
        }

        /// <summary>The same to an address with room for nx * ny cells.</summary>
        public void CopyTo(IntPtr memory)
        {
            long row = (long)Nx * CellBytes;
            for (int j = 0; j < Ny; ++j) Buffer.MemoryCopy((byte*)Data + j * RowPitch, (byte*)memory + j * row, row, row);
        }
    }

    /// <summary>What updates publish.</summary>
    public sealed unsafe partial class World
    {
        /// <summary>Chooses what every update publishes on the device.</summary>
        public void SetOutputs(OutputMask mask)
        {
            Check(Native.wadi_world_set_outputs(Id, mask));
        }

        /// <summary>Chooses outputs that are also copied to host memory.</summary>
        public void SetHostOutputs(OutputMask mask)
        {
            Check(Native.wadi_world_set_host_outputs(Id, mask));
        }

        /// <summary>Waits until the newest update's outputs are in host memory: for programs that print or film.</summary>
        public void WaitForOutputs()
        {
            Check(Native.wadi_world_wait_for_outputs(Id));
        }

        /// <summary>The newest copy that has arrived, usually of the update before; false where none has.</summary>
        public bool TryGetHostOutput(Output output, out HostOutput host)
        {
            float* data;
            ulong rowPitch, step;
            bool ready = Ready(Native.wadi_world_get_host_output(Id, output, &data, &rowPitch, &step));
            host = ready ? new HostOutput(output, Nx, Ny, data, rowPitch, step) : new HostOutput();
            return ready;
        }

        /// <summary>Where an output lies on the device; false where it is not published yet.</summary>
        public bool TryGetView(Output output, OutputSet set, out OutputView view)
        {
            var found = OutputView.Default;
            bool ready = Ready(Native.wadi_world_get_view(Id, output, set, &found));
            view = found;
            return ready;
        }

        /// <summary>Lowest and highest elevation of each output tile; null where none has arrived yet.</summary>
        public Tile[] GetTiles(out ulong step)
        {
            uint count = 0;
            ulong at = 0;
            step = 0;
            if (!Ready(Native.wadi_world_get_tiles(Id, null, &count, &at))) return null;
            var tiles = new Tile[count];
            fixed (Tile* to = tiles) Check(Native.wadi_world_get_tiles(Id, to, &count, &at));
            step = at;
            return tiles;
        }

        /// <summary>Rectangles with every cell whose surface changed after step `since` (-1 = ever); null where none has arrived yet. Pass
        /// `step` as `since` to the next call.</summary>
        public Region[] GetDirtyRegions(long since, out ulong step)
        {
            uint count = 0;
            ulong at = 0;
            step = 0;
            if (!Ready(Native.wadi_world_get_dirty_regions(Id, since, null, &count, &at))) return null;
            var regions = new Region[count];
            fixed (Region* to = regions) Check(Native.wadi_world_get_dirty_regions(Id, since, to, &count, &at));
            step = at;
            return regions;
        }
    }
}
