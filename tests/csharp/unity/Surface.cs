// WadiSurface: the points of its meshes are where and as high as the world says, seen from above, and follow it.
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using UnityEngine;
using Wadi;

static partial class UnityHost
{
    // Nothing of it looks the same with an axis mirrored or both exchanged.
    const string Shore = "{\"format_version\": 1, \"name\": \"shore\", \"grid\": {\"nx\": 21, \"ny\": 12, \"dx\": 0.5}, \"dt\": 0.01,"
        + " \"sand\": [{\"shape\": \"cylinder\", \"center\": [8, 2], \"radius\": 1.5, \"height\": 1}],"
        + " \"water\": [{\"shape\": \"cylinder\", \"center\": [3, 4], \"radius\": 2, \"height\": 1}]}";

    static WadiTerrain Shoreline()
    {
        var terrain = On<WadiTerrain>(new GameObject("terrain"), t =>
        {
            t.levelAsset = new TextAsset { name = "shore", bytes = Encoding.UTF8.GetBytes(Shore) };
            t.backend = "cpu";
            t.threads = 1;
        });
        terrain.transform.position = new Vector3(100, 10, -50);
        return terrain;
    }

    static float[] Published(World world, Output output)
    {
        HostOutput host;
        Expect(world.TryGetHostOutput(output, out host) && host.Step == world.Steps, output + " is that of the newest step");
        var values = new float[host.CellBytes / 4 * world.Nx * world.Ny];
        host.CopyTo(values);
        return values;
    }

    // In how many of the cells that count no point lies at the middle, or not exactly as high.
    static int Wrong(World world, IEnumerable<Vector3> points, float[] heights, Func<int, bool> counts, bool mirrorEast = false, bool mirrorNorth = false)
    {
        var found = new Dictionary<Tuple<int, int>, float>();
        foreach (var point in points) found[Tuple.Create((int)Math.Round(2 * point.x / world.Dx), (int)Math.Round(2 * point.z / world.Dx))] = point.y;
        int wrong = 0;
        for (int n = 0; n < heights.Length; ++n)
        {
            int i = n % world.Nx, j = n / world.Nx;
            float height;
            bool there = found.TryGetValue(Tuple.Create(2 * (mirrorEast ? world.Nx - 1 - i : i) + 1, 2 * (mirrorNorth ? world.Ny - 1 - j : j) + 1), out height);
            if (counts(n) && !(there && height == heights[n])) ++wrong;
        }
        return wrong;
    }

    static int[] Reversed(int[] triangles)
    {
        return Enumerable.Range(0, triangles.Length).Select(n => triangles[n / 3 * 3 + 2 - n % 3]).ToArray();
    }

    // Whether triangles cover an area of the map [m2] once, and show their front from above: clockwise there, in Unity's left-handed space.
    static bool Covers(Vector3[] points, int[] triangles, double extent)
    {
        double area = 0;
        var edges = new HashSet<Tuple<int, int>>(); // each in the way round its triangle; a neighbour has it the other way round
        for (int n = 0; n < triangles.Length; n += 3)
        {
            var a = points[triangles[n]];
            area += Math.Max(0, 0.5 * Cross(points[triangles[n + 1]] - a, points[triangles[n + 2]] - a).y);
            for (int k = 0; k < 3; ++k)
                if (!edges.Add(Tuple.Create(triangles[n + k], triangles[n + (k + 1) % 3]))) return false;
        }
        return Math.Abs(area - extent) < 1e-3;
    }

