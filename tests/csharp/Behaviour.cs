// Errors become exceptions with the library's text, a disposed world is refused, callbacks arrive, outputs are what fields say.
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Text;
using Wadi;

static class Behaviour
{
    const string Pond = "{\"format_version\": 1, \"name\": \"pond\", \"grid\": {\"nx\": 21, \"ny\": 12, \"dx\": 0.5}, \"dt\": 0.01,"
        + " \"water\": [{\"shape\": \"cylinder\", \"center\": [3, 3], \"radius\": 2, \"height\": 1}]}";
    static int failures;

    static void Expect(bool holds, string what)
    {
        if (holds) return;
        ++failures;
        Console.WriteLine("not so: " + what);
    }

    static void Throws<T>(Action call, string what, params string[] texts) where T : Exception
    {
        try
        {
            call();
        }
        catch (T e)
        {
            foreach (var text in texts) Expect(e.Message.Contains(text), what + ": \"" + e.Message + "\" names " + text);
            return;
        }
        catch (Exception e)
        {
            Expect(false, what + " throws " + typeof(T).Name + ", not " + e);
            return;
        }
        Expect(false, what + " throws");
    }

    static void Fails(Action call, Result result, string what, params string[] texts)
    {
        Throws<WadiException>(call, what, texts);
        try
        {
            call();
        }
        catch (WadiException e)
        {
            Expect(e.Result == result, what + " is " + result + ", not " + e.Result);
        }
    }

    static DeviceOptions Cpu()
    {
        return new DeviceOptions { Backend = "cpu", Threads = 1 };
    }

    static void Errors(string folder)
    {
        Fails(() => World.FromLevel(folder + "/none.json", null, Cpu()), Result.ErrorNotFound, "a level that is not there", "none.json");
        File.WriteAllText(folder + "/bad.json", Pond.Replace("\"dt\": 0.01", "\"dt\": -1"));
        Fails(() => World.FromLevel(folder + "/bad.json", null, Cpu()), Result.ErrorBadFile, "a negative time step", "dt", "-1");
        Fails(() => World.FromText(Pond.Replace("}", ""), null, null, Cpu()), Result.ErrorBadFile, "a level that is cut");
        Fails(() => World.FromText(Pond, null, null, new DeviceOptions { Backend = "abacus" }), Result.ErrorNotFound, "an unknown backend", "abacus");
        Throws<ArgumentNullException>(() => World.FromLevel(null), "no path");
        Throws<ArgumentException>(() => World.FromLevel("a\0b"), "a path with a zero inside");
        Throws<ArgumentException>(() => World.FromArrays(new WorldArrays { SettingsJson = Pond, Nx = 21, Ny = 12, Water = new float[251] }), "an array that is too short", "251", "21 x 12");
        using (var world = World.FromText(Pond, null, null, Cpu()))
        {
            Fails(() => world.ReadField(Field.SandDepth, new float[10]), Result.ErrorBadArgument, "room for too few values", "252");
            Fails(() => world.ReadField((Field)99, new float[252]), Result.ErrorBadArgument, "no such field");
            Fails(() => world.SetMaterial("frction", 1), Result.ErrorNotFound, "a misspelt name", "frction", "friction");
            Fails(() => world.Edit(new Edit()), Result.ErrorBadArgument, "an edit that does not come from Default", "struct_size");
            var edit = Edit.Default;
            edit.Radius = double.NaN;
            Fails(() => world.Edit(edit), Result.ErrorBadArgument, "a radius that is no number", "radius");
            Fails(() => world.Load(new byte[100]), Result.ErrorBadFile, "no snapshot");
            Fails(() => world.Load(new byte[0]), Result.ErrorBadArgument, "nothing at all");
            var region = new Region { I0 = 2, J0 = 3, Nx = 4, Ny = 5 };
            var depths = Enumerable.Repeat(0.25f, 20).ToArray();
            var pinned = System.Runtime.InteropServices.GCHandle.Alloc(depths, System.Runtime.InteropServices.GCHandleType.Pinned);
            var values = DeviceValues.Default;
            values.HandleKind = HandleKind.HostPointer;
            values.Handle = (ulong)pinned.AddrOfPinnedObject().ToInt64();
            world.WriteRegionFrom(Field.SandDepth, region, values);
            pinned.Free();
            var read = new float[20];
            world.ReadRegion(Field.SandDepth, region, read);
            Expect(read.SequenceEqual(depths), "values behind an address are written");
            values.RowPitch = 6;
            Fails(() => world.WriteRegionFrom(Field.SandDepth, region, values), Result.ErrorBadArgument, "a pitch that is no multiple of 4", "row_pitch");
            Fails(() => world.CudaWait(new IntPtr(8)), Result.ErrorNotSupported, "a CUDA event on the CPU");
            Fails(() => world.CudaSignal(new IntPtr(8)), Result.ErrorNotSupported, "a signal of CUDA on the CPU");
            var snapshot = world.Save();
            snapshot[snapshot.Length / 2] ^= 1;
            Fails(() => world.Load(snapshot), Result.ErrorBadFile, "a changed snapshot");
            Throws<ArgumentException>(() => world.CreateStamp(2, 2, new float[3]), "an image that is too short", "2 x 2");
            ulong ticket;
            Throws<ArgumentException>(() => world.TryQuery(new float[3], out ticket), "half a point");
            Fails(() => world.RollBack(3), Result.ErrorBadArgument, "no kept step");
            Fails(() => Library.DescribeTable("chairs"), Result.ErrorBadArgument, "no such table", "chairs");
            HostOutput output;
            Fails(() => world.TryGetHostOutput(Output.Foam, out output), Result.ErrorBadArgument, "an output that was not asked for");
            world.SetHostOutputs(OutputMask.Foam);
            Expect(!world.TryGetHostOutput(Output.Foam, out output), "an output that has not arrived is no error");
            world.ThrowIfBroken();
        }
    }

