// Written by plugin/csharp/write_csharp.py from plugin/wadi_api.json.
using System;
using System.Runtime.InteropServices;

namespace Wadi
{
    /// <summary>
    /// Gets what the library has to tell. Warnings are advice on a level, and limits that hold a running world back, each kind once,
    /// with the time step or setting that would end it. Information is each world made and each change of its effects. An error is a
    /// lost device. Messages of drivers and validation layers come here, too. Called during a call of the library, or from a driver's
    /// thread. It must not call the library; what it throws is lost.
    /// </summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void LogCallback(void* user, LogLevel level, byte* message);

    /// <summary>Part `n` of a pass of the CPU backend: any thread may run it, parts in any order and at once.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void Job(void* data, uint n);

    /// <summary>
    /// The host's job system: runs job(data, n) for each n below count, on any of its threads or one after the other on one, and
    /// returns when all have returned. A part that has begun may wait for others that have begun: they must be threads, not fibres of
    /// one. A part that is left out, runs twice or begins late changes no bit; none may begin after wadi_destroy_world. Called from a
    /// thread of the library, several times a step; must not throw and must not call the library.
    /// </summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void RunJobsCallback(void* user, uint count, IntPtr job, void* data);

    /// <summary>
    /// The host's memory: `bytes` (1 or more) at a multiple of `alignment`, a power of two, or NULL where it refuses. They need not
    /// be zero.
    /// </summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void* AllocateCallback(void* user, UIntPtr bytes, UIntPtr alignment);

    /// <summary>
    /// Takes back, whole, what the allocate callback gave. Both are called from threads of the library and of the host, from several
    /// at once; they must not call the library; what they throw counts as a refusal.
    /// </summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void FreeCallback(void* user, void* memory, UIntPtr bytes);

    /// <summary>
    /// Hears how far the call that makes a world is, as a share from 0 to 1 that never falls. Returns 1 to go on, or 0 to end the
    /// call with WADI_CANCELLED. Called on that call's thread alone, at least once for each layer of a level, and also before the
    /// device is opened and before the world is handed out. It is not called while a file is decoded or a driver compiles. It must
    /// not call the library. Should not throw: whatever it throws ends the call.
    /// </summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate int ProgressCallback(void* user, double share);

    /// <summary>
    /// Reads a file that a level names, for the host's own file system. Called with data NULL first: sets *size to the file's bytes;
    /// then with room for *size bytes: fills it and sets *size to what it wrote. Returns 1, or 0 where there is no such file. `name`
    /// is as the level writes it, '/' between folders, and never leads out of the level's folder but with overrides.any_files. Called
    /// only inside wadi_create_world_from_level_text, on its thread. Should not throw: whatever it throws ends that call with
    /// INTERNAL.
    /// </summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate int ReadFileCallback(void* user, byte* name, void* data, UIntPtr* size);

    /// <summary>The calls of wadi.h under their own names. World and Library are what programs use.</summary>
    public static unsafe class Native
    {
        /// <summary>libwadi.so on Linux, libwadi.dll on Windows.</summary>
        public const string Library = "libwadi";

        /// <summary>The ABI version of the library that is loaded; compare it with WADI_ABI_VERSION.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern uint wadi_get_abi_version();

        /// <summary>
        /// The version of the library that is loaded, as WADI_MAKE_VERSION writes it: at least WADI_VERSION has all that this header
        /// names.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern uint wadi_get_version();

        /// <summary>
        /// One line about the last error on this thread, "" before the first; never NULL. Calls that succeed leave it as it is; the
        /// pointer stays good as long as the thread, with the text of the newest error.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern byte* wadi_get_last_error();

        /// <summary>
        /// Lists the devices of all backends of this build. `notes` (may be NULL) receives one line per backend without a device,
        /// saying why, cut to notes_size bytes. Errors: BAD_ARGUMENT (sizes of infos that differ).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_list_devices(DeviceInfo* infos, uint* count, byte* notes, UIntPtr notesSize);

        /// <summary>Lists the accuracy presets by rising accuracy.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_list_accuracy_presets(RawAccuracyPreset* presets, uint* count);

