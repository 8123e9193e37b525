// Written by plugin/csharp/write_csharp.py from plugin/wadi_api.json.
using System;
using System.Runtime.InteropServices;
#pragma warning disable 169, 649 // fields that only the library fills

namespace Wadi
{
    [StructLayout(LayoutKind.Sequential)]
    public struct DeviceInfo
    {
        uint structSize;
        unsafe fixed byte backend[16];
        public unsafe string Backend { get { fixed (byte* text = backend) return Text.Of(text, 16); } }
        /// <summary>within its backend</summary>
        public int Index;
        unsafe fixed byte name[256];
        public unsafe string Name { get { fixed (byte* text = name) return Text.Of(text, 256); } }
        int isSoftware;
        /// <summary>1 for the CPU and for software Vulkan devices</summary>
        public bool IsSoftware { get { return isSoftware != 0; } set { isSoftware = value ? 1 : 0; } }
        /// <summary>0 = unknown</summary>
        public ulong MemoryBytes;
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe DeviceInfo Default
        {
            get
            {
                var value = new DeviceInfo();
                value.structSize = (uint)sizeof(DeviceInfo);
                return value;
            }
        }
    }

    /// <summary>
    /// What a level, a snapshot or a command log needs. All sums are known before the work begins; 0 where one has no such sum. As a
    /// host's limits: the most of each, 0 = no limit but the library's own.
    /// </summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Cost
    {
        uint structSize;
        /// <summary>of the grid</summary>
        public ulong Cells;
        /// <summary>bytes that are read: a level's text, its maps and series; a snapshot; a log</summary>
        public ulong FileBytes;
        /// <summary>numbers that maps and series hold once they are decoded</summary>
        public ulong MapValues;
        /// <summary>of drawing a level: looks at shapes, some nanoseconds of one thread each</summary>
        public ulong Work;
        /// <summary>of the host's memory while it loads, at most, beside those of the device</summary>
        public ulong HostBytes;
        /// <summary>
        /// that the world holds on its device once it is loaded, at most; with the backend "cpu" they are the host's. Of a log: the
        /// bytes of its stamps
        /// </summary>
        public ulong DeviceBytes;
        /// <summary>
        /// of a level: the steps of its duration (0 for a map alone); of a snapshot: the step that it is of; of a log: its last step
        /// </summary>
        public ulong Steps;
        /// <summary>the most edits that a level or a log brings into one step</summary>
        public ulong EditsPerStep;
        /// <summary>the most other commands that a log brings into one step</summary>
        public ulong CommandsPerStep;
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe Cost Default
        {
            get
            {
                var value = new Cost();
                value.structSize = (uint)sizeof(Cost);
                return value;
            }
        }
    }

