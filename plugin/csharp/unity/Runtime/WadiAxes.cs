using UnityEngine;

namespace Wadi
{
    /// <summary>Wadi has x east, y north, z up, right-handed; Unity x right, y up, z forward, left-handed. North becomes forward. Lengths
    /// are metres in both.</summary>
    public static class WadiAxes
    {
        /// <summary>Positions, velocities, forces.</summary>
        public static Vector3 ToUnity(float east, float north, float up)
        {
            return new Vector3(east, up, north);
        }

        /// <summary>Angular velocities and torques: mirrored axes turn the other way.</summary>
        public static Vector3 RotationToUnity(float east, float north, float up)
        {
            return new Vector3(-east, -up, -north);
        }

        public static Quaternion OrientationToUnity(float x, float y, float z, float w)
        {
            return new Quaternion(-x, -z, -y, w);
        }

        /// <summary>x east, y north, z up of a position, velocity or force.</summary>
        public static Vector3 FromUnity(Vector3 vector)
        {
            return new Vector3(vector.x, vector.z, vector.y);
        }

        public static Vector3 RotationFromUnity(Vector3 vector)
        {
            return new Vector3(-vector.x, -vector.z, -vector.y);
        }

        public static Quaternion OrientationFromUnity(Quaternion orientation)
        {
            return new Quaternion(-orientation.x, -orientation.z, -orientation.y, orientation.w);
        }
    }
}