        /// <summary>
        /// Creates a world from a level file (.json) or from a terrain map (.png, .r16, .r32, .raw, .hgt, .npy, .asc). overrides,
        /// options: NULL = the defaults. Waits: for compilers of drivers. Errors: NOT_FOUND, BAD_FILE, BAD_ARGUMENT, OUT_OF_MEMORY,
        /// NOT_SUPPORTED; no world is made.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_create_world_from_level(byte* path, RawLevelOverrides* overrides, RawDeviceOptions* options,
            WorldId* world);

        /// <summary>
        /// Creates a world from the text of a level file. Maps and series that it names come from read_file; with read_file NULL it
        /// may name none: nothing is read from disk. Waits and errors: those of wadi_create_world_from_level.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_create_world_from_level_text(byte* json, ReadFileCallback readFile, void* user,
            RawLevelOverrides* overrides, RawDeviceOptions* options, WorldId* world);

        /// <summary>
        /// What wadi_create_world_from_level, or ..._text, would cost. The level's text and series are read, and the headers of its
        /// maps; nothing is decoded or drawn and no device is opened. overrides: NULL = the defaults. Errors: those of the call that
        /// it is of, as far as that much shows them.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_get_level_cost(byte* path, RawLevelOverrides* overrides, Cost* cost);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_get_level_text_cost(byte* json, ReadFileCallback readFile, void* user, RawLevelOverrides*
            overrides, Cost* cost);

        /// <summary>Creates a world from arrays. Waits and errors: those of wadi_create_world_from_level.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_create_world_from_arrays(RawWorldArrays* arrays, RawDeviceOptions* options, WorldId* world);

        /// <summary>Frees a world. Waits: for what the device is at.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_destroy_world(WorldId world);

        /// <summary>Tells what a world is.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_info(WorldId world, WorldInfo* info);

        /// <summary>The text of warning n of the level; NULL and an error beyond the last. It lives as long as the world.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern byte* wadi_world_get_warning(WorldId world, uint n);

        /// <summary>
        /// Sets how updates take steps, from the next one on. Waits: nothing, unless interpolate_outputs changes: room, as
        /// wadi_world_set_outputs. Errors: BAD_ARGUMENT (out of range), OUT_OF_MEMORY.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_update_settings(WorldId world, UpdateSettings* settings);

        /// <summary>
        /// Advances by `host_nanoseconds` of host time since the last update (0 is allowed), then publishes the outputs: the call of
        /// each frame. Steps are fixed. After a total of t nanoseconds, less those dropped, floor(t / dt) water steps are done (dt as
        /// the double dt * 1e9, the quotient exact). So the same total gives the same bits in frames of any length. You may call
        /// wadi_world_step between updates. Its steps are beside this clock, which goes on where it was. Every call that reads or
        /// changes the state first finishes a step that `spread` began; the update in which it falls due does not repeat it. Waits:
        /// nothing, unless max_steps_in_flight is 0; a step ahead of which an edit brings a new material may (wadi_world_edit).
        /// Errors: OUT_OF_MEMORY (a new material). One that fails has not taken the time: repeated, it takes what steps are left of
        /// it.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_update(WorldId world, ulong hostNanoseconds, Frame* frame);

        /// <summary>
        /// Advances by `steps` water steps of fixed dt. Returns before the device has finished; reads wait for it. Waits: while the
        /// device's queue is full. Errors: OUT_OF_MEMORY (a new material; the steps ahead of it are taken, wadi_world_get_time counts
        /// them).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_step(WorldId world, uint steps);

        /// <summary>Simulated time [s] and water steps so far. Either pointer may be NULL.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_time(WorldId world, double* seconds, ulong* steps);

        /// <summary>
        /// Chooses what every update publishes; 0 = nothing, which costs nothing. Each output takes three buffers (previous, current,
        /// being written), the tiles in addition those of SAND_SURFACE and FREE_SURFACE. Where the mask changes, views taken before
        /// are void, and there is nothing to view until the next update. Waits: room, where the mask changes. Errors: BAD_ARGUMENT
        /// (an unknown bit), OUT_OF_MEMORY.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_outputs(WorldId world, OutputMask mask);

        /// <summary>
        /// Views an output on the device. PREVIOUS and CURRENT stay as they are during the next update at least: a publish writes the
        /// third set. Errors: BAD_ARGUMENT (no such output or set, not asked for), NOT_READY (not published yet; PREVIOUS: only
        /// once).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_view(WorldId world, Output output, OutputSet set, OutputView* view);

        /// <summary>
        /// Chooses outputs whose publishes are also copied to host memory, for hosts that share no API with the device; 0 = none.
        /// They need not be in the mask of wadi_world_set_outputs. Waits and errors: those of wadi_world_set_outputs.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_host_outputs(WorldId world, OutputMask mask);

        /// <summary>
        /// Waits until what the newest update published is there for all to see: the next wadi_world_get_host_output, _get_tiles and
        /// _get_dirty_regions give it, and views of the current set are `finished`. For programs that print, film or compute, and for
        /// tests; a game goes on drawing what has arrived. Steps of wadi_world_step are published by an update, which may be of 0
        /// nanoseconds. What those calls gave before stays valid as it would have. Waits: the steps. Errors: BAD_ARGUMENT (no output
        /// was asked for), NOT_READY (no update has published yet).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_wait_for_outputs(WorldId world);

        /// <summary>
        /// The newest copy that has arrived, usually of the update before. Cell (i, j) begins at byte j * row_pitch + i * bytes of a
        /// cell; PACKED_HALF has four 16-bit floats there (const uint16_t*). The same for all calls until an update or
        /// wadi_world_wait_for_outputs; valid until the second next update or until a mask changes. row_pitch [bytes] and step may be
        /// NULL. Errors: BAD_ARGUMENT (no such output, not asked for), NOT_READY (none has arrived yet).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_host_output(WorldId world, Output output, float** data, ulong* rowPitch, ulong* step);

        /// <summary>
        /// The newest tiles that have arrived from the device, in rows from south to north. Needs WADI_OUTPUT_TILES_BIT. *step (may
        /// be NULL): of the publish. Errors: BAD_ARGUMENT (not asked for), NOT_READY (none has arrived yet).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_tiles(WorldId world, Tile* tiles, uint* count, ulong* step);

        /// <summary>
        /// Rectangles that hold every cell whose solid or visible surface changed in a publish after step `since_step` (-1 = ever).
        /// They are tiles, neighbours in a row of tiles as one. Pass *step of one call as since_step to the next, and -1 after
        /// wadi_world_load. Errors: those of wadi_world_get_tiles; BAD_ARGUMENT (since_step below -1).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_dirty_regions(WorldId world, long sinceStep, Region* regions, uint* count, ulong*
            step);

        /// <summary>
        /// Short name used by tools: "H", "hs", "W", "hw", "surface", "phi", "uw", "vw", "us", "vs", "um", "vm", "Vxx", "Vxy", "Vyy",
        /// "limits", "foam", "wet", "silt"; NULL if unknown.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern byte* wadi_field_name(Field field);

        /// <summary>
        /// Reads a field, count = nx * ny floats. A field that the world's effects lack reads as zero. Waits: the steps. Errors:
        /// BAD_ARGUMENT (field, count).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_read_field(WorldId world, Field field, float* values, UIntPtr count);

        /// <summary>
        /// Reads a field in a region within the grid, count = its nx * ny floats. Waits: the steps. Errors: BAD_ARGUMENT (field,
        /// region, count).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_read_region(WorldId world, Field field, Region* region, float* values, UIntPtr count);

        /// <summary>Takes the statistics: reads the whole state, so not for every frame. Waits: the steps.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_stats(WorldId world, WorldStats* stats);

        /// <summary>
        /// 64-bit hash of the state, ghosts and terrain excluded: wadi_world_stats.hash without the rest. Equal states have equal
        /// hashes on every backend that passes the exact-float test. Reads the whole state. Waits: the steps.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_hash(WorldId world, ulong* hash);

        /// <summary>
        /// Asks for the state at `count` (1 ... 65536) points of the world: x, y of each in metres from the south-west corner of the
        /// grid. Answered for the state after the steps asked for so far or, in the middle of a step that runs in parts, after that
        /// step. Eight batches may be under way. The first eight calls allocate. Waits: nothing, but room for the first eight calls
        /// with more points than before (in powers of two, 1024 at least). Errors: NOT_READY (eight are under way), BAD_ARGUMENT
        /// (count, a coordinate that is NaN or infinite), OUT_OF_MEMORY.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_query(WorldId world, float* xY, uint count, ulong* ticket);

        /// <summary>
        /// The answers in the order of the points, their number and the step they are of. They may be fetched again until eight later
        /// batches were asked for. results may be NULL to ask count and step only; count and step may be NULL. Errors: NOT_READY (not
        /// there yet), BAD_ARGUMENT (unknown or too old a ticket, capacity below the number).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_query(WorldId world, ulong ticket, QueryResult* results, uint capacity, uint* count,
            ulong* step);

        /// <summary>
        /// The points to pass to wadi_world_query for a body: samples * samples for a box, those within the circle for a sphere.
        /// Needs no world. *count: points that fit xy in, points out; xy may be NULL to ask the number. Errors: BAD_ARGUMENT (a field
        /// of the body, too little room).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_buoyancy_points(Body* body, float* xY, uint* count);

        /// <summary>
        /// Force [N] and torque about the body's middle [N m] of the water, from the answers for those points. The body may have
        /// moved meanwhile. It is cut into columns, upright or along its steepest axis. Where V of a column lies between bed and
        /// surface: buoyancy water_density * gravity * V, upwards, at the middle of that part; drag V / volume * (linear_drag * du +
        /// water_density * quadratic_drag * area * |du| * du / 2) there, with du the water's velocity (vertical: 0) less the body's,
        /// area = pi radius^2 or volume^(2/3) of a box. The weight of the body is not in it; points outside the grid give nothing.
        /// Needs no world. Errors: BAD_ARGUMENT (a field of the body, count not that of wadi_buoyancy_points).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_buoyancy_force(Body* body, QueryResult* results, uint count, float* force, float* torque);

        /// <summary>
        /// Queues `count` edits. Ahead of a step its edits act by rising `player`, and those of one player in the order of the calls.
        /// In lockstep give each player a number, and it does not matter whose edits reach a machine first. In the middle of a step
        /// that runs in parts "the next one" is the one after it. Depths change by whole quanta and every quantum is in the ledger.
        /// What finds no room below method.largest_height is refused and counted (wadi_world_stats.refused). No more is taken than
        /// there is. Sand and water keep their depth where terrain changes. Added sand is unstrained, or in balance with
        /// method.prestress. An edit that adds a material the world has not held so far promotes it when its step comes. Buffers are
        /// then allocated and programs recorded anew, once, and that step may wait for the device. Edits of the level itself act
        /// ahead of these and are no part of the command log. Going back in time, by wadi_world_load or in another way, drops the
        /// edits that wait: queue those of later steps again. Errors: BAD_ARGUMENT, naming edit, field and range, or `effects` when
        /// the level forces off what an edit adds; none is queued.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_edit(WorldId world, Edit* edits, uint count);

        /// <summary>
        /// Copies an image for stamps: nx * ny values (1 ... 4096 each, |value| &lt;= 1e12), row 0 in the south, bilinear between
        /// pixels. *stamp counts up from 1; stamps live as long as the world. Waits: room. Errors: BAD_ARGUMENT, OUT_OF_MEMORY.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_create_stamp(WorldId world, int nx, int ny, float* values, uint* stamp);

        /// <summary>
        /// Overwrites TERRAIN, SAND_DEPTH or TOTAL_WATER_DEPTH [m] in a region at once, after the steps asked for. Values are rounded
        /// to quanta; what that adds or takes is in the ledger; velocities stay. Promotes like an edit. Waits: the steps. Errors:
        /// BAD_ARGUMENT (another field, a region outside, NaN, a negative depth, a column above method.largest_height: the message
        /// names the cell; `effects` forced off), OUT_OF_MEMORY.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_write_region(WorldId world, Field field, Region* region, float* values, UIntPtr count);

        /// <summary>
        /// wadi_world_write_region of values that the host need not see: copied and checked on the device, after the steps asked for.
        /// A value that wadi_world_write_region takes gives the same bits, and with method.quantum above 0 the same counts. Which it
        /// refuses the host cannot be told in time: too high or too low is cut to what the cell has room for; what was cut (beyond
        /// twice method.largest_height: that) is counted in wadi_world_stats.refused; NaN or infinite the cell stays as it is, and
        /// method.largest_height is counted there. SAND_DEPTH and TOTAL_WATER_DEPTH promote the world whatever the values are. Device
        /// memory is read behind all that the host put on the world's queue and points of wadi_vulkan_wait, with CUDA behind events
        /// of wadi_cuda_wait. It must stay as it is until that is done (behind wadi_vulkan_signal, wadi_cuda_signal, or on the
        /// queue). Waits: room for a larger region than before, and for compilers of drivers at first; of HOST_POINTER the fifth
        /// write for the first; while the device's queue is full. Errors: BAD_ARGUMENT (another field, a region outside, a field of
        /// `values`: the message says what is allowed; `effects` forced off), NOT_SUPPORTED (while the command log is on; device
        /// memory where the world knows none of the host's), NOT_READY (recorded work would be overtaken), OUT_OF_MEMORY.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_write_region_from(WorldId world, Field field, Region* region, DeviceValues* values);

        /// <summary>
        /// Compiles the pipelines of every effect that the level allows, so that a later promotion only allocates and records. Costs
        /// time once (GPU drivers: up to seconds) and next to no memory; call it while loading. Waits: for compilers of drivers.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_prepare_effects(WorldId world);

        /// <summary>
        /// Frees the passes and buffers of materials that the world no longer holds; what it gave and took stays in the ledger.
        /// Waits: the steps, and reads the depths.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_trim(WorldId world);

        /// <summary>
        /// Source `index` as it is now, 0 ... wadi_world_info.source_count - 1: those of the level come first, in its order. The
        /// series stay where they are until the next call of it on this world or wadi_destroy_world. step and player are 0. Errors:
        /// BAD_ARGUMENT (no such source: the message says how many there are).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_source(WorldId world, uint index, RawSource* source);

        /// <summary>
        /// Makes source `index`, 0 ... 31, another one: moves it, opens or closes it, or adds one. It waits for its step like an
        /// edit, with edits' rule of players, and acts ahead of them. To close a tap give it one sample of 0; sources are never taken
        /// out. Those below `index` that the world lacks come along, closed. Series are copied. What the ledger has of the source
        /// stays. The command log has the change. Snapshots and kept steps hold the sources of their moment. Like edits, changes that
        /// wait are in no snapshot and no kept step, and every way back in time drops them. Other values of the series cost a look at
        /// them. Another place, shape or number of sources records the step anew once its own comes: some milliseconds, so move taps
        /// seldom, or pour with a brush that follows. The first source of a material promotes the world, as an edit does. Waits:
        /// nothing; ahead of a step at which a source comes to another place wadi_world_step and _update wait for the steps before.
        /// Errors: BAD_ARGUMENT, naming the field and its range (a shape outside the grid, a rate beside a discharge, times that do
        /// not rise, a step that is done, `effects` that the level forces off), NOT_SUPPORTED (the command log is on and full for
        /// that step); nothing is changed. What only shows at its step, OUT_OF_MEMORY or NOT_READY (inside a recording), is an error
        /// of wadi_world_step or _update.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_source(WorldId world, uint index, RawSource* source);

        /// <summary>Lists the numbers of the material and their present values.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_material(WorldId world, MaterialInfo* infos, uint* count);

        /// <summary>
        /// Changes one of them from the next whole step on, in the level's units. Effects follow as for a level with that value. 0 in
        /// young_modulus, exchange_rate, diffusion_rate, bed_friction and manning, or bed_shear drops its effect, and with
        /// elastoplastic the strain of the sand. A value above 0 brings the effect, which allocates. Where effects stay, no pipeline
        /// is made: the step is recorded anew, once per change. Ahead of the first step the world becomes that of a level with the
        /// value, in every bit. Later, sand keeps the strain that it has (with method.prestress, that in balance with the material it
        /// was drawn with). The command log has the change. Snapshots and kept steps hold the values of their moment and bring them
        /// back. The level's warnings are not checked again. Waits: nothing, but the steps if it is called ahead of the first step,
        /// or if young_modulus was 0. Errors: NOT_FOUND (name), BAD_ARGUMENT (out of range, NaN, saturations out of order, or a
        /// number of an effect that the level forces off: the message says which), OUT_OF_MEMORY, NOT_READY (inside a recording).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_material(WorldId world, byte* name, double value);

        /// <summary>
        /// Saves the state to memory, to the bit: fields, ledgers and running totals, not the level itself nor edits and sources that
        /// wait. *size: bytes at `data` in, bytes of the snapshot out; data may be NULL to ask the number. Waits: the steps; nothing
        /// to ask the number. Errors: BAD_ARGUMENT (size too small).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_save(WorldId world, void* data, UIntPtr* size);

        /// <summary>
        /// Goes to a saved state: the world continues as the saved one would have, in every bit, on any backend that passes the
        /// exact-float test. The snapshot must be of a world of the same level settings (grid, dt, material, method, sides, sources,
        /// rain). Its material and sources are taken as they were changed by then. Initial fields may differ. Effects that only this
        /// world has start from zero, and the world is promoted to those that only the snapshot has. Edits and sources that wait and
        /// steps kept for roll-back are forgotten. Waits: the steps. Errors, the world as it was, also where the host's own memory
        /// ends: BAD_FILE (no snapshot, a newer version, truncated, changed), BAD_ARGUMENT (of another level, or with effects that
        /// this world's level forces off), OUT_OF_MEMORY.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_load(WorldId world, void* data, UIntPtr size);

        /// <summary>
        /// What wadi_world_load of these bytes would cost; the world stays as it is. Errors: those of wadi_world_load that the
        /// snapshot's header shows.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_snapshot_cost(WorldId world, void* data, UIntPtr size, Cost* cost);

        /// <summary>
        /// wadi_world_save to a file. Written beside it under a name that ends in ".part" and that no other call has, brought to the
        /// disk and renamed when it is whole. So several savers to one path each leave a whole file. A process that is killed
        /// meanwhile leaves its part. Waits: the steps, the disk. Errors, an earlier file unchanged: NOT_FOUND (the folder cannot be
        /// written to), BAD_FILE (writing failed, or path is a folder, pipe or device).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_save_file(WorldId world, byte* path);

        /// <summary>
        /// wadi_world_load from a regular file; one larger than any snapshot of this world is refused unread. Waits: the steps, the
        /// disk. Errors: NOT_FOUND, and those of wadi_world_load.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_load_file(WorldId world, byte* path);

        /// <summary>
        /// Asks for a snapshot of the state after the steps asked for so far, or, in the middle of a step that runs in parts, after
        /// that step. The device copies the state aside; the first call allocates room for it. A snapshot asked for earlier that
        /// nobody has begun to fetch is forgotten. Errors: NOT_READY (the device or a worker is still at an earlier one),
        /// OUT_OF_MEMORY.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_begin_save(WorldId world, ulong* ticket);

        /// <summary>
        /// Fetches it: NOT_READY until the snapshot lies in `data`, then OK, once. A worker thread fills `data`. From the first call
        /// on that memory must stay where it is, and you must pass the same pointer, until a call returns OK or the world is
        /// destroyed. An error does not end that. *size as in wadi_world_save; data may be NULL to ask the number. Where the system
        /// refuses that thread a call fills `data` itself. Errors: BAD_ARGUMENT (another ticket, another data, size too small),
        /// DEVICE_LOST (before the copy aside was done).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_end_save(WorldId world, ulong ticket, void* data, UIntPtr* size);

        /// <summary>
        /// Keeps earlier states on the device: the newest `frames` (0 ... 256; 0 = off, frees them) of the state now and of every
        /// later step that is a multiple of interval_steps (1 or more). Each takes the bytes of a snapshot, allocated here. States
        /// kept before are forgotten. Waits: nothing, but may when it frees. Errors: BAD_ARGUMENT, OUT_OF_MEMORY (nothing is kept
        /// then).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_rollback(WorldId world, uint frames, uint intervalSteps);

        /// <summary>Lists the steps that can be gone back to, oldest first.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_rollback_steps(WorldId world, ulong* steps, uint* count);

        /// <summary>
        /// Goes back to the newest kept step &lt;= `step`, written to *reached (may be NULL). Later kept steps, edits and sources
        /// that wait are forgotten. The world goes on from there as it did the first time, in every bit, given the same input. Steps
        /// with an effect that the world has lost since are forgotten. Waits: nothing, but the steps where material or sources were
        /// others then. Errors: BAD_ARGUMENT (no step that old is kept).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_roll_back(WorldId world, ulong step, ulong* reached);

        /// <summary>
        /// 1 = from now on remember every edit, source, written region, trim and change of the material with its step, in host memory
        /// that grows; 0 = stop and drop the log. Off at first. Going back in time drops what was remembered for later steps. While
        /// it is on wadi_world_write_region_from is refused.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_command_log(WorldId world, int on);

        /// <summary>
        /// The log as bytes, with all stamps of the world: a few dozen bytes per edit, versioned and checksummed. *size: bytes at
        /// `data` in, bytes of the log out; data may be NULL to ask the number. Errors: BAD_ARGUMENT (size too small).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_commands(WorldId world, void* data, UIntPtr* size);

        /// <summary>
        /// wadi_world_get_commands, of the commands that count ahead of `step` or a later one and are of one player alone, with the
        /// stamps that they use. A lockstep game sends this each turn, where every player queues for the steps of the turn after
        /// next. Commands other than edits and sources are of player 0. Played commands are in the log, too: ask for your own player,
        /// and none goes round twice. Errors: BAD_ARGUMENT (size too small; player above 4294967295 but WADI_EVERY_PLAYER).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_commands_since(WorldId world, ulong step, ulong player, void* data, UIntPtr* size);

        /// <summary>
        /// Queues the commands of a log in a world of the same level: a fresh one, or one that stands where logging began. Stamps
        /// that the world has are not made again. After the same number of steps, in frames of any rhythm, both have the same hash,
        /// on every backend that passes the exact-float test. Waits: room for stamps; the steps where a written region or trim counts
        /// at once, as do later steps ahead of which one counts. Errors, nothing queued: BAD_FILE (no log, a newer version,
        /// truncated, changed), BAD_ARGUMENT (of another level, or with commands for steps already done).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_play_commands(WorldId world, void* data, UIntPtr size);

        /// <summary>
        /// What wadi_world_play_commands of these bytes would cost; nothing is queued. Errors: those of wadi_world_play_commands.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_commands_cost(WorldId world, void* data, UIntPtr size, Cost* cost);

        /// <summary>
        /// The plan as text: effects on and why, passes, buffers, bytes per cell. Returns the length without the final zero; writes
        /// at most `size` bytes including it. 0 and an error for a bad world.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern UIntPtr wadi_world_describe_plan(WorldId world, byte* text, UIntPtr size);

        /// <summary>
        /// A table of the library as text, of any world and none: "settings" (keys of level files with unit, range, default),
        /// "effects", "fields", "stages", or "schema" (the settings as JSON). Returns the length without the final zero; writes at
        /// most `size` bytes including it. 0 and an error for another name.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern UIntPtr wadi_describe_table(byte* table, byte* text, UIntPtr size);

        /// <summary>Lists the effects and why each is on or off.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_effects(WorldId world, EffectInfo* effects, uint* count);

        /// <summary>
        /// Lists every buffer that the world holds on its device, those for the host to read included; they add up to
        /// wadi_world_info.device_bytes.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_memory(WorldId world, MemoryItem* items, uint* count);

        /// <summary>
        /// 1 = every step records timestamps, by programs recorded for it; off at first. Waits: the steps that are timed.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_profiling(WorldId world, int on);

        /// <summary>Lists the mean times since profiling was switched on. Waits: the steps that are timed.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_stage_timings(WorldId world, StageTiming* timings, uint* count);

        /// <summary>
        /// 1 = after every step the whole state is read and verified; off at first. Every number is finite, no depth is negative, no
        /// speed is above its clamp, and every quantum is in the books. The last three are not checked with method "published", and
        /// the books not of columns near method.largest_height. The call that takes a step which breaks one returns
        /// WADI_ERROR_INTERNAL, and wadi_get_last_error() names step, field and cell. Use it to look for a fault: each step is waited
        /// for, and takes many times as long.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_set_checking(WorldId world, int on);

        /// <summary>
        /// OK, or what broke the world for good (DEVICE_LOST) with wadi_get_last_error() saying how. A fault that the device has not
        /// reported yet is not known.
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_world_get_error(WorldId world);

        /// <summary>
        /// The world's next submission waits on the device for the newest record of `event` ahead of this call; for nothing where
        /// there is none. The event may be recorded anew, or destroyed, from here on. Errors: BAD_ARGUMENT (NULL, or no event of the
        /// device's primary context), NOT_SUPPORTED (the world's backend is not cuda).
        /// </summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_cuda_wait(WorldId world, void* @event);

        /// <summary>Records `event` behind everything that the world submitted so far. Errors: those of wadi_cuda_wait.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]
        public static extern Result wadi_cuda_signal(WorldId world, void* @event);
    }
}
