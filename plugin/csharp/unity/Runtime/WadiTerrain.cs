using System;
using System.IO;
using UnityEngine;

namespace Wadi
{
    /// <summary>A world of sand and water. Steps in FixedUpdate, fills textures ahead of each drawn frame. The south-west corner of the grid
    /// lies at this object's origin, x runs east, z north, y up, in metres. Row 0 of a texture is the south, so v grows with z.</summary>
    [AddComponentMenu("Wadi/Terrain")]
    public sealed class WadiTerrain : MonoBehaviour
    {
        [Tooltip("Level file or terrain map; relative paths begin in StreamingAssets.")]
        public string level = "canyon/level.json";
        [Tooltip("\"auto\" takes a real GPU where there is one, else the CPU; \"cpu\", \"vulkan\", \"cuda\".")]
        public string backend = "auto";
        [Tooltip("Threads of the CPU backend; 0 = all cores but one.")]
        public int threads;
        [Tooltip("May be none: gets the surface texture copied, for shaders and effect graphs that are wired to an asset.")]
        public RenderTexture surfaceTarget;

        bool published;
        ulong shownStep;
        float[] surfaceTexels, flowTexels;

        /// <summary>The world; null while this component is off.</summary>
        public World World { get; private set; }
        /// <summary>RGBAFloat: elevation of the visible surface [m], depth of water [m], foam 0 ... 1, saturation of the sand 0 ... 1.</summary>
        public Texture2D Surface { get; private set; }
        /// <summary>RGFloat: velocity of the water along x and z [m/s].</summary>
        public Texture2D Flow { get; private set; }
        /// <summary>What the newest FixedUpdate did: steps, time, time that was dropped.</summary>
        public Frame LastFrame { get; private set; }

        void OnEnable()
        {
            var options = new DeviceOptions { Backend = backend, Threads = threads, Log = Log };
            try
            {
                World = World.FromLevel(Path.Combine(Application.streamingAssetsPath, level), null, options);
                World.SetHostOutputs(OutputMask.Packed | OutputMask.Flow);
            }
            catch (Exception e)
            {
                Debug.LogException(e, this);
                enabled = false;
                return;
            }
            Surface = Make(TextureFormat.RGBAFloat, "Wadi surface");
            Flow = Make(TextureFormat.RGFloat, "Wadi flow");
            surfaceTexels = new float[4 * World.Nx * World.Ny];
            flowTexels = new float[2 * World.Nx * World.Ny];
            published = false;
        }

        void OnDisable()
        {
            if (World != null) World.Dispose();
            World = null;
            if (Surface != null) Destroy(Surface);
            if (Flow != null) Destroy(Flow);
            Surface = Flow = null;
        }

        void FixedUpdate()
        {
            LastFrame = World.Update((ulong)Math.Round(Time.fixedDeltaTime * 1e9));
        }

        void Update()
        {
            HostOutput surface, flow;
            if (!World.TryGetHostOutput(Output.Packed, out surface) || !World.TryGetHostOutput(Output.Flow, out flow)) return;
            if (published && surface.Step == shownStep) return;
            published = true;
            shownStep = surface.Step;
            surface.CopyTo(surfaceTexels);
            Surface.SetPixelData(surfaceTexels, 0);
            Surface.Apply(false);
            flow.CopyTo(flowTexels);
            Flow.SetPixelData(flowTexels, 0);
            Flow.Apply(false);
            if (surfaceTarget != null) Graphics.Blit(Surface, surfaceTarget);
        }

        /// <summary>Adds to a layer, or takes from it, within a disc round a point of the scene.</summary>
        /// <param name="amount">change of depth or elevation at the centre [m]</param>
        public void Pour(Vector3 where, Layer layer, float radius, float amount)
        {
            var at = WadiAxes.FromUnity(transform.InverseTransformPoint(where));
            var edit = Edit.Default;
            edit.Layer = layer;
            edit.X0 = at.x;
            edit.Y0 = at.y;
            edit.Radius = radius;
            edit.Amount = amount;
            World.Edit(edit);
        }

        Texture2D Make(TextureFormat format, string title)
        {
            return new Texture2D(World.Nx, World.Ny, format, false, true)
            {
                name = title,
                wrapMode = TextureWrapMode.Clamp,
                filterMode = FilterMode.Bilinear,
            };
        }

        static void Log(LogLevel severity, string text)
        {
            if (severity == LogLevel.Error) Debug.LogError("Wadi: " + text);
            else if (severity == LogLevel.Warning) Debug.LogWarning("Wadi: " + text);
            else Debug.Log("Wadi: " + text);
        }
    }
}