    /// <summary>Where and how a world runs.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct RawDeviceOptions
    {
        uint structSize;
        /// <summary>"auto" (a real GPU first, else the CPU), or one that wadi_list_devices names: "cpu", "vulkan" ...</summary>
        public IntPtr Backend;
        /// <summary>index from wadi_list_devices, -1 = the backend's best</summary>
        public int Device;
        /// <summary>
        /// of the CPU backend, and for any to load levels and to count and hash states. 0 = all cores; the CPU backend's steps then
        /// leave one to the host's frame
        /// </summary>
        public int Threads;
        int validate;
        /// <summary>1 = Vulkan validation layers; messages go to the log callback</summary>
        public bool Validate { get { return validate != 0; } set { validate = value ? 1 : 0; } }
        /// <summary>may be NULL</summary>
        public IntPtr Log;
        public IntPtr LogUser;
        /// <summary>
        /// NULL, or the host's own Vulkan device (wadi_vulkan.h): "auto" and "vulkan" run on it, "cuda" beside it
        /// </summary>
        public IntPtr VulkanHost;
        /// <summary>
        /// NULL, or: the CPU backend has no threads of its own but the one that takes steps in order; a pass has `threads` parts.
        /// Every bit stays, whatever the number
        /// </summary>
        public IntPtr RunJobs;
        public IntPtr JobsUser;
        /// <summary>
        /// set both callbacks or neither (NULL). With the CPU backend all that wadi_world_get_memory lists comes from here: fields,
        /// outputs, copies for the host, snapshots under way, kept states, queries. All of it is freed before wadi_destroy_world
        /// returns. If it refuses, the call fails with OUT_OF_MEMORY and the world is as it was, except that kept states are dropped
        /// where a promotion finds no room for theirs. Not from here: what a call needs while it lasts (level files, statistics),
        /// edits that wait, the command log, programs, threads. Nor is the memory of GPU backends, which is the driver's
        /// </summary>
        public IntPtr AllocateMemory;
        public IntPtr FreeMemory;
        public IntPtr MemoryUser;
        /// <summary>
        /// NULL, or limits of the host's own. They are checked before a level, and later a snapshot or log of this world, is read
        /// further than its header. What passes one is BAD_FILE, with the sum and the limit
        /// </summary>
        public IntPtr Most;
        /// <summary>NULL, or hears how far the making of the world is, and may end it</summary>
        public IntPtr Progress;
        public IntPtr ProgressUser;
        /// <summary>A struct with the size that the library asks for and the header's defaults; texts stay null.</summary>
        public static unsafe RawDeviceOptions Default
        {
            get
            {
                var value = new RawDeviceOptions();
                value.structSize = (uint)sizeof(RawDeviceOptions);
                value.Device = -1;
                return value;
            }
        }
    }

    /// <summary>
    /// A world by index and generation; all zero is null. Copy it freely; a destroyed one is recognised and refused.
    /// </summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct WorldId
    {
        public uint Index;
        public uint Generation;
    }

    /// <summary>Overrides for a level file; a value of 0 or NULL keeps the file's.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct RawLevelOverrides
    {
        uint structSize;
        /// <summary>keeps the x extent and square cells, stretches maps in y, scales dt with dx</summary>
        public int Nx;
        /// <summary>keeps the x extent and square cells, stretches maps in y, scales dt with dx</summary>
        public int Ny;
        /// <summary>[s]</summary>
        public double Dt;
        /// <summary>"robust" or "published"</summary>
        public IntPtr Method;
        /// <summary>one of the level's variants; NULL = the level as it is. Not for terrain maps</summary>
        public IntPtr Variant;
        /// <summary>
        /// "draft", "balanced" or "accurate": half, all or twice the level's cells along x and y (nx, ny win), and two sand steps per
        /// water step. "accurate" has second order for water, too. "fine": the cells of the level's fine_grid, for GPUs. NULL, or
        /// "fine" where it has none = what the level says
        /// </summary>
        public IntPtr Accuracy;
        public ActiveTiles ActiveTiles;
        /// <summary>ON = several stages in one pass wherever the effects allow, OFF = one by one. Every bit stays</summary>
        public Choice FusedStages;
        int anyFiles;
        /// <summary>
        /// 1 = maps and series may lie anywhere that the process can read; 0 = in the level's folder and below it alone, links
        /// followed: no "..", no path from the root on. For levels of one's own
        /// </summary>
        public bool AnyFiles { get { return anyFiles != 0; } set { anyFiles = value ? 1 : 0; } }
        /// <summary>
        /// WADI_OUTPUT_BIT of WADI_OUTPUT_FOAM, WADI_OUTPUT_WETNESS and WADI_OUTPUT_SILT, any of them, or 0: what the host will draw
        /// of what water carries and leaves. Effects foam and wetness are then on wherever there is water, silt where there is sand,
        /// too, and the level does not force them off. They move nothing, cost a pass each, and 8, 4 and 8 bytes a cell
        /// </summary>
        public ulong Draws;
        /// <summary>A struct with the size that the library asks for and the header's defaults; texts stay null.</summary>
        public static unsafe RawLevelOverrides Default
        {
            get
            {
                var value = new RawLevelOverrides();
                value.structSize = (uint)sizeof(RawLevelOverrides);
                return value;
            }
        }
    }

