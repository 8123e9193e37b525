// What the shaders of plugin/csharp/unity use of Unity's Lighting.cginc.
float4 _LightColor0, _WorldSpaceLightPos0;
