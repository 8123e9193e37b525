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
    const bool holds = !source.level.samples.empty(), bounded = !source.rate.samples.empty() || !source.discharge.samples.empty();
    double height = sample(source.level, time());
    if (P.quantum > 0) height = std::floor(height / static_cast<double>(P.quantum)) * static_cast<double>(P.quantum);
    const auto missing = [&](std::size_t cell) {
        const Real most = bounded ? amount : static_cast<Real>(2 * P.largest_height);
        return std::clamp(whole_quanta(water_at_level(cell, static_cast<Real>(height)), P.quantum, Real(0)) - water[cell],
                          source.drain ? -most : Real(0), most);
    };
    for (int j = 0; j < x.ny; ++j)
        for (int i = 0; i < x.nx; ++i) {
            const std::size_t cell = x.cell(i, j);
            if (!covers(i, j)) continue;
            const Real before = water[cell];
            add_depth(is_water ? water : sand, cell, holds ? missing(cell) : amount, is_water ? water_added : sand_added);
            const Real poured = std::max(water[cell] - before, Real(0));
            from_sources[0][cell] += poured;
            for (std::size_t n = 0; n < 2; ++n)
                if (source.set_velocity && rate > 0) from_sources[1 + n][cell] += poured * static_cast<Real>(source.velocity[n]);
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
    for (Field<Real>& field : from_sources) field.assign(cells(), Real(0));
    for (std::size_t s = 0; s < settings.sources.size(); ++s) apply_source(settings.sources[s], source_totals_[s]);
}

/// Ahead of apply_sources(): what a copy of this world's sources bring mixes with the pure water that is there.
template <class Real> void Solver<Real>::mix_source_momentum() {
    if (!has(EFFECT_SOURCES) || !has(EFFECT_WATER) || has(EFFECT_PUBLISHED)) return;
    split_water();
    Solver poured = *this;
    poured.apply_sources();
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b), R = ax.cell(a, b);
        const auto& [depth, along_x, along_y] = poured.from_sources;
        const Real added = mean(depth[L], depth[R]), there = mean(pure[L], pure[R]);
        const Real momentum = ax.is_y ? mean(along_y[L], along_y[R]) : mean(along_x[L], along_x[R]);
        Real& u = pure_velocity.along(ax)[ax.face(a, b)];
        if (added > Real(0)) u = (there * u + momentum) / (there + added);
    });
}

template <class Real> void Solver<Real>::apply_rain() {
    if (!has(EFFECT_RAIN)) return;
    const double Q = static_cast<double>(P.quantum);
    const double before = Q > 0 ? std::floor(rain_total_ / Q) : 0;
    const Real gained = static_cast<Real>(quanta(rain_total_, sample(settings.rain, time()) * rain_peak * settings.dt));
    const Real lost = static_cast<Real>(quanta(evaporation_total_, sample(settings.evaporation, time()) * settings.dt));
    rained = gained;
    for (std::size_t c = 0; c < cells(); ++c) {
        const double share = has(EFFECT_RAIN_MAP) ? static_cast<double>(rain_share[c]) / 65536 : 1;
        const double after = Q > 0 ? before + static_cast<double>(gained) / Q : 0;
        const Real fallen = Q > 0 ? static_cast<Real>((std::floor(share * after) - std::floor(share * before)) * Q)
                                  : static_cast<Real>(share * static_cast<double>(gained));
        add_depth(water, c, fallen, water_added);
        add_depth(water, c, -lost, water_added);
    }
}

template <class Real> void Solver<Real>::dilute_water_velocity() {
    if (!has(EFFECT_RAIN_MAP) || has(EFFECT_PUBLISHED)) return;
    split_water();
    for_inner_faces([&](const Axis& ax, int a, int b) {
        const std::size_t L = ax.cell(a - 1, b), R = ax.cell(a, b);
        const Real depth = mean(pure[L], pure[R]), rain = rained * mean(rain_share[L], rain_share[R]) / Real(65536);
        if (depth > Real(0)) pure_velocity.along(ax)[ax.face(a, b)] *= Real(1) - std::min(rain / depth, Real(1));
    });
}

/// Depth of a face outside which the free surface stands at `level`, over sand as high as in cell N.
template <class Real> Real Solver<Real>::clear_depth(std::size_t N, Real level) const {
    const Real outside = std::max(level - terrain[N], Real(0));
    return has(EFFECT_MIXTURE) ? std::max(outside - sand[N], Real(0)) : outside;
}

