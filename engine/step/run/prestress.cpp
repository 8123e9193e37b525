#include "engine/step/run/prestress.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace wadi {

namespace {

// A column of sand as its neighbours bound its tension, in double: what it holds is compared with what bears it, bit by bit alike
// on every device since their fields are.
struct Column {
    double surface = 0; // H + hs [m]
    double sand = 0;    // hs [m]
    double weight = 0;  // what pushes, as a share of the sand's own
    double clings = 0;  // cohesion on the ground [Pa]
    double balance = 0; // what pushes, times half the depth [Pa m]
    double pull = 0;    // depth times tension [Pa m]
    double allowed = 0; // of it
};

// What the sand and water of a cell push with and are held by, as 2.7, 2.8 and 2.19 have it.
Column column_of(const WorldParams& p, double ground, double sand, double water, double stretch) {
    Column column;
    column.surface = ground + sand;
    column.sand = sand;
    const double tr = 2 * std::log1p(stretch);
    column.pull = sand * static_cast<double>(p.lambda + p.shear) * tr * std::exp(-tr);
    if (sand <= static_cast<double>(p.dry_threshold)) return column;
    const double retained = static_cast<double>(p.retained), drainable = static_cast<double>(p.inv_drainable);
    const double porosity = static_cast<double>(p.porosity), buoyancy = static_cast<double>(p.buoyancy);
    const double room = porosity * sand, stands = water < room ? water / porosity : water + (sand - room); // 2.23
    const double full = retained > 0 ? std::clamp((stands - retained * sand) * drainable, 0.0, sand) : std::min(stands, sand);
    const double held = std::min(water, room) - porosity * full;
    column.weight = std::max(0.0, 1 - static_cast<double>(p.density_ratio) * (buoyancy * full - held) / sand);
    column.balance = 0.5 * static_cast<double>(p.sand_density) * static_cast<double>(p.gravity) * column.weight * sand * sand;
    const auto phi = static_cast<float>(stands / (stands + sand));
    float c = phi < p.phi1   ? p.cohesion0 + phi * p.slope01
              : phi < p.phi2 ? p.cohesion1 + (phi - p.phi1) * p.slope12
                             : (p.phi3 - phi) * p.slope23;
    if (phi > p.phi3) c = 0;
    column.clings = static_cast<double>(p.adhesion_slip * (c * p.cliff_share) * p.sand_density / p.dts);
    return column;
}

// Whole multiples of what it returns have exact sums here, and so the balance of cells once round any of them is exactly 0.
// Rounded otherwise, it can be less: each bound would then lower the next one for ever.
double make_exact(std::vector<Column>& columns) {
    double largest = 0;
    for (const Column& column : columns) largest = std::max({largest, column.balance, column.pull});
    const double grain = largest > 0 ? std::ldexp(1.0, std::ilogb(largest) - 50) : 1;
    for (Column& column : columns) {
        column.balance = std::nearbyint(column.balance / grain) * grain;
        column.pull = column.allowed = std::nearbyint(column.pull / grain) * grain;
    }
    return grain;
}

// The most that sand beside `other` may pull with: what that does, and what push and friction of the face bear, or what balance
// itself wants of two columns on level ground.
double allowed_beside(const WorldParams& p, const Column& own, const Column& other, double grain) {
    const double weight = static_cast<double>(p.sand_density) * static_cast<double>(p.gravity);
    const double dx = static_cast<double>(p.dx), friction = static_cast<double>(p.friction);
    const double mean_weight = 0.5 * (own.weight + other.weight), mean_depth = 0.5 * (own.sand + other.sand);
    const double borne = weight * mean_weight * mean_depth * (own.surface - other.surface + 0.8 * friction * dx) +
                         0.4 * dx * (own.clings + other.clings);
    const double rises = std::max(std::nearbyint(std::min(borne, own.pull) / grain) * grain, own.balance - other.balance);
    return std::max(0.0, other.allowed + rises);
}

// NUMERICS 2.20: where cohesion ends, tension does within a few cells, each bounded by its neighbours. A free face bounds
// nothing.
Status bound_balance(WorldState& state) {
    const auto& layout = state.layout();
    const auto& p = state.params();
    std::array<std::vector<float>, 5> fields;
    constexpr std::array names = {"terrain", "sand_height", "water_height", "stretch_xx", "stretch_yy"};
    for (std::size_t n = 0; n < names.size(); ++n) {
        fields[n].resize(layout.size());
        if (auto status = state.fields().read(names[n], 0, fields[n]); !status) return status;
    }
    auto& [ground, sand, water, xx, yy] = fields;
    const auto nx = static_cast<std::size_t>(layout.nx), ny = static_cast<std::size_t>(layout.ny);
    std::vector<Column> columns(nx * ny);
    const auto place = [&](std::size_t i, std::size_t j) { return layout.index(static_cast<int>(i), static_cast<int>(j)); };
    for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
            const std::size_t at = place(i, j);
            const auto value = [&](const std::vector<float>& field) { return static_cast<double>(field[at]); };
            columns[j * nx + i] = column_of(p, value(ground), value(sand), value(water), value(xx));
        }
    }
    const double grain = make_exact(columns);
    bool changed = false;
    const auto bound = [&](std::size_t c, std::size_t other) {
        if (columns[other].sand <= static_cast<double>(p.dry_threshold)) return;
        const double most = allowed_beside(p, columns[c], columns[other], grain);
        if (most >= columns[c].allowed) return;
        columns[c].allowed = most;
        changed = true;
    };
    // To and fro until nothing changes, as a distance is found: the order does not show.
    bool forth = true;
    do {
        changed = false;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const std::size_t c = forth ? k : columns.size() - 1 - k;
            if (columns[c].allowed <= 0) continue;
            if (c % nx > 0) bound(c, c - 1);
            if (c % nx + 1 < nx) bound(c, c + 1);
            if (c >= nx) bound(c, c - nx);
            if (c + nx < columns.size()) bound(c, c + nx);
        }
        forth = !forth;
    } while (changed);
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (columns[c].allowed >= columns[c].pull) continue;
        const std::size_t at = place(c % nx, c / nx);
        const auto left = static_cast<float>(columns[c].allowed / columns[c].pull);
        for (auto* stretch : {&xx, &yy}) (*stretch)[at] = std::abs((*stretch)[at] * left) < 1e-20F ? 0.0F : (*stretch)[at] * left;
    }
    if (auto status = state.fields().write("stretch_xx", 0, xx); !status) return status;
    return state.fields().write("stretch_yy", 0, yy);
}

} // namespace

