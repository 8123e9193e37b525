using System;
using System.Runtime.InteropServices;

namespace Wadi
{
    /// <summary>A world of sand and water. One thread at a time uses it; a call that meets another one inside throws ErrorBusy and has done
    /// nothing. Methods that begin with Try return false where the library answers "ask again later". Dispose it: a world that is only
    /// forgotten goes when the collector gets to it.</summary>
    public sealed unsafe partial class World : IDisposable
    {
        readonly LogHandle log;
        WorldId id;
        bool disposed;

        /// <summary>Cells along x (east) and y (north).</summary>
        public int Nx { get; private set; }
        public int Ny { get; private set; }
        /// <summary>Width of a cell [m].</summary>
        public double Dx { get; private set; }
        /// <summary>Water time step [s].</summary>
        public double Dt { get; private set; }

        delegate Result Maker(RawLevelOverrides* overrides, RawDeviceOptions* options, WorldId* made);

        World(CallMemory memory, LevelOverrides overrides, DeviceOptions options, Maker make)
        {
            Library.Load();
            options = options ?? new DeviceOptions();
            log = new LogHandle(options.Log);
            try
            {
                var rawOverrides = (overrides ?? new LevelOverrides()).Raw(memory);
                var rawOptions = options.Raw(memory, log);
                WorldId made;
                Library.Check(make(&rawOverrides, &rawOptions, &made));
                id = made;
            }
            catch
            {
                disposed = true;
                log.Free();
                throw;
            }
            var info = GetInfo();
            Nx = info.Nx;
            Ny = info.Ny;
            Dx = info.Dx;
            Dt = info.Dt;
        }

        /// <summary>A world from a level file (.json) or a terrain map (.png, .r16, .npy, .asc).</summary>
        public static World FromLevel(string path, LevelOverrides overrides = null, DeviceOptions options = null)
        {
            using (var memory = new CallMemory())
            {
                if (path == null) throw new ArgumentNullException("path");
                var text = memory.Pin(path, "path");
                return new World(memory, overrides, options, (o, d, made) => Native.wadi_create_world_from_level((byte*)text, o, d, made));
            }
        }

        /// <summary>What FromLevel would cost: nothing is decoded or drawn.</summary>
        public static Cost CostOfLevel(string path, LevelOverrides overrides = null)
        {
            if (path == null) throw new ArgumentNullException("path");
            using (var memory = new CallMemory())
            {
                var text = memory.Pin(path, "path");
                var cost = Cost.Default;
                var raw = (overrides ?? new LevelOverrides()).Raw(memory);
                Library.Check(Native.wadi_get_level_cost((byte*)text, &raw, &cost));
                return cost;
            }
        }

        /// <summary>What FromText would cost.</summary>
        public static Cost CostOfText(string json, Func<string, byte[]> readFile = null, LevelOverrides overrides = null)
        {
            if (json == null) throw new ArgumentNullException("json");
            var user = GCHandle.Alloc(new FileReader(readFile));
            try
            {
                using (var memory = new CallMemory())
                {
                    var text = memory.Pin(json, "json");
                    var cost = Cost.Default;
                    var raw = (overrides ?? new LevelOverrides()).Raw(memory);
                    Library.Check(Native.wadi_get_level_text_cost((byte*)text, readFile == null ? null : FileReader.Callback,
                        (void*)GCHandle.ToIntPtr(user), &raw, &cost));
                    return cost;
                }
            }
            finally
            {
                user.Free();
            }
        }

        /// <summary>A world from the text of a level. Files that it names come from readFile, by the name in the level; null from there means
        /// that there is none. Without readFile it may name none.</summary>
        public static World FromText(string json, Func<string, byte[]> readFile = null, LevelOverrides overrides = null,
            DeviceOptions options = null)
        {
            if (json == null) throw new ArgumentNullException("json");
            var reader = new FileReader(readFile);
            var user = GCHandle.Alloc(reader);
            try
            {
                using (var memory = new CallMemory())
                {
                    var text = memory.Pin(json, "json");
                    return new World(memory, overrides, options, (o, d, made) => Native.wadi_create_world_from_level_text(
                        (byte*)text, readFile == null ? null : FileReader.Callback, (void*)GCHandle.ToIntPtr(user), o, d, made));
                }
            }
            catch (WadiException e)
            {
                if (reader.Thrown == null) throw;
                throw new WadiException(e.Result, e.Message + " (readFile: " + reader.Thrown.Message + ")", reader.Thrown);
            }
            finally
            {
                user.Free();
            }
        }

