#!/usr/bin/env python3
"""Runs wadi-recorder through its success and error cases. Usage: recorder_cli.py RECORDER [--backend NAME]"""

import argparse
import json
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from recorded_files import boxes, inside, png_pixels, png_size, read_npy, read_table

OK, BAD_INPUT, RUN_FAILED = 0, 2, 3
LEVEL = "dam_break"
SUMMARY_KEYS = {
    "level", "completed", "steps", "simulated_seconds", "wall_seconds", "processor_seconds", "loading_seconds", "figures_seconds",
    "picture_seconds", "ms_per_step", "stages", "ledger", "extremes", "counts",
    "hash", "passes", "bytes_per_cell", "device", "warnings",
}


class Recorder:
    def __init__(self, program, backend, folder):
        self.program = str(Path(program).resolve())
        self.backend = backend
        self.folder = folder
        self.environment = dict(os.environ)

    def command(self, *arguments):
        return [self.program, *[str(a) for a in arguments]]

    def run(self, *arguments, code=OK):
        done = subprocess.run(self.command(*arguments), cwd=self.folder, capture_output=True, text=True, timeout=300, check=False,
                              env=self.environment)
        assert done.returncode == code, f"{arguments}: exit code {done.returncode}, not {code}\n{done.stdout}\n{done.stderr}"
        return done

    def record(self, *arguments, code=OK):
        return self.run(LEVEL, "--backend", self.backend, "--size", "40x12", "--dt", "0.01", *arguments, code=code)

    def refuse(self, *arguments, says):
        """A refused call writes one line on standard error, which says what is wrong, and leaves no file. Where the level was read
        before, its warnings and notes come first."""
        before = sorted(self.folder.rglob("*"))
        done = self.run(*arguments, code=BAD_INPUT)
        lines = [line for line in done.stderr.strip().splitlines() if not line.startswith(("warning: ", "note: "))]
        assert len(lines) == 1, f"{arguments}: want one line, got {lines}"
        for word in says:
            assert word in lines[0], f"{arguments}: \"{word}\" is not in: {lines[0]}"
        assert sorted(self.folder.rglob("*")) == before, f"{arguments}: files were left behind"


def test_lists(recorder):
    assert "cpu" in recorder.run("--list-backends").stdout
    lines = recorder.run("--list-levels").stdout.splitlines()
    names = [line.split()[0] for line in lines if not line.startswith(" ")]
    assert LEVEL in names, names
    assert names == sorted(names)
    assert any("--variant" in line for line in lines), lines
    assert "--dump" in recorder.run("--help").stdout


def test_plan(recorder):
    assert "water" in recorder.record("--print-plan").stdout.lower()
    assert not (recorder.folder / "out").exists()


