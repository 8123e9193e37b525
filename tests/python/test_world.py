"""Worlds from Python against what C hosts give, and what is refused."""
import gc
import json
import logging
import subprocess
import threading

import numpy as np
import pytest
import wadi

CPU = {"backend": "cpu", "log": False}
DAM = {"format_version": 1, "name": "dam", "grid": {"nx": 64, "ny": 32, "dx": 0.5}, "dt": 0.02,
       "sand": [{"shape": "cylinder", "center": [24, 8], "radius": 3, "height": 1}],
       "water": [{"shape": "box", "from": [0, 0], "to": [8, 16], "height": 1}]}


@pytest.fixture
def world():
    with wadi.World(text=DAM, **CPU) as made:
        yield made


def dam_of_the_smallest_host(**given):
    water = np.zeros((32, 128))
    water[:, :64] = 1
    return wadi.World(water=water, dx=0.078125, dt=0.01, **{**CPU, **given})


def test_bits_of_the_smallest_host(source):
    with dam_of_the_smallest_host() as world:
        for _ in range(60):
            world.step()
        assert f"{world.hash():016x}" == (source / "tests/platforms/minimal_host_hash.txt").read_text().strip()


@pytest.mark.parametrize("level", ["castle", "canyon"])
def test_bits_of_the_recorder(level):
    with wadi.World(wadi.levels()[level], **CPU) as world:
        world.step(40)
        done = subprocess.run([wadi.program("wadi-recorder"), wadi.levels()[level], "--seconds", str(world.time), "--no-frames", "--backend", "cpu"],
                              capture_output=True, text=True)
        assert done.returncode == 0 and f"{world.hash():016x}" in done.stdout, done.stdout + done.stderr


def test_golden_scene_by_text_dict_file_and_arrays(tmp_path, world):
    world.step(20)
    file = tmp_path / "level.json"
    file.write_text(json.dumps(DAM))
    hashes = {world.hash()}
    for made in (wadi.World(text=json.dumps(DAM), **CPU), wadi.World(file, **CPU)):
        with made:
            made.step(20)
            hashes.add(made.hash())
    with wadi.World(text=DAM, **CPU) as start:
        planes = {"sand": start.read("sand_depth"), "water": start.read("total_water_depth")}
        with wadi.World(dx=0.5, dt=0.02, **planes, **CPU) as made:
            made.step(20)
            hashes.add(made.hash())
    assert len(hashes) == 1
    with wadi.World(text={**DAM, "dt": 0.01}, **CPU) as other:
        other.step(20)
        assert other.hash() not in hashes


def test_level_text_with_files(source):
    text = (source / "samples/levels/letters/level.json").read_text()
    folder = source / "samples/levels/letters"
    with wadi.World(folder / "level.json", **CPU) as named:
        named.step(3)
        expected = named.hash()
    asked = []

    def read(name):
        asked.append(name)
        return (folder / name).read_bytes()

    for files in (folder, read):
        with wadi.World(text=text, files=files, **CPU) as made:
            made.step(3)
            assert made.hash() == expected
    assert asked
    with pytest.raises(wadi.Error):
        wadi.World(text=text, files={}, **CPU)

    def fails(name):
        raise RuntimeError("the disk is gone")

    with pytest.raises(RuntimeError, match="the disk is gone"):
        wadi.World(text=text, files=fails, **CPU)


def test_numpy_arrays_lie_as_the_grid_does():
    terrain = np.arange(12.0).reshape(3, 4) / 8
    with wadi.World(terrain=terrain.T.copy().T, dx=2, **CPU) as world:
        assert (world.nx, world.ny) == (4, 3)
        assert np.array_equal(world.read("terrain"), terrain.astype("f4"))
        assert np.array_equal(world.read("terrain", (1, 2, 3, 1)), terrain[2:3, 1:4].astype("f4"))
        assert world.x.tolist() == [1, 3, 5, 7] and world.y.tolist() == [1, 3, 5]
        out = np.empty((3, 4), "f4")
        assert world.read("terrain", out=out) is out and np.array_equal(out, terrain)
        with pytest.raises(ValueError, match=r"out: must be a writeable C-contiguous float32 array of shape \(3, 4\)"):
            world.read("terrain", out=np.empty((4, 3), "f4"))
        with pytest.raises(ValueError, match=r"region: .*, must lie in the grid of 4 x 3 cells"):
            world.read("terrain", (2, 0, 3, 1))


