using System;
using System.IO;
using UnityEngine;

namespace Wadi
{
    /// <summary>A world of sand and water. Steps in FixedUpdate, fills textures ahead of each drawn frame. The south-west corner of the grid
    /// lies at this object's origin, x runs east, z north, y up, in metres. Row 0 of a texture is the south, so v grows with z.</summary>
    [AddComponentMenu("Wadi/Terrain")]
    [DefaultExecutionOrder(-100)]
    public sealed class WadiTerrain : MonoBehaviour
    {
        [Tooltip("Level file or terrain map; relative paths begin in StreamingAssets.")]
        public string level = "canyon/level.json";
        [Tooltip("A level as an asset in place of the file; may be none.")]
        public TextAsset levelAsset;
        [Tooltip("Files that the level asset names: sand.png is an asset of the file sand.png.bytes.")]
        public TextAsset[] levelFiles = new TextAsset[0];
        [Tooltip("\"auto\" takes a real GPU where there is one, else the CPU; \"cpu\", \"vulkan\", \"cuda\".")]
        public string backend = "auto";
        [Tooltip("Threads of the CPU backend; 0 = all cores but one.")]
        public int threads;
        [Tooltip("May be none: gets the surface texture copied, for shaders and effect graphs that are wired to an asset.")]
        public RenderTexture surfaceTarget;

        OutputMask outputs = OutputMask.Packed | OutputMask.Flow;
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
                World = levelAsset != null ? World.FromText(levelAsset.text, ReadFile, null, options)
                    : World.FromLevel(Path.Combine(Application.streamingAssetsPath, level), null, options);
                World.SetHostOutputs(outputs);
            }
            catch (Exception e)
            {
                Debug.LogException(e, this);
                enabled = false;
                return;
            }
            Surface = MakeTexture(TextureFormat.RGBAFloat, "Wadi surface");
            Flow = MakeTexture(TextureFormat.RGFloat, "Wadi flow");
            surfaceTexels = new float[4 * World.Nx * World.Ny];
            flowTexels = new float[2 * World.Nx * World.Ny];
        }

        void OnDisable()
        {
            if (World != null) World.Dispose();
            World = null;
            if (Surface != null) Destroy(Surface);
            if (Flow != null) Destroy(Flow);
            Surface = Flow = null;
            published = false;
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

        /// <summary>Publishes more in host memory, for World.TryGetHostOutput, beside Packed and Flow; at any time.</summary>
        public void Publish(OutputMask more)
        {
            if ((outputs | more) == outputs) return;
            outputs |= more;
            if (World != null) World.SetHostOutputs(outputs);
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

        /// <summary>Where a ray of the scene meets what is seen, water or ground, to a hundredth of a cell; false where it does not.</summary>
        /// <param name="reach">how far to look [m]</param>
        public bool Raycast(Ray ray, float reach, out Vector3 where)
        {
            where = ray.origin;
            if (!published) return false;
            float step = 0.5f * (float)World.Dx, before = 0;
            bool wasAbove = false;
            for (float along = 0; along <= reach; along += step)
            {
                float height;
                bool inside = HeightAbove(transform.InverseTransformPoint(ray.GetPoint(along)), out height);
                if (inside && height <= 0 && wasAbove)
                {
                    for (float half = 0.5f * step; half > 0.01f * step; half *= 0.5f)
                        if (HeightAbove(transform.InverseTransformPoint(ray.GetPoint(before + half)), out height) && height > 0) before += half;
                    where = ray.GetPoint(before);
                    return true;
                }
                wasAbove = inside && height > 0;
                before = along;
            }
            return false;
        }

        /// <summary>How far a point of the terrain's space lies above the surface of its cell [m]; false outside the grid.</summary>
        bool HeightAbove(Vector3 local, out float height)
        {
            int i = (int)Math.Floor(local.x / World.Dx), j = (int)Math.Floor(local.z / World.Dx);
            bool inside = i >= 0 && j >= 0 && i < World.Nx && j < World.Ny;
            height = inside ? local.y - surfaceTexels[4 * (j * World.Nx + i)] : 0;
            return inside;
        }

        byte[] ReadFile(string file)
        {
            var asset = Array.Find(levelFiles, one => one != null && one.name == Path.GetFileName(file));
            return asset != null ? asset.bytes : null;
        }

        Texture2D MakeTexture(TextureFormat format, string title)
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