/// What the velocity out of the domain becomes beside such a surface: 2.4e, c and d.
template <class Real> Real Solver<Real>::beside_level(std::size_t N, Real level, Real u) const {
    const Real eta_in = (terrain[N] + seen_depth(N));
    const Real eta_out = std::max(level, terrain[N]);
    if (std::abs(eta_in - eta_out) <= P.rest_surface * lifts(N, N) && std::abs(u) <= P.rest_velocity * lifts(N, N))
        return Real(0);
    if (blocked(pure[N], clear_depth(N, level), eta_in, eta_out, P.eps)) return Real(0);
    return clamped(u, P.clamp);
}

/// A face beside water held at `level`: its own equation of motion, that of 2.3 and 2.4 with the level as the surface outside.
/// Returns what the push adds to the outward velocity.
template <class Real> Real Solver<Real>::level_face(const Axis& ax, int a, int b, Real level) {
    const bool far_end = a != 0;
    const Real outward = far_end ? Real(1) : Real(-1);
    const int cells = ax.along();
    const std::size_t f = ax.face(a, b);
    const std::size_t N = ax.cell(far_end ? cells - 1 : 0, b);
    const std::size_t M = ax.cell(far_end ? std::max(cells - 2, 0) : std::min(1, cells - 1), b);
    Field<Real>& u = pure_velocity.along(ax);
    const Real next = outward * u[cells == 1 ? f : ax.face(far_end ? cells - 1 : 1, b)];
    const Real own = step_index > 0 ? outward * u[f] : next;
    const Real outside = std::max(level - terrain[N], Real(0));
    const Real ghost = clear_depth(N, level);
    ghost_water.along(ax)[f] = ghost;
    const Real push = P.k * water_gravity(std::abs(own), std::max(seen_depth(N), outside)) * (seen_depth(N) - outside);
    const Real depth = mean(pure[N], ghost);
    Real moved = own + push;
    if (depth > Real(0)) {
        const Real leaves = mean(std::max(next, Real(0)) * pure[M], std::max(own, Real(0)) * pure[N]);
        moved += std::min(P.k * leaves / depth, Real(1)) * (next - own);
        moved = rubbed(moved, Real(0), std::abs(own), P.dt * bed_drag(N, N, depth) / depth);
    }
    u[f] = outward * beside_level(N, level, moved);
    return push;
}

