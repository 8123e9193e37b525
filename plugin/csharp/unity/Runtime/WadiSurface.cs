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
        float[] seen, solid, sand, levels;
        bool[] wetColumn;
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
            Lift(Ground, groundPoints, solid);
            if (Water == null) return;
            FindLevels();
            Lift(Water, waterPoints, levels);
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
            levels = new float[world.Nx * world.Ny];
            wetColumn = new bool[world.Nx];
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

        /// <summary>Puts a height over each cell, and on the rim those of the cells beside it.</summary>
        void Lift(Mesh mesh, Vector3[] points, float[] heights)
        {
            int nx = world.Nx, ny = world.Ny;
            float low = heights[0], high = heights[0];
            for (int row = 0; row < rows; ++row)
            {
                int from = Math.Min(Math.Max(row - 1, 0), ny - 1) * nx, to = row * columns;
                points[to].y = heights[from];
                for (int i = 0; i < nx; ++i)
                {
                    float height = heights[from + i];
                    if (height < low) low = height;
                    if (height > high) high = height;
                    points[to + i + 1].y = height;
                }
                points[to + nx + 1].y = heights[from + nx - 1];
            }
            mesh.SetVertices(points);
            float x = Place(columns, nx), z = Place(rows, ny);
            mesh.bounds = new Bounds(new Vector3(0.5f * x, 0.5f * (low + high), 0.5f * z), new Vector3(x, high - low, z));
        }

        /// <summary>Elevation of the water over each cell; away from water it lies below the ground.</summary>
        void FindLevels()
        {
            int nx = world.Nx, ny = world.Ny;
            float film = 0.25f * Math.Max(0.004f * (float)world.Dx, 1e-4f); // depth up to which it is a film that no wave runs on
            float below = 0.02f * (float)world.Dx;
            for (int j = 0; j < ny; ++j)
            {
                int row = j * nx, south = Math.Max(j - 1, 0) * nx, north = Math.Min(j + 1, ny - 1) * nx;
                for (int i = 0; i < nx; ++i)
                    wetColumn[i] = seen[4 * (row + i) + 1] > film || seen[4 * (south + i) + 1] > film || seen[4 * (north + i) + 1] > film;
                for (int i = 0; i < nx; ++i)
                {
                    int n = row + i;
                    if (seen[4 * n + 1] > film) levels[n] = seen[4 * n];
                    else if (wetColumn[i] || (i > 0 && wetColumn[i - 1]) || (i < nx - 1 && wetColumn[i + 1])) levels[n] = ShoreLevel(i, j, film);
                    else levels[n] = solid[n] - below;
                }
            }
        }

        /// <summary>Over a dry cell beside water: still water goes on to where it meets the shore, a front runs out with the mean depth in place
        /// of a step.</summary>
        float ShoreLevel(int i, int j, float film)
        {
            float level = 0, depth = 0;
            int wet = 0, cells = 0;
            for (int y = Math.Max(j - 1, 0); y <= Math.Min(j + 1, world.Ny - 1); ++y)
            {
                for (int x = Math.Max(i - 1, 0); x <= Math.Min(i + 1, world.Nx - 1); ++x, ++cells)
                {
                    int at = 4 * (y * world.Nx + x);
                    if (seen[at + 1] <= film) continue;
                    ++wet;
                    level += seen[at];
                    depth += seen[at + 1];
                }
            }
            return Math.Min(level / wet, solid[j * world.Nx + i] + 2 * depth / cells);
        }
    }
}