def test_refusals(recorder):
    recorder.refuse(says=["--list-levels"])
    recorder.refuse("dam_braek", says=["dam_braek", LEVEL])
    recorder.refuse("nowhere/level.json", says=["nowhere/level.json"])
    recorder.refuse("--terrain", "nowhere.png", says=["nowhere.png"])
    recorder.refuse(LEVEL, "--terrain", "nowhere.png", says=["--terrain"])
    recorder.refuse(LEVEL, "--unknown-option", says=["--unknown-option"])
    recorder.refuse(LEVEL, "--backend", "abacus", says=["abacus"])
    recorder.refuse(LEVEL, "--backend", "cpu", "--device", 1000, says=["1000"])
    for size in ("0x5", "40", "40x", "40x12x3", "-4x12", "99999x2", "axb"):
        recorder.refuse(LEVEL, f"--size={size}", says=["--size", size])
    recorder.refuse(LEVEL, "--dt", "-1", says=["--dt"])
    recorder.refuse(LEVEL, "--seconds", "soon", says=["--seconds"])
    recorder.refuse(LEVEL, "--every", "0", says=["--every"])
    recorder.refuse(LEVEL, "--method", "alchemy", says=["alchemy"])
    recorder.refuse(LEVEL, "--dump", "hs", says=["--dump", "hs"])
    recorder.refuse(LEVEL, "--dump", "gold@1", says=["gold", "hs"])
    recorder.refuse(LEVEL, "--dump", "hs@now", says=["now"])
    recorder.refuse(LEVEL, "--dump", "hs@-1", says=["-1"])
    recorder.refuse(LEVEL, "--seconds", "0.1", "--dump", "hs@5", says=["hs@5", "--seconds"])
    recorder.refuse(LEVEL, "--gauge", "5", says=["--gauge 5", "x,y"])
    recorder.refuse(LEVEL, "--gauge", "5,nan", says=["--gauge 5,nan", "x,y"])
    recorder.refuse(LEVEL, "--section", "5,6", says=["--section 5,6", "x0,y0,x1,y1"])
    recorder.refuse(LEVEL, "--size", "40x12", "--gauge", "5,29", says=["--gauge 5,29", "28.8"])
    recorder.refuse(LEVEL, "--size", "40x12", "--section", "5,5,97,5", says=["--section 5,5,97,5", "96"])
    (recorder.folder / "a_file").write_text("not a folder\n", encoding="utf-8")
    recorder.refuse(LEVEL, "--seconds", "0.1", "--out", "a_file/out", says=["a_file/out"])
    recorder.refuse(LEVEL, "--seconds", "0.1", "--summary", "a_file/in/summary.json", says=["a_file/in"])
    (recorder.folder / "broken.json").write_text("{ \"name\": ", encoding="utf-8")
    recorder.refuse("broken.json", says=["broken.json"])
    (recorder.folder / "rain.csv").write_text("0,0.001\n", encoding="utf-8")
    (recorder.folder / "inner").mkdir()
    level = {"format_version": 1, "name": "inner", "grid": {"nx": 4, "ny": 4, "dx": 1}, "dt": 0.01, "rain": {"file": "../rain.csv"}}
    (recorder.folder / "inner" / "level.json").write_text(json.dumps(level), encoding="utf-8")
    recorder.refuse("inner/level.json", says=["../rain.csv", "outside the level's folder"])
    recorder.run("inner/level.json", "--any-files", "--backend", recorder.backend, "--print-plan")


def test_frames(recorder):
    done = recorder.record("--seconds", "0.5", "--every", "0.25", "--out", "frames")
    folder = recorder.folder / "frames"
    names = sorted(path.name for path in folder.iterdir())
    assert names == ["contact_sheet.png", "frame_00000.png", "frame_00001.png", "frame_00002.png"], names
    for name in names[1:]:
        width, height = png_size(folder / name)
        assert width >= 800 and height > 240, (name, width, height)
    assert png_size(folder / "contact_sheet.png")[0] > 0
    frame, later = png_pixels(folder / names[1]), png_pixels(folder / names[3])
    assert frame[0][0] == frame[-1][-1] == (24, 27, 31), "the caption and the legend have another background"
    changed = [y for y, (a, b) in enumerate(zip(frame, later)) if a != b]
    assert len(frame) == len(later) and changed and changed[-1] < len(frame) - 60, "only caption and map change, not the legend"
    assert "hash" in done.stdout and "ledger" in done.stdout
    assert "100 %" in done.stderr
    recorder.record("--seconds", "0", "--out", "jpeg", "--jpeg")
    assert (recorder.folder / "jpeg" / "contact_sheet.jpg").read_bytes()[:3] == b"\xff\xd8\xff"
    recorder.record("--seconds", "0", "--out", "frames")
    names = sorted(path.name for path in folder.iterdir())
    assert names == ["contact_sheet.png", "frame_00000.png"], f"frames of the earlier recording are left: {names}"


