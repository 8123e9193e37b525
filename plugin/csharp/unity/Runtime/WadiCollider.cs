using System;
using System.Collections.Generic;
using UnityEngine;

namespace Wadi
{
    /// <summary>Solid ground of a WadiTerrain for physics: mesh colliders in tiles around chosen objects, made anew where sand or rock has
    /// changed. The surface runs through the middles of the cells: half a cell along the grid's rim is left out.</summary>
    [AddComponentMenu("Wadi/Collider")]
    [DefaultExecutionOrder(100)]
    public sealed class WadiCollider : MonoBehaviour
    {
        [Tooltip("The terrain; none: the one on this object or above it.")]
        public WadiTerrain terrain;
        [Tooltip("Objects that get solid ground below them; none: all of the grid is solid.")]
        public Transform[] around = new Transform[0];
        [Tooltip("How far from such an object, measured on the map, the ground is solid [m].")]
        public float reach = 5;
        [Tooltip("Cells along the side of a tile.")]
        [Range(8, 128)]
        public int tileCells = 32;
        [Tooltip("Whether bodies that a change would bury are carried up with the ground below them. A mesh has no inside that would push them out.")]
        public bool carryBodies = true;

        sealed class Tile
        {
            public int I, J, Nx, Ny; // cells whose middles are its points
            public MeshCollider Collider;
            public Mesh Mesh;
            public Vector3[] Points;
            public float[] Before;
        }

        readonly List<Tile> tiles = new List<Tile>();
        World world;
        float side;

        /// <summary>Meshes given to the physics since the start: an expensive call each.</summary>
        public int Rebuilt { get; private set; }

        void OnEnable()
        {
            if (terrain == null) terrain = GetComponentInParent<WadiTerrain>();
            if (terrain == null)
            {
                Debug.LogError("WadiCollider: no WadiTerrain: set `terrain`, or put this on it or below it", this);
                enabled = false;
                return;
            }
            terrain.Publish(OutputMask.SandSurface);
        }

        void OnDisable()
        {
            Clear();
            world = null;
        }

        void FixedUpdate()
        {
            if (terrain.World != world)
            {
                Clear();
                world = terrain.World;
                if (world != null) Make();
            }
            HostOutput solid;
            if (world == null || !world.TryGetHostOutput(Output.SandSurface, out solid)) return;
            foreach (var tile in tiles)
            {
                bool wanted = Wanted(tile);
                if (wanted && Follow(tile, solid) && carryBodies) Carry(tile);
                tile.Collider.enabled = wanted;
            }
        }

        void Make()
        {
            side = (float)world.Dx;
            Rebuilt = 0;
            for (int j = 0; j < world.Ny - 1; j += tileCells)
                for (int i = 0; i < world.Nx - 1; i += tileCells)
                    tiles.Add(MakeTile(i, j, Math.Min(tileCells + 1, world.Nx - i), Math.Min(tileCells + 1, world.Ny - j)));
            world.Update(0); // so that nothing falls before the first heights have come
            world.WaitForOutputs();
        }

        Tile MakeTile(int i, int j, int nx, int ny)
        {
            var tile = new Tile { I = i, J = j, Nx = nx, Ny = ny, Points = new Vector3[nx * ny], Before = new float[nx * ny] };
            for (int n = 0; n < tile.Points.Length; ++n)
                tile.Points[n] = new Vector3((i + n % nx + 0.5f) * side, float.NaN, (j + n / nx + 0.5f) * side);
            var ground = new GameObject("Wadi ground " + i + " " + j) { layer = gameObject.layer };
            ground.transform.SetParent(terrain.transform, false);
            tile.Collider = ground.AddComponent<MeshCollider>();
            tile.Collider.cookingOptions = MeshColliderCookingOptions.UseFastMidphase; // quick to make; the points need no repair
            tile.Collider.enabled = false;
            return tile;
        }

        void Clear()
        {
            foreach (var tile in tiles)
            {
                if (tile.Mesh != null) Destroy(tile.Mesh);
                if (tile.Collider != null) Destroy(tile.Collider.gameObject);
            }
            tiles.Clear();
        }

