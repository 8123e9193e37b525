// Written by plugin/csharp/write_csharp.py from plugin/wadi_api.json.
using System;

namespace Wadi
{
    /// <summary>What this binding was written from.</summary>
    public static class Header
    {
        /// <summary>The library that is loaded must have this one.</summary>
        public const uint AbiVersion = 1;
        /// <summary>As wadi_get_version gives it: at least this has all that this binding names.</summary>
        public const uint Version = (0u << 22) | (1u << 12) | 0u;
    }

    public enum Result
    {
        Ok = 0,
        /// <summary>a value is wrong; the message names it and its range</summary>
        ErrorBadArgument = 1,
        /// <summary>no such file, level, backend, device or effect</summary>
        ErrorNotFound = 2,
        /// <summary>a file is malformed; the message names the field</summary>
        ErrorBadFile = 3,
        /// <summary>this build or device cannot do it</summary>
        ErrorNotSupported = 4,
        ErrorOutOfMemory = 5,
        /// <summary>sticky for the world; destroy it and create another</summary>
        ErrorDeviceLost = 6,
        /// <summary>our bug: please report the message</summary>
        ErrorInternal = 7,
        /// <summary>not an error: ask again later</summary>
        NotReady = 8,
        /// <summary>another thread is inside a call on this world; nothing was done</summary>
        ErrorBusy = 9,
        /// <summary>not an error: the host's progress callback ended the call; nothing was made</summary>
        Cancelled = 10,
    }

    public enum LogLevel
    {
        Error = 0,
        Warning = 1,
        Information = 2,
    }

    /// <summary>A choice that a level makes, too.</summary>
    public enum Choice
    {
        Off = -1,
        /// <summary>as the level says</summary>
        Level = 0,
        On = 1,
    }

    /// <summary>Tiles in which nothing changes any more are left out of a step; every bit stays, also in snapshots.</summary>
    public enum ActiveTiles
    {
        Off = -1,
        /// <summary>as the level says, by default CHEAP</summary>
        Level = 0,
        /// <summary>on while little of the world is awake</summary>
        Auto = 1,
        /// <summary>AUTO in large grids on GPUs, else OFF</summary>
        Cheap = 2,
        /// <summary>on, of 8 x 8 cells</summary>
        Tiles8 = 8,
        Tiles16 = 16,
        Tiles32 = 32,
        Tiles64 = 64,
    }

    /// <summary>
    /// Fields for drawing and collision, one value per cell (its centre), published on the device after the steps of an update.
    /// </summary>
    public enum Output
    {
        /// <summary>elevation of the ground H [m], 1 float</summary>
        Terrain = 0,
        /// <summary>elevation of the solid surface H + hs [m], 1 float</summary>
        SandSurface = 1,
        /// <summary>elevation of the visible surface H + max(W, hs) [m], 1 float</summary>
        FreeSurface = 2,
        /// <summary>hs [m], 1 float</summary>
        SandDepth = 3,
        /// <summary>pure water above the sand, what its pores do not hold [m], 1 float</summary>
        WaterDepth = 4,
        /// <summary>W/(W + hs) where there is sand, else 0; 1 float</summary>
        Saturation = 5,
        /// <summary>flow map: velocity of pure water, what is seen to move, east and north [m/s], 2 floats</summary>
        Flow = 6,
        /// <summary>east and north [m/s], 2 floats</summary>
        SandVelocity = 7,
        /// <summary>
        /// 0 ... 1 from the present state of the pure water (depth h, velocity u), 1 float: max(clamp((Fr^2 - 1)/3), clamp((R -
        /// 0.15)/0.5)) * clamp(10 h/dx), clamps to 0 ... 1; Fr = |u|/sqrt(g h) (fast water), R = -h div(u)/sqrt(g h) (rising,
        /// breaking fronts). With effect foam that which drifts, fades and lies on the shore, at most 1: PACKED, too
        /// </summary>
        Foam = 8,
        /// <summary>unit normal of the visible surface: east, north, up, 0; 4 floats</summary>
        Normal = 9,
        /// <summary>elevation of the visible surface after a 3 x 3 Gaussian [m], 1 float</summary>
        SmoothSurface = 10,
        /// <summary>one texel to draw a surface with: FREE_SURFACE, WATER_DEPTH, FOAM, SATURATION; 4 floats</summary>
        Packed = 11,
        /// <summary>
        /// the same, each rounded to a 16-bit float (11 bits: a surface 16 ... 32 m up to 16 mm), at most 65504; 8 bytes
        /// </summary>
        PackedHalf = 12,
        /// <summary>with effect wetness how wet the ground is, 1 under water, less the longer it is dry, else 0; 1 float</summary>
        Wetness = 13,
        /// <summary>
        /// with effect silt what makes the water muddy, per area of the ground [kg/m2], else 0; 1 float. Grains of 0.08 mm hide 1 -
        /// exp(-7 s) of the ground below them, finer ones more
        /// </summary>
        Silt = 14,
        Count = 15,
    }

