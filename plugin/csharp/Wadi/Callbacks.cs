using System;
using System.Runtime.InteropServices;

namespace Wadi
{
    /// <summary>Tells compilers ahead of time (IL2CPP, Mono's full AOT), which look for its name, that native code calls a
    /// method.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type) { }
    }

    /// <summary>A log callback for as long as its world: the library has the address of one static method, whose delegate is never
    /// collected, and a handle of the world's own action.</summary>
    sealed unsafe class LogHandle
    {
        static readonly LogCallback callback = OnLog;
        readonly GCHandle action;
        internal readonly IntPtr Address, User;

        internal LogHandle(Action<LogLevel, string> log)
        {
            if (log == null) return;
            action = GCHandle.Alloc(log);
            Address = Marshal.GetFunctionPointerForDelegate(callback);
            User = GCHandle.ToIntPtr(action);
        }

        internal void Free()
        {
            if (action.IsAllocated) action.Free();
        }

        [MonoPInvokeCallback(typeof(LogCallback))]
        static void OnLog(void* user, LogLevel level, byte* message)
        {
            try
            {
                ((Action<LogLevel, string>)GCHandle.FromIntPtr((IntPtr)user).Target)(level, Text.Of(message));
            }
            catch (Exception) // must not pass through the library's frames; the header says that it is lost
            {
            }
        }
    }

    /// <summary>Files of a level for one call; what the host's function throws ends that call and is its exception's cause.</summary>
    sealed unsafe class FileReader
    {
        internal static readonly ReadFileCallback Callback = OnRead;
        readonly Func<string, byte[]> read;
        string name;
        byte[] bytes;
        internal Exception Thrown;

        internal FileReader(Func<string, byte[]> read)
        {
            this.read = read;
        }

        [MonoPInvokeCallback(typeof(ReadFileCallback))]
        static int OnRead(void* user, byte* name, void* data, UIntPtr* size)
        {
            var reader = (FileReader)GCHandle.FromIntPtr((IntPtr)user).Target;
            try
            {
                return reader.Read(Text.Of(name), (byte*)data, size) ? 1 : 0;
            }
            catch (Exception e) // must not pass through the library's frames
            {
                reader.Thrown = e;
                return 0;
            }
        }

        bool Read(string wanted, byte* data, UIntPtr* size)
        {
            if (data == null || wanted != name)
            {
                name = wanted;
                bytes = read(wanted);
            }
            if (bytes == null) return false;
            if (data != null)
            {
                if ((ulong)bytes.LongLength > (ulong)*size) return false;
                Marshal.Copy(bytes, 0, (IntPtr)data, bytes.Length);
            }
            *size = (UIntPtr)(ulong)bytes.LongLength;
            return true;
        }
    }
}
