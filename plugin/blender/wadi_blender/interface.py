"""Settings of a bake, its operators, and the panel in the sidebar of the 3D view."""
import pathlib

import bpy
import wadi
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import cache, materials, objects, terrain
from .bake import Bake, draws

# Blender 5 asks a path for this where it may begin with "//".
_RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (5, 0, 0) else set()
_levels = []  # Blender keeps no reference to the texts of an enum


def _shipped(_, _context):
    if not _levels:
        _levels.append(("FILE", "A file", "A level, or a terrain map"))
        _levels.extend((name, name.replace("_", " "), str(file)) for name, file in wadi.levels().items())
    return _levels


def _mesh(_, thing):
    return thing.type == "MESH"


class WadiSettings(bpy.types.PropertyGroup):
    """What is baked, and where to."""

    source: EnumProperty(name="From", items=[("LEVEL", "Level", "A level's file"), ("MESH", "Mesh", "The terrain of a mesh")])
    level: EnumProperty(name="Level", items=_shipped, description="One of the levels that come along, or a file")
    file: StringProperty(name="File", subtype="FILE_PATH", options=_RELATIVE,
                         description="A level (.json) or a terrain map (.png, .npy, .asc ...)")
    accuracy: EnumProperty(name="Cells", items=[("LEVEL", "As the level says", "")] + [
        (preset.name, preset.name.capitalize(), f"{preset.cells:g} times as many a side" if preset.cells else "The level's fine grid")
        for preset in wadi.accuracy_presets()])
    terrain: PointerProperty(name="Terrain", type=bpy.types.Object, poll=_mesh,
                             description="Its upper side is the ground, its bounds are the grid's")
    cells: IntProperty(name="Cells", default=128, min=4, max=4096, description="Along the longer side of the terrain")
    sand: PointerProperty(name="Sand", type=bpy.types.Object, poll=_mesh,
                          description="Sand fills up to its upper side; none: the depth below")
    sand_depth: FloatProperty(name="Sand depth", default=0.0, min=0, max=1000, unit="LENGTH", description="Everywhere, without an object")
    water: PointerProperty(name="Water", type=bpy.types.Object, poll=_mesh,
                          description="Water fills up to its upper side; none: the depth below")
    water_depth: FloatProperty(name="Water depth", default=0.0, min=0, max=1000, unit="LENGTH", description="Everywhere, without an object")
    inflow: PointerProperty(name="Inflow", type=bpy.types.Object, description="Water comes up where it stands, on a disc as wide")
    discharge: FloatProperty(name="Discharge", default=5.0, min=0, max=1e6, description="Of the inflow [m3/s]")
    open_sides: BoolProperty(name="Open sides", default=True, description="Water leaves over the grid's rim; off: walls")
    drifting_foam: BoolProperty(name="Drifting foam", default=False,
                                description="Foam drifts, fades and stays on the shore: for beaches and basins up to some 64 m, since it "
                                "covers all of a flood. Off: where water breaks at the moment")
    seconds: FloatProperty(name="Seconds", default=10.0, min=0, max=1e5, description="Simulated, at the scene's frames per second")
    skip: FloatProperty(name="Skip", default=0.0, min=0, max=1e5, description="Simulated seconds ahead of the first frame")
    start: IntProperty(name="First frame", default=1, description="Frame of the scene that shows the first baked one")
    backend: EnumProperty(name="Backend", items=[("auto", "The best there is", ""), ("cpu", "CPU", ""), ("vulkan", "Vulkan", ""),
                                                 ("cuda", "CUDA", "")])
    cache: StringProperty(name="Cache", default="//wadi", subtype="DIR_PATH", options=_RELATIVE,
                          description="Folder for the frames, of its own")