@pytest.mark.parametrize("given, kind, text", [
    ({}, TypeError, "World takes one of: a level's file, text=, arrays"),
    ({"water": np.ones((4, 4))}, TypeError, "arrays need dx="),
    ({"water": np.ones(4), "dx": 1}, ValueError, r"water: its shape is \(4,\), must be \(ny, nx\)"),
    ({"water": np.ones((4, 4)), "sand": np.ones((4, 5)), "dx": 1}, ValueError, r"water: its shape is \(4, 4\), that of the other arrays \(4, 5\)"),
    ({"water": np.ones((4, 4)), "dx": 1, "variant": "wet"}, TypeError, "variant= is for levels and texts"),
    ({"water": np.ones((4, 4)), "dx": 1, "settings": {"grid": {}}}, ValueError, "the grid is that of the arrays"),
    ({"text": DAM, "dx": 1}, TypeError, "dx= is for arrays"),
    ({"water": np.ones((4, 4)), "dx": -1, "dt": 0.1}, wadi.BadFileError, "dx"),
    ({"water": np.full((4, 4), -1.0), "dx": 1, "dt": 0.1}, wadi.Error, "water"),
    ({"text": "{"}, wadi.BadFileError, "line 1, column 2"),
    ({"text": {**DAM, "material": {"fricton": 1}}}, wadi.BadFileError, "fricton"),
    ({"level": "nowhere.json"}, wadi.NotFoundError, "nowhere.json"),
    ({"text": DAM, "backend": "abacus"}, wadi.NotFoundError, "abacus"),
    ({"text": DAM, "accuracy": "some"}, wadi.Error, "accuracy"),
    ({"text": DAM, "active_tiles": "some"}, ValueError, "active_tiles: there is no 'some'; there are off, level"),
    ({"text": DAM, "threads": -1}, wadi.BadArgumentError, "threads"),
    ({"text": DAM, "most": wadi.Cost(cells=100)}, wadi.BadFileError, "100"),
])
def test_refusals_name_the_field(given, kind, text):
    with pytest.raises(kind, match=text):
        wadi.World(**{**CPU, **given})


def test_edits_sources_material_and_the_ledger(world):
    world.pour(4, 8, 0.5, radius=2)
    world.pour(20, 8, 0.25, radius=2, layer="sand", to=(24, 8))
    world.dig(24, 8, 0.5, radius=1)
    world.raise_terrain(28, 4, 0.5)
    world.push(6, 8, (1, 0), radius=2)
    world.stamp(np.ones((2, 2)), (10, 2), (12, 4), 0.25, layer="water")
    world.set_source(0, center=(12, 8), rate=[(0, 0.5), (1, 0.5), (1.1, 0)])
    world.step(30)
    budget = world.budget()
    assert budget["water"]["in"] > 0 and budget["water"]["drift"] == 0 and budget["sand"]["drift"] == 0
    assert world.sources == [{"shape": "disc", "sand": False, "drain": False, "center": (12.0, 8.0), "radius": 1.0,
                              "rate": [(0.0, 0.5), (1.0, 0.5), (1.1, 0.0)]}]
    world.material["friction"] = 0.75
    assert world.material["friction"] == 0.75 and world.material.range("friction") == (0, 10)
    with pytest.raises(wadi.BadArgumentError, match="friction"):
        world.material["friction"] = 11
    with pytest.raises(KeyError):
        world.material["frction"] = 1
    for call, text in ((lambda: world.pour(4, 8, -1), "depth"), (lambda: world.pour(4, 8, 1, radius=0), "radius"),
                       (lambda: world.edit(wadi.Edit(softness=2)), "softness"), (lambda: world.set_source(0, center=(999, 8), rate=1), "outside the grid"),
                       (lambda: world.set_source(32, rate=1), "index: 32, must be 0 ... 31"), (lambda: world.step(-1), "steps: -1, must be 0"),
                       (lambda: world.write("saturation", 1), "field"), (lambda: world.write("sand_depth", np.zeros((2, 2))), "values: their shape"),
                       (lambda: world.write("sand_depth", np.nan), "nan|finite|NaN")):
        with pytest.raises(ValueError, match=text):
            call()


