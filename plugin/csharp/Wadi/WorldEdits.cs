using System;

namespace Wadi
{
    /// <summary>A source or drain: a tap, a spring, a pump, a conveyor. Of Rate, Discharge and Level it has one, or a level and one more.
    /// RawSource says what each number means.</summary>
    public sealed unsafe class Source
    {
        public SourceShape Shape;
        public bool Sand, Drain, SetVelocity;
        public double CenterX, CenterY, Radius = 1, FromX, FromY, ToX, ToY, VelocityX, VelocityY;
        /// <summary>Values over time; one sample is constant, null = there is no such series.</summary>
        public Sample[] Rate, Discharge, Level;
        public ulong Step, Player;

        public Source() { }

        internal Source(RawSource raw)
        {
            Shape = raw.Shape;
            Sand = raw.Sand;
            Drain = raw.Drain;
            SetVelocity = raw.SetVelocity;
            CenterX = raw.CenterX;
            CenterY = raw.CenterY;
            Radius = raw.Radius;
            FromX = raw.FromX;
            FromY = raw.FromY;
            ToX = raw.ToX;
            ToY = raw.ToY;
            VelocityX = raw.VelocityX;
            VelocityY = raw.VelocityY;
            Rate = Copy(raw.Rate, raw.RateCount);
            Discharge = Copy(raw.Discharge, raw.DischargeCount);
            Level = Copy(raw.Level, raw.LevelCount);
        }

        internal RawSource Raw(CallMemory memory)
        {
            var raw = RawSource.Default;
            raw.Shape = Shape;
            raw.Sand = Sand;
            raw.Drain = Drain;
            raw.SetVelocity = SetVelocity;
            raw.CenterX = CenterX;
            raw.CenterY = CenterY;
            raw.Radius = Radius;
            raw.FromX = FromX;
            raw.FromY = FromY;
            raw.ToX = ToX;
            raw.ToY = ToY;
            raw.VelocityX = VelocityX;
            raw.VelocityY = VelocityY;
            raw.RateCount = Pin(memory, Rate, ref raw.Rate);
            raw.DischargeCount = Pin(memory, Discharge, ref raw.Discharge);
            raw.LevelCount = Pin(memory, Level, ref raw.Level);
            raw.Step = Step;
            raw.Player = Player;
            return raw;
        }

        static uint Pin(CallMemory memory, Sample[] samples, ref IntPtr address)
        {
            if (samples == null || samples.Length == 0) return 0;
            address = memory.Pin(samples);
            return (uint)samples.Length;
        }

        static Sample[] Copy(IntPtr from, uint count)
        {
            if (count == 0) return null;
            var samples = new Sample[count];
            for (uint n = 0; n < count; ++n) samples[n] = ((Sample*)from)[n];
            return samples;
        }
    }

    /// <summary>Edits, sources and the material.</summary>
    public sealed unsafe partial class World
    {
        /// <summary>Queues edits for the next step or a later one. Start from Edit.Default.</summary>
        public void Edit(params Edit[] edits)
        {
            if (edits == null) throw new ArgumentNullException("edits");
            fixed (Edit* from = edits) Check(Native.wadi_world_edit(Id, from, (uint)edits.Length));
        }

        /// <summary>Copies an image for stamps, row 0 in the south; returns its number.</summary>
        public uint CreateStamp(int nx, int ny, float[] values)
        {
            if (values == null) throw new ArgumentNullException("values");
            if (values.LongLength != (long)nx * ny)
                throw new ArgumentException("has " + values.LongLength + " values, the image " + nx + " x " + ny + " pixels", "values");
            uint stamp;
            fixed (float* from = values) Check(Native.wadi_world_create_stamp(Id, nx, ny, from, &stamp));
            return stamp;
        }

        /// <summary>Makes source `index` (0 ... 31) another one, or adds it, ahead of its step.</summary>
        public void SetSource(uint index, Source source)
        {
            if (source == null) throw new ArgumentNullException("source");
            using (var memory = new CallMemory())
            {
                var raw = source.Raw(memory);
                Check(Native.wadi_world_set_source(Id, index, &raw));
            }
        }

        /// <summary>Source `index` as it is now; GetInfo().SourceCount says how many there are.</summary>
        public Source GetSource(uint index)
        {
            var raw = RawSource.Default;
            Check(Native.wadi_world_get_source(Id, index, &raw));
            return new Source(raw);
        }

        /// <summary>Compiles ahead for materials that edits may bring; call it while loading.</summary>
        public void PrepareEffects()
        {
            Check(Native.wadi_world_prepare_effects(Id));
        }

        /// <summary>Frees passes and buffers of materials that the world no longer holds. Waits for the steps.</summary>
        public void Trim()
        {
            Check(Native.wadi_world_trim(Id));
        }

        /// <summary>Numbers of the material, their values now and their ranges.</summary>
        public MaterialInfo[] GetMaterial()
        {
            uint count = 0;
            Check(Native.wadi_world_get_material(Id, null, &count));
            var infos = new MaterialInfo[count];
            fixed (MaterialInfo* to = infos) Check(Native.wadi_world_get_material(Id, to, &count));
            return infos;
        }

        /// <summary>Changes a number of the material from the next step on, in the level's units.</summary>
        public void SetMaterial(string name, double value)
        {
            fixed (byte* text = Text.Utf8(name, "name")) Check(Native.wadi_world_set_material(Id, text, value));
        }
    }
}
