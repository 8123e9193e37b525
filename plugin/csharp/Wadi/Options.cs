using System;
using System.Runtime.InteropServices;

namespace Wadi
{
    /// <summary>Where and how a world runs.</summary>
    public sealed unsafe class DeviceOptions
    {
        /// <summary>"auto" (a real GPU first, else the CPU), or one that Library.ListDevices names.</summary>
        public string Backend = "auto";
        /// <summary>Index from Library.ListDevices, -1 = the backend's best.</summary>
        public int Device = -1;
        /// <summary>Of the CPU backend, and for any to load levels and to count and hash states; 0 = all cores, of which steps leave one to the frame.</summary>
        public int Threads;
        /// <summary>Vulkan validation layers; their messages go to Log.</summary>
        public bool Validate;
        /// <summary>Gets what no call returns, during a call or from a driver's thread. It must not call the library; what it throws is
        /// lost. It lives as long as the world.</summary>
        public Action<LogLevel, string> Log;
        /// <summary>Address of a wadi_vulkan_host (wadi_vulkan.h), or zero.</summary>
        public IntPtr VulkanHost;
        /// <summary>Addresses of callbacks (RunJobsCallback, AllocateCallback, FreeCallback) and what they get as `user`, or zero: see
        /// RawDeviceOptions. Their delegates must be kept until the world is gone; Marshal.GetFunctionPointerForDelegate keeps none.</summary>
        public IntPtr RunJobs, JobsUser, AllocateMemory, FreeMemory, MemoryUser;
        /// <summary>Limits of what a level, and later a snapshot or log of the world, may ask for, each 0 = none; null = no limits.</summary>
        public Cost? Most;
        /// <summary>Address of a ProgressCallback, which hears how far the making of the world is and may end it, or zero; and its `user`.
        /// Its delegate must be kept until that call returns.</summary>
        public IntPtr Progress, ProgressUser;

        internal RawDeviceOptions Raw(CallMemory memory, LogHandle log)
        {
            var raw = RawDeviceOptions.Default;
            raw.Backend = memory.Pin(Backend ?? "auto", "Backend");
            raw.Device = Device;
            raw.Threads = Threads;
            raw.Validate = Validate;
            raw.Log = log.Address;
            raw.LogUser = log.User;
            raw.VulkanHost = VulkanHost;
            raw.RunJobs = RunJobs;
            raw.JobsUser = JobsUser;
            raw.AllocateMemory = AllocateMemory;
            raw.FreeMemory = FreeMemory;
            raw.MemoryUser = MemoryUser;
            if (Most != null) raw.Most = memory.Pin(new[] { Most.Value });
            raw.Progress = Progress;
            raw.ProgressUser = ProgressUser;
            return raw;
        }
    }

    /// <summary>Overrides for a level file; a value of 0 or null keeps the file's.</summary>
    public sealed class LevelOverrides
    {
        /// <summary>Cells; keeps the x extent and square cells, stretches maps in y, scales dt with dx.</summary>
        public int Nx, Ny;
        /// <summary>[s]</summary>
        public double Dt;
        /// <summary>"robust" or "published".</summary>
        public string Method;
        /// <summary>One of the level's variants. Not for terrain maps.</summary>
        public string Variant;
        /// <summary>"draft", "balanced" or "accurate": half, all or twice the level's cells along x and y; "fine": those of its fine_grid, for graphics cards.</summary>
        public string Accuracy;
        public ActiveTiles ActiveTiles;
        public Choice FusedStages;
        /// <summary>Maps and series may lie anywhere that the process can read, not in the level's folder alone. For levels of one's
        /// own.</summary>
        public bool AnyFiles;
        /// <summary>Any of OutputMask.Foam, OutputMask.Wetness and OutputMask.Silt: what you will draw of what water carries and leaves. It
        /// is then there wherever there is water, silt where there is sand, too, and the level does not force it off. It moves nothing, and
        /// costs a pass each and 8, 4 and 8 bytes a cell.</summary>
        public OutputMask Draws;

        internal RawLevelOverrides Raw(CallMemory memory)
        {
            var raw = RawLevelOverrides.Default;
            raw.Nx = Nx;
            raw.Ny = Ny;
            raw.Dt = Dt;
            raw.Method = memory.Pin(Method, "Method");
            raw.Variant = memory.Pin(Variant, "Variant");
            raw.Accuracy = memory.Pin(Accuracy, "Accuracy");
            raw.ActiveTiles = ActiveTiles;
            raw.FusedStages = FusedStages;
            raw.AnyFiles = AnyFiles;
            raw.Draws = (ulong)Draws;
            return raw;
        }
    }

    /// <summary>A world from arrays: settings as the text of a level file without its fields, and nx * ny floats each, row 0 in the south;
    /// null = zero everywhere.</summary>
    public sealed class WorldArrays
    {
        public string SettingsJson;
        public int Nx, Ny;
        /// <summary>Elevation of the ground [m].</summary>
        public float[] Terrain;
        /// <summary>Depth of sand [m].</summary>
        public float[] Sand;
        /// <summary>Depth of all water [m].</summary>
        public float[] Water;
        /// <summary>Of the water, at cell centres [m/s].</summary>
        public float[] VelocityX, VelocityY;
        /// <summary>What cells add to material.manning, 0 ... 1 [s/m^(1/3)].</summary>
        public float[] Roughness;
        /// <summary>How many times the settings' rain falls on each cell, 0 ... 100; null = once everywhere.</summary>
        public float[] RainMap;

        IntPtr Pin(CallMemory memory, float[] values, string name)
        {
            if (values != null && values.LongLength != (long)Nx * Ny)
                throw new ArgumentException("has " + values.LongLength + " values, the grid " + Nx + " x " + Ny + " cells", name);
            return memory.Pin(values);
        }

        internal RawWorldArrays Raw(CallMemory memory)
        {
            var raw = RawWorldArrays.Default;
            raw.SettingsJson = memory.Pin(SettingsJson, "SettingsJson");
            raw.Nx = Nx;
            raw.Ny = Ny;
            raw.Terrain = Pin(memory, Terrain, "Terrain");
            raw.Sand = Pin(memory, Sand, "Sand");
            raw.Water = Pin(memory, Water, "Water");
            raw.VelocityX = Pin(memory, VelocityX, "VelocityX");
            raw.VelocityY = Pin(memory, VelocityY, "VelocityY");
            raw.Roughness = Pin(memory, Roughness, "Roughness");
            raw.RainMap = Pin(memory, RainMap, "RainMap");
            return raw;
        }
    }

    /// <summary>An accuracy preset.</summary>
    public sealed unsafe class AccuracyPreset
    {
        public readonly string Name;
        /// <summary>Factor on the level's cells along x and y.</summary>
        public readonly double Cells;
        /// <summary>Sand steps per water step.</summary>
        public readonly int Substeps;
        /// <summary>method.water_transport_order; 0 = the level's.</summary>
        public readonly int WaterOrder;

        internal AccuracyPreset(RawAccuracyPreset raw)
        {
            Name = Text.Of((byte*)raw.Name);
            Cells = raw.Cells;
            Substeps = raw.Substeps;
            WaterOrder = raw.WaterOrder;
        }
    }
}
