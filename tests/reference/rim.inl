// What enters and leaves: sources, rain, evaporation and open sides (2.9). Amounts are whole quanta.
#pragma once
#include "tests/reference/prestress.inl"

namespace wadi::reference {

/// The amount of this step [m], so that everything given so far is floor(total / Q) quanta.
template <class Real> double Solver<Real>::quanta(double& total, double amount) const {
    const double Q = static_cast<double>(P.quantum);
    const double before = total;
    total += amount;
    return Q > 0 ? (std::floor(total / Q) - std::floor(before / Q)) * Q : amount;
}

/// Adds to a cell, or removes what is there at most; refuses to pass the declared largest column. Sand that is added
/// dilutes the strain of the cell.
template <class Real> void Solver<Real>::add_depth(Field<Real>& field, std::size_t cell, Real amount, double& ledger) {
    if (amount > Real(0) && terrain[cell] + sand[cell] + water[cell] + amount > P.largest_height) {
        ++refused;
        return;
    }
    const Real change = std::max(amount, -field[cell]);
    if (&field == &sand && change != Real(0)) change_strain(cell, change);
    field[cell] += change;
    ledger += static_cast<double>(change);
}

template <class Real> void Solver<Real>::apply_source(const Source& source, double& total) {
    const double dx = settings.grid.dx;
    // Whether a position is inside; positions are cell centres and face centres [m].
    const auto inside = [&](double px, double py) {
        const double rx = px - source.center[0];
        const double ry = py - source.center[1];
        if (source.shape == SourceShape::disc) return rx * rx + ry * ry <= source.radius * source.radius;
        return px >= source.box[0] && px < source.box[2] && py >= source.box[1] && py < source.box[3];
    };
    const bool is_point = source.shape == SourceShape::point;
    const int point_i = static_cast<int>(std::floor(source.center[0] / dx));
    const int point_j = static_cast<int>(std::floor(source.center[1] / dx));
    const Axis x = axis(false);

    const auto covers = [&](int i, int j) {
        return is_point ? i == point_i && j == point_j : inside((i + 0.5) * dx, (j + 0.5) * dx);
    };
    double rate = sample(source.rate, time());
    if (!source.discharge.samples.empty()) {
        int covered = 0;
        for (int j = 0; j < x.ny; ++j)
            for (int i = 0; i < x.nx; ++i) covered += covers(i, j) ? 1 : 0;
        rate = covered > 0 ? std::clamp(sample(source.discharge, time()) / (covered * dx * dx), -1e4, 1e4) : 0;
    }
    const Real amount = static_cast<Real>(quanta(total, rate * settings.dt));
    const bool is_water = source.material == SourceMaterial::water;
    if (!has(is_water ? EFFECT_WATER : EFFECT_SAND)) return;
    for (int j = 0; j < x.ny; ++j)
        for (int i = 0; i < x.nx; ++i) {
            if (covers(i, j)) add_depth(is_water ? water : sand, x.cell(i, j), amount, is_water ? water_added : sand_added);
        }

    if (!source.set_velocity || !is_water || !(rate > 0)) return;
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const double along = a * dx;
        const double across = (b + 0.5) * dx;
        const int cell_along = ax.is_y ? point_j : point_i;
        const int cell_across = ax.is_y ? point_i : point_j;
        const bool beside = b == cell_across && (a == cell_along || a == cell_along + 1);
        if (!(is_point ? beside : ax.is_y ? inside(across, along) : inside(along, across))) return;
        const Real u = static_cast<Real>(source.velocity[ax.is_y ? 1 : 0]);
        pure_velocity.along(ax)[ax.face(a, b)] = u;
    });
}

template <class Real> void Solver<Real>::apply_sources() {
    if (!has(EFFECT_SOURCES)) return;
    for (std::size_t s = 0; s < settings.sources.size(); ++s) apply_source(settings.sources[s], source_totals_[s]);
}

template <class Real> void Solver<Real>::apply_rain() {
    if (!has(EFFECT_RAIN)) return;
    const Real gained = static_cast<Real>(quanta(rain_total_, sample(settings.rain, time()) * settings.dt));
    const Real lost = static_cast<Real>(quanta(evaporation_total_, sample(settings.evaporation, time()) * settings.dt));
    for (std::size_t c = 0; c < cells(); ++c) {
        add_depth(water, c, gained, water_added);
        add_depth(water, c, -lost, water_added);
    }
}

