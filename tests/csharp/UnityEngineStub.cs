// What plugin/csharp/unity uses of Unity's scripting interface, so that it compiles and can be called here. It does nothing of Unity's and
// is no part of the package.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public class Object
    {
        public static readonly List<Object> Destroyed = new List<Object>();
        public string name { get; set; }
        public static void Destroy(Object which) { Destroyed.Add(which); }
    }

    public class Component : Object
    {
        public readonly Transform transform = new Transform();
    }

    public class MonoBehaviour : Component
    {
        public bool enabled = true;
    }

    public class Transform
    {
        public Vector3 position;
        public Vector3 InverseTransformPoint(Vector3 at) { return new Vector3(at.x - position.x, at.y - position.y, at.z - position.z); }
    }

    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }

    public struct Quaternion
    {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    }

    public enum TextureFormat { RGBAFloat, RGFloat }
    public enum TextureWrapMode { Repeat, Clamp }
    public enum FilterMode { Point, Bilinear }

    public class Texture : Object
    {
        public TextureWrapMode wrapMode { get; set; }
        public FilterMode filterMode { get; set; }
    }

    public class RenderTexture : Texture
    {
        public Texture Filled;
    }

    public class Texture2D : Texture
    {
        public readonly int width, height;
        public readonly TextureFormat format;
        public float[] Texels;
        public int Applied;
        public Texture2D(int width, int height, TextureFormat format, bool mipChain, bool linear)
        {
            if (mipChain || !linear) throw new ArgumentException("numbers want no mip levels and no sRGB");
            this.width = width;
            this.height = height;
            this.format = format;
        }
        public void SetPixelData<T>(T[] data, int mipLevel, int sourceDataStartIndex = 0)
        {
            var floats = (float[])(object)data;
            if (floats.Length != width * height * (format == TextureFormat.RGBAFloat ? 4 : 2)) throw new ArgumentException("data does not fill the texture");
            Texels = (float[])floats.Clone();
        }
        public void Apply(bool updateMipmaps) { ++Applied; }
    }

    public static class Graphics
    {
        public static void Blit(Texture source, RenderTexture dest) { dest.Filled = source; }
    }

    public static class Time
    {
        public static float fixedDeltaTime = 0.02f;
    }

    public static class Application
    {
        public static string streamingAssetsPath;
    }

    public static class Debug
    {
        public static readonly List<string> Lines = new List<string>();
        static void Add(string line) { lock (Lines) Lines.Add(line); }
        public static void Log(object message) { Add("log " + message); }
        public static void LogWarning(object message) { Add("warning " + message); }
        public static void LogError(object message) { Add("error " + message); }
        public static void LogException(Exception exception, Object context) { Add("exception " + exception.Message); }
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class TooltipAttribute : Attribute
    {
        public TooltipAttribute(string tooltip) { }
    }

    public sealed class AddComponentMenu : Attribute
    {
        public AddComponentMenu(string menuName) { }
    }
}