/// A face through which a wave comes in that raises the surface outside from `still` to `level`, and everything from inside
/// leaves: u - 2c, what comes in by the incident wave, about a stream that is learnt over the time `absorbs` (0: four times the
/// grid's length over a wave's speed).
template <class Real> Real Solver<Real>::waves_face(const Axis& ax, int a, int b, Real still, Real level, Real absorbs) {
    const bool far_end = a != 0;
    const Real outward = far_end ? Real(1) : Real(-1);
    const int cells = ax.along();
    const std::size_t f = ax.face(a, b);
    const std::size_t N = ax.cell(far_end ? cells - 1 : 0, b);
    const std::size_t M = ax.cell(far_end ? std::max(cells - 2, 0) : std::min(1, cells - 1), b);
    Field<Real>& u = pure_velocity.along(ax);
    const Real next = outward * u[cells == 1 ? f : ax.face(far_end ? cells - 1 : 1, b)];
    const Real outside = std::max(level - terrain[N], Real(0));
    const Real ghost = clear_depth(N, level);
    ghost_water.along(ax)[f] = ghost;
    const Real g = water_gravity(std::abs(next), std::max(seen_depth(N), outside));
    const auto wave = [&](Real depth) { return std::sqrt(g * std::max(depth, Real(0))); };
    const Real rise = minmod(pure[N] - pure[M], (terrain[N] + seen_depth(N)) - (terrain[M] + seen_depth(M)));
    const Real arriving = std::min(P.k * (wave(pure[N]) + std::max(next, Real(0))), Real(1));
    const Real c_in = wave(pure[N] + (Real(1) - arriving) * rise / Real(2));
    const Real c_still = wave(clear_depth(N, still));
    const Real c_wave = wave(ghost);
    Real& stream = side_memory.along(ax)[f].stream;
    if (step_index == 0) stream = next;
    const bool shoots = c_in > Real(0) && next > c_in;
    const Real swing = Real(2) * c_in + Real(2) * c_still - Real(4) * c_wave;
    const Real moved = shoots ? next : stream + swing;
    const bool rests =
        std::abs(seen_depth(N) - outside) <= P.rest_surface * lifts(N, N) && std::abs(stream) <= P.rest_velocity * lifts(N, N);
    u[f] = rests ? Real(0) : outward * beside_level(N, level, moved);
    const Real share = absorbs > Real(0) ? std::min(P.dt / absorbs, Real(0.5)) : P.k * c_still / (Real(4) * Real(cells));
    if (!rests) stream = clamped(shoots ? next - swing : stream + share * Real(2) * (c_in - c_wave), P.clamp);
    return P.k * g * (seen_depth(N) - outside);
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
    const Real rise = (terrain[N] + seen_depth(N)) - (terrain[N] + outside);
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
        free = pushed > Real(0)   ? through(seen_depth(N))
               : pushed < Real(0) ? through(outside)
                                  : std::max(through(seen_depth(N)), through(outside));
    }
    Real u = Real(0);
    if (free > Real(0)) u = pushed / (Real(1) + P.dt * P.exchange / (P.rho_w * free));
    if (std::abs(rise) <= P.rest_surface * lifts(N, N) && std::abs(own) <= P.rest_velocity * lifts(N, N)) u = Real(0);
    if (blocked(mixed[N], P.porosity * std::min(outside, sand[N]), (terrain[N] + seen_depth(N)), terrain[N] + outside, P.eps))
        u = Real(0);
    um = clamped(outward * u, P.clamp);
    if (outside - sand[N] > P.eps || sand[N] <= P.eps) return;
    ghost_water.along(ax)[f] = water_at_level(N, level);
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

/// A straight line fitted to the bed inside a face as far as water stands on it: its rise per cell inward, and how far it lies
/// above the bed of the last cell.
template <class Real> std::pair<Real, Real> Solver<Real>::bed_line(const Axis& ax, bool far_end, int b) const {
    const auto cell = [&](int n) { return ax.cell(far_end ? ax.along() - 1 - n : n, b); };
    int count = 1;
    while (count < std::min(ax.along(), 64) && pure[cell(count)] > P.eps) ++count;
    const auto bed = [&](int n) {
        const std::size_t c = cell(n);
        return terrain[c] + (has(EFFECT_MIXTURE) ? sand[c] : Real(0));
    };
    const Real middle = Real(count - 1) / Real(2);
    Real sum(0), moment(0), weight(0);
    for (int n = 0; n < count; ++n) {
        sum += bed(n) - bed(0);
        moment += (Real(n) - middle) * (bed(n) - bed(0));
        weight += (Real(n) - middle) * (Real(n) - middle);
    }
    const Real rise = weight > Real(0) ? moment / weight : Real(0);
    return {rise, sum / Real(count) - rise * middle};
}