/// A face beside a reservoir whose surface stands at `level`, and stood at `level_before` a step ago, over sand as high as
/// inside. Waves run out through it, d/dt (u - sqrt(g/h) eta) being what the level does; where one depth of pure water is under
/// half of the other the reservoir is a neighbour as any cell is. Returns what the outward velocity gains.
template <class Real> Real Solver<Real>::level_face(const Axis& ax, int a, int b, Real level, Real level_before) {
    const bool far_end = a != 0;
    const Real outward = far_end ? Real(1) : Real(-1);
    const int cells = ax.along();
    const std::size_t f = ax.face(a, b);
    const std::size_t N = ax.cell(far_end ? cells - 1 : 0, b);
    const std::size_t M = ax.cell(far_end ? std::max(cells - 2, 0) : std::min(1, cells - 1), b);
    const Real outside = std::max(level - terrain[N], Real(0));
    const auto above_sand = [&](Real depth) { return has(EFFECT_MIXTURE) ? std::max(depth - sand[N], Real(0)) : depth; };
    const Real ghost = above_sand(outside);
    ghost_water.along(ax)[f] = ghost;
    const Real eta_in = terrain[N] + water[N];
    const Real eta_out = terrain[N] + outside;
    Real& velocity = pure_velocity.along(ax)[f];
    const Real next = outward * pure_velocity.along(ax)[ax.face(far_end ? cells - 1 : 1, b)];
    const Real own = step_index > 0 || cells == 1 ? outward * velocity : next;
    const Real g = water_gravity(std::abs(own), std::max(water[N], outside));
    const Real push = P.k * g * (eta_in - eta_out);
    const Real deeper = std::max(pure[N], ghost);
    Real gain = push;
    const Real alike =
        deeper > Real(0) ? std::clamp(std::min(pure[N], ghost) / deeper * Real(4) - Real(2), Real(0), Real(1)) : Real(0);
    if (cells > 1 && alike > Real(0)) {
        const Real h = pure[N];
        const Real c = std::sqrt(g * h);
        const auto upwind = [&](Real speed, Real behind, Real ahead) { return P.k * speed * (speed > Real(0) ? behind : ahead); };
        const int inner = far_end ? cells - 1 : 0;
        const Axis cross = axis(!ax.is_y);
        velocity = outward * own; // for face_depth
        const bool second = has(EFFECT_SECOND_ORDER_WATER);
        const auto enters = [&](Layer layer, const Field<Real>& depth, Real beyond) {
            // Cells at the side's ends count as flat.
            const auto along_side = [&](int face) {
                const Real v = velocity_of(layer).along(cross)[cross.face(face, inner)];
                const int donor = v > Real(0) ? face - 1 : face;
                const bool flat = !second || donor == 0 || donor + 1 == cross.along();
                return P.k * v * (flat ? depth[cross.cell(donor, inner)] : face_depth(layer, cross, face, inner, v));
            };
            const Real low = b > 0 ? along_side(b) : Real(0);
            const Real high = b + 1 < ax.across() ? along_side(b + 1) : Real(0);
            const auto leaves = [&](int face, Real behind, Real ahead) {
                const Real speed = outward * velocity_of(layer).along(ax)[ax.face(face, b)];
                // Of two cells the further one lies beside the other side and counts as flat.
                const bool flat = cells == 2 && face != a && speed > Real(0);
                if (!second || flat) return upwind(speed, behind, ahead);
                return P.k * speed * face_depth(layer, ax, face, b, outward * speed);
            };
            Real out = leaves(a, depth[N], beyond);
            if (second) out = whole_quanta(out, P.quantum, false);
            return (leaves(far_end ? cells - 1 : 1, depth[M], depth[N]) - out) + (low - high);
        };
        Real gained = enters(Layer::pure, pure, ghost);
        if (has(EFFECT_MIXTURE)) gained += enters(Layer::mixed, mixed, Real(0));
        if (has(EFFECT_DIFFUSION)) {
            const Real through = outward * diffusion(ax, far_end ? cells - 1 : 1, b);
            const Real low = b > 0 ? diffusion(cross, b, inner) : Real(0);
            const Real high = b + 1 < ax.across() ? diffusion(cross, b + 1, inner) : Real(0);
            gained += P.k * (through + (low - high));
        }
        const Real risen = ghost - above_sand(std::max(level_before - terrain[N], Real(0)));
        const Real incoming = push / (Real(4) * Real(cells)) + (h > Real(0) ? c / h : Real(0)) * (gained - Real(2) * risen);
        gain += alike * (incoming / (Real(1) + P.k * std::max(second ? c : c + own, Real(0))) - push);
    }
    Real u = own + gain;
    if (std::abs(eta_in - eta_out) <= P.rest_surface && std::abs(u) <= P.rest_velocity) u = Real(0);
    if (blocked(pure[N], ghost, eta_in, eta_out, P.eps)) u = Real(0);
    velocity = clamped(outward * u, P.clamp);
    return gain;
}

