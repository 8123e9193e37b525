using System;

namespace Wadi
{
    /// <summary>Edits and the material.</summary>
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
