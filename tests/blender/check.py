#!/usr/bin/env python3
"""The extension in Blender as a module: what it bakes against the library's own fields, bit by bit, and a picture.
Usage: check.py WORK PACKAGE [--store] [PART ...]; run.sh calls it. Exit status 1 names what failed."""
import contextlib
import io
import math
import os
import pathlib
import shutil
import subprocess
import sys
import time
import traceback
from types import SimpleNamespace

WORK = pathlib.Path(sys.argv[1])
PICTURE = pathlib.Path(__file__).resolve().parent / "canyon.jpg"
# Blender's settings and extensions of this test alone
os.environ["BLENDER_USER_RESOURCES"] = str(WORK / "user")
shutil.rmtree(WORK / "user", ignore_errors=True)

import bpy  # noqa: E402
import numpy as np  # noqa: E402

FPS = 24
checks, failures = 0, []


def check(good, what):
    global checks
    checks += 1
    if not good:
        failures.append(what)
        print(f"FAIL {what}")


def same(a, b):
    """Equal bits."""
    return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()


def points(thing):
    mesh = thing.data
    found = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", found)
    return found.reshape(-1, 3)


def values(thing, name):
    attribute = thing.data.attributes[name]
    wide = 2 if name == "flow" else 1
    found = np.empty(wide * len(attribute.data), np.float32)
    attribute.data.foreach_get("vector" if wide == 2 else "value", found)
    check(attribute.domain == "POINT", f"{name} lies on points")
    return found


