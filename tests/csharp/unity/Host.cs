// Calls WadiTerrain as Unity would, over the stub: textures are what fields say, axes keep what is physical.
using System;
using System.Linq;
using System.Reflection;
using UnityEngine;
using Wadi;

static partial class UnityHost
{
    static int failures;

    static void Expect(bool holds, string what)
    {
        if (holds) return;
        ++failures;
        Console.WriteLine("not so: " + what);
    }

    static void Call(MonoBehaviour component, string message)
    {
        component.GetType().GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(component, null);
    }

    static T On<T>(GameObject owner, Action<T> set) where T : MonoBehaviour, new()
    {
        var made = owner.AddComponent<T>();
        set(made);
        Call(made, "OnEnable");
        return made;
    }

    // Frames with a step of physics each, in Unity's order; the outputs of each have come before they are looked at.
    static void Play(WadiTerrain terrain, int frames, params MonoBehaviour[] others)
    {
        for (int n = 0; n < frames; ++n)
        {
            Call(terrain, "FixedUpdate");
            terrain.World.WaitForOutputs();
            foreach (var other in others.Where(o => !(o is WadiSurface))) Call(other, "FixedUpdate");
            Call(terrain, "Update");
            foreach (var other in others.OfType<WadiSurface>()) Call(other, "LateUpdate");
        }
    }

    static bool Near(Vector3 a, Vector3 b)
    {
        return Math.Abs(a.x - b.x) + Math.Abs(a.y - b.y) + Math.Abs(a.z - b.z) < 1e-5f;
    }

    static Vector3 Cross(Vector3 a, Vector3 b)
    {
        return new Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    }

    // v turned by a unit quaternion, v + 2 q x (q x v + w v): one formula in either handedness.
    static Vector3 Turn(Quaternion q, Vector3 v)
    {
        var axis = new Vector3(q.x, q.y, q.z);
        var once = Cross(axis, v);
        var twice = Cross(axis, new Vector3(once.x + q.w * v.x, once.y + q.w * v.y, once.z + q.w * v.z));
        return new Vector3(v.x + 2 * twice.x, v.y + 2 * twice.y, v.z + 2 * twice.z);
    }

    static void Axes()
    {
        Expect(Near(WadiAxes.ToUnity(1, 0, 0), new Vector3(1, 0, 0)) && Near(WadiAxes.ToUnity(0, 1, 0), new Vector3(0, 0, 1)) && Near(WadiAxes.ToUnity(0, 0, 1), new Vector3(0, 1, 0)),
            "east is right, north forward, up up");
        var some = new Vector3(0.3f, -2, 5);
        var there = WadiAxes.ToUnity(some.x, some.y, some.z);
        Expect(Near(WadiAxes.FromUnity(there), some), "positions come back");
        var spin = WadiAxes.RotationToUnity(0.1f, 0.7f, -0.4f);
        Expect(Near(WadiAxes.RotationFromUnity(spin), new Vector3(0.1f, 0.7f, -0.4f)), "rotations come back");
        // The velocity of a point of a turning body is the same vector on both sides: omega x r.
        var velocity = Cross(new Vector3(0.1f, 0.7f, -0.4f), some);
        Expect(Near(Cross(spin, there), WadiAxes.ToUnity(velocity.x, velocity.y, velocity.z)), "a turning body moves the same way");
        Expect(!Near(Cross(WadiAxes.ToUnity(0.1f, 0.7f, -0.4f), there), WadiAxes.ToUnity(velocity.x, velocity.y, velocity.z)), "which it would not with a rotation taken as a vector");
        var q = new Quaternion(0.5f, -0.5f, 0.1f, 0.7f);
        var turned = Turn(q, some);
        Expect(Near(Turn(WadiAxes.OrientationToUnity(q.x, q.y, q.z, q.w), there), WadiAxes.ToUnity(turned.x, turned.y, turned.z)), "an orientation turns the same way");
        var back = WadiAxes.OrientationFromUnity(WadiAxes.OrientationToUnity(q.x, q.y, q.z, q.w));
        Expect(back.x == q.x && back.y == q.y && back.z == q.z && back.w == q.w, "orientations come back");
    }

