// WadiCollider: physics knows the ground near chosen objects as the world has it, and no body is buried.
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using Wadi;

static partial class UnityHost
{
    static IEnumerable<Vector3> Known(IEnumerable<MeshCollider> tiles)
    {
        return tiles.Where(tile => tile.enabled).SelectMany(tile => tile.Cooked);
    }

    static T Body<T>(WadiTerrain terrain, float x, float y, float z) where T : Collider, new()
    {
        var body = new GameObject("body");
        if (typeof(T) != typeof(CharacterController)) body.AddComponent<Rigidbody>();
        var collider = body.AddComponent<T>();
        body.transform.position = terrain.transform.TransformPoint(new Vector3(x, y, z));
        Physics.Bodies.Add(collider);
        return collider;
    }

    static void Solid()
    {
        var terrain = Shoreline();
        var world = terrain.World;
        var tiles = new List<MeshCollider>();
        Func<float[]> solid = () => Published(world, Output.SandSurface);
        var collider = On<WadiCollider>(terrain.gameObject, c => c.tileCells = 8);
        Call(terrain, "FixedUpdate");
        Call(collider, "FixedUpdate");
        Expect(collider.Rebuilt == 3 * 2, "there is ground ahead of the first step of physics: " + collider.Rebuilt + " tiles");
        Play(terrain, 10, collider);
        tiles.AddRange(GameObject.All.Where(o => o.transform.parent == terrain.transform).Select(o => o.GetComponent<MeshCollider>()));
        Expect(tiles.Count == 6 && tiles.All(tile => tile.enabled), "all of the grid is solid where nothing is chosen");
        var before = solid();
        Func<int, bool> all = n => true;
        Expect(Wrong(world, Known(tiles), before, all) == 0, "physics knows the heights that the world says");
        Expect(Wrong(world, Known(tiles), before, all, true) > 20 && Wrong(world, Known(tiles), before, all, false, true) > 20, "ground that is mirrored would be found");
        foreach (var tile in tiles)
            Expect(Covers(tile.Cooked, tile.sharedMesh.Triangles, (tile.Cooked.Max(p => p.x) - tile.Cooked[0].x) * (tile.Cooked.Max(p => p.z) - tile.Cooked[0].z)), tile.name + " is covered once, its front above");
        int rebuilt = collider.Rebuilt;
        Call(collider, "FixedUpdate");
        Expect(collider.Rebuilt == rebuilt, "ground that has not changed is not made anew");

        // Sand comes at x = 6.25 m, y = 4.75 m of the level, on flat dry ground.
        var buried = Body<Collider>(terrain, 6.25f, 0.1f, 4.75f);
        var walker = Body<CharacterController>(terrain, 6.25f, 0.1f, 4.5f);
        var above = Body<Collider>(terrain, 6.25f, 1.1f, 4.75f);
        var away = Body<Collider>(terrain, 9.5f, 0.1f, 5.5f);
        terrain.Pour(terrain.transform.TransformPoint(new Vector3(6.25f, 0, 4.75f)), Layer.Sand, 1, 0.8f);
        Play(terrain, 1, collider);
        var after = solid();
        int middle = 9 * world.Nx + 12; // whose cell has its middle there
        Expect(after[middle] > before[middle] + 0.3f, "sand has come");
        Expect(Wrong(world, Known(tiles), after, all) == 0 && Wrong(world, Known(tiles), before, all) > 3, "physics follows; the ground of before would be found");
        float raised = buried.transform.position.y - terrain.transform.position.y - 0.1f;
        Expect(Math.Abs(raised - (after[middle] - before[middle])) < 1e-4f, "a body that sand would bury is carried up with the ground: " + raised);
        Expect(walker.transform.position.y > terrain.transform.position.y + 0.3f && Physics.Synced > 0, "and so is one that walks");
        Expect(above.transform.position.y == terrain.transform.position.y + 1.1f && away.transform.position.y == terrain.transform.position.y + 0.1f, "others stay");
        collider.carryBodies = false;
        buried.transform.position = terrain.transform.TransformPoint(new Vector3(6.25f, after[middle] + 0.1f, 4.75f));
        float there = buried.transform.position.y;
        terrain.Pour(buried.transform.position, Layer.Sand, 1, 0.8f);
        Play(terrain, 1, collider);
        Expect(buried.transform.position.y == there && solid()[middle] > after[middle] + 0.3f, "switched off, it would be buried");

        // In the south-west, then in the north-east.
        var chosen = new GameObject("chosen");
        chosen.transform.position = terrain.transform.TransformPoint(new Vector3(1, 3, 1));
        collider.around = new[] { null, chosen.transform };
        collider.reach = 1;
        Play(terrain, 5, collider);
        Expect(tiles.Count(tile => tile.enabled) == 1 && tiles.Single(tile => tile.enabled).name == "Wadi ground 0 0", "the ground is solid near what is chosen");
        Expect(Wrong(world, Known(tiles), solid(), n => n % world.Nx < 9 && n / world.Nx < 9) == 0, "and up to date");
        Expect(Wrong(world, Known(tiles), solid(), all) == 21 * 12 - 9 * 9, "and not known elsewhere");
        chosen.transform.position = terrain.transform.TransformPoint(new Vector3(10, 3, 5.5f));
        Play(terrain, 1, collider);
        Expect(tiles.Single(tile => tile.enabled).name == "Wadi ground 16 8" && Wrong(world, Known(tiles), solid(), n => n % world.Nx >= 16 && n / world.Nx >= 8) == 0, "it follows");
        Call(collider, "OnDisable");
        Expect(tiles.All(tile => UnityEngine.Object.Destroyed.Contains(tile.gameObject)), "switched off, nothing is solid");
        Call(terrain, "OnDisable");
        var lost = On<WadiCollider>(new GameObject("lost"), c => { });
        Expect(!lost.enabled && Debug.Lines.Last().StartsWith("error WadiCollider: no WadiTerrain"), "a collider without terrain says so");
    }
}