def test_first_picture(recorder):
    """One command, and somebody's grid of heights is a picture to look at: shaded ground, a river where the valley is, its deepest
    place as blue as colours go, dry ridges, a picture of each moment, and what to try next. Controls: no water is seen ahead of the
    rain, and less of it is on the slopes than in the valley."""
    columns, rows = 48, 40

    def valley(j):  # its column in row j from the north
        return 23.5 + 5 * math.sin(0.16 * j)

    def height(i, j):
        beside = i - valley(j)
        rough = 9 * math.sin(0.55 * i) * math.cos(0.4 * j)
        return 900 + 1.5 * (rows - j) + 60 * (1 - math.exp(-((beside / 9) ** 2))) + rough * (1 - math.exp(-((beside / 7) ** 2)))

    lines = [" ".join("-9999" if i + j < 7 else f"{height(i, j):.2f}" for i in range(columns)) for j in range(rows)]
    header = f"ncols {columns}\nnrows {rows}\nxllcorner 612000\nyllcorner 5180000\ncellsize 10\nNODATA_value -9999\n"
    (recorder.folder / "valley.asc").write_text(header + "\n".join(lines) + "\n", encoding="utf-8")
    done = recorder.run("--terrain", "valley.asc")
    assert "28 cells without a height reach the map's rim: taken for outside" in done.stderr, done.stderr
    assert "next: wadi-import MAP" in done.stdout, done.stdout
    folder = recorder.folder / "out" / "valley"
    names = sorted(path.name for path in folder.glob("frame_*.png"))
    assert len(names) == 11, names

    def look(name):
        pixels = png_pixels(folder / name)
        cell = len(pixels[0]) // columns
        top = next(y for y, row in enumerate(pixels) if row[0] != (24, 27, 31))

        def at(i, j):
            return pixels[top + int((j + 0.5) * cell)][int((i + 0.5) * cell)]

        cells = [at(i, j) for j in range(rows) for i in range(columns)]
        wet = [blue > red + 20 for red, _, blue in cells]
        greys = [sum(pixel) / 3 for pixel, water in zip(cells, wet) if not water]
        river, slope = ([wet[j * columns + round(valley(j)) - beside] for j in range(rows)] for beside in (0, 9))
        deep = sum(water and red < 60 for water, (red, _, _) in zip(wet, cells))
        return sum(wet) / len(wet), sum(river) / rows, sum(slope) / rows, deep / len(wet), max(greys, default=0) - min(greys, default=0)

    dry, *_, shades = look(names[0])
    assert dry == 0 and shades > 80, (dry, shades)
    wet, river, slope, deep, shades = look(names[5])
    assert 0.05 < wet < 0.4 and river > 0.9 and slope < 0.3 and 0.01 < deep < 0.15 and shades > 80, (wet, river, slope, deep, shades)


def test_default_folder(recorder):
    recorder.record("--seconds", "0")
    assert (recorder.folder / "out" / LEVEL / "frame_00000.png").exists()


def test_dumps(recorder):
    done = recorder.record("--seconds", "0.5", "--no-frames", "--dump", "hs,W@0.2,0.5", "--dump", "H@0", "--out", "dumps")
    folder = recorder.folder / "dumps"
    names = sorted(path.name for path in folder.iterdir())
    assert names == ["H_0.npy", "W_0.2.npy", "W_0.5.npy", "hs_0.2.npy", "hs_0.5.npy"], names
    for name in names:
        nx, ny, values = read_npy(folder / name)
        assert (nx, ny) == (40, 12), (name, nx, ny)
        assert all(value == value for value in values), name
        assert name in done.stdout, f"{name} is not announced"
    assert max(read_npy(folder / "W_0.5.npy")[2]) > 0


