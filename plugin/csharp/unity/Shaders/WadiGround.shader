// Rock and sand of a WadiSurface, ported from the Godot add-on. Patterns scale with WadiSurface.detail.
Shader "Wadi/Ground"
{
    Properties
    {
        [Header(Sand)]
        _SandDry ("Dry sand", Color) = (0.80, 0.655, 0.445, 1)
        _SandWet ("Soaked sand; damp lies between", Color) = (0.42, 0.315, 0.215, 1)
        _SandCover ("Depth from which no rock shows [cells]", Range(0.01, 2)) = 0.15
        _DampFrom ("Saturation at which it looks damp", Range(0.01, 0.5)) = 0.22
        _SoakedFrom ("Saturation at which it looks soaked", Range(0.05, 0.5)) = 0.48
        _Ripples ("Height of wind ripples", Range(0, 3)) = 1
        _Glitter ("Grains that mirror the sun", Range(0, 4)) = 1
        [Header(Rock)]
        _Rock ("Rock", Color) = (0.50, 0.465, 0.425, 1)
        _Cliff ("Rock too steep to walk on", Color) = (0.45, 0.40, 0.35, 1)
        _CliffBelow ("Upward part of the normal: cliff below", Range(0, 1)) = 0.55
        _CliffAbove ("Upward part of the normal: none above", Range(0, 1)) = 0.85
        _Strata ("How much layers of cliffs differ", Range(0, 1)) = 0.16
        [Header(Light)]
        _Hollows ("How far hollows are darker", Range(0, 2)) = 1
        _Caustics ("Light of waves on the bed", Range(0, 2)) = 0.5
    }

    SubShader
    {
        Tags { "RenderPipeline" = "UniversalPipeline" "RenderType" = "Opaque" "Queue" = "Geometry" "DisableBatching" = "True" }

        Pass
        {
            Name "Ground"
            Tags { "LightMode" = "UniversalForwardOnly" }
            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex GroundVertex
            #pragma fragment GroundFragment
            #define WADI_URP
            #include "WadiGround.hlsl"
            ENDHLSL
        }

        Pass
        {
            Name "Shadow"
            Tags { "LightMode" = "ShadowCaster" }
            ColorMask 0
            Offset 1, 1
            HLSLPROGRAM
            #pragma vertex DepthVertex
            #pragma fragment DepthFragment
            #include "WadiDepth.hlsl"
            ENDHLSL
        }

        Pass
        {
            Name "Depth"
            Tags { "LightMode" = "DepthOnly" }
            ColorMask 0
            HLSLPROGRAM
            #pragma vertex DepthVertex
            #pragma fragment DepthFragment
            #include "WadiDepth.hlsl"
            ENDHLSL
        }
    }

    SubShader
    {
        Tags { "RenderType" = "Opaque" "Queue" = "Geometry" "DisableBatching" = "True" }

        Pass
        {
            Name "Ground"
            Tags { "LightMode" = "ForwardBase" }
            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex GroundVertex
            #pragma fragment GroundFragment
            #pragma multi_compile_fwdbase nolightmap nodirlightmap nodynlightmap novertexlight
            #include "WadiGround.hlsl"
            ENDHLSL
        }

        Pass
        {
            Name "Shadow"
            Tags { "LightMode" = "ShadowCaster" }
            HLSLPROGRAM
            #pragma vertex ShadowVertex
            #pragma fragment ShadowFragment
            #pragma multi_compile_shadowcaster
            #include "WadiShadow.hlsl"
            ENDHLSL
        }
    }
}
