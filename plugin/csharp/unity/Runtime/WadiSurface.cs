using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace Wadi
{
    /// <summary>Draws the ground, sand included, and the water of a WadiTerrain: two meshes with a point in the middle of each cell, whose
    /// heights are what the world publishes, and points on the rim, which are as high as the cell beside them.</summary>
    [AddComponentMenu("Wadi/Surface")]
    public sealed class WadiSurface : MonoBehaviour
    {
        [Tooltip("The terrain; none: the one on this object or above it.")]
        public WadiTerrain terrain;
        [Tooltip("Material of rock and sand, with the shader Wadi/Ground or one that takes the same textures.")]
        public Material groundMaterial;
        [Tooltip("Material of the water, with the shader Wadi/Water. None: no water is drawn.")]
        public Material waterMaterial;
        [Tooltip("Length that the patterns of both materials scale with [m]: a tenth of a metre for a beach of toys; 0: the side of a cell.")]
        public float detail;

        static readonly int SurfaceName = Shader.PropertyToID("_WadiSurface"), FlowName = Shader.PropertyToID("_WadiFlow");
        static readonly int SandName = Shader.PropertyToID("_WadiSand"), GridName = Shader.PropertyToID("_WadiGrid");

        World world;
        bool drawn;
        ulong drawnStep;
        int columns, rows;
        float[] seen, solid, sand;
        Vector3[] groundPoints, waterPoints;
        GameObject groundObject, waterObject;
        Texture2D sandTexture;
        MaterialPropertyBlock values;

        /// <summary>What is drawn, in the terrain's space; null while there is no world.</summary>
        public Mesh Ground { get; private set; }
        /// <summary>Null as well where there is no material of water.</summary>
        public Mesh Water { get; private set; }

        void OnEnable()
        {
            if (terrain == null) terrain = GetComponentInParent<WadiTerrain>();
            if (terrain == null || groundMaterial == null)
            {
                Debug.LogError("WadiSurface: no " + (terrain == null ? "WadiTerrain: set `terrain`, or put this on it or below it"
                    : "material of the ground: set `groundMaterial`, for example to the package's Shaders/WadiGround.mat"), this);
                enabled = false;
                return;
            }
            terrain.Publish(OutputMask.SandSurface | OutputMask.SandDepth);
        }

        void OnDisable()
        {
            Clear();
            world = null;
        }

        void LateUpdate()
        {
            if (terrain.World != world)
            {
                Clear();
                world = terrain.World;
                if (world != null) Make();
            }
            HostOutput packed, surface, depth;
            if (world == null || !world.TryGetHostOutput(Output.Packed, out packed) || !world.TryGetHostOutput(Output.SandSurface, out surface)
                || !world.TryGetHostOutput(Output.SandDepth, out depth)) return;
            if (drawn && packed.Step == drawnStep) return;
            drawn = true;
            drawnStep = packed.Step;
            packed.CopyTo(seen);
            surface.CopyTo(solid);
            depth.CopyTo(sand);
            sandTexture.SetPixelData(sand, 0);
            sandTexture.Apply(false);
            Lift(Ground, groundPoints, false);
            if (Water != null) Lift(Water, waterPoints, true);
        }

        void Make()
        {
            columns = world.Nx + 2;
            rows = world.Ny + 2;
            seen = new float[4 * world.Nx * world.Ny];
            solid = new float[world.Nx * world.Ny];
            sand = new float[world.Nx * world.Ny];
            sandTexture = new Texture2D(world.Nx, world.Ny, TextureFormat.RFloat, false, true)
            {
                name = "Wadi sand",
                wrapMode = TextureWrapMode.Clamp,
                filterMode = FilterMode.Point,
            };
            values = new MaterialPropertyBlock();
            values.SetTexture(SurfaceName, terrain.Surface);
            values.SetTexture(FlowName, terrain.Flow);
            values.SetTexture(SandName, sandTexture);
            values.SetVector(GridName, new Vector4(world.Nx, world.Ny, (float)world.Dx, detail > 0 ? detail : (float)world.Dx));
            groundPoints = Flat();
            Ground = WadiGrid.Make("Wadi ground", groundPoints, columns);
            groundObject = Show(Ground, groundMaterial, ShadowCastingMode.On);
            if (waterMaterial == null) return;
            waterPoints = Flat();
            Water = WadiGrid.Make("Wadi water", waterPoints, columns);
            waterObject = Show(Water, waterMaterial, ShadowCastingMode.Off);
        }

        void Clear()
        {
            foreach (var made in new UnityEngine.Object[] { groundObject, waterObject, Ground, Water, sandTexture })
                if (made != null) Destroy(made);
            groundObject = waterObject = null;
            Ground = Water = null;
            sandTexture = null;
            drawn = false;
        }

        Vector3[] Flat()
        {
            var points = new Vector3[columns * rows];
            for (int j = 0; j < rows; ++j)
                for (int i = 0; i < columns; ++i) points[j * columns + i] = new Vector3(Place(i, world.Nx), 0, Place(j, world.Ny));
            return points;
        }

        /// <summary>Along an axis: the rim, the middles of the cells, the rim [m].</summary>
        float Place(int point, int cells)
        {
            return (float)(Math.Min(Math.Max(point - 0.5, 0), cells) * world.Dx);
        }

        GameObject Show(Mesh mesh, Material material, ShadowCastingMode shadows)
        {
            var shown = new GameObject(mesh.name) { layer = gameObject.layer };
            shown.transform.SetParent(terrain.transform, false);
            shown.AddComponent<MeshFilter>().sharedMesh = mesh;
            var drawer = shown.AddComponent<MeshRenderer>();
            drawer.sharedMaterial = material;
            drawer.shadowCastingMode = shadows;
            drawer.SetPropertyBlock(values);
            return shown;
        }

        void Lift(Mesh mesh, Vector3[] points, bool water)
        {
            float low = float.MaxValue, high = float.MinValue;
            for (int j = 0; j < world.Ny; ++j)
            {
                for (int i = 0; i < world.Nx; ++i)
                {
                    float height = water ? WaterLevel(i, j) : solid[j * world.Nx + i];
                    low = Math.Min(low, height);
                    high = Math.Max(high, height);
                    points[(j + 1) * columns + i + 1].y = height;
                }
            }
            for (int j = 1; j < rows - 1; ++j)
            {
                points[j * columns].y = points[j * columns + 1].y;
                points[j * columns + columns - 1].y = points[j * columns + columns - 2].y;
            }
            for (int i = 0; i < columns; ++i)
            {
                points[i].y = points[columns + i].y;
                points[(rows - 1) * columns + i].y = points[(rows - 2) * columns + i].y;
            }
            mesh.SetVertices(points);
            float x = Place(columns, world.Nx), z = Place(rows, world.Ny);
            mesh.bounds = new Bounds(new Vector3(0.5f * x, 0.5f * (low + high), 0.5f * z), new Vector3(x, high - low, z));
        }

        /// <summary>Elevation of the water over a cell. Where there is none, still water goes on to where it meets the shore, a front runs out
        /// with the mean depth in place of a step, and away from water it lies below the ground.</summary>
        float WaterLevel(int i, int j)
        {
            int n = j * world.Nx + i;
            float least = 0.25f * Math.Max(0.004f * (float)world.Dx, 1e-4f); // below it is a film that no wave runs on
            if (seen[4 * n + 1] > least) return seen[4 * n];
            float level = 0, depth = 0;
            int wet = 0, cells = 0;
            for (int y = Math.Max(j - 1, 0); y <= Math.Min(j + 1, world.Ny - 1); ++y)
            {
                for (int x = Math.Max(i - 1, 0); x <= Math.Min(i + 1, world.Nx - 1); ++x)
                {
                    int at = 4 * (y * world.Nx + x);
                    ++cells;
                    if (seen[at + 1] <= least) continue;
                    ++wet;
                    level += seen[at];
                    depth += seen[at + 1];
                }
            }
            return wet == 0 ? solid[n] - 0.02f * (float)world.Dx : Math.Min(level / wet, solid[n] + 2 * depth / cells);
        }
    }
}