/// The water inside the sand of the cell beside such a reservoir (2.4e, c, d) gains as much as the water above it, less the drag
/// of sand at rest, implicit over the step. Where no pure water stands over the sand outside, the part that comes in is brought
/// by the pure layer, which alone has depth there.
template <class Real> void Solver<Real>::seep(const Axis& ax, int a, int b, Real level, Real gain) {
    const bool far_end = a != 0;
    const Real outward = far_end ? Real(1) : Real(-1);
    const std::size_t f = ax.face(a, b);
    const std::size_t N = ax.cell(far_end ? a - 1 : 0, b);
    const Real outside = std::max(level - terrain[N], Real(0));
    const Real rise = (terrain[N] + water[N]) - (terrain[N] + outside);
    Real& um = mixed_velocity.along(ax)[f];
    const Real own = outward * um;
    const Real pushed = own + gain;
    Real free(1);
    if (has(EFFECT_RETENTION)) {
        const auto through = [&](Real depth) {
            if (depth >= sand[N]) return Real(1);
            const Real drains = std::clamp((depth / sand[N] - P.retained) / (Real(1) - P.retained), Real(0), Real(1));
            return drains * drains * drains;
        };
        free = pushed > Real(0)   ? through(water[N])
               : pushed < Real(0) ? through(outside)
                                  : std::max(through(water[N]), through(outside));
    }
    Real u = Real(0);
    if (free > Real(0)) u = pushed / (Real(1) + P.dt * P.exchange / (P.rho_w * free));
    if (std::abs(rise) <= P.rest_surface && std::abs(own) <= P.rest_velocity) u = Real(0);
    if (blocked(mixed[N], std::min(outside, sand[N]), terrain[N] + water[N], terrain[N] + outside, P.eps)) u = Real(0);
    um = clamped(outward * u, P.clamp);
    if (outside - sand[N] > P.eps || sand[N] <= P.eps) return;
    ghost_water.along(ax)[f] = outside;
    Real& uw = pure_velocity.along(ax)[f];
    uw = outward * (std::max(outward * uw, Real(0)) + std::min(outward * um, Real(0)));
}

/// Whether face b of a side lies between its ends.
template <class Real> bool Solver<Real>::in_span(const Side& side, int b) const {
    const double centre = (b + 0.5) * settings.grid.dx;
    return centre >= side.from && centre <= side.to;
}

/// Outflow of sand and of the water inside it: the outer face takes the next face's outward velocity, `fastest` at most; a domain
/// one cell wide has no inner face.
template <class Real> void Solver<Real>::leave(Faces<Real>& velocity, const Axis& ax, bool far_end, int b, Real fastest) const {
    const Real outward = far_end ? Real(1) : Real(-1);
    Field<Real>& u = velocity.along(ax);
    const Real next = ax.along() > 1 ? u[ax.face(far_end ? ax.along() - 1 : 1, b)] : Real(0);
    u[ax.face(far_end ? ax.along() : 0, b)] = outward * std::clamp(outward * next, Real(0), fastest);
}

/// Outflow of pure water: u - 2 sqrt(g h), h the water above the sand, is the same at the outer face, with the depth of the last
/// cell, as at the next face inside.
template <class Real> void Solver<Real>::radiate(const Axis& ax, bool far_end, int b) {
    if (ax.along() < 2) return;
    const std::size_t N = ax.cell(far_end ? ax.along() - 1 : 0, b);
    const std::size_t M = ax.cell(far_end ? ax.along() - 2 : 1, b);
    const Real outward = far_end ? Real(1) : Real(-1);
    Field<Real>& velocity = pure_velocity.along(ax);
    const Real next = outward * velocity[ax.face(far_end ? ax.along() - 1 : 1, b)];
    const Real g = water_gravity(std::abs(next), std::max(water[N], water[M]));
    const Real fall = (terrain[N] + water[N]) - (terrain[M] + water[M]);
    const bool rests = std::abs(fall) <= P.rest_surface && std::abs(next) <= P.rest_velocity;
    const Real rise = rests ? Real(0) : minmod(pure[N] - pure[M], fall);
    const Real c_N = std::sqrt(g * pure[N]);
    const Real c_M = std::sqrt(g * std::max(pure[N] - rise, Real(0)));
    const Real subcritical = c_N > Real(0) ? std::clamp(Real(2) * (Real(1) - std::abs(next) / c_N), Real(0), Real(1)) : Real(1);
    const Real u = next + subcritical * Real(2) * (c_N - c_M);
    const std::size_t f = ax.face(far_end ? ax.along() : 0, b);
    velocity[f] = outward * std::clamp(u, Real(0), P.clamp);
    if (has(EFFECT_SECOND_ORDER_WATER)) ghost_water.along(ax)[f] = std::max(pure[N] + rise, Real(0)); // the slope goes on
}

