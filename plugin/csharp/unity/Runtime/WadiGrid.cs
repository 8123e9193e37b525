using UnityEngine;
using UnityEngine.Rendering;

namespace Wadi
{
    /// <summary>Meshes of a grid of points, which the surface is drawn with and bodies lie on. Points count from the south-west, x (east)
    /// fastest, as Wadi's cells do.</summary>
    static class WadiGrid
    {
        /// <summary>A mesh of these points; `columns` of them lie in a row from west to east. Its upper side is the front.</summary>
        public static Mesh Make(string title, Vector3[] points, int columns)
        {
            var mesh = new Mesh { name = title };
            mesh.MarkDynamic();
            mesh.indexFormat = points.Length > 65535 ? IndexFormat.UInt32 : IndexFormat.UInt16;
            mesh.SetVertices(points);
            mesh.SetTriangles(Triangles(columns, points.Length / columns), 0, false);
            return mesh;
        }

        /// <summary>Two triangles a square, clockwise from above, which Unity takes for the front. The diagonal changes from square to
        /// square, so that slopes look alike in all directions.</summary>
        static int[] Triangles(int columns, int rows)
        {
            var indices = new int[6 * (columns - 1) * (rows - 1)];
            int n = 0;
            for (int j = 0; j < rows - 1; ++j)
            {
                for (int i = 0; i < columns - 1; ++i)
                {
                    int southWest = j * columns + i, southEast = southWest + 1, northWest = southWest + columns, northEast = northWest + 1;
                    bool rising = (i + j) % 2 == 0;
                    indices[n++] = southWest;
                    indices[n++] = northWest;
                    indices[n++] = rising ? northEast : southEast;
                    indices[n++] = rising ? southWest : northWest;
                    indices[n++] = northEast;
                    indices[n++] = southEast;
                }
            }
            return indices;
        }
    }
}
