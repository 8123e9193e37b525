"""Meshes that show baked frames. What a mesh shows follows the scene's frame by handlers; the .blend file holds one frame of it."""
import bpy
import numpy as np
from bpy.app.handlers import persistent

from . import cache

FOLDER, PART, START = "wadi_cache", "wadi_part", "wadi_start"  # custom properties of an object that shows a cache
GROUND, WATER = "ground", "water"
WET = 1e-3  # depth of water that is shown [m]
#: Attributes of both meshes, by the plane of a frame that they show.
ATTRIBUTES = {"depth": "water_depth", "flow": "flow", "foam": "foam", "wetness": "wetness", "saturation": "saturation", "silt": "silt",
              "sand": "sand_depth"}
_readers, _newest, _told = {}, [None, None, None], set()


def linked_from(thing):
    """The other .blend file that an object is linked from; None = it is this file's own."""
    return getattr(thing, "library", None)


def folder_of(thing):
    """The cache of an object as a whole path; "//" is the folder of the .blend file that the object is from."""
    return bpy.path.abspath(thing[FOLDER], library=linked_from(thing))


def reader(folder, afresh=False):
    """The cache.Reader of a folder. Errors: CacheError."""
    if afresh or folder not in _readers:
        _readers[folder] = cache.Reader(folder)
        _newest[:] = None, None, None
        _told.discard(folder)
    return _readers[folder]


def _frame(folder, number):
    if _newest[:2] != [folder, number]:
        _newest[:] = folder, number, reader(folder).frame(number)
    return _newest[2]


def water_heights(frame, dx):
    """Elevations of the water's mesh: the free surface where there is water. Dry cells beside it carry that surface on into the ground,
    so that the shore is where the two meshes meet; the rest lies below the ground."""
    ground, wet = frame["sand_surface"], frame["water_depth"] > WET
    free = np.where(wet, frame["free_surface"], 0)
    ny, nx = ground.shape
    total, count = np.zeros_like(ground), np.zeros_like(ground)
    free, one = np.pad(free, 1), np.pad(wet.astype(np.float32), 1)
    for j in range(3):
        for i in range(3):
            total += free[j:j + ny, i:i + nx]
            count += one[j:j + ny, i:i + nx]
    below = ground - np.float32(0.3 * dx)
    beside = np.minimum(total / np.maximum(count, 1), ground - np.float32(0.01 * dx))
    return np.where(wet, frame["free_surface"], np.where(count > 0, beside, below))


def heights(part, frame, dx):
    """z of a mesh's points, shape (ny, nx)."""
    return frame["sand_surface"] if part == GROUND else water_heights(frame, dx)


def _grid(name, nx, ny, dx):
    mesh = bpy.data.meshes.new(name)
    x, y = np.meshgrid((np.arange(nx) + 0.5) * dx, (np.arange(ny) + 0.5) * dx)
    first = (np.arange(ny - 1)[:, None] * nx + np.arange(nx - 1)).ravel()
    corners = np.stack([first, first + 1, first + nx + 1, first + nx], axis=1).astype(np.int32).ravel()
    mesh.vertices.add(nx * ny)
    mesh.vertices.foreach_set("co", np.stack([x, y, np.zeros_like(x)], axis=2).astype(np.float32).ravel())
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(len(first))
    mesh.polygons.foreach_set("loop_start", np.arange(0, len(corners), 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.validate()
    mesh.shade_smooth()
    for attribute in ATTRIBUTES:
        mesh.attributes.new(attribute, "FLOAT2" if attribute == "flow" else "FLOAT", "POINT")
    return mesh


def show(thing, number):
    """Makes an object's mesh show a frame of its cache. Errors: CacheError."""
    folder, mesh = folder_of(thing), thing.data
    about = reader(folder).about
    frame = _frame(folder, min(max(number, 0), about["frames"] - 1))
    z = heights(thing[PART], frame, about["dx"])
    if len(mesh.vertices) != z.size:
        raise cache.CacheError(f"cache: {folder} has {z.size} cells, {mesh.name} {len(mesh.vertices)} points: bake again")
    position = np.empty(3 * z.size, np.float32)
    points = mesh.attributes["position"].data
    points.foreach_get("vector", position)
    position[2::3] = z.ravel()
    points.foreach_set("vector", position)
    for attribute, plane in ATTRIBUTES.items():
        found = mesh.attributes.get(attribute)
        if plane in frame and found is not None and found.domain == "POINT":
            found.data.foreach_set("vector" if attribute == "flow" else "value", np.ascontiguousarray(frame[plane], np.float32).ravel())
    mesh.update()


def shown(scene):
    """Objects of a scene that show caches."""
    return [thing for thing in scene.objects if FOLDER in thing and thing.type == "MESH"]


@persistent
def follow(scene, _=None):
    """Handler: every such object shows the scene's frame. What is missing is told once; the mesh stays as it is."""
    for thing in shown(scene):
        try:
            show(thing, scene.frame_current - thing[START])
        except cache.CacheError as failed:
            if folder_of(thing) not in _told:
                _told.add(folder_of(thing))
                print(f"Wadi: {thing.name}: {failed}")


@persistent
def opened(*_):
    """Handler: another .blend file is open."""
    _readers.clear()
    _newest[:] = None, None, None
    _told.clear()
    for scene in bpy.data.scenes:
        follow(scene)


def build(scene, folder, path, start):
    """Objects "Wadi ground" and "Wadi water" that show the cache in `folder`; those that show it already get new meshes. path: the folder
    as the objects keep it, "//..." too. start: frame of the scene that shows the first one. Errors: CacheError."""
    about = reader(folder, afresh=True).about
    found = []
    for part in (GROUND, WATER):
        name = f"Wadi {part}"
        mesh = _grid(name, about["nx"], about["ny"], about["dx"])
        there = [thing for thing in shown(scene) if linked_from(thing) is None and folder_of(thing) == folder and thing[PART] == part]
        thing = there[0] if there else None
        if thing is None:
            thing = bpy.data.objects.new(name, mesh)
            scene.collection.objects.link(thing)
        else:
            old = thing.data
            for material in old.materials:
                mesh.materials.append(material)
            thing.data = mesh
            if old.users == 0:
                bpy.data.meshes.remove(old)
        thing.location = about["origin"]
        thing[FOLDER], thing[PART], thing[START] = path, part, start
        found.append(thing)
    follow(scene)
    return found


def register():
    bpy.app.handlers.frame_change_pre.append(follow)
    bpy.app.handlers.load_post.append(opened)


def unregister():
    bpy.app.handlers.frame_change_pre.remove(follow)
    bpy.app.handlers.load_post.remove(opened)