    public enum OutputSet
    {
        /// <summary>the publish before the current one</summary>
        Previous = 0,
        /// <summary>the newest publish; wadi_frame.published_step</summary>
        Current = 1,
        /// <summary>
        /// between the two at the host's time, one dt late; outputs of 1 float, and only with
        /// wadi_update_settings.interpolate_outputs. Written anew by each update; an update leaves it as it is while the device is
        /// two updates behind
        /// </summary>
        Interpolated = 2,
    }

    public enum HandleKind
    {
        /// <summary>CPU backend: an address</summary>
        HostPointer = 0,
        /// <summary>VkBuffer</summary>
        VulkanBuffer = 1,
        /// <summary>CUdeviceptr</summary>
        CudaPointer = 2,
    }

    public enum Format
    {
        R32Float = 1,
        R32G32Float = 2,
        R32G32B32A32Float = 4,
        /// <summary>8 bytes; those above: so many floats of 4 bytes</summary>
        R16G16B16A16Float = 8,
    }

    public enum Field
    {
        /// <summary>H, elevation of the ground [m]</summary>
        Terrain = 0,
        /// <summary>hs [m]</summary>
        SandDepth = 1,
        /// <summary>W, depth of all water, above the sand and inside it [m]</summary>
        TotalWaterDepth = 2,
        /// <summary>pure water above the sand, what its pores do not hold [m]</summary>
        WaterDepth = 3,
        /// <summary>H + max(W, hs), elevation of what a viewer sees [m]</summary>
        FreeSurface = 4,
        /// <summary>W/(W + hs) where there is sand, else 0</summary>
        Saturation = 5,
        /// <summary>pure water, cell centre [m/s]</summary>
        WaterVelocityX = 6,
        WaterVelocityY = 7,
        /// <summary>[m/s]</summary>
        SandVelocityX = 8,
        SandVelocityY = 9,
        /// <summary>water inside sand [m/s]</summary>
        MixedVelocityX = 10,
        MixedVelocityY = 11,
        /// <summary>left stretch V - I of the sand</summary>
        StretchXX = 12,
        StretchXY = 13,
        StretchYY = 14,
        /// <summary>which limits hold the cell in the next step: a sum of wadi_limit bits, 0 = none</summary>
        Limits = 15,
        /// <summary>effect foam: 1 covers the cell, at most 4 where currents pile it up</summary>
        Foam = 16,
        /// <summary>effect wetness: 1 under water, less the longer the ground is dry</summary>
        Wetness = 17,
        /// <summary>effect silt: what makes the water muddy, per area of the ground, at most 8 [kg/m2]</summary>
        Silt = 18,
        Count = 19,
    }

    /// <summary>
    /// Bits of WADI_FIELD_LIMITS, of a cell or any of its four faces. wadi_world_stats counts the same, by faces.
    /// </summary>
    public enum Limit
    {
        /// <summary>water, pure or in sand, at the velocity clamp</summary>
        WaterSpeed = 1,
        /// <summary>gravity of water capped: waves are slower there</summary>
        WaterGravity = 2,
        /// <summary>more water would leave than there is</summary>
        WaterOutflow = 4,
        SandSpeed = 8,
        SandGravity = 16,
        SandOutflow = 32,
        /// <summary>the column stands above method.largest_height: its heights are rounded, the books drift</summary>
        Height = 64,
    }

    public enum BodyShape
    {
        Box = 0,
        Sphere = 1,
    }

    public enum Layer
    {
        Terrain = 0,
        Sand = 1,
        Water = 2,
    }

    public enum EditKind
    {
        /// <summary>adds to (amount &gt; 0) or takes from a layer within a disc or capsule</summary>
        Brush = 0,
        /// <summary>the same by an image over a rectangle</summary>
        Stamp = 1,
        /// <summary>a body that drags sand and water along and feels nothing itself; moves no mass</summary>
        Push = 2,
    }

    public enum SourceShape
    {
        Disc = 0,
        Box = 1,
        /// <summary>the cell that holds `center`</summary>
        Point = 2,
    }

    /// <summary>Outputs, one bit each.</summary>
    [Flags]
    public enum OutputMask : uint
    {
        None = 0,
        Terrain = 1u << 0,
        SandSurface = 1u << 1,
        FreeSurface = 1u << 2,
        SandDepth = 1u << 3,
        WaterDepth = 1u << 4,
        Saturation = 1u << 5,
        Flow = 1u << 6,
        SandVelocity = 1u << 7,
        Foam = 1u << 8,
        Normal = 1u << 9,
        SmoothSurface = 1u << 10,
        Packed = 1u << 11,
        PackedHalf = 1u << 12,
        Wetness = 1u << 13,
        Silt = 1u << 14,
        /// <summary>For World.SetOutputs: lowest and highest elevation of tiles and their changes.</summary>
        Tiles = 0x80000000u,
    }
}
