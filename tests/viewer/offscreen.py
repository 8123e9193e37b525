#!/usr/bin/env python3
"""Pictures of wadi-viewer without a window: against stored ones, and for what must be in them.
Usage: offscreen.py VIEWER [--store]   --store writes the stored pictures anew, after a look at them."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from pictures import alike, black_pixels, blue, difference, pixels, read_png, sandy, share

IMAGES = Path(__file__).parent / "images"
# Time [s] and grid of a level: half as fine as its own and early, for slow machines.
SCENES = {"beach": (1.0, "160x128"), "canyon": (6.0, "100x128"), "castle": (2.0, "128x64"), "dam_break": (3.0, "96x96"), "flush": (1.5, "128x128"),
          "letters": (0.5, "160x80"), "piles": (0.5, "168x112"), "seepage": (1.0, "128x64"), "spring": (0.5, "128x128"), "wadi": (1.0, "224x144")}


class Viewer:
    def __init__(self, program, folder):
        self.program, self.folder = str(Path(program).resolve()), folder

    def run(self, *arguments, code=0):
        done = subprocess.run([self.program, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=600, check=False)
        if done.returncode != code:
            raise AssertionError(f"{arguments}: exit code {done.returncode}, not {code}\n{done.stdout}\n{done.stderr}")
        return done

    def picture(self, name, level, *arguments):
        self.run(level, "--offscreen", "--out", name, "--quality", "low", *arguments)
        return read_png(self.folder / name / "frame_00000.png")


def test_checks_can_fail():
    grey = (12, 12, (bytes([90, 90, 90] * 12),) * 12)
    hole = (12, 12, (bytes([90, 90, 90] * 12),) * 11 + (bytes([90, 90, 90] * 11 + [0, 0, 0]),))
    sea = (12, 12, (bytes([20, 90, 130] * 12),) * 12)
    assert black_pixels(grey) == 0 and black_pixels(hole) == 1
    assert share(grey, blue) == 0 and share(sea, blue) == 1
    assert alike(grey, grey) and not alike(grey, sea)


def test_levels(viewer, store):
    shots, stored = {}, {}
    for level, (start, grid) in SCENES.items():
        shot = shots[level] = viewer.picture(level, level, "--backend", "cpu", "--start", start, "--grid", grid, "--size", "192x108")
        assert black_pixels(shot) == 0, f"{level}: {black_pixels(shot)} black pixels"
        if store:
            (IMAGES / f"{level}.png").write_bytes((viewer.folder / level / "frame_00000.png").read_bytes())
        stored[level] = read_png(IMAGES / f"{level}.png")
        print(f"{level}: mean and 98 % of the differences {difference(shot, stored[level])}")
        assert alike(shot, stored[level]), f"{level} differs from its stored picture: {difference(shot, stored[level])}"
    for level, shot in shots.items():
        for other in SCENES:
            if other != level:
                assert not alike(shot, stored[other]), f"the comparison takes {level} for {other}"


def test_water_is_where_water_is(viewer):
    """Seen from above at the start, dam_break has water on 39 m x 40 m of 96 m x 96 m, in the south-west."""
    for backend in ("cpu", "vulkan"):
        shot = viewer.picture(f"top_{backend}", "dam_break", "--backend", backend, "--camera", "top", "--grid", "96x96", "--size", "200x200")
        width, height, rows = shot
        corner = (0, 0, [row[:3 * (width // 2)] for row in rows[height // 2:]])
        south_west = (width // 2, height - height // 2, corner[2])
        north_east = (width - width // 2, height // 2, [row[3 * (width // 2):] for row in rows[:height // 2]])
        print(f"{backend}: water on {share(south_west, blue):.3f} of the south-west, {share(north_east, blue):.3f} of the north-east; "
              f"sand on {share(north_east, sandy):.3f} of the north-east")
        # 39 x 40 of 48 x 48 m, less the margin round the block, more the near top of the column
        assert 0.45 < share(south_west, blue) < 0.85
        assert share(north_east, blue) < 0.01
        assert 0.05 < share(north_east, sandy) < 0.5


def test_backends_agree(viewer):
    """The outputs read in place on the device and those that came through host memory make the same picture."""
    one, other = (viewer.picture(f"same_{b}", "dam_break", "--backend", b, "--start", 1, "--grid", "96x96", "--size", "192x108") for b in ("cpu", "vulkan"))
    mean, most = difference(one, other)
    print(f"backends: {mean:.3f}, {most:.3f}")
    assert mean < 1.5 and most < 14 # the outputs of one are interpolated in time, one step late, and the net of foam shows it


def part(picture, left, top, right, bottom):
    """A rectangle in shares of the whole."""
    width, height, rows = picture
    x0, x1, y0, y1 = int(left * width), int(right * width), int(top * height), int(bottom * height)
    return x1 - x0, y1 - y0, [row[3 * x0:3 * x1] for row in rows[y0:y1]]


def above_lowest(r, g, b):
    """Of the false colours: the lowest is dark blue with less green than red."""
    return g > r + 6 or r > b


def test_views(viewer):
    """Dry ground is the lowest colour of every quantity of water, deep water the highest."""
    depth = viewer.picture("depth", "dam_break", "--backend", "cpu", "--camera", "top", "--grid", "96x96", "--size", "120x120", "--view", "depth")
    reds = share(depth, lambda r, g, b: r > 120 and g < 110 and b < 100)
    print(f"view depth: {reds:.3f} of the picture in the highest colour")
    assert 0.05 < reds < 0.3
    for view, start in (("strain", 2), ("stress", 2), ("active", 1)): # not outputs: read on the host
        shot = viewer.picture(view, "dam_break", "--backend", "cpu", "--camera", "top", "--size", "120x120", "--grid", "96x96", "--start", start, "--view", view)
        north_west, south_west, east = part(shot, 0.1, 0.1, 0.3, 0.3), part(shot, 0.1, 0.7, 0.3, 0.9), part(shot, 0.55, 0.1, 0.9, 0.9)
        print(f"view {view}: above the lowest colour {share(north_west, above_lowest):.3f} north-west, {share(south_west, above_lowest):.3f} south-west, {share(east, above_lowest):.3f} east")
        assert share(north_west, above_lowest) == 0 # dry rock
        assert (share(south_west, above_lowest) > 0.9) == (view == "active") # water
        assert share(east, above_lowest) > 0.05 # two heaps of sand
    held = viewer.picture("limits", "dam_break", "--variant", "paper", "--backend", "cpu", "--camera", "top", "--size", "120x120", "--grid", "96x96", "--start", 1, "--view", "limits")
    red = lambda r, g, b: r > 120 and g < 110 and b < 100
    fronts, rock = share(held, lambda r, g, b: r > 120 and g > 110 and b < 120), share(part(held, 0.1, 0.1, 0.3, 0.3), above_lowest)
    print(f"view limits: {fronts:.3f} of the picture at the speed limit, {rock:.3f} of dry rock")
    assert 0.01 < fronts < 0.5 and rock == 0 and share(held, red) == 0
    for largest in (1, 4): # water that runs against a side stands above 1 m there, and nowhere above 4 m
        level = viewer.folder / f"surge_{largest}.json"
        level.write_text(json.dumps({"format_version": 1, "name": "surge", "grid": {"nx": 48, "ny": 48, "dx": 0.5}, "dt": 0.02,
                                     "water": [{"shape": "plane", "height": 0.75}], "method": {"largest_height": largest},
                                     "velocities": [{"shape": "plane", "of": "water", "velocity": [-4, 0]}]}), encoding="utf-8")
        high = viewer.picture(level.stem, str(level), "--backend", "cpu", "--camera", "top", "--size", "120x120", "--start", 1, "--view", "limits")
        print(f"view limits: {share(high, red):.3f} of the picture above a largest height of {largest} m")
        assert share(part(high, 0.5, 0, 1, 1), red) == 0 and (share(high, red) > 0.01) == (largest == 1)
    plain = viewer.picture("plain", "dam_break", "--backend", "cpu", "--camera", "top", "--size", "120x120", "--grid", "96x96", "--start", 2)
    arrows = viewer.picture("arrows", "dam_break", "--backend", "cpu", "--camera", "top", "--size", "120x120", "--grid", "96x96", "--start", 2, "--arrows")
    changed = sum(1 for p, q in zip(pixels(plain), pixels(arrows)) if p != q)
    assert changed > 50, f"arrows change {changed} pixels"


def test_qualities_and_cameras(viewer):
    for quality in ("medium", "high"):
        viewer.run("piles", "--offscreen", "--out", quality, "--backend", "cpu", "--grid", "84x56", "--size", "96x54", "--quality", quality)
        assert black_pixels(read_png(viewer.folder / quality / "frame_00000.png")) == 0, quality
    viewer.run("piles", "--offscreen", "--out", "jpeg", "--backend", "cpu", "--grid", "84x56", "--size", "96x54", "--quality", "low", "--jpeg")
    assert (viewer.folder / "jpeg" / "frame_00000.jpg").read_bytes()[:3] == b"\xff\xd8\xff"
    for camera in ("opposite", "top", "close", "low"):
        assert black_pixels(viewer.picture(camera, "canyon", "--backend", "cpu", "--camera", camera, "--grid", "100x128", "--size", "96x54")) == 0, camera
    for grid in ("1x40", "40x1"):
        thin = viewer.picture(f"thin_{grid}", "dam_break", "--backend", "cpu", "--grid", grid, "--size", "61x47")
        assert black_pixels(thin) == 0, grid
    odd = viewer.picture("odd", "dam_break", "--backend", "cpu", "--grid", "37x5", "--size", "61x47")
    assert odd[:2] == (61, 47) and black_pixels(odd) == 0


def test_refusals(viewer):
    for words, says in ((["nowhere"], "nowhere"), (["piles", "--size", "9x9"], "16 ... 8192"), (["piles", "--quality", "best"], "low medium high"),
                        (["piles", "--view", "mood"], "froude"), (["piles", "--camera", "front"], "overview"), (["piles", "--camera", "0,-100,1,0.5,0.5"], "-89 ... -1"),
                        (["piles", "--camera", "0,nan,1,0.5,0.5"], "-89 ... -1"), (["piles", "--variant", "wet"], "no_retention"), (["piles", "--gpu", "40"], "--list-gpus"),
                        (["piles", "--backend", "abacus"], "abacus"), (["piles", "--frames", "0"], "--frames")):
        done = viewer.run(*words, "--offscreen", code=2)
        assert says in done.stderr, f"{words}: \"{says}\" is not in: {done.stderr}"


def test_validated(viewer):
    """No message of the validation layers, synchronization included, with the world on the viewer's own device."""
    for view in ("picture", "strain", "active"):
        done = viewer.run("dam_break", "--offscreen", "--out", "validated", "--backend", "vulkan", "--grid", "48x48", "--frames", 3, "--size", "96x54", "--view", view, "--validate")
        assert "validation 0 messages" in done.stdout, done.stdout


def main():
    store = "--store" in sys.argv
    with tempfile.TemporaryDirectory() as folder:
        viewer = Viewer(sys.argv[1], Path(folder))
        test_checks_can_fail()
        test_levels(viewer, store)
        test_water_is_where_water_is(viewer)
        test_backends_agree(viewer)
        test_views(viewer)
        test_qualities_and_cameras(viewer)
        test_refusals(viewer)
        test_validated(viewer)
    print("viewer off screen: all well")


if __name__ == "__main__":
    main()
