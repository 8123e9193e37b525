// What plugin/csharp/unity uses of Unity's scripting interface, so that it compiles and can be called here. Places are those of objects that
// are moved and not turned. It is no part of the package.
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public class Object
    {
        public static readonly List<Object> Destroyed = new List<Object>();
        public string name { get; set; }
        public static void Destroy(Object which) { Destroyed.Add(which); }
    }

    public class GameObject : Object
    {
        public static readonly List<GameObject> All = new List<GameObject>();
        internal static GameObject Adding;
        readonly List<Component> components = new List<Component>();
        public readonly Transform transform;
        public int layer { get; set; }
        public GameObject(string name)
        {
            this.name = name;
            transform = AddComponent<Transform>();
            All.Add(this);
        }
        public T AddComponent<T>() where T : Component, new()
        {
            var outer = Adding;
            Adding = this;
            try
            {
                var made = new T();
                components.Add(made);
                return made;
            }
            finally
            {
                Adding = outer;
            }
        }
        public T GetComponent<T>() { return components.OfType<T>().FirstOrDefault(); }
    }

    public class Component : Object
    {
        readonly GameObject owner = GameObject.Adding;
        public GameObject gameObject { get { return owner; } }
        public new string name { get { return owner.name; } }
        public Transform transform { get { return owner.transform; } }
        public T GetComponent<T>() { return owner.GetComponent<T>(); }
        public T GetComponentInParent<T>() where T : class
        {
            for (var at = transform; at != null; at = at.parent)
            {
                var found = at.gameObject.GetComponent<T>();
                if (found != null) return found;
            }
            return null;
        }
    }

    public class Behaviour : Component
    {
        public bool enabled = true;
    }

    public class MonoBehaviour : Behaviour
    {
    }

    public class Transform : Component
    {
        Vector3 local;
        public Transform parent { get; private set; }
        public void SetParent(Transform parent, bool worldPositionStays)
        {
            if (worldPositionStays) throw new ArgumentException("nothing asks for it");
            this.parent = parent;
        }
        public Vector3 position
        {
            get { return parent == null ? local : parent.position + local; }
            set { local = parent == null ? value : value - parent.position; }
        }
        public Quaternion rotation { get { return new Quaternion(0, 0, 0, 1); } }
        public Vector3 up { get { return new Vector3(0, 1, 0); } }
        public Vector3 TransformPoint(Vector3 at) { return at + position; }
        public Vector3 InverseTransformPoint(Vector3 at) { return at - position; }
    }

    public struct Vector2
    {
        public float x, y;
        public Vector2(float x, float y) { this.x = x; this.y = y; }
        public static implicit operator Vector3(Vector2 v) { return new Vector3(v.x, v.y, 0); }
    }

    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 operator +(Vector3 a, Vector3 b) { return new Vector3(a.x + b.x, a.y + b.y, a.z + b.z); }
        public static Vector3 operator -(Vector3 a, Vector3 b) { return new Vector3(a.x - b.x, a.y - b.y, a.z - b.z); }
        public static Vector3 operator *(float s, Vector3 v) { return new Vector3(s * v.x, s * v.y, s * v.z); }
    }

    public struct Vector4
    {
        public float x, y, z, w;
        public Vector4(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    }

    public struct Quaternion
    {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    }

    public struct Bounds
    {
        public Vector3 center, size;
        public Bounds(Vector3 center, Vector3 size) { this.center = center; this.size = size; }
    }

    public struct Ray
    {
        public Vector3 origin, direction;
        public Ray(Vector3 origin, Vector3 direction) { this.origin = origin; this.direction = direction; }
        public Vector3 GetPoint(float distance) { return origin + distance * direction; }
    }

    public struct Rect
    {
        public Rect(float x, float y, float width, float height) { }
    }

    public static class Mathf
    {
        public static float Lerp(float a, float b, float t) { return a + (b - a) * Math.Min(Math.Max(t, 0), 1); }
    }

    public enum TextureFormat { RGBAFloat, RGFloat, RFloat }
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
            int channels = format == TextureFormat.RGBAFloat ? 4 : format == TextureFormat.RGFloat ? 2 : 1;
            if (floats.Length != width * height * channels) throw new ArgumentException("data does not fill the texture");
            Texels = (float[])floats.Clone();
        }
        public void Apply(bool updateMipmaps) { ++Applied; }
    }

    public class TextAsset : Object
    {
        public byte[] bytes { get; set; }
        public string text { get { return System.Text.Encoding.UTF8.GetString(bytes); } }
    }

    public class Material : Object
    {
    }

    public class Mesh : Object
    {
        public Vector3[] Vertices;
        public int[] Triangles;
        public IndexFormat indexFormat { get; set; }
        public Bounds bounds { get; set; }
        public void MarkDynamic() { }
        public void SetVertices(Vector3[] vertices) { Vertices = (Vector3[])vertices.Clone(); }
        public void SetTriangles(int[] triangles, int submesh, bool calculateBounds)
        {
            if (triangles.Any(n => n < 0 || n >= Vertices.Length)) throw new ArgumentException("a triangle has a point that is not there");
            if (indexFormat == IndexFormat.UInt16 && Vertices.Length > 65536) throw new ArgumentException("more points than 16 bits count");
            Triangles = (int[])triangles.Clone();
        }
        public void RecalculateBounds() { }
    }

    public class MeshFilter : Component
    {
        public Mesh sharedMesh { get; set; }
    }

    public class Renderer : Component
    {
        public MaterialPropertyBlock Values;
        public Material sharedMaterial { get; set; }
        public ShadowCastingMode shadowCastingMode { get; set; }
        public void SetPropertyBlock(MaterialPropertyBlock properties) { Values = properties; }
    }

    public class MeshRenderer : Renderer
    {
    }

    public class MaterialPropertyBlock
    {
        public readonly Dictionary<string, object> Values = new Dictionary<string, object>();
        public void SetTexture(int nameID, Texture value) { Values[Shader.Names[nameID]] = value; }
        public void SetVector(int nameID, Vector4 value) { Values[Shader.Names[nameID]] = value; }
    }

    public static class Shader
    {
        public static readonly List<string> Names = new List<string>();
        public static int PropertyToID(string name)
        {
            Names.Add(name);
            return Names.Count - 1;
        }
    }

    public class Rigidbody : Component
    {
    }

    public class Collider : Component
    {
        public bool enabled { get; set; }
        public Rigidbody attachedRigidbody { get { return GetComponent<Rigidbody>(); } }
    }

    public class CharacterController : Collider
    {
    }

    public enum MeshColliderCookingOptions { None, UseFastMidphase = 16 }

    public class MeshCollider : Collider
    {
        Mesh shared;
        public Vector3[] Cooked; // what physics knows: the mesh as it was when it was given
        public MeshColliderCookingOptions cookingOptions { get; set; }
        public Mesh sharedMesh
        {
            get { return shared; }
            set
            {
                if (value != shared) Cooked = value == null ? null : (Vector3[])value.Vertices.Clone();
                shared = value;
            }
        }
    }

    public static class Physics
    {
        public static readonly List<Collider> Bodies = new List<Collider>();
        public static int Synced;
        public static Collider[] OverlapBox(Vector3 center, Vector3 halfExtents, Quaternion orientation)
        {
            return Bodies.Where(body =>
            {
                var at = body.transform.position - center;
                return Math.Abs(at.x) <= halfExtents.x && Math.Abs(at.y) <= halfExtents.y && Math.Abs(at.z) <= halfExtents.z;
            }).ToArray();
        }
        public static void SyncTransforms() { ++Synced; }
    }

    public class Camera : Behaviour
    {
        public Func<Vector3, Ray> Rays;
        public Ray ScreenPointToRay(Vector3 pos) { return Rays(pos); }
    }

    public enum EventType { MouseDown, MouseUp, MouseDrag, Repaint }

    public class Event
    {
        public static Event current;
        public EventType type { get; set; }
        public int button { get; set; }
        public Vector2 mousePosition { get; set; }
    }

    public static class GUI
    {
        public static void Label(Rect position, string text) { }
    }

    public static class Screen
    {
        public static int height { get { return 600; } }
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
        public static void LogError(object message, Object context = null) { Add("error " + message); }
        public static void LogException(Exception exception, Object context) { Add("exception " + exception.Message); }
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class TooltipAttribute : Attribute
    {
        public TooltipAttribute(string tooltip) { }
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class RangeAttribute : Attribute
    {
        public RangeAttribute(float min, float max) { }
    }

    public sealed class AddComponentMenu : Attribute
    {
        public AddComponentMenu(string menuName) { }
    }

    public sealed class DefaultExecutionOrder : Attribute
    {
        public DefaultExecutionOrder(int order) { }
    }
}

namespace UnityEngine.Rendering
{
    public enum IndexFormat { UInt16, UInt32 }
    public enum ShadowCastingMode { Off, On }
}
