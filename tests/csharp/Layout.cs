// Prints what the binding lays out: sizes and offsets of every struct, numbers of every enum, sizes of every argument. check.py compares
// that with what the C compiler says of wadi.h.
using System;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;

static class Layout
{
    static int SizeOf(Type type)
    {
        if (type == typeof(void)) return 0;
        if (type.IsPointer || typeof(Delegate).IsAssignableFrom(type)) return IntPtr.Size;
        return Marshal.SizeOf(type.IsEnum ? Enum.GetUnderlyingType(type) : type);
    }

    // What an array of them has from one to the next; Marshal.SizeOf tells of what calls would be given.
    static long ManagedSize(Type type)
    {
        var two = Array.CreateInstance(type, 2);
        var pinned = GCHandle.Alloc(two, GCHandleType.Pinned);
        var size = Marshal.UnsafeAddrOfPinnedArrayElement(two, 1).ToInt64() - Marshal.UnsafeAddrOfPinnedArrayElement(two, 0).ToInt64();
        pinned.Free();
        return size;
    }

    static void Call(string name, MethodInfo method)
    {
        var sizes = new[] { SizeOf(method.ReturnType) }.Concat(method.GetParameters().Select(p => SizeOf(p.ParameterType)));
        Console.WriteLine("call " + name + " " + string.Join(" ", sizes));
    }

    static void Main()
    {
        const BindingFlags all = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
        foreach (var type in typeof(Wadi.Native).Assembly.GetTypes().Where(t => t.Namespace == "Wadi" && t.IsPublic))
        {
            if (type.IsEnum)
                foreach (var value in Enum.GetValues(type))
                    Console.WriteLine("number " + type.Name + "." + value + " " + Convert.ToInt64(value));
            else if (type.IsValueType && type.StructLayoutAttribute.Value == LayoutKind.Sequential && type.Name != "HostOutput")
            {
                Console.WriteLine("struct " + type.Name + " " + Marshal.SizeOf(type) + " " + ManagedSize(type));
                foreach (var field in type.GetFields(all))
                    Console.WriteLine("field " + type.Name + "." + field.Name + " " + Marshal.OffsetOf(type, field.Name) + " " + SizeOf(field.FieldType));
            }
            else if (typeof(Delegate).IsAssignableFrom(type)) Call(type.Name, type.GetMethod("Invoke"));
        }
        foreach (var method in typeof(Wadi.Native).GetMethods(BindingFlags.Static | BindingFlags.Public)) Call(method.Name, method);
    }
}