    static void Surface()
    {
        var terrain = Shoreline();
        var world = terrain.World;
        var surface = On<WadiSurface>(terrain.gameObject, s =>
        {
            s.groundMaterial = new Material();
            s.waterMaterial = new Material();
        });
        Expect(surface.terrain == terrain, "it finds the terrain that it lies on");
        Play(terrain, 10, surface);
        float[] solid = Published(world, Output.SandSurface), seen = Published(world, Output.Packed);
        Func<int, bool> all = n => true, wet = n => seen[4 * n + 1] > 1e-3f;
        var level = Enumerable.Range(0, solid.Length).Select(n => seen[4 * n]).ToArray();
        Expect(solid.Max() > 0.3f && solid.Distinct().Count() > 20 && Enumerable.Range(0, solid.Length).Count(wet) > 40, "there are sand and water");
        Expect(Wrong(world, surface.Ground.Vertices, solid, all) == 0, "the ground is as high as the world says");
        Expect(Wrong(world, surface.Water.Vertices, level, wet) == 0, "the water is as high as the world says");
        foreach (var east in new[] { true, false })
        {
            Expect(Wrong(world, surface.Ground.Vertices, solid, all, east, !east) > 20, "the ground would be found mirrored");
            Expect(Wrong(world, surface.Water.Vertices, level, wet, east, !east) > 20, "the water would be found mirrored");
        }
        double extent = world.Nx * world.Dx * world.Ny * world.Dx;
        foreach (var mesh in new[] { surface.Ground, surface.Water })
        {
            Expect(Covers(mesh.Vertices, mesh.Triangles, extent), mesh.name + " covers the grid once, its front above");
            Expect(!Covers(mesh.Vertices, Reversed(mesh.Triangles), extent), mesh.name + " with triangles reversed would be found");
            var twice = (int[])mesh.Triangles.Clone();
            Array.Copy(twice, 0, twice, 3, 3);
            Expect(!Covers(mesh.Vertices, twice, extent), mesh.name + " with a triangle twice would be found");
            float low = mesh.Vertices.Min(v => v.y), high = mesh.Vertices.Max(v => v.y);
            Expect(Math.Abs(mesh.bounds.center.y - 0.5f * (low + high)) < 1e-5f && Math.Abs(mesh.bounds.size.y - (high - low)) < 1e-5f, mesh.name + " has bounds");
        }
        int columns = world.Nx + 2, dry = 0;
        for (int n = 0; n < solid.Length; ++n)
        {
            int i = n % world.Nx, j = n / world.Nx, at = (j + 1) * columns + i + 1;
            if (seen[4 * n + 1] > 0) continue;
            bool shore = Enumerable.Range(-1, 9).Any(k => Inside(world, i + k % 3, j + k / 3) && seen[4 * ((j + k / 3) * world.Nx + i + k % 3) + 1] > 0);
            if (shore) continue;
            ++dry;
            if (surface.Water.Vertices[at].y >= solid[n]) Expect(false, "no water shows on the dry cell " + i + " " + j);
        }
        Expect(dry > 20, "there are dry cells: " + dry);
        Expect(surface.Ground.Vertices[0].x == 0 && surface.Ground.Vertices[0].z == 0 && surface.Ground.Vertices[0].y == solid[0], "the rim is as high as the cell beside it");
        Play(terrain, 10, surface);
        Expect(Wrong(world, surface.Water.Vertices, level, wet) > 20, "the water of ten frames ago would be found");
        Expect(Wrong(world, surface.Ground.Vertices, Published(world, Output.SandSurface), all) == 0, "the ground follows");
        var vertices = surface.Water.Vertices;
        Call(surface, "LateUpdate");
        Expect(surface.Water.Vertices == vertices, "nothing is uploaded twice");
        var first = surface.Ground;
        Call(terrain, "OnDisable");
        Call(surface, "LateUpdate");
        Expect(surface.Ground == null && UnityEngine.Object.Destroyed.Contains(first), "without a world nothing is drawn");
        Call(terrain, "OnEnable");
        Play(terrain, 2, surface);
        Expect(surface.Ground != null && Wrong(terrain.World, surface.Ground.Vertices, Published(terrain.World, Output.SandSurface), all) == 0, "a world made anew is drawn");
        Call(surface, "OnDisable");
        Call(terrain, "OnDisable");
        foreach (var set in new Action<WadiSurface>[] { s => s.groundMaterial = new Material(), s => s.terrain = terrain })
        {
            var lost = On(new GameObject("lost"), set);
            Expect(!lost.enabled && Debug.Lines.Last().StartsWith("error WadiSurface: no "), "what is missing is said: " + Debug.Lines.Last());
        }
    }

    static bool Inside(World world, int i, int j)
    {
        return i >= 0 && j >= 0 && i < world.Nx && j < world.Ny;
    }
}