def prepare(scene, depsgraph):
    """(a Bake, its folder) from a scene's settings. Errors: those of wadi, ValueError, CacheError; they name the setting."""
    given = scene.wadi
    if not given.cache.strip():
        raise ValueError("cache: no folder is named")
    if given.cache.startswith("//") and not bpy.data.filepath:
        raise ValueError("cache: save the .blend file first, or name a folder that does not begin with //")
    folder, backend, traces = bpy.path.abspath(given.cache), given.backend, draws(given.drifting_foam)
    about = {"origin": (0.0, 0.0, 0.0), "cells_without_ground": 0}
    if given.source == "MESH":
        full, files, about = terrain.level(given.terrain, given.cells, depsgraph, given.sand, given.sand_depth, given.water,
                                           given.water_depth, given.inflow, given.discharge, given.open_sides)

        def make():
            return wadi.World(text=full, files=files, draws=traces, backend=backend, log=False)
    else:
        if given.level == "FILE" and not given.file.strip():
            raise ValueError("file: no level is named")
        level = pathlib.Path(bpy.path.abspath(given.file)) if given.level == "FILE" else wadi.levels()[given.level]
        accuracy = None if given.accuracy == "LEVEL" else given.accuracy

        def make():
            return wadi.World(level, accuracy=accuracy, draws=traces, backend=backend, log=False)

    return Bake(make, folder, given.seconds, scene.render.fps / scene.render.fps_base, given.skip, about), folder


class WADI_OT_bake(bpy.types.Operator):
    """Simulates and shows the result as two meshes. Esc ends it; frames that are done stay"""

    bl_idname, bl_label = "wadi.bake", "Bake"
    _timer = _bake = None
    running = False  # one at a time

    @classmethod
    def poll(cls, context):
        return not WADI_OT_bake.running

    def _begin(self, context):
        # What the panel and the window show may be another scene by the end.
        self._scene, self._path, self._start = context.scene, context.scene.wadi.cache, context.scene.wadi.start
        try:
            self._bake, self._folder = prepare(context.scene, context.evaluated_depsgraph_get())
            self._bake.tick(0)  # makes the world: what is wrong with a level is told here
        except (wadi.Error, ValueError, TypeError, cache.CacheError) as failed:
            return self._fail(failed)
        return True

    def _fail(self, failed):
        if self._bake is not None:
            self._bake.stop()
        self.report({"ERROR"}, str(failed))
        return False

    def _tick(self):
        """None where it failed, else whether there is more to do."""
        try:
            return self._bake.tick()
        except (wadi.Error, cache.CacheError) as failed:
            self._fail(failed)
            return None

    def _finish(self):
        self._bake.stop()
        if self._bake.done == 0:
            self.report({"WARNING"}, "Nothing was baked")
            return {"CANCELLED"}
        scene = self._scene
        first = not objects.shown(scene)
        ground, water = objects.build(scene, self._folder, self._path, self._start)
        materials.dress(ground, water)
        if first and not any(thing.type == "LIGHT" and thing.data.type == "SUN" for thing in scene.objects):
            materials.light(scene)
        about = objects.reader(self._folder).about
        scene.frame_end = max(scene.frame_end, self._start + about["frames"] - 1)
        said = f"{self._bake.done} of {self._bake.count} frames in {self._folder}"
        holes = about["cells_without_ground"]
        for text in about["warnings"] + ([f"terrain: {holes} cells lie under no ground and drain to the rim"] if holes else []):
            self.report({"WARNING"}, text)
        self.report({"INFO"}, said)
        return {"FINISHED"}

    def execute(self, context):
        if not self._begin(context):
            return {"CANCELLED"}
        manager = context.window_manager
        manager.progress_begin(0, 100)
        while more := self._tick():
            manager.progress_update(100 * self._bake.share)
        manager.progress_end()
        return {"CANCELLED"} if more is None else self._finish()

    def invoke(self, context, event):
        if not self._begin(context):
            return {"CANCELLED"}
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self._timer = manager.event_timer_add(0.001, window=context.window)
        manager.modal_handler_add(self)
        WADI_OT_bake.running = True
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            return self._leave(context, True)
        if event.type == "TIMER":
            more = self._tick()
            if not more:
                return self._leave(context, more is not None)
            context.window_manager.progress_update(100 * self._bake.share)
            if context.workspace is not None:
                context.workspace.status_text_set(
                    f"Wadi: {100 * self._bake.share:.0f} %, {self._bake.done} of {self._bake.count} frames. Esc ends it")
        return {"PASS_THROUGH"}

    def cancel(self, context):
        self._leave(context, False)

    def _leave(self, context, good):
        WADI_OT_bake.running = False
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        if not good:
            self._bake.stop()
            return {"CANCELLED"}
        return self._finish()