    /// <summary>An accuracy preset.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct RawAccuracyPreset
    {
        public IntPtr Name;
        /// <summary>factor on the level's cells along x and y; 0 = the level's fine_grid</summary>
        public double Cells;
        /// <summary>sand steps per water step; 0 = the level's</summary>
        public int Substeps;
        /// <summary>method.water_transport_order; 0 = the level's</summary>
        public int WaterOrder;
    }

    /// <summary>
    /// A world from arrays: settings, and fields of nx * ny floats. NULL = zero everywhere. The settings are the text of a level file
    /// without its "terrain", "sand", "water", "velocities", "roughness" and "rain_map" entries. They may name no files.
    /// </summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct RawWorldArrays
    {
        uint structSize;
        /// <summary>must not be NULL; texts may stand in single quotes: "{'grid': {'nx': 64, 'ny': 64, 'dx': 0.5}, ...}"</summary>
        public IntPtr SettingsJson;
        /// <summary>of the arrays; must equal the settings' grid</summary>
        public int Nx;
        /// <summary>of the arrays; must equal the settings' grid</summary>
        public int Ny;
        /// <summary>elevation of the ground [m]</summary>
        public IntPtr Terrain;
        /// <summary>depth hs [m]</summary>
        public IntPtr Sand;
        /// <summary>depth of all water, W [m]</summary>
        public IntPtr Water;
        /// <summary>water, at cell centres [m/s]</summary>
        public IntPtr VelocityX;
        public IntPtr VelocityY;
        /// <summary>what cells add to material.manning, 0 ... 1 [s/m^(1/3)]</summary>
        public IntPtr Roughness;
        /// <summary>how many times the settings' "rain" falls on each cell, 0 ... 100; NULL = once everywhere</summary>
        public IntPtr RainMap;
        /// <summary>A struct with the size that the library asks for and the header's defaults; texts stay null.</summary>
        public static unsafe RawWorldArrays Default
        {
            get
            {
                var value = new RawWorldArrays();
                value.structSize = (uint)sizeof(RawWorldArrays);
                return value;
            }
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct WorldInfo
    {
        uint structSize;
        unsafe fixed byte name[64];
        public unsafe string Name { get { fixed (byte* text = name) return Text.Of(text, 64); } }
        public int Nx;
        public int Ny;
        /// <summary>[m]</summary>
        public double Dx;
        /// <summary>water time step [s]</summary>
        public double Dt;
        /// <summary>T: sand substeps per water step</summary>
        public int Substeps;
        /// <summary>the level's own length [s]</summary>
        public double Duration;
        /// <summary>dispatches outside the sand substeps</summary>
        public uint PassesPerWaterStep;
        public uint PassesPerSandSubstep;
        /// <summary>state, ping-pong and scratch</summary>
        public double BytesPerCell;
        /// <summary>everything the world holds on the device</summary>
        public ulong DeviceBytes;
        unsafe fixed byte backend[16];
        public unsafe string Backend { get { fixed (byte* text = backend) return Text.Of(text, 16); } }
        unsafe fixed byte deviceName[256];
        public unsafe string DeviceName { get { fixed (byte* text = deviceName) return Text.Of(text, 256); } }
        int exactFloat;
        /// <summary>1 = the device passed the exact-float self-test</summary>
        public bool ExactFloat { get { return exactFloat != 0; } set { exactFloat = value ? 1 : 0; } }
        public uint WarningCount;
        /// <summary>
        /// of the grid's south-west corner in the coordinates of the map that the level was cut from, for a host to show [m]; 0
        /// without a map. Every call counts from the corner
        /// </summary>
        public double OriginX;
        /// <summary>
        /// of the grid's south-west corner in the coordinates of the map that the level was cut from, for a host to show [m]; 0
        /// without a map. Every call counts from the corner
        /// </summary>
        public double OriginY;
        /// <summary>sources and drains that the world has now: wadi_world_get_source</summary>
        public ulong SourceCount;
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe WorldInfo Default
        {
            get
            {
                var value = new WorldInfo();
                value.structSize = (uint)sizeof(WorldInfo);
                return value;
            }
        }
    }

    /// <summary>How wadi_world_update turns host time into water steps.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct UpdateSettings
    {
        uint structSize;
        /// <summary>1 ... 1024, default 8: time beyond it is dropped</summary>
        public uint MaxStepsPerUpdate;
        /// <summary>
        /// 0 ... 64, default 8: once the device has this many unfinished water steps (or its queue of submissions is full), time is
        /// dropped. 0 = drop nothing for that reason; the call may wait
        /// </summary>
        public uint MaxStepsInFlight;
        int spread;
        /// <summary>
        /// 1 = a water step is submitted as 1 water part and T sand parts, evenly over its dt. The bits are the same, and the load
        /// has no peak every dt. Default 0
        /// </summary>
        public bool Spread { get { return spread != 0; } set { spread = value ? 1 : 0; } }
        int interpolateOutputs;
        /// <summary>1 = every update also writes the interpolated set of the outputs; default 0</summary>
        public bool InterpolateOutputs { get { return interpolateOutputs != 0; } set { interpolateOutputs = value ? 1 : 0; } }
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe UpdateSettings Default
        {
            get
            {
                var value = new UpdateSettings();
                value.structSize = (uint)sizeof(UpdateSettings);
                value.MaxStepsPerUpdate = 8;
                value.MaxStepsInFlight = 8;
                return value;
            }
        }
    }

    /// <summary>What one update did.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Frame
    {
        uint structSize;
        /// <summary>water steps that became whole in this update</summary>
        public uint Steps;
        /// <summary>whole water steps since creation</summary>
        public ulong TotalSteps;
        /// <summary>simulated: total_steps * dt [s]</summary>
        public double Time;
        /// <summary>
        /// in [0, 1): how far the host's clock is from the last whole step to the one to come. A renderer shows (1 - f) * last but
        /// one + f * last, one dt late, and moves evenly
        /// </summary>
        public double Interpolation;
        /// <summary>of the outputs' current set; UINT64_MAX = none yet</summary>
        public ulong PublishedStep;
        /// <summary>host time that became no step in this update; steps is then less than it asks for</summary>
        public ulong DroppedNanoseconds;
        /// <summary>and since the world was created</summary>
        public ulong DroppedNanosecondsTotal;
        /// <summary>
        /// the step of the newest look for limits that has arrived; UINT64_MAX = none yet. A world with a log callback looks every 64
        /// steps where limits are at work, told below as wadi_world_stats does
        /// </summary>
        public ulong LimitsStep;
        public ulong WetFaces;
        public ulong ClampedWaterFaces;
        public ulong CappedWaterFaces;
        public ulong SandFaces;
        public ulong ClampedSandFaces;
        public ulong CappedSandFaces;
        public ulong HighColumns;
        /// <summary>[s]</summary>
        public double UnlimitedDt;
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe Frame Default
        {
            get
            {
                var value = new Frame();
                value.structSize = (uint)sizeof(Frame);
                return value;
            }
        }
    }

    /// <summary>Where a published field lies on the device. Read only.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct OutputView
    {
        uint structSize;
        public HandleKind HandleKind;
        /// <summary>the same for a buffer until wadi_world_set_outputs changes the mask</summary>
        public ulong Handle;
        /// <summary>of cell (0, 0), past the ghost cells [bytes]; VkBufferImageCopy.bufferOffset</summary>
        public ulong Offset;
        /// <summary>[bytes]; over the size of a cell it is VkBufferImageCopy.bufferRowLength</summary>
        public ulong RowPitch;
        public ulong BufferBytes;
        public int Nx;
        public int Ny;
        public Format Format;
        /// <summary>water steps done in the state it shows; INTERPOLATED: in the current set</summary>
        public ulong Step;
        int finished;
        /// <summary>
        /// 1 = the device has written it. 0 = it will have, ahead of anything that you submit after it. A host that reads elsewhere
        /// (the CPU backend's address) must wait for 1
        /// </summary>
        public bool Finished { get { return finished != 0; } set { finished = value ? 1 : 0; } }
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe OutputView Default
        {
            get
            {
                var value = new OutputView();
                value.structSize = (uint)sizeof(OutputView);
                return value;
            }
        }
    }

    /// <summary>The cells (i, j) with i0 &lt;= i &lt; i0 + nx and j0 &lt;= j &lt; j0 + ny.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Region
    {
        public int I0;
        public int J0;
        public int Nx;
        public int Ny;
    }

    /// <summary>A tile of 32 x 32 cells (less at the east and north rim): cells i ... i + nx - 1, j ... j + ny - 1.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Tile
    {
        public int I;
        public int J;
        public int Nx;
        public int Ny;
        /// <summary>elevation of the solid surface H + hs [m]</summary>
        public float SolidMin;
        /// <summary>elevation of the solid surface H + hs [m]</summary>
        public float SolidMax;
        /// <summary>elevation of the visible surface H + max(W, hs) [m]</summary>
        public float FreeMin;
        /// <summary>elevation of the visible surface H + max(W, hs) [m]</summary>
        public float FreeMax;
        /// <summary>
        /// step of the newest publish that changed the solid or visible surface of a cell; at first that of the first publish
        /// </summary>
        public long ChangedStep;
    }

    /// <summary>State now: extremes, limits at work, and the ledger.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct WorldStats
    {
        uint structSize;
        /// <summary>[s]</summary>
        public double Time;
        public ulong Steps;
        /// <summary>[m3] now</summary>
        public double SandVolume;
        public double WaterVolume;
        /// <summary>[m3] at creation</summary>
        public double SandInitial;
        public double WaterInitial;
        /// <summary>[m3] by sources, sinks, rain, evaporation and sides since creation</summary>
        public double SandIn;
        /// <summary>[m3] by sources, sinks, rain, evaporation and sides since creation</summary>
        public double SandOut;
        public double WaterIn;
        public double WaterOut;
        /// <summary>[m3] of sources and rain that found no room below method.largest_height, the highest elevation</summary>
        public double Refused;
        /// <summary>now - (initial + in - out) in quanta of depth x cell area; 0 = exact; sums stop at 2^60</summary>
        public long SandDriftQuanta;
        public long WaterDriftQuanta;
        /// <summary>[m]</summary>
        public double Quantum;
        /// <summary>hs [m]</summary>
        public double LargestSandDepth;
        /// <summary>W [m]</summary>
        public double LargestTotalWaterDepth;
        /// <summary>largest face velocity of pure and mixed water [m/s]</summary>
        public double LargestWaterSpeed;
        /// <summary>[m/s]</summary>
        public double LargestSandSpeed;
        /// <summary>least hs or W [m]: never negative</summary>
        public double SmallestDepth;
        /// <summary>values that are NaN or infinite: never any</summary>
        public ulong NotFinite;
        /// <summary>faces at the velocity clamp</summary>
        public ulong ClampedFaces;
        /// <summary>faces whose gravity the next step caps</summary>
        public ulong CappedFaces;
        /// <summary>cells whose outflow the next step limits</summary>
        public ulong LimitedCells;
        /// <summary>
        /// of the world, and of those the ones that the newest step ran over; 0 without active tiles. Where water and sand have a
        /// list each, those in the longer one
        /// </summary>
        public ulong Tiles;
        /// <summary>
        /// of the world, and of those the ones that the newest step ran over; 0 without active tiles. Where water and sand have a
        /// list each, those in the longer one
        /// </summary>
        public ulong ActiveTiles;
        /// <summary>64-bit state hash, ghosts excluded</summary>
        public ulong Hash;
        /// <summary>
        /// columns of terrain, sand and water above method.largest_height, which flow and pushes can pile up: there heights are
        /// rounded like any float, and the books drift
        /// </summary>
        public ulong HighColumns;
        /// <summary>faces beside water deeper than method.dry_threshold, inside it too: what the next three are of</summary>
        public ulong WetFaces;
        /// <summary>those of the counts above that hold water; the rest hold sand</summary>
        public ulong ClampedWaterFaces;
        public ulong CappedWaterFaces;
        public ulong LimitedWaterCells;
        /// <summary>faces beside sand deeper than method.dry_threshold</summary>
        public ulong SandFaces;
        /// <summary>
        /// the time step with which, as far as this state tells, neither clamp nor cap would hold water; dt where none does [s]
        /// </summary>
        public double UnlimitedDt;
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe WorldStats Default
        {
            get
            {
                var value = new WorldStats();
                value.structSize = (uint)sizeof(WorldStats);
                return value;
            }
        }
    }

    /// <summary>The state at one point.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct QueryResult
    {
        /// <summary>elevation of the ground [m]; elevations and depths are bilinear between cell centres</summary>
        public float Terrain;
        /// <summary>[m]</summary>
        public float SandDepth;
        /// <summary>pure water above the sand [m]; 0 where all four cells around are dry</summary>
        public float WaterDepth;
        /// <summary>
        /// elevation of the visible surface, H + max(W, hs) [m]. At the water's edge it leads from the water's surface in the last
        /// wet cell to the ground of the dry one, as a mesh through the cell centres does
        /// </summary>
        public float Surface;
        /// <summary>of the pure water, between faces [m/s]; 0 on dry faces</summary>
        public float VelocityX, VelocityY;
        /// <summary>of the visible surface, unit length, up; slopes bilinear between cell centres</summary>
        public float NormalX, NormalY, NormalZ;
        /// <summary>W/(W + hs) of the sand, 0 without sand</summary>
        public float Saturation;
        int inside;
        /// <summary>0: the point is outside the grid, all else is 0</summary>
        public bool Inside { get { return inside != 0; } set { inside = value ? 1 : 0; } }
    }

    /// <summary>A body in the water. World axes: x east, y north, z up.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Body
    {
        uint structSize;
        public BodyShape Shape;
        /// <summary>of its middle [m]</summary>
        public float PositionX, PositionY, PositionZ;
        /// <summary>unit quaternion x, y, z, w from the body's axes to the world's; spheres ignore it</summary>
        public float OrientationX, OrientationY, OrientationZ, OrientationW;
        /// <summary>box: half edges along its own axes [m], above 0</summary>
        public float HalfSizeX, HalfSizeY, HalfSizeZ;
        /// <summary>sphere [m], above 0</summary>
        public float Radius;
        /// <summary>[m/s]</summary>
        public float VelocityX, VelocityY, VelocityZ;
        /// <summary>about the world's axes [rad/s]</summary>
        public float AngularVelocityX, AngularVelocityY, AngularVelocityZ;
        /// <summary>[kg/m3], 0 or more; default 1000</summary>
        public float WaterDensity;
        /// <summary>[m/s2], 0 or more; default 9.81</summary>
        public float Gravity;
        /// <summary>of the whole body [kg/s], 0 or more; default 0</summary>
        public float LinearDrag;
        /// <summary>drag coefficient, dimensionless, 0 or more; default 1</summary>
        public float QuadraticDrag;
        /// <summary>columns per side, 1 ... 16; default 4</summary>
        public int Samples;
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe Body Default
        {
            get
            {
                var value = new Body();
                value.structSize = (uint)sizeof(Body);
                value.OrientationW = 1f;
                value.HalfSizeX = 0.5f;
                value.HalfSizeY = 0.5f;
                value.HalfSizeZ = 0.5f;
                value.Radius = 0.5f;
                value.WaterDensity = 1000f;
                value.Gravity = 9.81f;
                value.QuadraticDrag = 1f;
                value.Samples = 4;
                return value;
            }
        }
    }

    /// <summary>
    /// One edit. A cell at a hard rim counts by the share that lies inside. The shape may lie outside the grid in part or as a whole.
    /// Positions are kept to 1/256 of a cell.
    /// </summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Edit
    {
        uint structSize;
        public EditKind Kind;
        /// <summary>of brush and stamp</summary>
        public Layer Layer;
        int capsule;
        /// <summary>brush and push: 0 = disc round (x0, y0), 1 = all within radius of the line from (x0, y0) to (x1, y1)</summary>
        public bool Capsule { get { return capsule != 0; } set { capsule = value ? 1 : 0; } }
        /// <summary>the water step ahead of which it acts, as wadi_world_get_time counts; 0 = the next one</summary>
        public ulong Step;
        /// <summary>[m], -1e9 ... 1e9; of a stamp the low corner</summary>
        public double X0;
        /// <summary>[m], -1e9 ... 1e9; of a stamp the low corner</summary>
        public double Y0;
        /// <summary>[m], capsule and stamp only; of a stamp the high corner, greater than the low one</summary>
        public double X1;
        /// <summary>[m], capsule and stamp only; of a stamp the high corner, greater than the low one</summary>
        public double Y1;
        /// <summary>[m], 1e-9 ... 1e9, brush and push</summary>
        public double Radius;
        /// <summary>0 ... 1, brush and push: share of the radius over which the effect falls to 0 (3 s^2 - 2 s^3)</summary>
        public double Softness;
        /// <summary>
        /// brush: change at the centre [m], of the terrain's elevation or of a layer's depth, water's being W; stamp: the same per
        /// unit of the image. At most twice method.largest_height up or down
        /// </summary>
        public double Amount;
        /// <summary>0 ... 1, push: how far velocities are drawn to the body's at the centre</summary>
        public double Strength;
        /// <summary>[m/s], -1e4 ... 1e4, push: the body's velocity</summary>
        public double VelocityX;
        public double VelocityY;
        /// <summary>stamp: its number, from wadi_world_create_stamp</summary>
        public uint Stamp;
        /// <summary>0 ... 4294967295: those of one step act by rising player, whoever was queued first; default 0</summary>
        public ulong Player;
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe Edit Default
        {
            get
            {
                var value = new Edit();
                value.structSize = (uint)sizeof(Edit);
                value.Radius = 1;
                value.Softness = 0.5;
                value.Strength = 1;
                return value;
            }
        }
    }

    /// <summary>Rows of floats in memory of the device or the host, the south first.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct DeviceValues
    {
        uint structSize;
        /// <summary>
        /// HOST_POINTER: any world, read before the call returns. Else memory of the API that the world runs in: CUDA_POINTER of its
        /// device, or VULKAN_BUFFER of its vulkan_host, made with VK_BUFFER_USAGE_TRANSFER_SRC_BIT, CONCURRENT or owned by
        /// queue_family
        /// </summary>
        public HandleKind HandleKind;
        /// <summary>address, or VkBuffer</summary>
        public ulong Handle;
        /// <summary>of the region's south-west value [bytes], a multiple of 4</summary>
        public ulong Offset;
        /// <summary>[bytes], a multiple of 4, at least 4 * nx of the region; 0 = 4 * nx</summary>
        public ulong RowPitch;
        /// <summary>A struct with the size that the library asks for and the header's defaults.</summary>
        public static unsafe DeviceValues Default
        {
            get
            {
                var value = new DeviceValues();
                value.structSize = (uint)sizeof(DeviceValues);
                return value;
            }
        }
    }

    /// <summary>A value at a time. In a series it is linear between samples and constant outside; one sample is constant.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Sample
    {
        /// <summary>simulated, as wadi_world_get_time counts [s]</summary>
        public double Time;
        public double Value;
    }

    /// <summary>
    /// A source or drain of a world: a tap, a spring, a pump, a conveyor. Numbers as "sources" of level files have them.
    /// </summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct RawSource
    {
        uint structSize;
        public SourceShape Shape;
        int sand;
        /// <summary>1 = of sand, 0 = of water</summary>
        public bool Sand { get { return sand != 0; } set { sand = value ? 1 : 0; } }
        int drain;
        /// <summary>1 = with `level`: takes away what stands above, too</summary>
        public bool Drain { get { return drain != 0; } set { drain = value ? 1 : 0; } }
        /// <summary>x, y of point and disc [m]</summary>
        public double CenterX, CenterY;
        /// <summary>disc [m], above 0</summary>
        public double Radius;
        /// <summary>x, y of a box's south-west and north-east corner [m], `to` the greater</summary>
        public double FromX, FromY;
        /// <summary>x, y of a box's south-west and north-east corner [m], `to` the greater</summary>
        public double ToX, ToY;
        int setVelocity;
        /// <summary>1 = `velocity` holds</summary>
        public bool SetVelocity { get { return setVelocity != 0; } set { setVelocity = value ? 1 : 0; } }
        /// <summary>
        /// samples, 0 ... 4096; 0 = there is no such series. A source has a rate, a discharge or a level; with a level the other is
        /// the most that it moves
        /// </summary>
        public uint RateCount;
        public uint DischargeCount;
        public uint LevelCount;
        /// <summary>forced on the water inside while something is added [m/s], -1e4 ... 1e4</summary>
        public double VelocityX, VelocityY;
        /// <summary>depth per time [m/s], -1e4 ... 1e4; below 0 it takes away; 0 = off</summary>
        public IntPtr Rate;
        /// <summary>volume per time [m3/s], -1e9 ... 1e9, shared by the cells inside</summary>
        public IntPtr Discharge;
        /// <summary>of water: elevation of the surface that it holds in each cell [m]</summary>
        public IntPtr Level;
        /// <summary>wadi_world_set_source: the water step ahead of which it changes; 0 = the next one</summary>
        public ulong Step;
        /// <summary>as wadi_edit.player</summary>
        public ulong Player;
        /// <summary>A struct with the size that the library asks for and the header's defaults; texts stay null.</summary>
        public static unsafe RawSource Default
        {
            get
            {
                var value = new RawSource();
                value.structSize = (uint)sizeof(RawSource);
                value.Radius = 1;
                return value;
            }
        }
    }

    /// <summary>One number of the material.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct MaterialInfo
    {
        unsafe fixed byte name[32];
        /// <summary>as level files write it: "friction", "cohesion_wet", "saturation[0]"</summary>
        public unsafe string Name { get { fixed (byte* text = name) return Text.Of(text, 32); } }
        /// <summary>now; units as in level files</summary>
        public double Value;
        /// <summary>what wadi_world_set_material takes</summary>
        public double Least;
        /// <summary>what wadi_world_set_material takes</summary>
        public double Most;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct EffectInfo
    {
        unsafe fixed byte name[32];
        /// <summary>as level files write it</summary>
        public unsafe string Name { get { fixed (byte* text = name) return Text.Of(text, 32); } }
        int on;
        /// <summary>1 = its passes run and its fields exist</summary>
        public bool On { get { return on != 0; } set { on = value ? 1 : 0; } }
        unsafe fixed byte why[160];
        /// <summary>one sentence: why it is on or off</summary>
        public unsafe string Why { get { fixed (byte* text = why) return Text.Of(text, 160); } }
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct MemoryItem
    {
        unsafe fixed byte label[64];
        /// <summary>the field, or what the buffer is for</summary>
        public unsafe string Label { get { fixed (byte* text = label) return Text.Of(text, 64); } }
        public ulong Bytes;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct StageTiming
    {
        unsafe fixed byte name[64];
        public unsafe string Name { get { fixed (byte* text = name) return Text.Of(text, 64); } }
        /// <summary>mean per water step, all its sand substeps together</summary>
        public double Milliseconds;
        /// <summary>dispatches per water step</summary>
        public uint Passes;
    }
}