def fresh(**settings):
    """An empty scene with these settings of the panel."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = FPS
    for name, value in {"backend": "cpu", "source": "LEVEL", **settings}.items():
        setattr(scene.wadi, name, value)
    return scene


def pair():
    return bpy.data.objects["Wadi ground"], bpy.data.objects["Wadi water"]


def breaches(ground, water, world):
    """Where the two meshes differ from a world of now."""
    found = []
    world.set_outputs(*bake.SHAPE, *bake.DRAWN, host=True)
    world.publish()
    field = {name: world.output(name) for name in bake.SHAPE + bake.DRAWN}
    wet = field["water_depth"].ravel() > objects.WET
    if not same(points(ground)[:, 2].copy(), field["sand_surface"].ravel()):
        found.append("ground's heights")
    heights = points(water)[:, 2]
    if not same(heights[wet], field["free_surface"].ravel()[wet]):
        found.append("water's heights")
    if not (heights[~wet] < field["sand_surface"].ravel()[~wet]).all():
        found.append("dry water above the ground")
    x, y = np.meshgrid(world.x, world.y)
    for thing in (ground, water):
        if not np.allclose(points(thing)[:, :2], np.stack([x.ravel(), y.ravel()], 1), atol=1e-4 * world.dx):
            found.append(f"{thing.name}: x, y")
        for name, plane in objects.ATTRIBUTES.items():
            if plane in field and not same(values(thing, name), field[plane].ravel()):
                found.append(f"{thing.name}: {name}")
    return found


def recorded(level, accuracy, moment, fields):
    """Fields that the recorder, a host of the C interface, has at that time."""
    folder = WORK / "recorded"
    shutil.rmtree(folder, ignore_errors=True)
    program = wadi.program("wadi-recorder")
    program.chmod(0o755)  # Blender unpacks wheels without such bits
    subprocess.run([program, wadi.levels()[level], "--backend", "cpu", "--accuracy", accuracy, "--seconds", moment, "--no-frames",
                    "--dump", f"{','.join(fields)}@{moment}", "--out", folder], check=True, stdout=subprocess.DEVNULL)
    return {name: np.load(next(folder.glob(f"{name}_*.npy"))) for name in fields}


def part_level():
    """A level's frames are the world's, in every bit; the recorder's too; they follow the scene's frame, also in a file that was saved."""
    folder = WORK / "cache_level"
    skip = 2
    scene = fresh(level="castle", accuracy="draft", seconds=0.5, skip=skip, cache=str(folder), start=3, drifting_foam=True)
    begun = time.perf_counter()
    check(bpy.ops.wadi.bake() == {"FINISHED"}, "a level bakes")
    print(f"bake: {(time.perf_counter() - begun) / 13:.3f} s a frame of {len(pair()[0].data.vertices)} cells")
    about = objects.reader(str(folder)).about
    check(about["frames"] == 13 and scene.frame_end >= 15, "half a second has 13 frames")
    check(len(list(folder.glob("*.npz"))) == 13, "a file for each frame")
    traces = bake.draws(True)
    check({"foam", "wetness", "silt"} == set(traces), f"the world is asked for all traces, not {traces}")
    with wadi.World(wadi.levels()["castle"], accuracy="draft", draws=traces, backend="cpu", log=False) as world:
        for frame in range(13):
            world.step(int((skip + frame / FPS) / world.dt + 1e-6) - world.steps)
            scene.frame_set(3 + frame)
            found = breaches(*pair(), world)
            check(not found, f"frame {frame}: {found}")
        check(about["hash"] == f"{world.hash():016x}", "the hash of the last frame's state")
        moment = world.steps * world.dt
        scene.frame_set(14)
        check("ground's heights" in breaches(*pair(), world), "another frame's heights are noticed")
        scene.frame_set(15)
        place = pair()[0].data.attributes["position"].data[1234]
        place.vector[2] = np.nextafter(np.float32(place.vector[2]), np.float32(100))
        pair()[0].data.attributes["flow"].data[777].vector[1] += 1e-3
        found = breaches(*pair(), world)
        check("ground's heights" in found, "a changed bit of a height is noticed")
        check("Wadi ground: flow" in found, "a changed flow is noticed")
    scene.frame_set(15)
    theirs = recorded("castle", "draft", f"{moment:.6g}", ("hs",))
    check(same(values(pair()[0], "sand").reshape(theirs["hs"].shape), theirs["hs"]), "depths of sand are the recorder's")
    scene.frame_set(100)
    last = points(pair()[0])
    scene.frame_set(15)
    check(same(last, points(pair()[0])), "behind the end stays the last frame")
    scene.frame_set(9)
    kept = [points(thing) for thing in pair()]
    foam = values(pair()[1], "foam")
    check(foam.max() > 0.5, "there is foam")
    file = WORK / "level.blend"
    scene.frame_set(1)
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    sizes = [path.stat().st_size / 1e6 for path in (file, folder / "frame_00012.npz")]
    print(f"the .blend file: {sizes[0]:.1f} MB, a frame of the cache: {sizes[1]:.2f} MB")
    check(file.stat().st_size < 150 * len(kept[0]), "the .blend file has one frame")
    fresh()
    bpy.ops.wm.open_mainfile(filepath=str(file))
    check(not same(kept[0], points(pair()[0])), "an opened file shows its own frame")
    bpy.context.scene.frame_set(9)
    check(all(same(a, points(b)) for a, b in zip(kept, pair())), "an opened file follows its cache")
    # A moved cache is told once and changes nothing.
    folder.rename(WORK / "cache_moved")
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        bpy.ops.wm.open_mainfile(filepath=str(file))
        before = points(pair()[0])
        for frame in (5, 6):
            bpy.context.scene.frame_set(frame)
    check(said.getvalue().count("has no baked frames") == 1, f"a missing cache is told once: {said.getvalue()!r}")
    check(same(before, points(pair()[0])), "a missing cache changes nothing")
    (WORK / "cache_moved").rename(folder)
    # Baked again into the same folder: the same objects, longer or shorter.
    bpy.ops.wm.open_mainfile(filepath=str(file))
    names = set(bpy.data.objects.keys())
    bpy.context.scene.wadi.seconds = 0.1
    bpy.ops.wadi.bake()
    check(set(bpy.data.objects.keys()) == names, "baked again: the objects are the same")
    check(len(list(folder.glob("*.npz"))) == 3, "baked again: no frames of before")


def part_export():
    """USD brings shapes and attributes back, Alembic shapes."""
    folder = WORK / "cache_export"
    scene = fresh(level="dam_break", accuracy="draft", seconds=0.25, cache=str(folder))
    bpy.ops.wadi.bake()
    scene.frame_set(7)
    heights, depth = points(pair()[1])[:, 2].copy(), values(pair()[1], "depth")
    scene.frame_set(1)
    first = points(pair()[1])[:, 2].copy()
    check(bpy.ops.wadi.export(filepath=str(WORK / "out.usdc")) == {"FINISHED"}, "USD is written")
    check(bpy.ops.wadi.export(filepath=str(WORK / "out.abc")) == {"FINISHED"}, "Alembic is written")
    check(scene.frame_current == 1 and not pair()[0].modifiers, "an export leaves the scene as it was")
    for kind, read in (("usdc", bpy.ops.wm.usd_import), ("abc", bpy.ops.wm.alembic_import)):
        fresh().frame_set(1)
        read(filepath=str(WORK / f"out.{kind}"))
        thing = next(thing for thing in bpy.data.objects if thing.type == "MESH" and "water" in thing.name)
        for frame, wanted in ((1, first), (7, heights)):
            bpy.context.scene.frame_set(frame)
            seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
            check(np.allclose(points(seen)[:, 2], wanted, atol=1e-5), f"{kind}: heights of frame {frame}")
        if kind == "usdc":
            check(np.allclose(values(seen, "depth"), depth, atol=1e-6) and depth.max() > 0.1, "usdc: depth")


def hill(x, y):
    return 3 + 2 * np.sin(0.31 * x) * np.cos(0.23 * y)


def surface(name, height, size=20.0, n=81, place=(0, 0, 0)):
    """A mesh of squares over 0 ... size, with heights by a function."""
    side = np.linspace(0, size, n)
    x, y = np.meshgrid(side, side)
    corners = np.stack([x, y, np.broadcast_to(height(x, y), x.shape)], 2).reshape(-1, 3)
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners.tolist(), [], np.stack([first, first + 1, first + n + 1, first + n], 1).tolist())
    thing = bpy.data.objects.new(name, mesh)
    thing.location = place
    bpy.context.scene.collection.objects.link(thing)
    return thing


def part_mesh():
    """Heights of meshes, placed, turned and scaled; water and sand by objects and by depths; an inflow."""
    place = (100, -50, 7)
    folder = WORK / "cache_mesh"
    scene = fresh(source="MESH", cells=50, seconds=0.25, cache=str(folder), open_sides=False)
    given = scene.wadi
    given.terrain = surface("hills", hill, place=place)
    given.water = surface("lake", lambda x, y: 0 * x + 3, place=place, n=2)
    given.sand = surface("dune", lambda x, y: hill(x, y) + 0.4 - 0.1 * np.abs(x - 10), place=place)
    bpy.context.view_layer.update()
    check(bpy.ops.wadi.bake() == {"FINISHED"}, "a mesh bakes")
    ground, water = pair()
    scene.frame_set(1)
    about = objects.reader(str(folder)).about
    check(about["nx"] == 50 and about["ny"] == 50 and abs(about["dx"] - 0.4) < 1e-6, f"cells: {about}")
    corner = [100, -50, 7 + points(given.terrain)[:, 2].min()]
    check(np.allclose(np.array(ground.location), corner, atol=1e-4), "the ground lies where the mesh lies")
    x, y = points(ground)[:, 0], points(ground)[:, 1]
    top = points(ground)[:, 2] + ground.location.z - 7
    sand = np.maximum(0, 0.4 - 0.1 * np.abs(x - 10))
    check(np.abs(values(ground, "sand") - sand).max() < 0.02, "depth of sand between two meshes")
    check(np.abs(top - hill(x, y) - sand).max() < 0.02, "heights of a mesh")
    check(np.abs(top - hill(x + 0.4, y) - sand).max() > 0.1, "a shift by a cell is noticed")
    wet = values(water, "depth") > objects.WET
    level = points(water)[wet, 2] + water.location.z - 7
    check(500 < wet.sum() < 2000 and np.abs(level - 3).max() < 2e-3, f"the lake is flat: {np.abs(level - 3).max()}")
    full, files, _ = terrain.level(given.terrain, 50, bpy.context.evaluated_depsgraph_get(), given.sand, 0, given.water, 0, None, 0, False)
    with wadi.World(text=full, files=files, draws=bake.draws(False), backend="cpu", log=False) as world:
        world.step(int(0.25 / world.dt + 1e-6))
        scene.frame_set(7)
        found = breaches(ground, water, world)
        check(not found, f"the frames of a mesh: {found}")
        check(about["hash"] == f"{world.hash():016x}", "the hash of a mesh's world")
    # Turned by a quarter, twice as large, with depths and an inflow; half of the mesh has no ground.
    scene = fresh(source="MESH", cells=32, seconds=0.5, cache=str(WORK / "cache_turned"), water_depth=0.2, discharge=3.0)
    given = scene.wadi
    given.terrain = surface("hills", hill)
    given.terrain.rotation_euler[2], given.terrain.scale = math.pi / 2, (2, 2, 2)
    given.inflow = bpy.data.objects.new("spring", None)
    scene.collection.objects.link(given.inflow)
    given.inflow.location = (-20, 20, 0)
    bpy.context.view_layer.update()
    bpy.ops.wadi.bake()
    scene.frame_set(13)
    poured = values(pair()[1], "depth").sum()
    given.discharge = 0
    bpy.ops.wadi.bake()
    scene.frame_set(13)
    more = (poured - values(pair()[1], "depth").sum()) * objects.reader(str(WORK / "cache_turned")).about["dx"]**2
    check(1.4 < more < 1.6, f"the inflow brings 1.5 m3 in half a second, not {more:.2f}")
    given.sand_depth = 0.5
    bpy.ops.wadi.bake()
    scene.frame_set(1)
    ground = pair()[0]
    x, y = points(ground)[:, 0] + ground.location.x, points(ground)[:, 1] + ground.location.y
    top = points(ground)[:, 2] + ground.location.z - 0.5
    check(np.abs(top - 2 * hill(y / 2, -x / 2)).max() < 0.05, "heights of a mesh that is turned and scaled")


def part_cancel():
    """Esc ends a bake; what is done stays. No piece of work takes long."""
    folder = WORK / "cache_cancel"
    # An operator's functions without Blender's event loop, which a module lacks.
    kind = type("Bake", (), {name: value for name, value in vars(interface.WADI_OT_bake).items() if not name.startswith("__")})
    for event, least in (("ESC", 30), ("TIMER", None)):
        scene = fresh(level="castle", accuracy="balanced", seconds=3.0, cache=str(folder))
        told, calls = [], []
        operator = kind()
        operator.report = lambda level, text: told.append((level, text))
        manager = SimpleNamespace(**{name: lambda *_, name=name, **__: calls.append(name) for name in (
            "progress_begin", "progress_update", "progress_end", "event_timer_add", "event_timer_remove", "modal_handler_add")})
        context = SimpleNamespace(window_manager=manager, window=None, workspace=None, scene=scene,
                                  evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get)
        check(operator.invoke(context, None) == {"RUNNING_MODAL"}, "a bake runs on")
        answer, ticks = {"PASS_THROUGH"}, []
        while answer == {"PASS_THROUGH"} and (event == "TIMER" or operator._bake.done < least):
            begun = time.perf_counter()
            answer = operator.modal(context, SimpleNamespace(type="TIMER"))
            ticks.append(time.perf_counter() - begun)
        check(interface.WADI_OT_bake.poll(context) == (answer != {"PASS_THROUGH"}), "one bake at a time")
        if event == "ESC":
            done = operator._bake.done
            check(operator.modal(context, SimpleNamespace(type="MOUSEMOVE")) == {"PASS_THROUGH"}, "the mouse ends nothing")
            answer = operator.modal(context, SimpleNamespace(type="ESC"))
            frames = objects.reader(str(folder)).about["frames"]
            check(frames == done < 73, f"Esc: {done} frames, {frames} in the cache")
            check(any(f"{done} of 73 frames" in text for _, text in told), f"Esc is told: {told}")
        else:
            check(objects.reader(str(folder)).about["frames"] == 73, "all frames")
        check(answer == {"FINISHED"} and "Wadi water" in bpy.data.objects, "frames that are done are shown")
        check(calls.count("event_timer_remove") == calls.count("progress_end") == 1, "timer and progress end")
        check(calls.count("progress_update") > 2, "progress is shown")
        typical, slowest = np.median(ticks), max(ticks[:-1])  # the last one builds the meshes
        print(f"{event}: a tick took {1000 * typical:.0f} ms, the slowest {1000 * slowest:.0f} ms")
        check(typical < 0.1, f"a tick took {typical:.3f} s")


def part_bad():
    """What is wrong is told by the setting's name, and nothing is made."""
    strange = WORK / "strange"
    strange.mkdir(exist_ok=True)
    (strange / "thesis.txt").write_text("mine")
    (WORK / "broken.json").write_text('{ "format_version": 1, "grid": { "nx": 8, "ny": 8, "dx": -1 }, "dt": 0.01 }')
    good = {"level": "dam_break", "accuracy": "draft", "seconds": 0.05, "cache": str(WORK / "cache_bad")}
    mesh = {**good, "source": "MESH"}
    for settings, said in (({**good, "cache": ""}, "cache: no folder"), ({**good, "cache": "//wadi"}, "cache: save the .blend"),
                           ({**good, "cache": str(strange)}, "thesis.txt"), ({**good, "cache": "/proc/wadi"}, "cache: "),
                           ({**good, "level": "FILE"}, "file: no level"),
                           ({**good, "level": "FILE", "file": "/nowhere/level.json"}, "/nowhere/level.json"),
                           ({**good, "level": "FILE", "file": str(WORK / "broken.json")}, "dx"), (mesh, "terrain: no object"),
                           ({**mesh, "terrain": "flat"}, "must be wider than 0"),
                           ({**mesh, "terrain": "hills", "sand": "far"}, "sand: far lies under no cell"),
                           ({**mesh, "terrain": "hills", "inflow": "far"}, "inflow: far stands outside")):
        scene = fresh(**{name: value for name, value in settings.items() if name not in ("terrain", "sand", "inflow")})
        made = {"hills": surface("hills", hill, n=5), "far": surface("far", hill, n=3, place=(500, 0, 0)),
                "flat": surface("flat", hill, size=0.0, n=2)}
        for name in ("terrain", "sand", "inflow"):
            if name in settings:
                setattr(scene.wadi, name, made[settings[name]])
        bpy.context.view_layer.update()
        try:
            bpy.ops.wadi.bake()
            text = "nothing"
        except RuntimeError as failed:
            text = str(failed)
        check(said in text, f"{settings} is told as {said!r}, not {text!r}")
        check("Wadi ground" not in bpy.data.objects, f"{said}: nothing is made")
    check((strange / "thesis.txt").read_text() == "mine", "a stranger's file stays")
    fresh(**good)
    check(bpy.ops.wadi.bake() == {"FINISHED"}, "the same settings without a fault are good")
    for path, said in (("x.obj", "must end in"), ("", "must end in")):
        try:
            bpy.ops.wadi.export(filepath=path)
            check(False, f"an export to {path!r} is refused")
        except RuntimeError as failed:
            check(said in str(failed), f"an export to {path!r}: {failed}")


