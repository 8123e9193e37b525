// Run where there is no library: what the exception says, from the first thing that a program does.
using System;

static class MissingLibrary
{
    static void Main(string[] arguments)
    {
        foreach (var start in new Action[] { () => Wadi.World.FromLevel("level.json"), () => Console.WriteLine(Wadi.Library.Version), () => Wadi.Buoyancy.Points(Wadi.Body.Default) })
            try
            {
                start();
                Console.WriteLine("it ran");
            }
            catch (Exception e)
            {
                Console.WriteLine(e.GetType().Name + ": " + e.Message.Replace("\n", " "));
            }
    }
}
