// Shadows and depth textures of the built-in pipeline.
#include "UnityCG.cginc"

struct Shadowed
{
    V2F_SHADOW_CASTER;
};

struct Caster
{
    float4 vertex;
    float3 normal;
};

Shadowed ShadowVertex(float4 vertex : POSITION)
{
    Caster v; // by this name the macro takes it
    v.vertex = vertex;
    v.normal = float3(0.0, 1.0, 0.0); // the meshes have no normals of their own
    Shadowed o;
    TRANSFER_SHADOW_CASTER(o)
    return o;
}

float4 ShadowFragment(Shadowed i) : SV_Target
{
    SHADOW_CASTER_FRAGMENT(i)
}