def rendered(scene, file):
    """The picture's pixels, 0 ... 255."""
    scene.render.filepath = str(file)
    bpy.ops.render.render(write_still=True)
    return pixels(file)


def pixels(file):
    image = bpy.data.images.load(str(file))
    found = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(found)
    size = tuple(image.size)
    bpy.data.images.remove(image)
    return 255 * found.reshape(size[1], size[0], -1)[:, :, :3]


def part_picture():
    """The canyon's second dam breaks, as in the picture that is kept; without water, or 20 s earlier, it is another."""
    from mathutils import Vector

    scene = fresh(level="canyon", seconds=20, skip=15, cache=str(WORK / "cache_canyon"))
    scene.render.fps, scene.render.fps_base = 1, 20
    begun = time.perf_counter()
    bpy.ops.wadi.bake()
    print(f"bake: 35 s of the canyon in {time.perf_counter() - begun:.1f} s")
    eye, at = Vector((84, 30, 40)), Vector((46, 70, 2))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = eye, (at - eye).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens, camera.data.clip_end = 30, 1000
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", 32, 1
    scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = False, True
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 480, 270, 100
    scene.render.image_settings.file_format, scene.render.image_settings.quality = "JPEG", 90
    for name in dir(scene.render):
        if name.startswith("use_stamp_"):
            setattr(scene.render, name, False)  # times and names that would be in the file
    scene.frame_set(2)
    begun = time.perf_counter()
    now = rendered(scene, WORK / "canyon.jpg")
    print(f"render: {time.perf_counter() - begun:.1f} s, {(WORK / 'canyon.jpg').stat().st_size / 1000:.0f} kB")
    if "--store" in sys.argv:
        shutil.copy(WORK / "canyon.jpg", PICTURE)
    kept = pixels(PICTURE)
    scene.cycles.samples = 8
    pair()[1].hide_render = True
    dry = rendered(scene, WORK / "canyon_dry.jpg")
    pair()[1].hide_render = False
    scene.frame_set(1)
    early = rendered(scene, WORK / "canyon_early.jpg")
    pictures = {"kept": now, "without water": dry, "20 s earlier": early}
    mean = {name: float(np.abs(kept - picture).mean()) for name, picture in pictures.items()}
    print("mean difference of 255:", ", ".join(f"{name} {value:.2f}" for name, value in mean.items()))
    check(mean["kept"] < 2, f"the picture is the one that is kept ({WORK / 'canyon.jpg'}): {mean['kept']:.2f}")
    check(mean["without water"] > 6 and mean["20 s earlier"] > 6, f"other pictures are told apart: {mean}")


