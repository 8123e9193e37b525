#include "tests/conformance/symmetry.hpp"
#include <algorithm>
#include <cstdio>

namespace wadi::conformance {

namespace {

std::size_t at(int i, int j, int nx) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
}

// All digits of a float.
std::string number(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
    return text;
}

// The image of a cell field, or of one component of a vector field with its sign.
std::vector<float> image_of(const std::vector<float>& field, const Grid& grid, Symmetry symmetry, float sign) {
    std::vector<float> image(field.size());
    if (field.empty()) return image;
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const float value = sign * field[at(i, j, grid.nx)];
            if (symmetry == Symmetry::transpose) {
                image[at(j, i, grid.ny)] = value;
            } else {
                image[symmetry == Symmetry::mirror_x ? at(grid.nx - 1 - i, j, grid.nx) : at(i, grid.ny - 1 - j, grid.nx)] = value;
            }
        }
    }
    return image;
}

void image_vector(const std::vector<float>& x, const std::vector<float>& y, const Grid& grid, Symmetry symmetry,
                  std::vector<float>& to_x, std::vector<float>& to_y) {
    to_x = image_of(x, grid, symmetry, symmetry == Symmetry::mirror_x ? -1.0F : 1.0F);
    to_y = image_of(y, grid, symmetry, symmetry == Symmetry::mirror_y ? -1.0F : 1.0F);
    if (symmetry == Symmetry::transpose) std::swap(to_x, to_y);
}

// The span of a side along its own axis, seen from the other end.
void flip_span(Side& side, double length) {
    const double from = std::max(0.0, length - side.to), to = length - side.from;
    side.from = from;
    side.to = to;
}

} // namespace

Scene image_of(const Scene& scene, Symmetry symmetry) {
    Scene image = scene;
    auto& s = image.settings;
    const auto& grid = scene.settings.grid;
    const double lx = grid.nx * grid.dx, ly = grid.ny * grid.dx;
    const bool transpose = symmetry == Symmetry::transpose, x = symmetry == Symmetry::mirror_x;
    if (transpose) std::swap(s.grid.nx, s.grid.ny);
    for (auto member : {&InitialFields::terrain, &InitialFields::sand, &InitialFields::water})
        image.fields.*member = image_of(scene.fields.*member, grid, symmetry, 1);
    s.roughness = image_of(scene.settings.roughness, grid, symmetry, 1);
    s.rain_map = image_of(scene.settings.rain_map, grid, symmetry, 1);
    const auto& f = scene.fields;
    image_vector(f.velocity_x, f.velocity_y, grid, symmetry, image.fields.velocity_x, image.fields.velocity_y);
    image_vector(f.sand_velocity_x, f.sand_velocity_y, grid, symmetry, image.fields.sand_velocity_x,
                 image.fields.sand_velocity_y);
    for (Source& source : s.sources) {
        if (transpose) {
            std::swap(source.center[0], source.center[1]);
            std::swap(source.velocity[0], source.velocity[1]);
            source.box = {source.box[1], source.box[0], source.box[3], source.box[2]};
        } else {
            const std::size_t axis = x ? 0 : 1;
            const double length = x ? lx : ly;
            source.center[axis] = length - source.center[axis];
            source.velocity[axis] = -source.velocity[axis];
            const double low = length - source.box[axis + 2];
            source.box[axis + 2] = length - source.box[axis];
            source.box[axis] = low;
        }
    }
    auto& sides = s.sides;
    if (transpose) {
        std::swap(sides[SIDE_WEST], sides[SIDE_SOUTH]);
        std::swap(sides[SIDE_EAST], sides[SIDE_NORTH]);
    } else {
        std::swap(sides[x ? SIDE_WEST : SIDE_SOUTH], sides[x ? SIDE_EAST : SIDE_NORTH]);
        flip_span(sides[x ? SIDE_SOUTH : SIDE_WEST], x ? lx : ly);
        flip_span(sides[x ? SIDE_NORTH : SIDE_EAST], x ? lx : ly);
    }
    return image;
}

Verdict compare_images(World& world, World& image, Symmetry symmetry) {
    const int nx = world.settings().grid.nx, ny = world.settings().grid.ny;
    const FieldLayout from{nx, ny}, to{image.settings().grid.nx, image.settings().grid.ny};
    for (const auto& field : world.plan().fields) {
        if (field.role != FieldRole::state) continue;
        const bool face_x = field.name.ends_with("_velocity_x"), face_y = field.name.ends_with("_velocity_y");
        std::string twin = field.name;
        if (symmetry == Symmetry::transpose && (face_x || face_y)) twin.back() = face_x ? 'y' : 'x';
        if (symmetry == Symmetry::transpose && twin == "stretch_xx")
            twin = "stretch_yy";
        else if (symmetry == Symmetry::transpose && twin == "stretch_yy")
            twin = "stretch_xx";
        const bool shear = field.name == "stretch_xy", turn = field.name == "rotation";
        const bool odd = turn || (symmetry == Symmetry::mirror_x && (face_x || shear)) ||
                         (symmetry == Symmetry::mirror_y && (face_y || shear));
        auto a = world.reader().read_raw(field.name), b = image.reader().read_raw(twin);
        if (!a) return verdict_of(a.status());
        if (!b) return verdict_of(b.status());
        for (int j = 0; j < ny + (face_y ? 1 : 0); ++j) {
            for (int i = 0; i < nx + (face_x ? 1 : 0); ++i) {
                const int mirrored_i = nx - (face_x ? 0 : 1) - i, mirrored_j = ny - (face_y ? 0 : 1) - j;
                const float value = (*a)[from.index(i, j)];
                const float other = (*b)[symmetry == Symmetry::transpose  ? to.index(j, i)
                                         : symmetry == Symmetry::mirror_x ? to.index(mirrored_i, j)
                                                                          : to.index(i, mirrored_j)];
                if (value <= (odd ? -other : other) && value >= (odd ? -other : other)) continue;
                return failed(field.name + "(" + std::to_string(i) + ", " + std::to_string(j) + ") is " + number(value) +
                              ", its image " + number(other));
            }
        }
    }
    return {};
}

} // namespace wadi::conformance