/// The water's velocities and outer depths of one side's faces. Positive `outward` points out of the domain.
template <class Real> void Solver<Real>::update_side(const Side& side, const Axis& ax, bool far_end) {
    const int a = far_end ? ax.along() : 0;
    const Real outward = far_end ? Real(1) : Real(-1);
    int open_faces = 0;
    for (int b = 0; b < ax.across(); ++b) open_faces += in_span(side, b) ? 1 : 0;
    const double value = sample(side.value, time());
    Real given(0); // by a discharge in this step [m2/s], with half a quantum that the flux loses
    if (side.kind == SideKind::discharge && open_faces > 0) {
        const std::size_t n = static_cast<std::size_t>((ax.is_y ? SideName::south : SideName::west)) + (far_end ? 1 : 0);
        const double k = settings.dt / settings.grid.dx;
        const double depth = quanta(side_totals_[n], value / (open_faces * settings.grid.dx) * k);
        given = static_cast<Real>(depth > 0 ? (depth + static_cast<double>(P.quantum) / 2) / k : 0);
    }

    for (int b = 0; b < ax.across(); ++b) {
        const std::size_t f = ax.face(a, b);
        const std::size_t inner = ax.cell(far_end ? a - 1 : 0, b);
        const bool open = side.kind != SideKind::wall && in_span(side, b);
        if (!open || side.kind != SideKind::level) pure_velocity.along(ax)[f] = Real(0);
        if (!open || side.kind != SideKind::level) mixed_velocity.along(ax)[f] = Real(0);
        ghost_water.along(ax)[f] = Real(0);
        if (!open) continue;
        if (side.kind == SideKind::discharge) {
            const Real q = static_cast<Real>(value) / (Real(open_faces) * P.dx); // as wanted; what moves is of whole quanta
            const Real critical = P.gravity > Real(0) ? std::cbrt(q * q / P.gravity) : Real(0);
            const Real fastest = given * P.k / P.alpha;
            const bool shooting = side.depth > 0 && static_cast<Real>(side.depth) < critical;
            const Real depth = std::max(shooting ? static_cast<Real>(side.depth) : std::max(water[inner], critical), fastest);
            ghost_water.along(ax)[f] = depth;
            if (depth > Real(0)) pure_velocity.along(ax)[f] = -outward * given / depth;
        } else if (side.kind == SideKind::level) {
            const Real gain =
                level_face(ax, a, b, static_cast<Real>(value), static_cast<Real>(sample(side.value, time() - settings.dt)));
            if (has(EFFECT_MIXTURE)) seep(ax, a, b, static_cast<Real>(value), gain);
        } else {
            radiate(ax, far_end, b);
            if (has(EFFECT_MIXTURE)) leave(mixed_velocity, ax, far_end, b, P.clamp);
        }
    }
}

template <class Real> template <class F> void Solver<Real>::for_sides(F f) {
    for (const SideName name : {SideName::west, SideName::east, SideName::south, SideName::north}) {
        const bool is_y = name == SideName::south || name == SideName::north;
        const bool far_end = name == SideName::east || name == SideName::north;
        f(settings.sides[static_cast<std::size_t>(name)], axis(is_y), far_end);
    }
}

template <class Real> void Solver<Real>::update_open_sides() {
    if (!has(EFFECT_OPEN_SIDES) || !has(EFFECT_WATER)) return;
    split_water();
    for_sides([&](const Side& side, const Axis& ax, bool far_end) { update_side(side, ax, far_end); });
}

template <class Real> void Solver<Real>::update_open_sand_sides() {
    if (!has(EFFECT_OPEN_SIDES) || !has(EFFECT_SAND)) return;
    for_sides([&](const Side& side, const Axis& ax, bool far_end) {
        for (int b = 0; b < ax.across(); ++b)
            if (side.kind == SideKind::outflow && in_span(side, b)) leave(sand_velocity, ax, far_end, b, P.clamp_sand);
    });
}

} // namespace wadi::reference
