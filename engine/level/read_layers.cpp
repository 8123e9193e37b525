#include "engine/image/map.hpp"
#include "engine/level/layers.hpp"
#include "engine/settings/data/setting_table.hpp"
#include <cstddef>

namespace wadi {
namespace {

constexpr double SIDE_SLOPE_LEAST = 1e-3, SIDE_SLOPE_MOST = 1e3;
constexpr std::size_t POINTS_MOST = 256;
constexpr int OCTAVES_MOST = 12;
const std::vector<std::string> SHAPE_NAMES = {"plane", "box", "cylinder", "cone", "ridge", "noise"};
const std::vector<std::string> REGION_NAMES = {"plane", "box", "cylinder"}; // as SHAPE_NAMES begin

/// Whether the layer lies on others.
bool of_column(LayerTarget target) { return target == LayerTarget::sand || target == LayerTarget::water; }

/// What the layers' numbers are where they are no heights; else nothing.
const MapMeaning* number_of(LayerTarget target) {
    static const MapMeaning roughness{"manning", 0, MANNING_MOST}, rain{"times", 0, RAIN_TIMES_MOST};
    return target == LayerTarget::roughness ? &roughness : target == LayerTarget::rain ? &rain : nullptr;
}

/// Reads exactly one of height, surface and wet, as far as the target and the shape have them.
void read_amount(ObjectReader& reader, LayerTarget target, Layer& layer) {
    if (const MapMeaning* number = number_of(target)) {
        reader.required_number(number->name, layer.top, number->least, number->most);
        return;
    }
    const bool cone = layer.shape.kind == ShapeKind::cone;
    int given = 0;
    const auto read = [&](const char* key, Amount amount, double least, double most) {
        const Json* value = reader.find(key);
        if (value == nullptr) return;
        ++given;
        layer.amount = amount;
        layer.top = read_number(*value, reader.path_of(key), least, most, reader.status());
    };
    std::string names = "\"height\"";
    read("height", Amount::height, -HEIGHT_MOST, HEIGHT_MOST);
    if (target != LayerTarget::terrain) {
        names += " or \"surface\"";
        read("surface", Amount::surface, -HEIGHT_MOST, HEIGHT_MOST);
    }
    if (target == LayerTarget::water && !cone) {
        names += " or \"wet\"";
        read("wet", Amount::wet, 0, 1);
    }
    if (given > 1) reader.fail("", "give only one of " + names);
    if (given == 0) reader.require(target == LayerTarget::water ? "surface" : "height");
}

void require_pair(ObjectReader& reader, const char* key, Point& out) {
    if (reader.require(key) != nullptr) reader.pair(key, out, -POSITION_MOST, POSITION_MOST);
}

/// The outline of a box, cylinder or ridge.
void read_outline(ObjectReader& reader, Shape& shape) {
    if (shape.kind == ShapeKind::box) {
        require_pair(reader, "from", shape.from);
        require_pair(reader, "to", shape.to);
        for (std::size_t axis = 0; axis < 2; ++axis)
            if (reader.find("from") != nullptr && reader.find("to") != nullptr && !(shape.to[axis] > shape.from[axis]))
                reader.fail("to[" + std::to_string(axis) + "]", "must be greater than from[" + std::to_string(axis) + "]");
    }
    if (shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone) require_pair(reader, "center", shape.center);
    if (shape.kind == ShapeKind::cylinder) reader.required_number("radius", shape.radius, 1e-6, POSITION_MOST);
    if (shape.kind != ShapeKind::ridge) return;
    reader.required_number("width", shape.width, 1e-6, POSITION_MOST);
    const Json* points = reader.require("points");
    if (points == nullptr) return;
    const std::string path = reader.path_of("points");
    const auto elements = read_array(*points, path, POINTS_MOST, reader.status());
    for (std::size_t n = 0; n < elements.size(); ++n)
        shape.points.push_back(
            read_pair(*elements[n], path + "[" + std::to_string(n) + "]", -POSITION_MOST, POSITION_MOST, reader.status()));
    if (elements.size() < 2) reader.fail("points", "a ridge needs at least two points");
}

/// Sides of a solid. A cone is all side: its slope is given, or follows from height and foot radius.
void read_sides(ObjectReader& reader, Layer& layer) {
    Shape& shape = layer.shape;
    const bool cone = shape.kind == ShapeKind::cone;
    const bool radius_allowed = cone && layer.amount == Amount::height;
    const bool radius_given = radius_allowed && reader.find("radius") != nullptr;
    if (radius_given) {
        double radius = 1;
        reader.number("radius", radius, 1e-6, POSITION_MOST);
        shape.side_slope = layer.top / radius;
        if (reader.find("side_slope") != nullptr) reader.fail("", "give only one of \"radius\" or \"side_slope\"");
    } else {
        if (cone && reader.find("side_slope") == nullptr) reader.require(radius_allowed ? "radius" : "side_slope");
        reader.number("side_slope", shape.side_slope, SIDE_SLOPE_LEAST, SIDE_SLOPE_MOST);
    }
    if (has_sloping_sides(shape) && layer.amount == Amount::height && !(layer.top > 0))
        reader.fail("height", "must be above 0 where the sides slope; to dig, combine with \"subtract\"");
}

void read_noise(ObjectReader& reader, Shape& shape) {
    reader.required_number("amplitude", shape.amplitude, 0, HEIGHT_MOST);
    reader.required_number("wavelength", shape.wavelength, 1e-3, POSITION_MOST);
    reader.whole_number("octaves", shape.octaves, 1, OCTAVES_MOST);
    int seed = 0;
    reader.whole_number("seed", seed, 0, 2147483647);
    shape.seed = static_cast<std::uint32_t>(seed);
}

void read_shape(ObjectReader& reader, LayerTarget target, Layer& layer) {
    int kind = 0;
    reader.choice("shape", number_of(target) != nullptr ? REGION_NAMES : SHAPE_NAMES, kind);
    layer.shape.kind = static_cast<ShapeKind>(kind);
    if (reader.failed()) return;
    if (layer.shape.kind == ShapeKind::noise) return read_noise(reader, layer.shape);
    read_amount(reader, target, layer);
    read_outline(reader, layer.shape);
    if (layer.amount == Amount::wet || number_of(target) != nullptr) return;
    if (layer.shape.kind == ShapeKind::plane) {
        reader.number("slope_x", layer.shape.slope[0], -SIDE_SLOPE_MOST, SIDE_SLOPE_MOST);
        reader.number("slope_y", layer.shape.slope[1], -SIDE_SLOPE_MOST, SIDE_SLOPE_MOST);
    } else {
        read_sides(reader, layer);
    }
}

MapSource read_map_source(ObjectReader& reader, const MapMeaning& meaning) {
    MapSource map;
    map.meaning = meaning;
    reader.string("file", map.file);
    if (map.file.empty()) reader.fail("file", "must name a map");
    const bool range = reader.find("min") != nullptr || reader.find("max") != nullptr;
    const bool linear = reader.find("scale") != nullptr || reader.find("offset") != nullptr;
    if (range && linear) reader.fail("", "give either min and max, or scale and offset");
    map.grey_range = range;
    if (range) {
        reader.require("max");
        reader.number("min", map.min, -HEIGHT_MOST, HEIGHT_MOST);
        reader.number("max", map.max, -HEIGHT_MOST, HEIGHT_MOST);
    }
    map.scale_given = reader.find("scale") != nullptr;
    reader.number("scale", map.scale, -HEIGHT_MOST, HEIGHT_MOST);
    reader.number("offset", map.offset, -HEIGHT_MOST, HEIGHT_MOST);
    if (reader.find("size") != nullptr) {
        Point size = {1, 1};
        reader.pair("size", size, 1, MAP_LIMIT);
        map.form.size = {static_cast<int>(size[0]), static_cast<int>(size[1])};
        if (size[0] != map.form.size->first || size[1] != map.form.size->second) reader.fail("size", "must be whole numbers");
    }
    int samples = -1;
    reader.choice("samples", {"cells", "corners"}, samples);
    if (samples >= 0) map.corners = samples == 1;
    int packing = -1, flip = -1, holes = 0;
    reader.choice("packed", {"terrarium", "mapbox"}, packing);
    map.form.packing = static_cast<Packing>(packing + 1);
    reader.choice("flip", {"x", "y", "xy"}, flip);
    map.form.flip_x = flip == 0 || flip == 2;
    map.form.flip_y = flip > 0;
    reader.choice("holes", {"filled", "outside", "wall", "pit"}, holes);
    map.holes = static_cast<Holes>(holes);
    return map;
}

void read_map_layer(ObjectReader& reader, LayerTarget target, Layer& layer) {
    layer.map = read_map_source(reader, number_of(target) != nullptr ? *number_of(target) : MapMeaning{});
    bool absolute = false;
    if (of_column(target)) reader.boolean("absolute", absolute);
    if (absolute) layer.amount = Amount::surface;
}

/// Of water that is filled up to an elevation.
void read_inside_sand(ObjectReader& reader, LayerTarget target, Layer& layer) {
    if (target == LayerTarget::water && layer.amount == Amount::surface) reader.boolean("inside_sand", layer.inside_sand);
}

std::optional<Point> read_bounds(ObjectReader& reader, const char* key, double least, double most) {
    if (reader.find(key) == nullptr) return std::nullopt;
    Point bounds = {least, most};
    reader.pair(key, bounds, least, most);
    if (bounds[0] > bounds[1]) reader.fail(key, "is [least, most]; the first number must not be above the second");
    return bounds;
}

/// A word, or the ground that the layer falls on.
void read_where(ObjectReader& reader, Layer& layer) {
    const Json* where = reader.find("where");
    if (where == nullptr || !where->is_object()) {
        int word = 0;
        reader.choice("where", {"everywhere", "present"}, word);
        layer.only_present = word == 1;
        return;
    }
    ObjectReader ground(*where, reader.path_of("where"), reader.status());
    ground.boolean("present", layer.only_present);
    layer.mask = {read_bounds(ground, "elevation", -HEIGHT_MOST, HEIGHT_MOST), read_bounds(ground, "slope", 0, SIDE_SLOPE_MOST)};
    ground.finish();
    if (!layer.mask->elevation && !layer.mask->slope) ground.fail("", "needs \"elevation\" or \"slope\", each [least, most]");
}

void read_combine(ObjectReader& reader, LayerTarget target, Layer& layer) {
    static const std::vector<std::string> all = {"add", "set", "max", "min", "subtract"};
    static const std::vector<std::string> filling = {"set", "max", "min"};
    if (layer.amount == Amount::height) {
        int combine = static_cast<int>(Combine::add);
        reader.choice("combine", all, combine);
        layer.combine = static_cast<Combine>(combine);
    } else {
        int combine = 1;
        reader.choice("combine", filling, combine);
        const Combine meaning[] = {Combine::set, Combine::max, Combine::min};
        layer.combine = meaning[combine];
    }
    if (!of_column(target)) return;
    read_where(reader, layer);
}

/// Whether a layer is a map; fails unless it is either that or a shape.
bool is_map(ObjectReader& reader, const Json& layer) {
    const bool has_file = layer.contains("file");
    if (has_file == layer.contains("shape")) reader.fail("", "needs either a \"shape\" or the \"file\" of a map");
    return has_file;
}

} // namespace

std::vector<Layer> read_layers(const Json& value, const std::string& path, LayerTarget target, Status& status) {
    std::vector<Layer> layers;
    const auto elements = read_array(value, path, LAYERS_MOST, status);
    for (std::size_t n = 0; n < elements.size() && status; ++n) {
        Layer layer;
        layer.path = path + "[" + std::to_string(n) + "]";
        ObjectReader reader(*elements[n], layer.path, status);
        if (!status) break;
        const bool has_file = is_map(reader, *elements[n]);
        if (!status) break;
        if (has_file)
            read_map_layer(reader, target, layer);
        else
            read_shape(reader, target, layer);
        if (status) read_inside_sand(reader, target, layer);
        if (status) read_combine(reader, target, layer);
        reader.finish();
        layers.push_back(std::move(layer));
    }
    return layers;
}

std::vector<VelocityLayer> read_velocities(const Json& value, const std::string& path, Status& status) {
    std::vector<VelocityLayer> layers;
    const auto elements = read_array(value, path, LAYERS_MOST, status);
    for (std::size_t n = 0; n < elements.size() && status; ++n) {
        VelocityLayer layer;
        layer.path = path + "[" + std::to_string(n) + "]";
        ObjectReader reader(*elements[n], layer.path, status);
        if (!status) break;
        int of = 0;
        reader.require("of");
        reader.choice("of", {"water", "sand"}, of);
        layer.of_sand = of == 1;
        const bool has_file = is_map(reader, *elements[n]);
        if (!status) break;
        if (has_file) {
            int component = 0;
            reader.require("component");
            reader.choice("component", {"x", "y"}, component);
            layer.map_along_y = component == 1;
            layer.map = read_map_source(reader, {"velocity", -SPEED_MOST, SPEED_MOST});
        } else {
            int kind = 0;
            reader.choice("shape", REGION_NAMES, kind);
            layer.shape.kind = static_cast<ShapeKind>(kind); // REGION_NAMES begin like SHAPE_NAMES
            if (status) read_outline(reader, layer.shape);
            reader.require("velocity");
            reader.pair("velocity", layer.velocity, -SPEED_MOST, SPEED_MOST);
        }
        reader.finish();
        layers.push_back(std::move(layer));
    }
    return layers;
}

} // namespace wadi