Status change_balance(WorldState& state, const Region& region, Balance change) {
    if (!state.settings().method.prestress || (state.plan().effects & EFFECT_ELASTOPLASTIC) == 0) return ok_status();
    StepInput input{};
    input.edit_count = 1;
    cover(region, input.edit[0]);
    input.edit[0].kind = EDIT_BALANCE;
    input.edit[0].amount = static_cast<float>(change);
    auto& device = state.device();
    auto no_stamps = device.create_buffer({STAMP_PAGE * 4, "no stamps"});
    if (!no_stamps) return no_stamps.status();
    const auto run = [&] {
        compute::ProgramBuilder builder("balance");
        if (auto status = state.append_stage(builder, "apply_edits", state.fields().parity(), {{"stamp_images", *no_stamps}});
            !status)
            return status;
        auto program = device.compile(builder, state.params());
        if (!program) return program.status();
        auto ticket = device.submit(*program, input);
        const auto status = ticket ? device.wait(*ticket) : ticket.status();
        device.destroy_program(*program);
        return status;
    };
    const auto status = run();
    device.destroy_buffer(*no_stamps);
    return status;
}

Status put_in_balance(WorldState& state) {
    if (auto status = change_balance(state, {0, 0, state.layout().nx, state.layout().ny}, Balance::add); !status) return status;
    constexpr std::uint32_t bounded = EFFECT_COHESION | EFFECT_SLOPE_NORMAL;
    if (!state.settings().method.prestress || (state.plan().effects & bounded) != bounded) return ok_status();
    return bound_balance(state);
}

Status balance_anew(WorldState& state) {
    if (!state.settings().method.prestress) return ok_status();
    const std::vector<float> none(state.layout().size());
    for (const char* name : {"stretch_xx", "stretch_xy", "stretch_yy", "rotation"}) {
        if (auto status = state.fields().write(name, 0, none); !status) return status;
    }
    return put_in_balance(state);
}

} // namespace wadi
