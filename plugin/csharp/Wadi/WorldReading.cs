using System;

namespace Wadi
{
    /// <summary>Fields and points.</summary>
    public sealed unsafe partial class World
    {
        /// <summary>Reads a field into nx * ny floats, x fastest, row 0 in the south. Waits for the steps asked for.</summary>
        public void ReadField(Field field, float[] values)
        {
            if (values == null) throw new ArgumentNullException("values");
            fixed (float* to = values) Check(Native.wadi_world_read_field(Id, field, to, (UIntPtr)(ulong)values.LongLength));
        }

        public float[] ReadField(Field field)
        {
            var values = new float[Nx * Ny];
            ReadField(field, values);
            return values;
        }

        /// <summary>Reads a field in a region within the grid.</summary>
        public void ReadRegion(Field field, Region region, float[] values)
        {
            if (values == null) throw new ArgumentNullException("values");
            fixed (float* to = values) Check(Native.wadi_world_read_region(Id, field, &region, to, (UIntPtr)(ulong)values.LongLength));
        }

        /// <summary>Overwrites Terrain, SandDepth or TotalWaterDepth in a region at once, after the steps asked for.</summary>
        public void WriteRegion(Field field, Region region, float[] values)
        {
            if (values == null) throw new ArgumentNullException("values");
            fixed (float* from = values) Check(Native.wadi_world_write_region(Id, field, &region, from, (UIntPtr)(ulong)values.LongLength));
        }

        /// <summary>The same of values that lie on the device or behind an address and are checked there; start from
        /// DeviceValues.Default.</summary>
        public void WriteRegionFrom(Field field, Region region, DeviceValues values)
        {
            Check(Native.wadi_world_write_region_from(Id, field, &region, &values));
        }

        /// <summary>Extremes, limits at work and the ledger; reads the whole state, so not for every frame.</summary>
        public WorldStats GetStats()
        {
            var stats = WorldStats.Default;
            Check(Native.wadi_world_get_stats(Id, &stats));
            return stats;
        }

        /// <summary>64-bit hash of the state, equal on every backend. Reads the whole state.</summary>
        public ulong GetHash()
        {
            ulong hash;
            Check(Native.wadi_world_get_hash(Id, &hash));
            return hash;
        }

        /// <summary>Asks for the state at points (x, y, x, y ... in metres from the south-west corner); false where eight batches are under
        /// way.</summary>
        public bool TryQuery(float[] xy, out ulong ticket)
        {
            if (xy == null) throw new ArgumentNullException("xy");
            if (xy.Length % 2 != 0) throw new ArgumentException("has " + xy.Length + " numbers, two belong to each point", "xy");
            ulong given = 0;
            bool ready;
            fixed (float* points = xy) ready = Ready(Native.wadi_world_query(Id, points, (uint)(xy.Length / 2), &given));
            ticket = given;
            return ready;
        }

        /// <summary>The answers, their number and the step they are of; false where they are not there yet.</summary>
        public bool TryGetQuery(ulong ticket, QueryResult[] results, out int count, out ulong step)
        {
            if (results == null) throw new ArgumentNullException("results");
            uint found = 0;
            ulong at = 0;
            bool ready;
            fixed (QueryResult* to = results)
                ready = Ready(Native.wadi_world_get_query(Id, ticket, to, (uint)results.Length, &found, &at));
            count = (int)found;
            step = at;
            return ready;
        }
    }

    /// <summary>Which points to ask for under a body, and the force and torque that their answers make. Needs no world.</summary>
    public static unsafe class Buoyancy
    {
        /// <summary>Points for World.TryQuery.</summary>
        public static float[] Points(Body body)
        {
            Library.Load();
            uint count = 0;
            Library.Check(Native.wadi_buoyancy_points(&body, null, &count));
            var xy = new float[2 * count];
            fixed (float* to = xy) Library.Check(Native.wadi_buoyancy_points(&body, to, &count));
            return xy;
        }

        /// <summary>Force [N] and torque about the body's middle [N m], three floats each.</summary>
        public static void Force(Body body, QueryResult[] results, int count, float[] force, float[] torque)
        {
            Library.Load();
            if (results == null || count < 0 || count > results.Length) throw new ArgumentException("has not " + count + " answers", "results");
            if (force == null || force.Length < 3) throw new ArgumentException("needs room for 3 floats", "force");
            if (torque == null || torque.Length < 3) throw new ArgumentException("needs room for 3 floats", "torque");
            fixed (QueryResult* answers = results)
            fixed (float* f = force, t = torque) Library.Check(Native.wadi_buoyancy_force(&body, answers, (uint)count, f, t));
        }
    }
}
