using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Wadi
{
    /// <summary>Texts of the library, which are UTF-8 and end with a zero.</summary>
    static unsafe class Text
    {
        internal static string Of(byte* text)
        {
            return text == null ? null : Of(text, int.MaxValue);
        }

        internal static string Of(byte* text, int room)
        {
            int length = 0;
            while (length < room && text[length] != 0) ++length;
            return Encoding.UTF8.GetString(text, length);
        }

        internal static byte[] Utf8(string text, string name)
        {
            if (text == null) throw new ArgumentNullException(name);
            if (text.IndexOf('\0') >= 0) throw new ArgumentException("has a zero inside, at which the library would end it", name);
            var bytes = new byte[Encoding.UTF8.GetByteCount(text) + 1];
            Encoding.UTF8.GetBytes(text, 0, text.Length, bytes, 0);
            return bytes;
        }
    }

    /// <summary>Texts and arrays that stay where they are during one call.</summary>
    sealed class CallMemory : IDisposable
    {
        readonly List<GCHandle> pinned = new List<GCHandle>();

        internal IntPtr Pin(Array values)
        {
            if (values == null) return IntPtr.Zero;
            pinned.Add(GCHandle.Alloc(values, GCHandleType.Pinned));
            return pinned[pinned.Count - 1].AddrOfPinnedObject();
        }

        internal IntPtr Pin(string text, string name)
        {
            return text == null ? IntPtr.Zero : Pin(Text.Utf8(text, name));
        }

        public void Dispose()
        {
            foreach (var handle in pinned) handle.Free();
            pinned.Clear();
        }
    }
}