def test_points(recorder):
    """Gauges and sections against dumped fields, interpolated here."""
    dx = 96 / 40
    asked = [(15.5 * dx, 4.5 * dx), (17.3, 11.1)]
    line = (5.0, 3.0, 60.0, 20.0)
    names = ("H", "hs", "W", "uw", "vw")
    arguments = [f"--gauge={x},{y}" for x, y in asked] + ["--section", "5,3,60,20", "--section", "1,1,1,9", "--gauge=96,28.8"]
    recorder.record("--seconds", "1", "--every", "0.5", "--no-frames", "--dump", ",".join(names) + "@0.5,1", "--out", "points", *arguments)
    folder = recorder.folder / "points"
    assert not list(folder.glob("*.part"))
    gauges, sections = read_table(folder / "gauges.csv"), read_table(folder / "sections.csv")
    assert [(row["time"], row["gauge"]) for row in gauges] == [(t, n) for t in (0, 0.5, 1) for n in range(3)], gauges
    assert (gauges[-1]["x"], gauges[-1]["y"]) == (96, 28.8)
    along = [row for row in sections if row["time"] == 1 and row["section"] == 0]
    ends = along[0], along[-1]
    assert tuple(end[key] for end in ends for key in "xy") == line, ends
    length = math.hypot(line[2] - line[0], line[3] - line[1])
    assert math.isclose(ends[1]["distance"], length, rel_tol=1e-8) and len(along) == math.ceil(length / dx) + 1, len(along)

    moving = 0
    for row in gauges + sections:
        if row["time"] == 0:
            continue
        fields = {name: read_npy(folder / f"{name}_{row['time']:g}.npy") for name in names}

        def between(value, x, y):
            """Bilinear between places x, y of an array; beyond the outermost centres it repeats them."""
            x, y = max(x, 0), max(y, 0)
            i, j = min(int(x), 39), min(int(y), 11)
            a, b = x - i, y - j
            return ((value(i, j) * (1 - a) + value(i + 1, j) * a) * (1 - b)
                    + (value(i, j + 1) * (1 - a) + value(i + 1, j + 1) * a) * b)

        def at(name, i, j):
            return fields[name][2][min(j, 11) * 40 + min(i, 39)]

        def face(name, i, j, beside):
            """From cell centres, which hold the mean of their two faces, and the wall in the west or south, where it is 0."""
            if beside == 0:
                return 0
            before = face(name, i, j, beside - 1)
            return 2 * (at(name, beside - 1, j) if name == "uw" else at(name, i, beside - 1)) - before

        x, y = row["x"] / dx, row["y"] / dx
        want = {
            "terrain": between(lambda i, j: at("H", i, j), x - 0.5, y - 0.5),
            "sand_depth": between(lambda i, j: at("hs", i, j), x - 0.5, y - 0.5),
            "water_depth": between(lambda i, j: max(at("W", i, j) - at("hs", i, j), 0), x - 0.5, y - 0.5),
            "surface": between(lambda i, j: at("H", i, j) + max(at("W", i, j), at("hs", i, j)), x - 0.5, y - 0.5),
            "velocity_x": between(lambda i, j: face("uw", i, j, i), x, y - 0.5),
            "velocity_y": between(lambda i, j: face("vw", i, j, j), x - 0.5, y),
        }
        for key, value in want.items():
            assert abs(row[key] - value) < 1e-4, (row, key, value)
        moving += row["water_depth"] > 0.1 and abs(row["velocity_x"]) > 0.1
    assert moving > 5, f"{moving} points with water that moves: the case shows nothing"


def test_gauge_beside_wall(recorder):
    """Between the last cell of a lake and a wall the surface is half wall; that of the water is the lake's."""
    level = {"format_version": 1, "name": "wall", "grid": {"nx": 16, "ny": 4, "dx": 1}, "dt": 0.02,
             "terrain": [{"shape": "box", "from": [8, 0], "to": [16, 4], "height": 10}],
             "water": [{"shape": "box", "from": [0, 0], "to": [8, 4], "surface": 3}]}
    (recorder.folder / "wall.json").write_text(json.dumps(level), encoding="utf-8")
    recorder.run("wall.json", "--backend", recorder.backend, "--seconds", "0", "--no-frames", "--out", "wall",
                 *(f"--gauge={x},2" for x in (4, 7.9, 8, 12)))
    rows = read_table(recorder.folder / "wall/gauges.csv")
    lake, near, edge, wall = rows[-4:]
    assert lake["surface"] == lake["water_surface"] == 3, lake
    assert near["surface"] > 5 and edge["surface"] == 6.5, (near, edge)
    assert abs(near["water_surface"] - 3) < 1e-5 and abs(edge["water_surface"] - 3) < 1e-5, (near, edge)
    assert wall["surface"] == 10 and math.isnan(wall["water_surface"]), wall