def test_pour_adds_and_dig_takes(world):
    for call, more in ((world.pour, 1), (world.dig, -1)):
        before = world.stats().sand_volume
        call(24, 8, 0.25, radius=2, layer="sand")
        world.step()
        assert more * (world.stats().sand_volume - before) > 0.5


def test_write_and_read_back(world):
    values = np.full((32, 64), 0.25, "f4")
    values[3, 5] = 0.5
    world.write("sand_depth", values)
    assert np.array_equal(world.read("sand_depth"), values)
    world.write("total_water_depth", 0.125, (2, 3, 4, 5), wait=False)
    assert np.array_equal(world.read("total_water_depth", (2, 3, 4, 5)), np.full((5, 4), 0.125))
    assert world.read("total_water_depth", (1, 3, 1, 1)) != 0.125


def test_query_answers_what_the_fields_say(world):
    world.step(10)
    surface, sand = world.read("free_surface"), world.read("sand_depth")
    answers = world.query([(world.x[10], world.y[7]), (world.x[48], world.y[16]), (-5, 0)])
    assert answers["surface"][:2].tolist() == [surface[7, 10], surface[16, 48]]
    assert answers["sand_depth"][1] == sand[16, 48] > 0 and answers["inside"].tolist() == [1, 1, 0]
    with pytest.raises(ValueError, match=r"points: their shape is \(3,\)"):
        world.query([1, 2, 3])


def test_bodies_float_by_archimedes():
    with wadi.World(water=np.full((16, 16), 2.0), dx=1, **CPU) as lake:
        body = wadi.Body(position=(8, 8, 2), half_size=(0.5, 0.5, 0.5))
        force, torque = wadi.buoyancy_force(body, lake.query(wadi.buoyancy_points(body)))
        assert force[2] == pytest.approx(0.5 * 1000 * 9.81, rel=1e-5) and abs(torque).max() < 1e-3
        with pytest.raises(wadi.BadArgumentError, match="radius"):
            wadi.buoyancy_points(wadi.Body(shape="sphere", radius=-1))


