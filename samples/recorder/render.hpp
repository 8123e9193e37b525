// Shaded view from above of terrain, sand and water: light from the north-west, computed in linear light.
#pragma once
#include "image.hpp"
#include <vector>

namespace recorder {

/// The fields that a picture needs, row 0 in the south; cells of side dx [m].
struct MapFields {
    int nx = 0, ny = 0;
    double dx = 1;
    std::vector<float> terrain;    // H [m]
    std::vector<float> sand;       // hs [m]
    std::vector<float> water;      // pure water above the sand [m]
    std::vector<float> saturation; // W/(W + hs)
};

/// Means over factor x factor blocks of cells, for grids larger than a picture.
MapFields reduced(const MapFields& fields, int factor);

/// What stays fixed over a recording once there is water, so that colours mean the same in every frame.
struct Look {
    float low = 0, high = 1; // range of the terrain's height [m] for its tint; equal on a plain
    float relief_gain = 1;   // ground slopes are multiplied by this before shading
    float water_scale = 1;   // depth [m] that is drawn in deep blue
    bool wet_from_start = false;
};
/// From the first frame; a level that begins dry waits for scale_to_water(). `water_scale` > 0 overrides the one derived from the
/// largest depth and the relief.
Look choose_look(const MapFields& fields, double water_scale);

/// Scales to the water of the first frame that has any, unless the first of all had or `water_scale` > 0; whether there was some.
bool scale_to_water(const MapFields& fields, double water_scale, Look& look);

/// How cells become pixels: enlarged until the longer side has at least 800 pixels, reduced above 1600 cells. A strip of a
/// few cells' width is enlarged further across, to be seen at all.
struct Scaling {
    int reduce = 1;                   // cells per picture cell
    int enlarge_x = 1, enlarge_y = 1; // pixels per picture cell
};
Scaling choose_scaling(int nx, int ny);

/// One pixel of flat ground's colours, for the map and its legend alike.
Linear terrain_colour(float fraction);                                          // 0 = lowest, 1 = highest ground
Linear sand_colour(float saturation);                                           // 0 = dry, 0.5 = pores full
Linear under_water(Linear ground, float depth, float water_scale, float light); // light 1 = level surface

Image render_map(const MapFields& fields, const Look& look, const Scaling& scaling);

} // namespace recorder
