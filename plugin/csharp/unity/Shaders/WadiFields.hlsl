// What a WadiTerrain publishes, read so that it is smooth between cells. Set by WadiSurface, not by hand.
//
// Texels are read one by one, so that no device needs to filter 32-bit textures. Positions `at` are metres from the south-west corner,
// x east, y north: x and z of the mesh. Outside the grid everything is as at the nearest point of its rim.
#ifndef WADI_FIELDS
#define WADI_FIELDS

Texture2D<float4> _WadiSurface; // elevation of the visible surface [m], depth of pure water [m], foam 0 ... 1, saturation 0 ... 0.5 ... 1
Texture2D<float4> _WadiFlow;    // velocity of the water east and north [m/s]
Texture2D<float4> _WadiSand;    // depth of sand [m]
float4 _WadiGrid;               // cells along x and y, side of a cell [m], length that patterns scale with [m]

#define CELLS int2(_WadiGrid.xy)
#define CELL_SIZE _WadiGrid.z
#define DETAIL _WadiGrid.w

struct Surfaces
{
    float ground;       // elevation of rock and sand [m]
    float level;        // elevation of the water; below the ground where there is none [m]
    float depth;        // of pure water, mean of the cells around [m]
    float foam;
    float saturation;
    float2 groundSlope; // rise per metre to the east and to the north
    float2 levelSlope;
};

// Position within the grid, in cells from the middle of cell (0, 0).
float2 ClampedCell(float2 place)
{
    return clamp(place / CELL_SIZE - 0.5, 0.0, _WadiGrid.xy - 1.0);
}

int3 Inside(int2 c)
{
    return int3(clamp(c, int2(0, 0), CELLS - 1), 0);
}

// Weights of a quadratic B-spline over three cells, and their derivatives.
float Weight(int n, float t)
{
    return n == 1 ? 0.75 - t * t : n == 0 ? 0.5 * (0.5 - t) * (0.5 - t) : 0.5 * (0.5 + t) * (0.5 + t);
}

float WeightSlope(int n, float t)
{
    return n == 1 ? -2.0 * t : n == 0 ? t - 0.5 : t + 0.5;
}

// Depth below which water is a film that no wave runs on [m].
float Film()
{
    return max(0.004 * CELL_SIZE, 1e-4);
}

Surfaces SurfacesAt(float2 place)
{
    float2 free = place / CELL_SIZE - 0.5, q = ClampedCell(place);
    int2 middle = int2(round(q));
    float2 t = q - float2(middle);
    float4 mean = 0.0;
    float2 groundSlope = 0.0, depthSlope = 0.0, levelRise = 0.0, wetRise = 0.0;
    float level = 0.0, wet = 0.0;
    [unroll]
    for (int y = 0; y < 3; ++y)
    {
        [unroll]
        for (int x = 0; x < 3; ++x)
        {
            float4 here = _WadiSurface.Load(Inside(middle + int2(x, y) - 1));
            float w = Weight(x, t.x) * Weight(y, t.y);
            float2 rise = float2(WeightSlope(x, t.x) * Weight(y, t.y), Weight(x, t.x) * WeightSlope(y, t.y));
            float ground = here.r - here.g;
            mean += w * float4(ground, here.gba);
            groundSlope += rise * ground;
            depthSlope += rise * here.g;
            if (here.g > 0.25 * Film())
            {
                level += w * here.r;
                wet += w;
                levelRise += rise * here.r;
                wetRise += rise;
            }
        }
    }
    Surfaces s;
    s.ground = mean.x;
    s.depth = mean.y;
    s.foam = mean.z;
    s.saturation = mean.w;
    s.level = mean.x - 0.02 * CELL_SIZE;
    s.levelSlope = groundSlope;
    if (wet > 1e-5)
    {
        // Still water meets its shore level; a front runs out with the mean depth instead of ending in a step.
        s.level = level / wet;
        s.levelSlope = (levelRise - s.level * wetRise) / wet;
        float front = mean.x + 2.0 * mean.y;
        if (front < s.level)
        {
            s.level = front;
            s.levelSlope = groundSlope + 2.0 * depthSlope;
        }
    }
    float2 within = float2(free.x == q.x ? 1.0 : 0.0, free.y == q.y ? 1.0 : 0.0); // no slope across the rim
    s.groundSlope = groundSlope / CELL_SIZE * within;
    s.levelSlope = s.levelSlope / CELL_SIZE * within;
    return s;
}

// A normal in the terrain's space from slopes to the east and north.
float3 NormalOf(float2 slope)
{
    return normalize(float3(-slope.x, 1.0, -slope.y));
}

// A field of one texture at a place, bilinear.
float4 BilinearAt(Texture2D<float4> field, float2 place)
{
    float2 q = ClampedCell(place);
    int2 low = int2(floor(q));
    float2 t = q - float2(low);
    float4 south = lerp(field.Load(Inside(low)), field.Load(Inside(low + int2(1, 0))), t.x);
    float4 north = lerp(field.Load(Inside(low + int2(0, 1))), field.Load(Inside(low + int2(1, 1))), t.x);
    return lerp(south, north, t.y);
}

#endif