def test_check(recorder):
    """--check ends at the step that breaks a promise, and names it; control: without it the same world goes on, a sound one with it too."""
    level = {"format_version": 1, "name": "leaky", "grid": {"nx": 40, "ny": 36, "dx": 0.2}, "dt": 0.2,
             "method": {"outflow_limiter": False, "velocity_clamp": 0.9},
             "water": [{"shape": "box", "from": [0, 0], "to": [3, 4], "height": 2}]}
    (recorder.folder / "leaky.json").write_text(json.dumps(level), encoding="utf-8")
    leaky = ("leaky.json", "--backend", recorder.backend, "--seconds", "4", "--no-frames")
    said = recorder.run(*leaky, "--check", code=RUN_FAILED).stderr
    assert "checking: after step " in said and "promised: " in said, said
    recorder.run(*leaky)
    recorder.record("--seconds", "0.1", "--no-frames", "--check")


def test_until_calm(recorder):
    """--until-calm ends a run that swings and comes to rest where it says, in the state that a run of those seconds has. Controls: the same
    without it, a speed that is not reached, and a push late in the run, ahead of which the world rests."""
    swings = {"format_version": 1, "name": "swings", "grid": {"nx": 24, "ny": 8, "dx": 0.1}, "dt": 0.01, "duration": 30,
              "material": {"manning": 0.1}, "water": [{"shape": "plane", "height": 0.04},
                                                      {"shape": "box", "from": [0, 0], "to": [1.2, 0.8], "height": 0.03}]}
    pushed = {**swings, "name": "pushed", "water": swings["water"][:1], "edits": [
        {"time": 8, "kind": "push", "shape": "disc", "center": [1.2, 0.4], "radius": 0.4, "velocity": [1, 0]}]}
    for level in (swings, pushed):
        (recorder.folder / f"{level['name']}.json").write_text(json.dumps(level), encoding="utf-8")

    def summary(name, *arguments):
        text = recorder.run(f"{name}.json", "--backend", recorder.backend, "--no-frames", "--summary", "calm.json", *arguments).stdout
        return json.loads((recorder.folder / "calm.json").read_text(encoding="utf-8")), text

    whole, _ = summary("swings")
    assert "calm_since" not in whole and abs(whole["simulated_seconds"] - 30) < 0.02
    calm, text = summary("swings", "--until-calm", "0.05,2", "--dump", "W@0,30", "--out", "calm")
    since, end = calm["calm_since"], calm["simulated_seconds"]
    assert calm["completed"] and 1 < since < 20 and 1.99 < end - since < 2.3, (since, end)
    assert f"calm      since {since:.6g} s: nothing faster than 0.05 m/s" in text, text
    assert (recorder.folder / "calm" / "W_30.npy").exists(), "what is asked for later shows the end"
    assert summary("swings", "--seconds", end)[0]["hash"] == calm["hash"]
    for end, slow in ((since, True), (since - 0.25, False)):  # two seconds over eight looks
        last = float(re.search(r"speed of water \[m/s\] +(\S+)", summary("swings", "--seconds", end)[1])[1])
        assert (last <= 0.05) is slow, (end, last)
    never, text = summary("swings", "--until-calm", "1e-9,2", "--seconds", 10)
    assert never["calm_since"] is None and abs(never["simulated_seconds"] - 10) < 0.02 and "calm      not yet" in text, text
    late, _ = summary("pushed", "--until-calm", "0.05,2")
    assert late["calm_since"] > 8, late["calm_since"]
    for bad in ("0.02", "0,5", "-1,5", "nan,5", "0.02,0", "0.02,x", "2e4,5", "0.02,5,1"):
        recorder.refuse("swings.json", "--until-calm", bad, says=[f"--until-calm {bad}", "above 0", "1e-7 ... 1e9 s"])


