// The garbage collector runs all the time while the library calls back. With argument "forgotten" a delegate is passed that nobody keeps:
// the negative control, which must not end well.
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Wadi;

static unsafe class CollectorStress
{
    const string Pond = "{\"format_version\": 1, \"name\": \"pond\", \"grid\": {\"nx\": 160, \"ny\": 128, \"dx\": 0.5}, \"dt\": 0.01,"
        + " \"terrain\": [{\"file\": \"bed.r16\", \"size\": [160, 128], \"min\": 0, \"max\": 1}], \"water\": [{\"shape\": \"cylinder\", \"center\": [3, 3], \"radius\": 2, \"height\": 1}]}";
    static volatile bool done;
    static int logged, ran;
    static readonly RunJobsCallback runJobs = RunJobs;

    static void RunJobs(void* user, uint count, IntPtr job, void* data)
    {
        var run = (Job)Marshal.GetDelegateForFunctionPointer(job, typeof(Job));
        Parallel.For(0, (int)count, n => run(data, (uint)n));
        Interlocked.Increment(ref ran);
    }

    static void Collect()
    {
        var garbage = new object[64];
        for (int n = 0; !done; ++n)
        {
            garbage[n % 64] = new byte[1000 + n % 5000];
            if (n % 16 == 0) GC.Collect(2, GCCollectionMode.Forced, true, true);
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    static World Make(int number)
    {
        var text = new string('x', number % 5 + 1); // what the closure holds is garbage but for the closure
        var options = new DeviceOptions { Backend = "cpu", Threads = 3, Log = (level, message) => { if (text.Length > 0 && message.Length > 0) Interlocked.Increment(ref logged); } };
        options.RunJobs = Marshal.GetFunctionPointerForDelegate(runJobs);
        return World.FromText(Pond, name => new byte[2 * 160 * 128], null, options);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    static WorldId MakeForgotten()
    {
        var raw = RawDeviceOptions.Default;
        var text = new byte[] { (byte)'c', (byte)'p', (byte)'u', 0 };
        var level = System.Text.Encoding.ASCII.GetBytes(Pond.Replace("\"terrain\": [{\"file\": \"bed.r16\", \"size\": [160, 128], \"min\": 0, \"max\": 1}], ", "") + "\0");
        var count = new int[1];
        raw.Log = Marshal.GetFunctionPointerForDelegate(new LogCallback((user, severity, message) => ++count[0]));
        WorldId id;
        fixed (byte* backend = text, json = level)
        {
            raw.Backend = (IntPtr)backend;
            if (Native.wadi_create_world_from_level_text(json, null, null, null, &raw, &id) != Result.Ok) Environment.Exit(3);
        }
        return id;
    }

    static void AddSand(WorldId id)
    {
        var sand = Edit.Default;
        sand.Layer = Layer.Sand;
        sand.X0 = sand.Y0 = 5;
        sand.Amount = 0.5;
        if (Native.wadi_world_edit(id, &sand, 1) != Result.Ok || Native.wadi_world_step(id, 2) != Result.Ok) Environment.Exit(3);
    }

    static int Main(string[] arguments)
    {
        if (arguments.Length > 0)
        {
            var id = MakeForgotten();
            for (int n = 0; n < 20; ++n) GC.Collect(2, GCCollectionMode.Forced, true, true);
            AddSand(id);
            Console.WriteLine("the forgotten delegate was still there");
            return 0;
        }
        var collector = new Thread(Collect);
        collector.IsBackground = true;
        collector.Start();
        ulong hash = 0;
        const int worlds = 12;
        var forgotten = new System.Collections.Generic.List<WorldId>();
        for (int number = 0; number < worlds; ++number)
        {
            var world = Make(number);
            world.SetHostOutputs(OutputMask.FreeSurface);
            var pace = UpdateSettings.Default;
            pace.MaxStepsInFlight = 0;
            world.SetUpdateSettings(pace);
            ulong ticket, other;
            for (int n = 0; n < 20; ++n) world.Update(10000000);
            if (!world.TryBeginSave(out ticket)) return 1;
            AddSand(world.Id); // the log tells of it
            while (world.TryEndSave(ticket) == null) Thread.Sleep(1);
            if (world.TryQuery(new float[] { 5, 5 }, out ticket))
            {
                var results = new QueryResult[1];
                int count;
                while (!world.TryGetQuery(ticket, results, out count, out other)) Thread.Sleep(1);
            }
            var now = world.GetHash();
            if (hash != 0 && now != hash) return 2;
            hash = now;
            if (number % 3 != 0) world.Dispose(); // the others are forgotten: the collector's finalizer destroys them
            else forgotten.Add(world.Id);
        }
        done = true;
        collector.Join();
        GC.Collect();
        GC.WaitForPendingFinalizers();
        var gone = forgotten.FindAll(id => Native.wadi_world_step(id, 1) == Result.ErrorBadArgument).Count;
        Console.WriteLine("{0} messages, {1} passes by the host's jobs, {2} collections, {3} of {4} forgotten worlds destroyed, hash {5:x16}", logged, ran, GC.CollectionCount(2), gone,
            forgotten.Count, hash);
        return logged >= 2 * worlds && ran > 100 && GC.CollectionCount(2) > 50 && gone > 0 ? 0 : 1;
    }
}
