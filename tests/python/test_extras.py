"""What needs more packages than NumPy: xarray, rasterio, matplotlib, tqdm; and maps."""
import importlib
import sys

import numpy as np
import pytest
import wadi

CPU = {"backend": "cpu", "log": False}
HEIGHTS = np.add.outer(np.linspace(0, 8, 24), np.linspace(4, 0, 32)).astype("f4")  # rises to the north and the west


@pytest.fixture
def dam():
    water = np.zeros((16, 48))
    water[:, :16] = 1
    with wadi.World(water=water, sand=np.full((16, 48), 0.25), dx=0.5, name="dam", **CPU) as world:
        yield world


@pytest.mark.parametrize("module, extra, use", [
    ("tqdm", "progress", lambda world: world.run(0.1, progress=True)), ("xarray", "xarray", lambda world: world.to_xarray()),
    ("rasterio", "maps", lambda world: wadi.write_geotiff("a.tif", np.ones((2, 2)), 1)), ("matplotlib", "plot", lambda world: wadi.plot.map(world))])
def test_a_package_that_is_missing_is_named_with_its_extra(dam, monkeypatch, module, extra, use):
    for name in [name for name in sys.modules if name.partition(".")[0] == module]:
        monkeypatch.delitem(sys.modules, name)
    real = importlib.import_module

    def missing(name, package=None):
        if name.partition(".")[0] == module:
            raise ImportError(f"No module named '{module}'")
        return real(name, package)

    monkeypatch.setattr(importlib, "import_module", missing)
    with pytest.raises(wadi.MissingExtraError, match=rf'needs {module}.*pip install "wadi\[{extra}\]"'):
        use(dam)


def test_progress_bar(dam, capsys):
    pytest.importorskip("tqdm")
    dam.run(0.5, progress=True)
    assert "dam:" in capsys.readouterr().err
    dam.run(0.5, progress=False)
    assert capsys.readouterr().err == ""


def test_xarray_has_units_and_coordinates(dam):
    pytest.importorskip("xarray")
    data = dam.to_xarray(["water_depth", "water_velocity_x", "saturation"])
    assert data.water_depth.dims == ("y", "x") and np.array_equal(data.water_depth, dam.read("water_depth"))
    assert [data[name].units for name in ("water_depth", "water_velocity_x", "saturation", "x")] == ["m", "m s-1", "1", "m"]
    assert np.array_equal(data.x, dam.x) and np.array_equal(data.y, dam.y)
    recording = dam.record(0.4, 0.1, ["water_depth"], {"west": (2, 4), "east": (20, 4)})
    data = recording.to_xarray()
    assert data.water_depth.dims == ("time", "y", "x") and np.array_equal(data.time, recording.times)
    assert data.gauge_water_depth.sel(gauge="west")[0] == recording.gauges["west"]["water_depth"][0]
    assert data.gauge_x.values.tolist() == [2, 20]


def test_geotiff_keeps_values_holes_and_place(tmp_path):
    pytest.importorskip("rasterio")
    heights = HEIGHTS.copy()
    heights[3, 5] = np.nan
    wadi.write_geotiff(tmp_path / "a.tif", heights, 2.0, (600000.0, 5200000.0), "EPSG:32632", name="dem")
    read = wadi.read_geotiff(tmp_path / "a.tif")
    assert np.array_equal(read.heights, heights, equal_nan=True)
    assert read.dx == 2 and read.origin == (600000, 5200000) and "32632" in read.crs
    finer = wadi.read_geotiff(tmp_path / "a.tif", cell=1)
    assert finer.dx == 1 and finer.heights.shape == (48, 64) and abs(finer.heights[40, 50] - HEIGHTS[20, 25]) < 0.3
    for bad, text in (((tmp_path / "a.tif", None, 2), "band 2, must be 1 ... 1"), ((tmp_path / "none.tif",), "none.tif")):
        with pytest.raises(wadi.BadFileError, match=text):
            wadi.read_geotiff(*bad)
    with pytest.raises(ValueError, match="values: their shapes"):
        wadi.write_geotiff(tmp_path / "b.tif", {"a": np.ones((2, 2)), "b": np.ones((2, 3))}, 1)