/// Outflow of pure water (2.9): a steady stream goes on, what stands above it is a wave and leaves, and in the long run the depth
/// is that of uniform flow on the slope `given`, or on that of the bed inside.
template <class Real> void Solver<Real>::run_off(const Axis& ax, bool far_end, int b, Real given) {
    const int cells = ax.along();
    const std::size_t f = ax.face(far_end ? cells : 0, b);
    auto& memory = side_memory.along(ax)[f];
    const auto line = bed_line(ax, far_end, b);
    if (step_index == 0) memory.rise = line.first, memory.above = line.second;
    const auto known = memory;
    if (step_index % 16 == 0) memory.rise = line.first, memory.above = line.second;
    const auto cell = [&](int n) {
        const int inward = std::min(n, cells - 1);
        return ax.cell(far_end ? cells - 1 - inward : inward, b);
    };
    const Real outward = far_end ? Real(1) : Real(-1);
    Field<Real>& velocity = pure_velocity.along(ax);
    const auto speed =
        [&](int n) { // of the nth inner face, of the last one where there are no more, in a grid of one cell its own
            const int face = cells > 1 ? std::min(n, cells - 1) : 0;
            return outward * velocity[ax.face(far_end ? cells - face : face, b)];
        };
    const std::size_t N = cell(0), M = cell(1), F = cell(2);
    const Real next = speed(1), runs = std::max(next, Real(0));
    const Real g = water_gravity(std::abs(next), std::max(seen_depth(N), seen_depth(M)));
    const auto bed = [&](std::size_t c) { return terrain[c] + (has(EFFECT_MIXTURE) ? sand[c] : Real(0)); };
    const auto ratio = [](Real a, Real over) { return over > Real(0) ? a / over : Real(0); };
    const Real h = pure[N], before = pure[M];
    const Real c = std::sqrt(g * h);
    const Real subcritical = std::clamp(Real(2) - Real(2) * ratio(std::abs(next), c), Real(0), Real(1));
    // 1: what a steady stream's surface falls by, and the velocity of the same discharge there.
    const Real drag = before > Real(0) ? bed_drag(M, M, before) : Real(0);
    const Real rubs = ratio(P.dx * drag * runs * runs, g * std::max(before, P.eps));
    const Real carried = ratio(std::max(speed(2), Real(0)) * pure[F] + runs * before, before + h);
    const Real most = before > Real(0) ? before / Real(4) + std::max(bed(M) - bed(N), Real(0)) : Real(0);
    const Real falls = std::clamp(rubs + ratio(carried * (next - speed(2)), g), -before / Real(4), most);
    const Real steady = bed(M) + before - falls - bed(N);
    const Real narrowed = std::clamp(ratio(before, std::max(steady, P.eps)), Real(0.25), Real(4));
    // 2: the wave.
    const Real fall = (terrain[N] + seen_depth(N)) - (terrain[M] + seen_depth(M));
    const bool rests = std::abs(fall) <= P.rest_surface * lifts(N, M) && std::abs(next) <= P.rest_velocity * lifts(N, M);
    const Real head = Real(1) + std::min(ratio(runs, c), Real(1));
    const Real rise = rests ? Real(0) : (fall + falls) / head;
    const Real behind = cells > 2 ? ((terrain[M] + seen_depth(M)) - (bed(F) + pure[F]) + falls) / head : rise;
    Real wave = (Real(1) - std::min(P.k * (c + runs), Real(1))) * (rise - behind) / Real(2);
    wave = rise + std::clamp(wave, -std::abs(rise) / Real(2), std::abs(rise) / Real(2));
    wave = std::clamp(wave, -h / Real(2), h / Real(2));
    const Real free = Real(2) * (c - std::sqrt(g * std::max(h - wave, Real(0))));
    // 3: the depth of uniform flow, at most critical.
    const Real slope = given > Real(0) ? given : std::max(known.rise / P.dx, Real(1e-3));
    const Real deep = std::max(h - known.above, Real(0));
    Real due = std::sqrt(P.gravity * h) * h;
    const Real stress = bed_drag(N, N, std::max(deep, Real(1e-30)));
    if (stress > Real(0)) due = std::min(due, deep * std::sqrt(P.gravity * slope * deep / stress));
    const Real comes = runs * before;
    const Real wanted = std::clamp(due - comes, -comes / Real(2), Real(2) * comes);
    const Real flows =
        std::clamp(Real(4) * known.mean - Real(1), given > Real(0) && comes > Real(0) ? Real(1) : Real(0), Real(1));
    const Real n = Real(cells);
    const Real extra = flows * ratio(wanted, h) / n;
    const Real arrives = next * (Real(1) + subcritical * (narrowed - Real(1))) * (Real(1) + subcritical * known.error);
    if (cells > 1) {
        const Real u = std::min(arrives + subcritical * (free + extra), std::max(next, c));
        velocity[f] = outward * std::clamp(u, Real(0), P.clamp);
        if (has(EFFECT_SECOND_ORDER_WATER)) // the slope goes on
            ghost_water.along(ax)[f] = std::max(h + minmod(h - before, rise), Real(0));
    }
    // 4 and 5: what 1 is wrong by, and whether this is a stream.
    const Real pace = P.k * c / n;
    const Real miss = std::clamp(ratio(wanted, comes), Real(-0.2), Real(0.2));
    memory.error += flows > Real(0) ? flows * subcritical * Real(2) / n * pace * miss : -std::min(pace, Real(1)) * known.error;
    memory.error = std::clamp(memory.error, Real(-0.1), Real(0.1));
    memory.mean += std::min(pace / Real(8), Real(1)) * (std::clamp(Real(50) * ratio(next, c), Real(-1), Real(1)) - known.mean);
}