bpy.ops.extensions.package_install_files(filepath=sys.argv[2], repo="user_default", enable_on_install=True)
import wadi  # noqa: E402
from bl_ext.user_default.wadi_blender import bake, interface, objects, terrain  # noqa: E402

check("user/extensions/.local" in pathlib.Path(wadi.__file__).as_posix(), f"wadi is the wheel's: {wadi.__file__}")
parts = {name[5:]: value for name, value in list(globals().items()) if name.startswith("part_")}
for name, part in parts.items():
    asked = [word for word in sys.argv[3:] if word != "--store"]
    if asked and name not in asked:
        continue
    begun, before = time.perf_counter(), len(failures)
    try:
        part()
    except Exception:  # the other parts are run, too
        failures.append(name)
        traceback.print_exc()
    print(f"{name}: {'yes' if len(failures) == before else 'FAILED'} ({time.perf_counter() - begun:.0f} s)")
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.wadi_blender")
left = [handler for handler in bpy.app.handlers.frame_change_pre if "wadi" in getattr(handler, "__module__", "")]
check(not hasattr(bpy.types.Scene, "wadi") and not left, "switched off, nothing is left")
print(f"{checks} checks passed, {len(failures)} failed" if not failures else f"{checks} checks, failed: {failures}")
sys.exit(bool(failures))