def test_geotiff_in_degrees_becomes_metres(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    from rasterio.transform import from_origin

    with rasterio.open(tmp_path / "deg.tif", "w", driver="GTiff", width=32, height=24, count=1, dtype="float32", crs="EPSG:4326",
                       transform=from_origin(11.0, 47.0, 1 / 3600, 1 / 3600)) as out:
        out.write(HEIGHTS[::-1], 1)
    read = wadi.read_geotiff(tmp_path / "deg.tif")
    assert "UTM zone 32N" in read.crs and 20 < read.dx < 31
    inside = read.heights[np.isfinite(read.heights)]
    assert inside.size > 0.8 * read.heights.size and inside.min() >= 0 and inside.max() <= 12
    with pytest.raises(wadi.BadFileError, match="does not say where it lies"):
        with rasterio.open(tmp_path / "nowhere.tif", "w", driver="GTiff", width=2, height=2, count=1, dtype="float32") as out:
            out.write(np.ones((2, 2), "f4"), 1)
        wadi.read_geotiff(tmp_path / "nowhere.tif")


@pytest.mark.parametrize("kind", ["asc", "tif", "npy", "hgt"])
def test_import_keeps_heights_and_coordinates(tmp_path, kind):
    path, given, expected, dx, origin = tmp_path / f"valley.{kind}", {}, HEIGHTS, 2.0, (600000.0, 5200000.0)
    if kind == "asc":
        wadi.write_asc(path, HEIGHTS, 2.0, origin)
    elif kind == "tif":
        pytest.importorskip("rasterio")
        wadi.write_geotiff(path, HEIGHTS, 2.0, origin, "EPSG:32632")
    elif kind == "npy":
        np.save(path, HEIGHTS[::-1])
        given, origin = {"cell": 2.0, "flip": "y"}, None
    else:
        path = tmp_path / "N47E011.hgt"
        expected = np.arange(1201 * 1201).reshape(1201, 1201) % 300
        path.write_bytes(expected[::-1].astype(">i2").tobytes())
        dx = origin = None
    level = wadi.import_map(path, tmp_path / "level", preview=True, **given)
    assert (tmp_path / "level/preview.png").exists()
    if kind == "hgt":  # a tile of 1.4 million cells: its level says what it is
        assert level.exists() and wadi.level_cost(level).cells > 1e6
        return
    with wadi.World(level, **CPU) as world:
        terrain = world.read("terrain")
        assert world.dx == dx and (origin is None or world.origin == origin)
        assert abs((terrain - terrain.min()) - (expected - expected.min())).max() < 0.01
        if origin:
            data = pytest.importorskip("xarray") and world.to_xarray()
            assert data.x[0] == origin[0] + 1 and data.y.standard_name == "projection_y_coordinate"
            pytest.importorskip("rasterio")
            wadi.write_geotiff(tmp_path / "out.tif", {"terrain": terrain, "depth": world.read("water_depth")}, world.dx, world.origin, "EPSG:32632")
            assert wadi.read_geotiff(tmp_path / "out.tif").origin == origin


def test_import_says_what_the_program_says(tmp_path):
    (tmp_path / "bad.asc").write_text("ncols 2\nnrows 2\n1 2\n3\n")
    with pytest.raises(wadi.BadFileError, match="bad.asc"):
        wadi.import_map(tmp_path / "bad.asc", tmp_path / "level")


def test_pictures(dam, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    recording = dam.record(1.0, 0.1, ["terrain", "sand_depth", "water_depth"], {"west": (2, 4), "east": (20, 4)})
    shown = wadi.plot.map(recording, frame=2)
    assert np.array_equal(shown.images[-1].get_array().filled(0), np.where(recording.fields["water_depth"][2] < 1e-3, 0, recording.fields["water_depth"][2]))
    assert shown.images[-1].get_extent() == (0, 24, 0, 8) and shown.get_title() == f"dam, t = {recording.times[2]:.4g} s"
    cut = wadi.plot.section(dam, y=4)
    assert len(cut.collections) == 3 and cut.get_xlabel() == "x [m]"
    assert wadi.plot.section(recording, x=4, frame=0).get_xlabel() == "y [m]"
    lines = wadi.plot.hydrograph(recording).lines
    assert [line.get_label() for line in lines] == ["west", "east"] and np.array_equal(lines[0].get_ydata(), recording.gauges["west"]["water_depth"])
    assert wadi.plot.hydrograph(recording, "speed", gauges=["west"]).get_ylabel() == "speed of water [m/s]"
    moving = wadi.plot.animation(recording)
    moving.save(tmp_path / "a.gif", writer="pillow")
    assert (tmp_path / "a.gif").stat().st_size > 1000
    flat = wadi.plot.relief(np.zeros((4, 4)), 1.0)
    slope = wadi.plot.relief(HEIGHTS, 2.0)
    assert np.allclose(flat, np.sin(np.pi / 4)) and slope.mean() < flat.mean()  # it falls to the south-east, away from the light
    rises_east = np.arange(8.0) * np.ones((8, 1))
    assert wadi.plot.relief(rises_east, 2.0).min() > flat.max() > wadi.plot.relief(rises_east[:, ::-1], 2.0).max()
    for call, text in ((lambda: wadi.plot.map(recording, "saturation"), "saturation"), (lambda: wadi.plot.section(dam, x=1, y=1), "not both"),
                       (lambda: wadi.plot.section(dam, y=50), "must lie in 0"), (lambda: wadi.plot.hydrograph(dam.record(0.1, 0.1)), "no gauges")):
        with pytest.raises((KeyError, TypeError, ValueError), match=text):
            call()
    matplotlib.pyplot.close("all")
