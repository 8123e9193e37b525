"""Materials over the meshes' attributes, the sun and the sky."""
import math

import bpy

SAND, SAND_WET = (0.66, 0.44, 0.20, 1), (0.22, 0.13, 0.055, 1)
ROCK, ROCK_DARK, DUST = (0.32, 0.165, 0.09, 1), (0.12, 0.062, 0.04, 1), (0.30, 0.185, 0.105, 1)
HAZE = (0.9, 1.1, 1.35, 1)  # below the horizon, where the sky's model is black
DEEP, MUD = (0.008, 0.085, 0.150, 1), (0.30, 0.20, 0.07, 1)
ABSORBED = (0.55, 0.12, 0.07)  # of red, green and blue, per metre of water [1/m]
NISHITA = ("MULTIPLE_SCATTERING", "NISHITA")  # its names in Blender 5 and 4


class _Tree:
    """Nodes by short calls; a link is given where a value could stand."""

    def __init__(self, tree):
        self._tree = tree
        tree.nodes.clear()

    def node(self, kind, inputs=None, **settings):
        node = self._tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self._tree.links.new(value, node.inputs[name])
            else:
                node.inputs[name].default_value = value
        return node

    def attribute(self, name, output="Fac"):
        return self.node("ShaderNodeAttribute", attribute_name=name).outputs[output]

    def math(self, operation, a, b=0.0, clamp=False):
        return self.node("ShaderNodeMath", {0: a, 1: b}, operation=operation, use_clamp=clamp).outputs[0]

    def ramp(self, value, low, high):
        """0 below low, 1 above high, smooth between."""
        inputs = {"Value": value, "From Min": low, "From Max": high}
        return self.node("ShaderNodeMapRange", inputs, interpolation_type="SMOOTHSTEP").outputs[0]

    def mix(self, share, a, b):
        node = self.node("ShaderNodeMix", data_type="RGBA")
        for socket, value in ((node.inputs[0], share), (node.inputs[6], a), (node.inputs[7], b)):
            if isinstance(value, bpy.types.NodeSocket):
                self._tree.links.new(value, socket)
            else:
                socket.default_value = value
        return node.outputs[2]

    def blend(self, share, a, b):
        return self.node("ShaderNodeMixShader", {0: share, 1: a, 2: b}).outputs[0]

    def noise(self, scale, detail=4.0, vector=None):
        place = vector or self.node("ShaderNodeTexCoord").outputs["Object"]
        return self.node("ShaderNodeTexNoise", {"Vector": place, "Scale": scale, "Detail": detail}).outputs[0]

    def bump(self, height, strength, distance, normal=None):
        inputs = {"Height": height, "Strength": strength, "Distance": distance}
        return self.node("ShaderNodeBump", {**inputs, **({"Normal": normal} if normal else {})}).outputs[0]

    def end(self, kind, shader):
        self.node(kind, {"Surface": shader})


def _material(name, part):
    """A material of that name made anew, unless the file has it: it may be the user's by now."""
    found = bpy.data.materials.get(name)
    if found is None:
        found = bpy.data.materials.new(name)
        found.use_nodes = True
        part(_Tree(found.node_tree))
    return found


def _ground(t):
    """Sand, darker where it is wet; rock where there is none; what the water whips lies white on the shore."""
    grain, patches = t.noise(9.0, 6.0), t.noise(0.35, 3.0)
    wet = t.math("MAXIMUM", t.attribute("wetness"), t.ramp(t.attribute("saturation"), 0.02, 0.3))
    sand = t.mix(t.math("MULTIPLY", patches, 0.45), SAND, (0.50, 0.32, 0.14, 1))
    sand = t.mix(t.math("MULTIPLY", wet, 0.85), sand, SAND_WET)
    # Layers of rock where it is steep, dust where it is flat.
    place = t.node("ShaderNodeTexCoord").outputs["Object"]
    layers = t.node("ShaderNodeVectorMath", {0: place, 1: (0.03, 0.03, 1.0)}, operation="MULTIPLY").outputs[0]
    rock = t.mix(t.ramp(t.noise(0.9, 6.0, layers), 0.35, 0.65), ROCK_DARK, ROCK)
    steep = t.node("ShaderNodeSeparateXYZ", {0: t.node("ShaderNodeNewGeometry").outputs["Normal"]}).outputs[2]
    steep = t.math("ADD", steep, t.math("MULTIPLY", t.math("SUBTRACT", t.noise(0.5, 8.0), 0.5), 0.3))
    rock = t.mix(t.ramp(steep, 0.7, 1.0), rock, DUST)
    rock = t.mix(t.math("MULTIPLY", wet, 0.5), rock, (0.04, 0.03, 0.024, 1))
    color = t.mix(t.ramp(t.attribute("sand"), 0.0, 0.05), rock, sand)
    foam = t.math("MULTIPLY", t.ramp(t.attribute("foam"), 0.2, 1.0), 0.5)
    normal = t.bump(grain, 0.5, 0.15)
    shader = t.node("ShaderNodeBsdfPrincipled", {"Base Color": t.mix(foam, color, (0.8, 0.8, 0.78, 1)), "Normal": normal,
                                                 "Roughness": t.math("SUBTRACT", 0.95, t.math("MULTIPLY", wet, 0.45))})
    t.end("ShaderNodeOutputMaterial", shader.outputs[0])


