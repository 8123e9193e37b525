// What a picture looks like: materials, light, quality. Ranges are those of the panel's sliders.
#pragma once
#include "camera.hpp"
#include "frame_params.hpp"
#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace viewer {

struct Quality {
    std::string name;
    int samples;          // per pixel
    int primary_steps;    // most steps of a ray from the eye
    int reflection_steps; // 0 = water mirrors the sky only
    int refraction_steps;
    int sky_sectors;   // directions in which the horizon is sought for sky light
    int octaves;       // of a material's pattern, each 0.45 as long as the last
    bool smooth_edges; // where there is one sample
};
const std::vector<Quality>& quality_presets();
/// Throws std::runtime_error naming the presets.
const Quality& quality_preset(const std::string& name);

/// What a picture may be drawn without, to see what it brings and costs. Numbers and order are those of shaders/frame.glsl.
const std::vector<std::string>& features();
/// Bits of the features of a list such as "foam,glitter". Throws std::runtime_error naming the features.
uint32_t feature_bits(const std::string& list);

/// Lengths in metres; colours linear.
struct Look {
    float sun_azimuth = 250;    // direction to the sun, from north to east [degrees]
    float sun_elevation = 38;   // [degrees]
    float sun_softness = 0.05f; // half width of the penumbra, a difference of slopes
    float exposure = 0.72f;
    float ambient = 1.25f;
    float clarity = 2.5f; // depth at which a third of green light is left [m]
    float ripples = 1.0f;
    float glitter = 1.2f;
    float rim = 0.5f;
    glm::vec3 sand_dry{0.56f, 0.355f, 0.165f};
    glm::vec3 sand_wet{0.155f, 0.085f, 0.040f};
    glm::vec3 rock{0.215f, 0.185f, 0.155f};
    glm::vec3 water_glow{0.010f, 0.085f, 0.11f};
    uint32_t features = ~0u; // bits of what is drawn
    bool land = true;        // beyond the block its rim goes on to the horizon; otherwise the block stands cut out on a plane
};

/// A view of a quantity instead of materials.
struct View {
    const char* name;
    const char* unit;
    float low, high;
};
/// [0] is the ordinary picture; the others' numbers are those of shaders/false_colour.glsl.
const std::vector<View>& views();
/// Throws std::runtime_error naming the views.
int view_number(const std::string& name);

struct Section {
    bool shown = false;
    glm::vec4 ends{0}; // x0, y0, x1, y1 [m]
};

/// All that a picture is of.
struct Picture {
    Camera camera;
    Look look;
    Quality quality;
    int view = 0;
    float low = 0, high = 1; // of the view
    bool arrows = false;
    Section section;
    float time = 0;  // moves ripples [s]
    float scale = 1; // of the sides of what is drawn, and then brought to the picture's size: 0.25 ... 1
    float shift = 0; // of the middle to the right, in half widths: beside a panel
};

/// The grid that is drawn.
struct Grid {
    int nx = 1, ny = 1;
    float dx = 1;             // [m]
    Block block;              // low.z: where the block is cut off below
    bool foam_drifts = false; // the world has effect foam
    glm::vec2 lengths() const { return {static_cast<float>(nx) * dx, static_cast<float>(ny) * dx}; }
};

/// Depth that water of a level of this size is seen through, [m] as Look::clarity: models look like models, landscapes of large
/// cells show streams.
float default_clarity(const Grid& grid);

/// Parameters of sample `sample` of a picture; sources and pyramid levels are the renderer's.
FrameParams frame_params(const Picture& picture, const Grid& grid, int width, int height, int sample);

} // namespace viewer
