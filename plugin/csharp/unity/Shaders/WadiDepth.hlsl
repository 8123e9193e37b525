// Depth alone, for shadows and depth textures of the Universal Render Pipeline.
#include "UnityCG.cginc"

float4 DepthVertex(float4 vertex : POSITION) : SV_POSITION
{
    return UnityObjectToClipPos(vertex);
}

float4 DepthFragment() : SV_Target
{
    return 0.0;
}