def test_summary(recorder):
    def summary(*arguments):
        recorder.record("--seconds", "0.5", "--no-frames", "--summary", "summary.json", *arguments)
        return json.loads((recorder.folder / "summary.json").read_text(encoding="utf-8"))

    first = summary()
    assert SUMMARY_KEYS <= first.keys(), SUMMARY_KEYS - first.keys()
    assert first["completed"] is True and first["steps"] > 0
    assert abs(first["simulated_seconds"] - 0.5) <= first["grid"]["dt"]
    assert len(first["hash"]) == 16 and int(first["hash"], 16) >= 0
    assert first["device"].keys() >= {"backend", "name", "exact_float"}
    one = summary("--threads", 1)  # its steps wait for nobody: on one thread a processor is busy for no longer than the clock runs
    assert 0 < one["processor_seconds"] < 1.05 * one["stepping_seconds"] + 0.001 or recorder.backend != "cpu", one
    for layer in ("water", "sand"):
        assert first["ledger"][layer].keys() >= {"initial_m3", "in_m3", "out_m3", "now_m3", "relative_drift", "drift_quanta"}
        assert abs(first["ledger"][layer]["relative_drift"]) < 1e-6, first["ledger"]
    assert first["counts"]["not_finite"]["largest"] == 0
    assert first["extremes"]["smallest_depth_m"] >= 0
    assert first["stages"] == []
    assert not (recorder.folder / "out").exists(), "--no-frames without dumps creates no folder"
    recorder.record("--seconds", "0", "--no-frames", "--summary", "made/for/it.json")
    assert (recorder.folder / "made" / "for" / "it.json").exists()

    profiled = summary("--profile")
    assert profiled["hash"] == first["hash"], "profiling changes the result"
    assert profiled["stages"] and all(stage.keys() >= {"name", "ms", "passes"} for stage in profiled["stages"])
    assert sum(stage["passes"] for stage in profiled["stages"]) == profiled["passes"]["per_step"], profiled["passes"]


def test_video_refusals(recorder):
    recorder.refuse(LEVEL, "--mp4", "--no-frames", says=["--mp4"])
    recorder.refuse(LEVEL, "--fps", 25, says=["--mp4"])
    recorder.refuse(LEVEL, "--mp4", "--fps", 0, says=["--fps"])
    recorder.environment["PATH"] = str(recorder.folder)
    recorder.refuse(LEVEL, "--mp4", says=["--mp4", "ffmpeg", "Debian"])
    if os.name != "posix":
        return
    failing = recorder.folder / "ffmpeg"
    failing.write_text("#!/bin/sh\nexit 3\n", encoding="utf-8")
    failing.chmod(0o755)
    done = recorder.record("--seconds", "0", "--mp4", "--out", "video", code=BAD_INPUT)
    assert "recording.mp4" in done.stderr and "code 3" in done.stderr, done.stderr
    assert sorted(p.name for p in (recorder.folder / "video").iterdir()) == ["contact_sheet.png", "frame_00000.png"]


