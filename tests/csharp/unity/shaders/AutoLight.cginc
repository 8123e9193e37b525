// What the shaders of plugin/csharp/unity use of Unity's AutoLight.cginc, as with shadows on.
Texture2D _ShadowMapTexture;
SamplerState sampler_ShadowMapTexture;
float4x4 unity_WorldToShadow[4];
#define SHADOW_COORDS(n) float4 _ShadowCoord : TEXCOORD##n;
#define TRANSFER_SHADOW(a) a._ShadowCoord = mul(unity_WorldToShadow[0], mul(unity_ObjectToWorld, v.vertex));
#define SHADOW_ATTENUATION(a) _ShadowMapTexture.Sample(sampler_ShadowMapTexture, a._ShadowCoord.xy).r