def test_saves_roll_back_and_log(world, tmp_path):
    world.set_command_log()
    world.set_rollback(4, 5)
    world.pour(4, 8, 0.5, radius=2, step=3)
    world.step(10)
    snapshot, at_ten = world.save(), world.hash()
    later = world.begin_save()
    while later.result() is None:
        pass
    assert later.result() == snapshot
    world.save_file(tmp_path / "a.snapshot")
    log = world.commands()
    world.step(10)
    at_twenty = world.hash()
    assert world.rollback_steps == [5, 10, 15, 20] and world.roll_back(12) == 10 and world.hash() == at_ten
    world.step(10)
    assert world.hash() == at_twenty
    world.load(snapshot)
    assert (world.hash(), world.steps) == (at_ten, 10)
    world.step(10)
    world.load_file(tmp_path / "a.snapshot")
    assert world.hash() == at_ten and world.snapshot_cost(snapshot).steps == 10
    with wadi.World(text=DAM, **CPU) as other:
        assert other.commands_cost(log).edits_per_step == 1
        other.play_commands(log)
        other.step(10)
        assert other.hash() == at_ten
        spoilt = bytearray(snapshot)
        spoilt[len(spoilt) // 2] ^= 1
        with pytest.raises(wadi.BadFileError):
            other.load(spoilt)
        assert other.hash() == at_ten
        with pytest.raises(wadi.BadArgumentError):
            other.roll_back(3)


def test_run_record_update(world):
    assert world.run(0.05) == pytest.approx(0.06)
    recording = world.record(0.4, 0.1, ["water_depth"], {"west": (2, 8)})
    assert recording.fields["water_depth"].shape == (5, 32, 64) and len(recording) == 5
    assert np.allclose(recording.times, 0.06 + 0.1 * np.arange(5))
    assert recording.gauges["west"]["water_depth"][0] == pytest.approx(1)
    before = world.steps
    frame = world.update(0.045)
    assert frame.steps == 2 and world.steps == before + 2
    for bad in (-1, float("nan")):
        with pytest.raises(ValueError, match="seconds"):
            world.run(bad)


def test_what_it_tells(world, caplog):
    assert world.info.backend == "cpu" and world.info.source_count == 0 and "dam" in repr(world)
    assert {effect.name: effect.on for effect in world.effects}["water"] and "water" in world.plan()
    assert sum(item.bytes for item in world.memory) == world.info.device_bytes
    assert any(device.backend == "cpu" for device in wadi.devices()[0]) and "castle" in wadi.levels()
    assert wadi.level_cost(text=DAM).cells == 64 * 32 and [p.name for p in wadi.accuracy_presets()][0] == "draft"
    assert "grid.nx" in wadi.describe("settings") and wadi.field_name(wadi.Field.SAND_DEPTH) == "hs"
    with pytest.raises(wadi.BadArgumentError):
        wadi.describe("tables")
    world.set_profiling()
    world.step(2)
    assert any(timing.milliseconds > 0 for timing in world.stage_timings)
    world.set_checking()
    world.step(1)
    world.check()
    told = []
    with wadi.World(text=DAM, backend="cpu", log=lambda level, text: told.append((level, text))):
        pass
    assert any(level == wadi.LogLevel.INFORMATION for level, _ in told)
    with caplog.at_level(logging.INFO, "wadi"), wadi.World(text=DAM, backend="cpu"):
        pass
    assert caplog.records


def test_first_lines_of_the_page(source, capsys):
    page = (source / "plugin/python/README.md").read_text()
    exec(page.split("```python\n")[1].split("```")[0], {})
    assert "'drift': 0.0" in capsys.readouterr().out


def test_progress_is_told_and_ends_the_making():
    shares = []
    wadi.World(text=DAM, progress=shares.append, **CPU).close()
    assert shares == sorted(shares) and shares
    with pytest.raises(wadi.CancelledError):
        wadi.World(text=DAM, progress=lambda share: False, **CPU)

    def fails(share):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        wadi.World(text=DAM, progress=fails, **CPU)


def test_closed_worlds_and_other_threads(world):
    other = wadi.World(text=DAM, **CPU)
    other.close()
    other.close()
    assert other.closed and "closed" in repr(other)
    for call in (other.step, other.hash, other.save, lambda: other.read("terrain"), lambda: other.info):
        with pytest.raises(wadi.BadArgumentError, match="world"):
            call()
    errors = []

    def work(made):
        try:
            for _ in range(50):
                made.step()
                made.hash()
        except wadi.Error as error:
            errors.append(error)

    threads = [threading.Thread(target=work, args=(world,)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(isinstance(error, wadi.BusyError) for error in errors)
    world.check()


def test_memory_comes_back():
    import resource

    def rounds(n):
        for _ in range(n):
            with wadi.World(water=np.zeros((256, 256)), dx=1, **CPU) as made:
                made.set_outputs("free_surface")
                made.publish()
                np.asarray(made.view("free_surface")).sum()
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    rounds(5)
    first = rounds(2)
    assert rounds(40) - first < 20000  # kB; a world has some 6000
