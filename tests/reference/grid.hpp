// Cells and faces of the reference solver: dense arrays without ghosts, and one way to walk them along either axis.
#pragma once
#include <cstddef>
#include <vector>

namespace wadi::reference {

template <class Real> using Field = std::vector<Real>;

/// One axis of the grid. Every formula is written once for an axis; `a` counts along it and `b` across it, so that
/// transposed scenes run the very same operations.
struct Axis {
    bool is_y = false;
    int nx = 0;
    int ny = 0;

    int along() const { return is_y ? ny : nx; }
    int across() const { return is_y ? nx : ny; }
    /// Cell a along, b across.
    std::size_t cell(int a, int b) const { return is_y ? at(b, a, nx) : at(a, b, nx); }
    /// Face between the cells a - 1 and a, normal to this axis.
    std::size_t face(int a, int b) const { return is_y ? at(b, a, nx) : at(a, b, nx + 1); }
    /// Face between the cells (a, b - 1) and (a, b), normal to the other axis.
    std::size_t cross(int a, int b) const { return is_y ? at(b, a, nx + 1) : at(a, b, nx); }

  private:
    static std::size_t at(int i, int j, int row) {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(row) + static_cast<std::size_t>(i);
    }
};

/// Values on the (nx + 1) ny faces normal to x and the nx (ny + 1) faces normal to y.
template <class Real> struct Faces {
    Field<Real> x;
    Field<Real> y;

    Field<Real>& along(const Axis& axis) { return axis.is_y ? y : x; }
    const Field<Real>& along(const Axis& axis) const { return axis.is_y ? y : x; }
    const Field<Real>& across(const Axis& axis) const { return axis.is_y ? x : y; }
};

} // namespace wadi::reference