    static void Terrain(string streamingAssets)
    {
        Application.streamingAssetsPath = streamingAssets;
        var terrain = On<WadiTerrain>(new GameObject("terrain"), t =>
        {
            t.level = "castle/level.json";
            t.backend = "cpu";
            t.threads = 2;
            t.surfaceTarget = new RenderTexture();
        });
        Expect(terrain.enabled && Debug.Lines.Any(line => line.StartsWith("log Wadi: ")), "it starts and logs: " + string.Join("|", Debug.Lines));
        var world = terrain.World;
        var pace = UpdateSettings.Default;
        pace.MaxStepsInFlight = 0;
        world.SetUpdateSettings(pace);
        terrain.transform.position = new Vector3(100, 10, -50);
        var before = world.ReadField(Field.SandDepth);
        for (int n = 0; n < 20; ++n)
        {
            if (n == 10) terrain.Pour(new Vector3(100 + 45, 30, -50 + 20), Layer.Sand, 1.5f, 0.5f); // x = 45 m, y = 20 m of the level
            Call(terrain, "FixedUpdate");
            Call(terrain, "Update");
        }
        Expect(terrain.LastFrame.TotalSteps == (ulong)(0.4 / world.Dt), "20 fixed updates are 0.4 s: " + terrain.LastFrame.TotalSteps);
        var after = world.ReadField(Field.SandDepth);
        Func<int, int, float> gained = (i, j) => after[j * world.Nx + i] - before[j * world.Nx + i];
        Expect(gained((int)(45 / world.Dx), (int)(20 / world.Dx)) > 0.3f && Math.Abs(gained((int)(45 / world.Dx), (int)(5 / world.Dx))) < 0.1f, "sand lies where it was poured");

        HostOutput host;
        do world.Update(0);
        while (!world.TryGetHostOutput(Output.Packed, out host) || host.Step != world.Steps);
        Call(terrain, "Update");
        var surface = world.ReadField(Field.FreeSurface);
        var depth = world.ReadField(Field.WaterDepth);
        var texels = terrain.Surface.Texels;
        Expect(terrain.Surface.width == world.Nx && terrain.Surface.height == world.Ny && terrain.Flow.format == TextureFormat.RGFloat, "textures have the grid's size");
        Expect(Enumerable.Range(0, surface.Length).All(n => texels[4 * n] == surface[n] && texels[4 * n + 1] == depth[n]), "texels are the fields");
        Expect(depth.Max() > 0.5f && terrain.Flow.Texels.Max() > 0.1f, "water stands and flows");
        Expect(terrain.surfaceTarget.Filled == terrain.Surface, "the render texture is filled");
        int applied = terrain.Surface.Applied;
        Call(terrain, "Update");
        Expect(terrain.Surface.Applied == applied, "nothing is uploaded twice");
        Call(terrain, "OnDisable");
        Expect(terrain.World == null && UnityEngine.Object.Destroyed.Count == 2, "it lets go of world and textures");
        try
        {
            world.Step();
            Expect(false, "the world is gone");
        }
        catch (ObjectDisposedException)
        {
        }
        var wrong = On<WadiTerrain>(new GameObject("terrain"), t => t.level = "castle/none.json");
        Expect(!wrong.enabled && Debug.Lines.Any(line => line.StartsWith("exception ") && line.Contains("none.json")), "a level that is not there switches it off and is logged");
        Call(wrong, "OnDisable");
    }

    static int Main(string[] arguments)
    {
        Axes();
        Terrain(arguments[0]);
        Surface();
        Solid();
        Sample(arguments[1]);
        Console.WriteLine(failures + " failures");
        return failures == 0 ? 0 : 1;
    }
}