def _water(t):
    """What lies below shows through a colour that is absorbed by depth; silt makes it opaque and brown; foam lies on it."""
    depth, silt = t.attribute("depth"), t.attribute("silt")
    left = {channel: t.math("POWER", math.exp(-2 * absorbed), depth) for channel, absorbed in zip(("Red", "Green", "Blue"), ABSORBED)}
    through = t.node("ShaderNodeCombineColor", left).outputs[0]
    mud = t.math("SUBTRACT", 1.0, t.math("POWER", math.exp(-0.12), silt))
    murky = t.math("MAXIMUM", t.math("SUBTRACT", 1.0, t.math("POWER", math.exp(-0.5), depth)), mud)
    speed = t.node("ShaderNodeVectorMath", {0: t.attribute("flow", "Vector")}, operation="LENGTH").outputs["Value"]
    waves = t.math("ADD", t.noise(1.1, 5.0), t.math("MULTIPLY", t.noise(4.0, 4.0), 0.3))
    normal = t.bump(waves, t.math("ADD", 0.12, t.math("MULTIPLY", speed, 0.08), clamp=True), 0.25)
    body = t.blend(murky, t.node("ShaderNodeBsdfTransparent", {"Color": through}).outputs[0],
                   t.node("ShaderNodeBsdfDiffuse", {"Color": t.mix(mud, DEEP, MUD)}).outputs[0])
    mirror = t.node("ShaderNodeBsdfAnisotropic", {"Roughness": 0.12, "Normal": normal}).outputs[0]
    fresnel = t.node("ShaderNodeFresnel", {"IOR": 1.33, "Normal": normal}).outputs[0]
    surface = t.blend(fresnel, body, mirror)
    holes = t.math("ADD", t.math("MULTIPLY", t.noise(0.9, 4.0), 0.7), t.math("MULTIPLY", t.noise(3.5, 4.0), 0.6))
    foam = t.math("MULTIPLY", t.ramp(t.math("SUBTRACT", t.attribute("foam"), holes), -0.3, 0.55), 0.9)
    white = t.node("ShaderNodeBsdfDiffuse", {"Color": (0.82, 0.85, 0.85, 1)}).outputs[0]
    edge = t.ramp(depth, 0.0, 0.03)  # films of water have no edge
    shader = t.blend(edge, t.node("ShaderNodeBsdfTransparent").outputs[0], t.blend(foam, surface, white))
    t.end("ShaderNodeOutputMaterial", shader)


def dress(ground, water):
    """Gives objects their materials, where they have none."""
    for thing, name, part in ((ground, "Wadi ground", _ground), (water, "Wadi water", _water)):
        if not thing.data.materials:
            thing.data.materials.append(_material(name, part))


def light(scene, elevation=38.0, azimuth=235.0):
    """A sun and the sky that goes with it (Nishita). elevation above the horizon, azimuth from the north over the east [degrees]."""
    height, turn = math.radians(elevation), math.radians(azimuth)
    sun = bpy.data.objects.new("Wadi sun", bpy.data.lights.new("Wadi sun", "SUN"))
    sun.data.energy, sun.data.angle, sun.data.color = 4.0, math.radians(0.53), (1, 0.93, 0.82)
    sun.rotation_euler = (math.pi / 2 - height, 0, math.pi - turn)
    scene.collection.objects.link(sun)
    world = bpy.data.worlds.new("Wadi sky")
    if world.node_tree is None:
        world.use_nodes = True
    t = _Tree(world.node_tree)
    sky = t.node("ShaderNodeTexSky", sun_elevation=height, sun_rotation=turn, sun_disc=False)
    kinds = sky.bl_rna.properties["sky_type"].enum_items.keys()
    sky.sky_type = next(kind for kind in NISHITA if kind in kinds)
    up = t.node("ShaderNodeSeparateXYZ", {0: t.node("ShaderNodeTexCoord").outputs["Generated"]}).outputs[2]
    color = t.mix(t.ramp(up, -0.03, 0.03), HAZE, sky.outputs[0])
    t.end("ShaderNodeOutputWorld", t.node("ShaderNodeBackground", {"Color": color, "Strength": 0.12}).outputs[0])
    scene.world = world
    return sun