        bool Wanted(Tile tile)
        {
            if (around.Length == 0) return true;
            float west = (tile.I + 0.5f) * side, east = west + (tile.Nx - 1) * side, south = (tile.J + 0.5f) * side, north = south + (tile.Ny - 1) * side;
            foreach (var chosen in around)
            {
                if (chosen == null) continue; // destroyed since
                var at = terrain.transform.InverseTransformPoint(chosen.position);
                float x = Math.Max(0, Math.Max(west - at.x, at.x - east)), z = Math.Max(0, Math.Max(south - at.z, at.z - north));
                if (x * x + z * z <= reach * reach) return true;
            }
            return false;
        }

        /// <summary>Brings a tile up to date; whether it had other heights before.</summary>
        bool Follow(Tile tile, HostOutput solid)
        {
            bool changed = false;
            for (int j = 0; j < tile.Ny; ++j)
            {
                var row = solid.Row(tile.J + j);
                for (int i = 0; i < tile.Nx; ++i)
                {
                    int n = j * tile.Nx + i;
                    tile.Before[n] = tile.Points[n].y;
                    changed |= tile.Points[n].y != row[tile.I + i];
                    tile.Points[n].y = row[tile.I + i];
                }
            }
            if (!changed) return false;
            bool first = tile.Mesh == null;
            if (first) tile.Mesh = WadiGrid.Make("Wadi ground", tile.Points, tile.Nx);
            else tile.Mesh.SetVertices(tile.Points);
            tile.Mesh.RecalculateBounds();
            tile.Collider.sharedMesh = null; // the same mesh again would not be taken
            tile.Collider.sharedMesh = tile.Mesh;
            ++Rebuilt;
            return !first;
        }

        void Carry(Tile tile)
        {
            float low = float.MaxValue, high = float.MinValue;
            for (int n = 0; n < tile.Before.Length; ++n)
            {
                if (tile.Points[n].y == tile.Before[n]) continue;
                low = Math.Min(low, Math.Min(tile.Points[n].y, tile.Before[n]));
                high = Math.Max(high, Math.Max(tile.Points[n].y, tile.Before[n]));
            }
            float x = (tile.Nx - 1) * side, z = (tile.Ny - 1) * side;
            var middle = new Vector3(tile.Points[0].x + 0.5f * x, 0.5f * (low + high), tile.Points[0].z + 0.5f * z);
            var half = new Vector3(0.5f * x, 0.5f * (high - low) + side, 0.5f * z);
            bool moved = false;
            foreach (var hit in Physics.OverlapBox(terrain.transform.TransformPoint(middle), half, terrain.transform.rotation))
            {
                var body = hit.attachedRigidbody != null ? hit.attachedRigidbody.transform : hit is CharacterController ? hit.transform : null;
                if (body == null) continue;
                var at = terrain.transform.InverseTransformPoint(body.position);
                float before = Height(tile, n => tile.Before[n], at), after = Height(tile, n => tile.Points[n].y, at);
                if (!(after > before && at.y >= before && at.y < after)) continue; // no number outside the tile
                body.position += (after - before) * terrain.transform.up;
                moved = true;
            }
            if (moved) Physics.SyncTransforms(); // a CharacterController would go back to where it was
        }

        /// <summary>Elevation of a tile at a point of the terrain's space; no number outside.</summary>
        float Height(Tile tile, Func<int, float> height, Vector3 at)
        {
            float x = (at.x - tile.Points[0].x) / side, z = (at.z - tile.Points[0].z) / side;
            if (!(x >= 0 && z >= 0 && x <= tile.Nx - 1 && z <= tile.Ny - 1)) return float.NaN;
            int i = Math.Min((int)x, tile.Nx - 2), j = Math.Min((int)z, tile.Ny - 2), n = j * tile.Nx + i;
            float south = Mathf.Lerp(height(n), height(n + 1), x - i), north = Mathf.Lerp(height(n + tile.Nx), height(n + tile.Nx + 1), x - i);
            return Mathf.Lerp(south, north, z - j);
        }
    }
}
