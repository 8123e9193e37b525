// Hashes and value noise, and shares of light. Integer hashes: the same picture on every device.
#ifndef WADI_NOISE
#define WADI_NOISE

uint HashOf(uint2 v)
{
    uint h = v.x * 0x9E3779B1u ^ (v.y + 0x7F4A7C15u) * 0x85EBCA77u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    return h ^ (h >> 15);
}

float UnitOf(uint h)
{
    return float(h >> 8) * (1.0 / 16777216.0);
}

// Value noise in [-1, 1] with its derivatives: x value, yz d/dp.
float3 NoiseSlopes(float2 p)
{
    float2 corner = floor(p), f = p - corner;
    uint2 k = uint2(int2(corner));
    float a = UnitOf(HashOf(k));
    float b = UnitOf(HashOf(k + uint2(1, 0)));
    float c = UnitOf(HashOf(k + uint2(0, 1)));
    float d = UnitOf(HashOf(k + uint2(1, 1)));
    float2 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    float2 du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    float e = a - b - c + d;
    float value = a + (b - a) * u.x + (c - a) * u.y + e * u.x * u.y;
    return float3(2.0 * value - 1.0, 2.0 * du * float2(b - a + e * u.y, c - a + e * u.x));
}

// Two turned frames, as rows: value noise alone would show its grid.
static const float2x2 Turned = float2x2(0.80, -0.60, 0.60, 0.80);
static const float2x2 TurnedMore = float2x2(0.34, 0.94, -0.94, 0.34);

// How much of a pattern of this wavelength a pixel of this size still shows.
float Resolved(float wavelength, float pixel)
{
    return saturate(0.5 * wavelength / pixel - 0.5);
}

// A share of light as colours are multiplied by it. Projects in gamma space compute with colours as they are shown.
float3 Shown(float3 share)
{
#ifdef UNITY_COLORSPACE_GAMMA
    return pow(max(share, 0.0), 1.0 / 2.2);
#else
    return share;
#endif
}

#endif
