// session.c in C#: the same calls, the same lines.
using System;
using System.Globalization;
using Wadi;

static class Session
{
    const int Nx = 64, Ny = 32;

    static ulong Digest(byte[] data)
    {
        ulong value = 14695981039346656037;
        foreach (var part in data) value = unchecked((value ^ part) * 1099511628211);
        return value;
    }

    static unsafe byte[] Bytes(void* from, int size)
    {
        var bytes = new byte[size];
        System.Runtime.InteropServices.Marshal.Copy((IntPtr)from, bytes, 0, size);
        return bytes;
    }

    static unsafe ulong Digest(float[] values)
    {
        fixed (float* from = values) return Digest(Bytes(from, 4 * values.Length));
    }

    static unsafe ulong Digest(QueryResult[] values)
    {
        fixed (QueryResult* from = values) return Digest(Bytes(from, sizeof(QueryResult) * values.Length));
    }

    static void Tell(string name, ulong value)
    {
        Console.WriteLine(name + " " + value.ToString("x16"));
    }

    // As %.17g and %.9g print them: the shortest exponent that C# writes is brought to C's form.
    static string Number(double value, int digits = 17)
    {
        return value.ToString("G" + digits, CultureInfo.InvariantCulture).Replace("E", "e");
    }

    static int Flag(bool flag)
    {
        return flag ? 1 : 0;
    }

    static World Create(string level)
    {
        var world = World.FromLevel(level, new LevelOverrides { Nx = Nx, Ny = Ny }, new DeviceOptions { Backend = "cpu", Threads = 2 });
        var pace = UpdateSettings.Default;
        pace.MaxStepsInFlight = 0;
        pace.MaxStepsPerUpdate = 64;
        world.SetUpdateSettings(pace);
        return world;
    }

    static void Main(string[] arguments)
    {
        using (var world = Create(arguments[0]))
        {
            var info = world.GetInfo();
            Console.WriteLine("{0} {1} x {2} dx {3} dt {4} on {5}, exact {6}", info.Name, info.Nx, info.Ny, Number(info.Dx), Number(info.Dt), info.Backend, Flag(info.ExactFloat));
            world.SetCommandLog(true);
            world.SetHostOutputs(OutputMask.Packed);
            world.SetOutputs(OutputMask.Flow | OutputMask.Tiles);
            world.SetRollback(4, 8);

            var stamp = world.CreateStamp(3, 2, new[] { 0, 1, 0.5f, 1, 0, 0.25f });
            var pour = Edit.Default;
            pour.Layer = Layer.Water;
            pour.X0 = 20;
            pour.Y0 = 6;
            pour.Radius = 3;
            pour.Amount = 0.4;
            var print = Edit.Default;
            print.Kind = EditKind.Stamp;
            print.Layer = Layer.Sand;
            print.X0 = 30;
            print.Y0 = 10;
            print.X1 = 40;
            print.Y1 = 16;
            print.Amount = 0.75;
            print.Stamp = stamp;
            var push = Edit.Default;
            push.Kind = EditKind.Push;
            push.Capsule = true;
            push.Step = 12;
            push.X0 = 4;
            push.Y0 = 4;
            push.X1 = 9;
            push.Y1 = 8;
            push.VelocityX = 2.5;
            push.VelocityY = -0.5;
            world.Edit(pour, print, push);
            for (int image = 0; image < 30; ++image)
            {
                var frame = world.Update(16666667);
                if (image % 10 == 9)
                    Console.WriteLine("frame {0} {1} {2} {3} {4}", frame.Steps, frame.TotalSteps, Number(frame.Time), Number(frame.Interpolation), frame.DroppedNanosecondsTotal);
            }
            world.SetMaterial("friction", 0.3);

            ulong ticket, step;
            int count;
            var results = new QueryResult[3];
            world.TryQuery(new[] { 5, 5, 20.5f, 7.25f, 1000, 0 }, out ticket);
            while (!world.TryGetQuery(ticket, results, out count, out step)) { }
            Console.WriteLine("query {0} at {1}, inside {2} {3} {4}, {5} {6} {7}", count, step, Flag(results[0].Inside), Flag(results[1].Inside), Flag(results[2].Inside),
                Number(results[0].Surface, 9), Number(results[1].NormalZ, 9), Number(results[0].VelocityX, 9));
            Tell("query", Digest(results));

            for (var field = Field.Terrain; field < Field.Count; ++field) Tell(Library.FieldName(field), Digest(world.ReadField(field)));
            HostOutput output;
            do world.Update(0);
            while (!world.TryGetHostOutput(Output.Packed, out output) || output.Step != world.Steps);
            var packed = new float[4 * Nx * Ny];
            output.CopyTo(packed);
            Console.Write("packed of step " + output.Step + " ");
            Tell("", Digest(packed));

            var region = new Region { I0 = 3, J0 = 4, Nx = 5, Ny = 6 };
            var values = new float[30];
            world.ReadRegion(Field.SandDepth, region, values);
            for (int n = 0; n < values.Length; ++n) values[n] += 0.125f;
            world.WriteRegion(Field.SandDepth, region, values);
            Tell("hash", world.GetHash());
            var stats = world.GetStats();
            Console.WriteLine("stats {0} {1} {2} {3} {4}", Number(stats.SandVolume), Number(stats.WaterVolume), Number(stats.LargestWaterSpeed), stats.SandDriftQuanta, stats.WaterDriftQuanta);

            var snapshot = world.Save();
            Tell("snapshot", Digest(snapshot));
            world.TryBeginSave(out ticket);
            byte[] fetched;
            while ((fetched = world.TryEndSave(ticket)) == null) { }
            Console.WriteLine("fetched " + (System.Linq.Enumerable.SequenceEqual(fetched, snapshot) ? "equal" : "other"));
            world.SaveFile(arguments[1]);
            world.Step(7);
            Tell("after", world.GetHash());
            world.Load(snapshot);
            world.Step(7);
            Tell("again", world.GetHash());
            world.LoadFile(arguments[1]);
            Tell("loaded", world.GetHash());

            var commands = world.GetCommands();
            Tell("commands", Digest(commands));
            using (var second = Create(arguments[0]))
            {
                second.PlayCommands(commands);
                second.Step((uint)world.Steps);
                Tell("played", second.GetHash());
                second.SetRollback(4, 8);
                second.Step(40);
                var kept = second.GetRollbackSteps();
                var reached = second.RollBack(kept[1] + 3);
                Console.WriteLine("kept {0} from {1}, reached {2}", kept.Length, kept[0], reached);
                Tell("back", second.GetHash());
            }
        }
    }
}