class WADI_OT_light(bpy.types.Operator):
    """Adds a sun and the sky that goes with it, as the scene's world"""

    bl_idname, bl_label, bl_options = "wadi.light", "Add sun and sky", {"REGISTER", "UNDO"}

    elevation: FloatProperty(name="Elevation", default=38, min=0, max=90, description="Of the sun above the horizon, in degrees")
    azimuth: FloatProperty(name="Azimuth", default=235, min=0, max=360, description="From the north over the east, in degrees")

    def execute(self, context):
        materials.light(context.scene, self.elevation, self.azimuth)
        return {"FINISHED"}


class WADI_OT_export(bpy.types.Operator):
    """Writes the baked meshes for machines without this add-on: USD with all attributes, or Alembic with shapes alone"""

    bl_idname, bl_label = "wadi.export", "Export USD or Alembic"

    filepath: StringProperty(subtype="FILE_PATH", options=_RELATIVE, description="Ends in .usdc, .usd or .abc")
    filter_glob: StringProperty(default="*.usdc;*.usd;*.abc", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return bool(objects.shown(context.scene))

    def invoke(self, context, event):
        self.filepath = self.filepath or bpy.path.abspath("//wadi.usdc")
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        scene, things, path = context.scene, objects.shown(context.scene), bpy.path.abspath(self.filepath)
        kind = pathlib.Path(path).suffix
        try:
            if kind not in (".usdc", ".usd", ".abc"):
                raise ValueError(f"filepath: {self.filepath!r}, must end in .usdc, .usd or .abc")
            counts = [(thing[objects.START], objects.reader(objects.folder_of(thing)).about["frames"]) for thing in things]
        except (ValueError, cache.CacheError) as failed:
            self.report({"ERROR"}, str(failed))
            return {"CANCELLED"}
        start, end = min(first for first, _ in counts), max(first + count - 1 for first, count in counts)
        before, chosen = (scene.frame_start, scene.frame_end, scene.frame_current), list(context.selected_objects)
        scene.frame_start, scene.frame_end = start, end
        for thing in context.view_layer.objects:
            thing.select_set(thing in things)
        # Exporters take a mesh for still unless something acts on it: this does, and moves nothing.
        still = [(thing, thing.modifiers.new("Wadi export", "DISPLACE")) for thing in things]
        for _, modifier in still:
            modifier.strength = 0
        try:
            if kind == ".abc":
                return bpy.ops.wm.alembic_export(filepath=path, start=start, end=end, selected=True, export_custom_properties=False,
                                                  as_background_job=False)
            return bpy.ops.wm.usd_export(filepath=path, selected_objects_only=True, export_animation=True, export_custom_properties=False)
        finally:
            for thing, modifier in still:
                thing.modifiers.remove(modifier)
            for thing in context.view_layer.objects:
                thing.select_set(thing in chosen)
            scene.frame_start, scene.frame_end = before[:2]
            scene.frame_set(before[2])


class WADI_PT_panel(bpy.types.Panel):
    bl_label, bl_idname = "Wadi", "WADI_PT_panel"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Wadi"

    def draw(self, context):
        given, layout = context.scene.wadi, self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        layout.prop(given, "source", expand=True)
        box = layout.column()
        if given.source == "LEVEL":
            box.prop(given, "level")
            if given.level == "FILE":
                box.prop(given, "file")
            box.prop(given, "accuracy")
        else:
            box.prop(given, "terrain")
            box.prop(given, "cells")
            for name in ("sand", "water"):
                box.prop(given, name)
                if getattr(given, name) is None:
                    box.prop(given, f"{name}_depth")
            box.prop(given, "inflow")
            if given.inflow is not None:
                box.prop(given, "discharge")
            box.prop(given, "open_sides")
        layout.separator()
        for name in ("drifting_foam", "seconds", "skip", "start", "backend", "cache"):
            layout.prop(given, name)
        layout.operator("wadi.bake", icon="MOD_FLUIDSIM")
        layout.operator("wadi.light", icon="LIGHT_SUN")
        layout.operator("wadi.export", icon="EXPORT")


_classes = (WadiSettings, WADI_OT_bake, WADI_OT_light, WADI_OT_export, WADI_PT_panel)


def register():
    for kind in _classes:
        bpy.utils.register_class(kind)
    bpy.types.Scene.wadi = PointerProperty(type=WadiSettings)


def unregister():
    del bpy.types.Scene.wadi
    for kind in reversed(_classes):
        bpy.utils.unregister_class(kind)
