// What the shaders of plugin/csharp/unity use of Unity's UnityCG.cginc, so that a compiler can read them here. Types are Unity's. What the
// functions do is not, and the file is no part of the package.
#ifndef UNITY_CG
#define UNITY_CG
float4x4 unity_ObjectToWorld, unity_MatrixVP, unity_WorldToObject;
float4 _Time, unity_SpecCube0_HDR;
float3 _WorldSpaceCameraPos;
TextureCube<half4> unity_SpecCube0;
SamplerState samplerunity_SpecCube0;
#define UNITY_SAMPLE_TEXCUBE_LOD(tex, coord, lod) tex.SampleLevel(sampler##tex, coord, lod)
float4 UnityObjectToClipPos(float4 pos) { return mul(unity_MatrixVP, mul(unity_ObjectToWorld, pos)); }
float3 UnityObjectToWorldNormal(float3 norm) { return normalize(mul(norm, (float3x3)unity_WorldToObject)); }
half3 ShadeSH9(half4 normal) { return normal.xyz; }
half3 DecodeHDR(half4 data, half4 decodeInstructions) { return data.rgb * decodeInstructions.x; }
float4 UnityClipSpaceShadowCasterPos(float4 vertex, float3 normal) { return UnityObjectToClipPos(vertex + float4(normal, 0.0)); }
float4 UnityApplyLinearShadowBias(float4 clipPos) { return clipPos; }
#define V2F_SHADOW_CASTER float4 pos : SV_POSITION
#define TRANSFER_SHADOW_CASTER(o) o.pos = UnityClipSpaceShadowCasterPos(v.vertex, v.normal); o.pos = UnityApplyLinearShadowBias(o.pos);
#define SHADOW_CASTER_FRAGMENT(i) return 0;
#endif