/// Water falls off the edge: as fast as it comes, critical at least.
template <class Real> void Solver<Real>::fall(const Axis& ax, bool far_end, int b) {
    const std::size_t N = ax.cell(far_end ? ax.along() - 1 : 0, b);
    const Real outward = far_end ? Real(1) : Real(-1);
    Field<Real>& u = pure_velocity.along(ax);
    const Real next = ax.along() > 1 ? outward * u[ax.face(far_end ? ax.along() - 1 : 1, b)] : Real(0);
    const Real critical = std::sqrt(water_gravity(std::abs(next), seen_depth(N)) * pure[N]);
    const std::size_t f = ax.face(far_end ? ax.along() : 0, b);
    u[f] = outward * std::clamp(std::max(next, critical), Real(0), P.clamp);
    if (has(EFFECT_SECOND_ORDER_WATER)) ghost_water.along(ax)[f] = pure[N];
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
        if (!open || !side.has_level()) pure_velocity.along(ax)[f] = Real(0);
        if (!open || !side.has_level()) mixed_velocity.along(ax)[f] = Real(0);
        ghost_water.along(ax)[f] = Real(0);
        if (!open) continue;
        if (side.kind == SideKind::discharge) {
            const Real q = static_cast<Real>(value) / (Real(open_faces) * P.dx); // as wanted; what moves is of whole quanta
            const Real critical = P.gravity > Real(0) ? std::cbrt(q * q / P.gravity) : Real(0);
            const Real fastest = given * P.k / P.alpha;
            const bool shooting = side.depth > 0 && static_cast<Real>(side.depth) < critical;
            const Real depth =
                std::max(shooting ? static_cast<Real>(side.depth) : std::max(seen_depth(inner), critical), fastest);
            ghost_water.along(ax)[f] = depth;
            if (depth > Real(0)) pure_velocity.along(ax)[f] = -outward * given / depth;
        } else if (side.has_level()) {
            const Real still = static_cast<Real>(value);
            const bool held = side.kind == SideKind::level && !(side.absorb > 0);
            const Real level = still + static_cast<Real>(sample(side.wave, time()));
            const Real gain =
                held ? level_face(ax, a, b, still) : waves_face(ax, a, b, still, level, static_cast<Real>(side.absorb));
            if (has(EFFECT_MIXTURE)) seep(ax, a, b, level, gain);
        } else if (side.kind == SideKind::brink) {
            fall(ax, far_end, b);
            if (has(EFFECT_MIXTURE)) leave(mixed_velocity, ax, far_end, b, P.clamp);
        } else {
            run_off(ax, far_end, b, static_cast<Real>(side.slope));
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

/// 2.11 at an open side: the law at the face's own velocity, no slope, as much of it as the side lets pass.
template <class Real> void Solver<Real>::open_bed_load(const Side& side, const Axis& ax, bool far_end, int b) {
    const std::size_t f = ax.face(far_end ? ax.along() : 0, b);
    const std::size_t N = ax.cell(far_end ? ax.along() - 1 : 0, b);
    const Real u = pure_velocity.along(ax)[f];
    const bool enters = side.kind == SideKind::discharge;
    const double share = side.sediment >= 0 ? side.sediment : enters ? 0 : 1;
    const bool carries = pure[N] > P.eps && (enters || (far_end ? u > Real(0) : u < Real(0)));
    bed_load.along(ax)[f] =
        carries ? static_cast<Real>(std::copysign(share, static_cast<double>(u))) * capacity(std::abs(u)) : Real(0);
}

template <class Real> void Solver<Real>::update_open_sand_sides() {
    if (!has(EFFECT_OPEN_SIDES) || !has(EFFECT_SAND)) return;
    for_sides([&](const Side& side, const Axis& ax, bool far_end) {
        for (int b = 0; b < ax.across(); ++b) {
            if (side.kind == SideKind::wall || !in_span(side, b)) continue;
            if (has(EFFECT_BED_SHEAR)) open_bed_load(side, ax, far_end, b);
            if (side.kind == SideKind::outflow || side.kind == SideKind::brink)
                leave(sand_velocity, ax, far_end, b, P.clamp_sand);
        }
    });
}

} // namespace wadi::reference
