#!/usr/bin/env python3
"""`conformance perf` on the CPU at 128 x 128, and what plot.py and compare_perf.py make of its CSV. Usage: test_perf_tools.py CONFORMANCE."""
import csv
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import perf_table

here = pathlib.Path(__file__).parent


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


with tempfile.TemporaryDirectory() as folder:
    table = pathlib.Path(folder) / "perf.csv"
    table.write_text(run(sys.argv[1], "perf", "--backend", "cpu", "--max-size", 128, "--repeats", 2, "--output", "csv"))
    steps = [row for row in perf_table.read(table) if row["row"].startswith("step, ")]
    assert len(steps) == 6, steps
    for row in steps:
        assert 0 < row["floor_ms"] < row["median_ms"] <= row["p95_ms"], row
        assert row["bytes_per_cell"] == {"step, half storage": 108, "step, all effects": 144, "step, sand of the paper": 124}.get(row["row"], row["bytes_per_cell"]), row
        assert row["world_bytes"] > row["bytes_per_cell"] * 128 * 128 and row["host_us_median"] > 0, row
    # Half a dozen of 289 tiles move: left out, the others cost nothing and change no bit.
    tiles = run(sys.argv[1], "perf-tiles", "--backend", "cpu", "--size", 256, "--shares", 0.01, "--tiles", "0,16", "--steps", 10, "--repeats", 1)
    dense, tiled = csv.DictReader(tiles.splitlines())
    assert dense["hash"] == tiled["hash"] and float(dense["awake"]) == 1 and 0 < float(tiled["awake"]) < 0.5, (dense, tiled)
    picture = pathlib.Path(folder) / "plot.svg"
    run(sys.executable, here / "plot.py", picture, table)
    lines = xml.parse(picture).getroot().findall("{http://www.w3.org/2000/svg}polyline")
    assert len(lines) == 7, len(lines)  # of robust alone: three times, the floor, three memories
    ratios = run(sys.executable, here / "compare_perf.py", table, table, 128)
    assert "| step, all effects |" in ratios and "| 1.00 |" in ratios, ratios
    empty = subprocess.run([sys.executable, here / "plot.py", picture, "/dev/null"], capture_output=True, text=True)
    assert empty.returncode != 0 and "no rows" in empty.stderr, empty
print("five whole steps measured and compared, three drawn")