    static void Disposed()
    {
        var world = World.FromText(Pond, null, null, Cpu());
        var id = world.Id;
        world.Dispose();
        world.Dispose();
        var skipped = new[] { "Dispose", "GetType", "Equals", "GetHashCode", "ToString", "get_Nx", "get_Ny", "get_Dx", "get_Dt" };
        int refused = 0;
        foreach (var method in typeof(World).GetMethods(BindingFlags.Public | BindingFlags.Instance).Where(m => !skipped.Contains(m.Name)))
        {
            var given = method.GetParameters().Select(p => p.ParameterType == typeof(string) ? "friction" : p.ParameterType.IsArray
                ? Array.CreateInstance(p.ParameterType.GetElementType(), 4) : p.ParameterType.IsByRef ? null : Activator.CreateInstance(p.ParameterType)).ToArray();
            if (method.Name == "CreateStamp") given = new object[] { 2, 2, new float[4] };
            try
            {
                method.Invoke(world, given);
                Expect(false, method.Name + " of a disposed world is refused");
            }
            catch (TargetInvocationException e)
            {
                Expect(e.InnerException is ObjectDisposedException, method.Name + " of a disposed world says so, not " + e.InnerException.Message);
                ++refused;
            }
        }
        Expect(refused > 35, "all methods were tried: " + refused);
        Expect(Library_Refuses(id), "the library refuses the id as well");
    }

    static bool Library_Refuses(WorldId id)
    {
        return Native.wadi_world_step(id, 1) == Result.ErrorBadArgument;
    }

    static byte[] Raw16(int nx, int ny)
    {
        var bytes = new byte[2 * nx * ny];
        for (int n = 0; n < nx * ny; ++n) bytes[2 * n + 1] = (byte)(n % 7 * 30);
        return bytes;
    }

    static void Callbacks()
    {
        var said = new List<string>();
        var options = Cpu();
        options.Log = (severity, text) => { said.Add(severity + ": " + text); throw new Exception("lost"); };
        var level = Pond.Replace("\"water\"", "\"terrain\": [{\"file\": \"maps/höhe.r16\", \"size\": [21, 12], \"min\": 0, \"max\": 1}], \"water\"");
        var asked = new List<string>();
        using (var world = World.FromText(level, name => { asked.Add(name); return Raw16(21, 12); }, null, options))
        {
            Expect(asked.Distinct().SequenceEqual(new[] { "maps/höhe.r16" }), "the file is asked for by its name: " + string.Join(", ", asked));
            Expect(world.ReadField(Field.Terrain).Max() > 0.5f, "its terrain is there");
            Expect(said.Any(line => line.StartsWith("Information: ")), "the log says that a world was made: " + string.Join("|", said));
            int before = said.Count;
            var sand = Edit.Default;
            sand.Layer = Layer.Sand;
            sand.X0 = sand.Y0 = 3;
            sand.Amount = 0.5;
            world.Edit(sand);
            world.Step(2);
            world.GetHash();
            Expect(said.Count > before, "the log says that sand came");
        }
        Fails(() => World.FromText(level, name => null, null, Cpu()), Result.ErrorNotFound, "a file that is not there", "höhe.r16");
        try
        {
            World.FromText(level, name => { throw new IOException("disk on fire"); }, null, Cpu());
            Expect(false, "a reader that throws ends the call");
        }
        catch (WadiException e)
        {
            Expect(e.InnerException is IOException && e.Message.Contains("disk on fire"), "a reader's exception is the cause: " + e.Message);
        }
    }