        /// <summary>A world from arrays.</summary>
        public static World FromArrays(WorldArrays arrays, DeviceOptions options = null)
        {
            if (arrays == null) throw new ArgumentNullException("arrays");
            using (var memory = new CallMemory())
            {
                var raw = arrays.Raw(memory);
                return new World(memory, null, options, (o, d, made) =>
                {
                    var given = raw;
                    return Native.wadi_create_world_from_arrays(&given, d, made);
                });
            }
        }

        /// <summary>Destroys the world. Waits for what the device is at.</summary>
        /// <exception cref="WadiException">ErrorBusy: another thread is inside; the world is as it was</exception>
        public void Dispose()
        {
            if (disposed) return;
            Library.Check(Native.wadi_destroy_world(id));
            Forget();
            GC.SuppressFinalize(this);
        }

        void Forget()
        {
            disposed = true;
            log.Free();
            FreePinnedSaves();
        }

        ~World()
        {
            if (disposed || log == null) return;
            if (Native.wadi_destroy_world(id) == Result.Ok) Forget();
        }

        /// <summary>The world's id, for calls of Native.</summary>
        /// <exception cref="ObjectDisposedException">it was disposed</exception>
        public WorldId Id
        {
            get
            {
                if (disposed) throw new ObjectDisposedException("Wadi.World");
                return id;
            }
        }

        /// <summary>Throws where a call failed. It uses `this` behind the call, so that no collector destroys the world meanwhile.</summary>
        void Check(Result result)
        {
            Library.Check(result);
            GC.KeepAlive(this);
        }

        /// <summary>The same, but false where the library asks to come again.</summary>
        bool Ready(Result result)
        {
            if (result != Result.NotReady) Library.Check(result);
            GC.KeepAlive(this);
            return result == Result.Ok;
        }

        public WorldInfo GetInfo()
        {
            var info = WorldInfo.Default;
            Check(Native.wadi_world_get_info(Id, &info));
            return info;
        }

        /// <summary>What the level may not do as expected.</summary>
        public string[] GetWarnings()
        {
            var warnings = new string[GetInfo().WarningCount];
            for (uint n = 0; n < warnings.Length; ++n) warnings[n] = Text.Of(Native.wadi_world_get_warning(Id, n));
            GC.KeepAlive(this);
            return warnings;
        }

        /// <summary>How updates take steps, from the next one on.</summary>
        public void SetUpdateSettings(UpdateSettings settings)
        {
            Check(Native.wadi_world_set_update_settings(Id, &settings));
        }

        /// <summary>Advances by host time and publishes the outputs: the call of each frame. Steps have a fixed dt, so the same total gives the
        /// same bits in frames of any length. Never waits, unless MaxStepsInFlight is 0.</summary>
        public Frame Update(ulong hostNanoseconds)
        {
            var frame = Frame.Default;
            Check(Native.wadi_world_update(Id, hostNanoseconds, &frame));
            return frame;
        }

        /// <summary>Advances by whole water steps; returns before the device has finished.</summary>
        public void Step(uint steps = 1)
        {
            Check(Native.wadi_world_step(Id, steps));
        }

        /// <summary>Simulated time [s].</summary>
        public double Time
        {
            get
            {
                double seconds;
                Check(Native.wadi_world_get_time(Id, &seconds, null));
                return seconds;
            }
        }

        /// <summary>Water steps so far.</summary>
        public ulong Steps
        {
            get
            {
                ulong steps;
                Check(Native.wadi_world_get_time(Id, null, &steps));
                return steps;
            }
        }
    }
}
