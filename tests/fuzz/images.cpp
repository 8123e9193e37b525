#include "tests/conformance/symmetry.hpp"
#include "tests/fuzz/fuzz_case.hpp"

namespace wadi::fuzz {

Case image_of(const Case& c, Image image) {
    Case result = c;
    const bool transpose = image == Image::transpose;
    result.scene = conformance::image_of(c.scene, transpose                  ? conformance::Symmetry::transpose
                                                  : image == Image::mirror_x ? conformance::Symmetry::mirror_x
                                                                             : conformance::Symmetry::mirror_y);
    const auto& grid = c.scene.settings.grid;
    for (Edit& edit : result.commands) {
        if (transpose) {
            std::swap(edit.x0, edit.y0);
            std::swap(edit.x1, edit.y1);
            std::swap(edit.velocity_x, edit.velocity_y);
        } else if (image == Image::mirror_x) {
            edit.x0 = grid.nx * grid.dx - edit.x0;
            edit.x1 = grid.nx * grid.dx - edit.x1;
            edit.velocity_x = -edit.velocity_x;
        } else {
            edit.y0 = grid.ny * grid.dx - edit.y0;
            edit.y1 = grid.ny * grid.dx - edit.y1;
            edit.velocity_y = -edit.velocity_y;
        }
    }
    return result;
}

} // namespace wadi::fuzz