    static void Outputs()
    {
        using (var world = World.FromText(Pond, null, null, Cpu()))
        {
            var pace = UpdateSettings.Default;
            pace.MaxStepsInFlight = 0;
            world.SetUpdateSettings(pace);
            OutputMask all = OutputMask.None;
            for (var output = Output.Terrain; output < Output.Count; ++output) all |= (OutputMask)(1u << (int)output);
            foreach (var name in Enum.GetNames(typeof(Output)).Where(n => n != "Count"))
                Expect((uint)(OutputMask)Enum.Parse(typeof(OutputMask), name) == 1u << (int)(Output)Enum.Parse(typeof(Output), name), "bit of " + name);
            world.SetOutputs(all | OutputMask.Tiles);
            world.SetHostOutputs(all);
            world.Update(50000000);
            HostOutput surface;
            do world.Update(0);
            while (!world.TryGetHostOutput(Output.FreeSurface, out surface) || surface.Step != world.Steps);
            for (var output = Output.Terrain; output < Output.Count; ++output)
            {
                OutputView view;
                HostOutput host;
                Expect(world.TryGetView(output, OutputSet.Current, out view), output + " has a view");
                Expect(world.TryGetHostOutput(output, out host), output + " has a host copy");
                int bytes = view.Format == Format.R16G16B16A16Float ? 8 : 4 * (int)view.Format;
                Expect(host.CellBytes == bytes, output + " has " + bytes + " bytes a cell, not " + host.CellBytes);
            }
            var field = world.ReadField(Field.FreeSurface);
            var copy = new float[field.Length];
            surface.CopyTo(copy);
            Expect(surface.Step == 5 && copy.SequenceEqual(field), "the output is the field");
            Expect(surface.Row(7).ToArray().SequenceEqual(field.Skip(7 * 21).Take(21)), "a row of it is a row");
            Throws<ArgumentOutOfRangeException>(() => surface.Row(12), "a row outside", "0 ... 11");
            Throws<ArgumentException>(() => surface.CopyTo(new float[3]), "room for too few", "252");
            ulong step;
            Expect(world.GetTiles(out step).Length == 1 && step == 5, "one tile");
            Expect(world.GetDirtyRegions(-1, out step).Length == 1, "one dirty rectangle");
            Expect(world.DescribePlan().Length > 100 && world.GetMemory().Length > 3 && world.GetEffects().Any(e => e.Name == "water" && e.On), "plan, memory and effects");
            Expect(world.GetMaterial().Any(m => m.Name == "friction" && m.Most > m.Least), "material");
            world.SetProfiling(true);
            world.Step(3);
            Expect(world.GetStageTimings().Length > 0, "timings");
        }
        string notes;
        Expect(Library.ListDevices(out notes).Any(d => d.Backend == "cpu" && d.Name.Length > 0 && d.IsSoftware), "devices");
        Expect(Library.ListAccuracyPresets().Select(p => p.Name).SequenceEqual(new[] { "draft", "balanced", "accurate", "fine" }), "presets");
        Expect(Library.DescribeTable("settings").Contains("friction") && Library.FieldName((Field)77) == null && Library.Version.Contains("."), "tables");
        var body = Body.Default;
        body.PositionX = body.PositionY = 3;
        var points = Buoyancy.Points(body);
        var force = new float[3];
        var torque = new float[3];
        var answers = new QueryResult[points.Length / 2];
        for (int n = 0; n < answers.Length; ++n)
        {
            answers[n].Inside = true;
            answers[n].Surface = answers[n].WaterDepth = 10;
            answers[n].NormalZ = 1;
        }
        Buoyancy.Force(body, answers, answers.Length, force, torque);
        Expect(points.Length == 32 && Math.Abs(force[2] - 9810 * 0.5f) < 1, "half a cube in the water's bed is lifted by half its water: " + force[2]);
    }

    // A field of the header that the hand-written classes lack would be out of reach.
    static void Mirrors()
    {
        foreach (var name in new[] { "DeviceOptions", "LevelOverrides", "WorldArrays", "AccuracyPreset" })
        {
            var assembly = typeof(World).Assembly;
            var mirror = assembly.GetType("Wadi." + name);
            foreach (var field in assembly.GetType("Wadi.Raw" + name).GetMembers(BindingFlags.Public | BindingFlags.Instance).Where(m => m is FieldInfo || m is PropertyInfo))
                Expect(field.Name == "LogUser" || mirror.GetField(field.Name) != null, name + " has " + field.Name);
        }
        var source = string.Join("\n", Environment.GetCommandLineArgs().Skip(2).Select(File.ReadAllText));
        foreach (var call in typeof(Native).GetMethods(BindingFlags.Static | BindingFlags.Public))
            Expect(source.Contains("Native." + call.Name + "("), call.Name + " is used by the layer on top");
    }

    static void ForgottenSaves()
    {
        using (var world = World.FromText(Pond, null, null, Cpu()))
        {
            var pinned = (System.Collections.IDictionary)typeof(World).GetField("pinnedSaves", BindingFlags.NonPublic | BindingFlags.Instance).GetValue(world);
            int asked = 0, most = 0;
            for (int n = 0; n < 2000 && asked < 8; ++n)
            {
                ulong ticket;
                world.Step(1);
                if (!world.TryBeginSave(out ticket)) continue;
                ++asked;
                world.TryEndSave(ticket); // once: whether it was there or not, nobody asks again
                most = Math.Max(most, pinned.Count);
            }
            Expect(asked == 8 && most <= 1, "saves that nobody fetches hold one buffer at most, not " + most + " of " + asked);
        }
    }

    static int Main(string[] arguments)
    {
        Errors(arguments[0]);
        Disposed();
        Callbacks();
        Outputs();
        Mirrors();
        ForgottenSaves();
        Console.WriteLine(failures + " failures");
        return failures == 0 ? 0 : 1;
    }
}