def test_video(recorder):
    if shutil.which("ffmpeg") is None:
        return "SKIPPED: no program ffmpeg in PATH"
    folder = recorder.folder / "50%d"  # a pattern of numbers, were it not taken as it is
    done = recorder.run(LEVEL, "--backend", recorder.backend, "--size", "801x101", "--dt", "0.001", "--seconds", "0.005", "--every",
                        "0.001", "--mp4", "--fps", 10, "--out", folder.name)
    assert "6 frames, recording.mp4" in done.stdout, done.stdout
    data = (folder / "recording.mp4").read_bytes()
    kinds = [kind for kind, _, _ in boxes(data)]
    assert kinds[0] == b"ftyp" and kinds.index(b"moov") < kinds.index(b"mdat"), kinds
    tables = (b"moov", b"trak", b"mdia", b"minf", b"stbl")
    sample = inside(data, *tables, b"stsd")[8:]
    assert sample[4:8] == b"avc1", sample[:16]
    width, height = png_size(folder / "frame_00000.png")
    assert width % 2 == 1, "the case is about sizes that H.264 does not have"
    assert struct.unpack(">HH", sample[32:36]) == (width + width % 2, height + height % 2), struct.unpack(">HH", sample[32:36])
    assert struct.unpack(">I", inside(data, *tables, b"stsz")[8:12])[0] == 6
    scale, duration = struct.unpack(">II", inside(data, b"moov", b"mvhd")[12:20])
    assert abs(duration / scale - 0.6) < 0.01, (scale, duration)
    recorder.record("--seconds", "0", "--out", folder.name)
    assert not (folder / "recording.mp4").exists(), "the video of the earlier recording is left"


def test_interrupt(recorder):
    arguments = recorder.command(LEVEL, "--backend", recorder.backend, "--size", "40x12", "--seconds", "100000", "--every", "1000")
    with subprocess.Popen(arguments + ["--out", "cut", "--summary", "cut.json"], cwd=recorder.folder, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as process:
        deadline = time.monotonic() + 60
        while not (recorder.folder / "cut" / "frame_00000.png").exists():
            assert time.monotonic() < deadline and process.poll() is None, "no first frame"
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=60)
    assert process.returncode == OK, (process.returncode, stderr)
    assert "hash" in stdout and "interrupted" in stdout
    assert (recorder.folder / "cut" / "contact_sheet.png").exists()
    cut = json.loads((recorder.folder / "cut.json").read_text(encoding="utf-8"))
    assert cut["interrupted"] is True and cut["completed"] is False
    assert not list((recorder.folder / "cut").glob("*.part"))


def test_gpu_clock(recorder, nvml):
    """The clock of the GPU that steps, told by a stand-in for the driver's library."""
    def summary(names):
        recorder.environment.update(LD_LIBRARY_PATH=str(Path(nvml).resolve().parent), FAKE_GPUS=names)
        said = recorder.record("--seconds", "0.5", "--no-frames", "--summary", "summary.json").stdout
        told = json.loads((recorder.folder / "summary.json").read_text(encoding="utf-8"))
        assert ("MHz while stepping" in said) == ("gpu_clock" in told), said
        return told

    name = summary("another")["device"]["name"]
    clock = summary("another|" + name)["gpu_clock"]
    assert clock["readings"] > 0 and clock["last_mhz"] == clock["slowest_mhz"] == 1990 - 10 * clock["readings"], clock
    for others in ("another", name + "|" + name):  # not there; which of two is not known
        assert "gpu_clock" not in summary(others), others


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recorder")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--nvml", help="libnvidia-ml.so.1 of fake_nvml.c")
    options = parser.parse_args()
    tests = [test_frames, test_dumps, test_points, test_gauge_beside_wall, test_check, test_until_calm, test_summary]
    if options.backend == "cpu":  # what meets no device
        tests += [test_lists, test_plan, test_refusals, test_first_picture, test_default_folder, test_video_refusals, test_video]
    if os.name == "posix":
        tests.append(test_interrupt)
    for test in tests:
        with tempfile.TemporaryDirectory(prefix="wadi_recorder_") as folder:
            skipped = test(Recorder(options.recorder, options.backend, Path(folder)))
        print(f"{test.__name__}: {skipped or 'OK'}")
    if options.nvml:
        with tempfile.TemporaryDirectory(prefix="wadi_recorder_") as folder:
            test_gpu_clock(Recorder(options.recorder, options.backend, Path(folder)), options.nvml)
        print("test_gpu_clock: OK")
    return 0


if __name__ == "__main__":
    sys.exit(main())
