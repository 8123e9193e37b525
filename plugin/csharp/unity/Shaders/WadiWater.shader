// Water of a WadiSurface, ported from the Godot add-on. Patterns scale with WadiSurface.detail.
Shader "Wadi/Water"
{
    Properties
    {
        [Header(Colour)]
        _Clarity ("Depth that leaves a third of green light [details]", Range(0.5, 200)) = 7
        _Absorption ("Red, green, blue lost, against that of green", Vector) = (2.6, 1.0, 0.82, 0)
        _Glow ("Light that the water sends back", Color) = (0.04, 0.29, 0.36, 1)
        [Header(Waves)]
        _Ripples ("Small waves on top of the world's own", Range(0, 4)) = 1
        _Roughness ("Roughness of the mirror", Range(0, 1)) = 0.06
        [Header(Foam)]
        _FoamColour ("Foam", Color) = (0.95, 0.97, 0.97, 1)
        _FoamAmount ("Share of the surface under it", Range(0, 2)) = 1
        _FoamSize ("Size of its patches [details]", Range(0.1, 20)) = 2
        _ShoreFoam ("Foam at the shore, up to a depth of [cells]", Range(0, 1)) = 0.12
    }

    SubShader
    {
        Tags { "RenderPipeline" = "UniversalPipeline" "RenderType" = "Transparent" "Queue" = "Transparent-10" "DisableBatching" = "True" }

        Pass
        {
            Name "Dim"
            Tags { "LightMode" = "SRPDefaultUnlit" }
            Blend Zero SrcColor
            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex WaterVertex
            #pragma fragment DimFragment
            #define WADI_URP
            #include "WadiWater.hlsl"
            ENDHLSL
        }

        Pass
        {
            Name "Light"
            Tags { "LightMode" = "UniversalForward" }
            Blend One One
            ZWrite Off
            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex WaterVertex
            #pragma fragment LightFragment
            #define WADI_URP
            #include "WadiWater.hlsl"
            ENDHLSL
        }
    }

    SubShader
    {
        Tags { "RenderType" = "Transparent" "Queue" = "Transparent-10" "DisableBatching" = "True" }

        Pass
        {
            Name "Dim"
            Tags { "LightMode" = "ForwardBase" }
            Blend Zero SrcColor
            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex WaterVertex
            #pragma fragment DimFragment
            #include "WadiWater.hlsl"
            ENDHLSL
        }

        Pass
        {
            Name "Light"
            Tags { "LightMode" = "ForwardBase" }
            Blend One One
            ZWrite Off
            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex WaterVertex
            #pragma fragment LightFragment
            #include "WadiWater.hlsl"
            ENDHLSL
        }
    }
}
