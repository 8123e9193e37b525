// The sample's level as assets, and its brush: what is held over a place pours there.
using System;
using System.IO;
using System.Linq;
using UnityEngine;
using Wadi;

static partial class UnityHost
{
    static void Sample(string sample)
    {
        Func<string, TextAsset> asset = file => new TextAsset { name = Path.GetFileNameWithoutExtension(file), bytes = File.ReadAllBytes(sample + "/Level/" + file) };
        var none = On<WadiTerrain>(new GameObject("terrain"), t => { t.levelAsset = asset("level.json"); t.backend = "cpu"; });
        Expect(!none.enabled && Debug.Lines.Last().Contains("sand.png"), "a file of the level that is no asset is named: " + Debug.Lines.Last());
        var terrain = On<WadiTerrain>(new GameObject("terrain"), t =>
        {
            t.levelAsset = asset("level.json");
            t.levelFiles = new[] { null, asset("sand.png.bytes") };
            t.backend = "cpu";
            t.threads = 2;
        });
        terrain.transform.position = new Vector3(100, 10, -50);
        var world = terrain.World;
        Play(terrain, 1);
        var eye = new GameObject("camera");
        var target = terrain.transform.TransformPoint(new Vector3(45.1f, 0, 20.1f)); // dry ground, cell (225, 100)
        var given = new Vector3();
        eye.AddComponent<Camera>().Rays = pointer =>
        {
            given = pointer;
            return new Ray(target + new Vector3(-30, 30, -30), (1 / (float)Math.Sqrt(3)) * new Vector3(1, -1, 1));
        };
        var brush = eye.AddComponent<Pour>();
        brush.terrain = terrain;
        brush.rate = 20;
        Func<float> sand = () => world.ReadField(Field.SandDepth)[100 * world.Nx + 225];
        Action<EventType> say = type =>
        {
            Event.current = new Event { type = type, button = 1, mousePosition = new Vector2(40, 50) };
            Call(brush, "OnGUI");
        };
        float before = sand();
        Play(terrain, 1, brush);
        say(EventType.Repaint);
        Play(terrain, 1, brush);
        Expect(sand() == before, "nothing is poured before a button goes down");
        say(EventType.MouseDown);
        Play(terrain, 2, brush);
        float after = sand();
        Expect(after > before + 0.2f && given.x == 40 && given.y == 550, "sand lies where the pointer is: " + (after - before));
        say(EventType.MouseUp);
        Play(terrain, 1, brush); // the edit of the frame before is in this step
        after = sand();
        Play(terrain, 2, brush);
        Expect(sand() <= after + 0.01f, "nothing is poured after it has gone up: " + (sand() - after));

        Vector3 hit;
        var down = new Ray(target + new Vector3(0, 30, 0), new Vector3(0, -1, 0));
        float ground = terrain.Surface.Texels[4 * (100 * world.Nx + 225)];
        Expect(terrain.Raycast(down, 100, out hit) && Math.Abs(hit.y - target.y - ground) < 0.01 * world.Dx, "a ray down finds the surface: " + (hit.y - target.y) + ", " + ground);
        Expect(!terrain.Raycast(down, 10, out hit), "not beyond its reach");
        Expect(!terrain.Raycast(new Ray(target - new Vector3(100, -30, 0), new Vector3(0, -1, 0)), 100, out hit), "nor beside the grid");
        Call(terrain, "OnDisable");
    }
}
