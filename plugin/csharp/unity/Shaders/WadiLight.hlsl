// One sun and the light of the sky, in the built-in pipeline and, with WADI_URP, in the Universal Render Pipeline. The latter sets most of
// what UnityCG.cginc declares; its sun has names of its own, and its shadows are not received.
#ifndef WADI_LIGHT
#define WADI_LIGHT

#include "UnityCG.cginc"

#ifdef WADI_URP
float4 _MainLightPosition;
float4 _MainLightColor;
#define SUN_PLACE _MainLightPosition
#define SUN_COLOUR _MainLightColor.rgb
#define WADI_SHADOW_COORDS(n)
#define WADI_TRANSFER_SHADOW(o)
#define WADI_SHADOW(i) 1.0
#else
#include "Lighting.cginc"
#include "AutoLight.cginc"
#define SUN_PLACE _WorldSpaceLightPos0
#define SUN_COLOUR _LightColor0.rgb
#define WADI_SHADOW_COORDS(n) SHADOW_COORDS(n)
#define WADI_TRANSFER_SHADOW(o) TRANSFER_SHADOW(o)
#define WADI_SHADOW(i) SHADOW_ATTENUATION(i)
#endif

struct Vertex
{
    float4 vertex : POSITION;
};

// Direction to the sun; 0 where a scene has none.
float3 ToSun()
{
    return SUN_PLACE.xyz / max(length(SUN_PLACE.xyz), 1e-5);
}

// Light of the sky on a surface with this normal.
float3 SkyLight(float3 normal)
{
    return max(ShadeSH9(half4(normal, 1.0)), 0.0);
}

// The sky in a mirror: the reflection probe.
float3 SkyMirrored(float3 direction, float roughness)
{
    half4 texel = UNITY_SAMPLE_TEXCUBE_LOD(unity_SpecCube0, direction, roughness * 6.0);
    return DecodeHDR(texel, unity_SpecCube0_HDR);
}

#endif
