#!/usr/bin/env python3
"""`conformance perf` on the CPU at 128 x 128, what plot.py and compare_perf.py make of its CSV, and limits.py of Nsight Compute's. Usage: test_perf_tools.py CONFORMANCE."""
import csv
import gzip
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import limits
import perf_table

here = pathlib.Path(__file__).parent


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


with tempfile.TemporaryDirectory() as folder:
    table = pathlib.Path(folder) / "perf.csv"
    table.write_text(run(sys.argv[1], "perf", "--backend", "cpu", "--max-size", 128, "--repeats", 2, "--output", "csv"))
    steps = [row for row in perf_table.read(table) if row["row"].startswith("step, ")]
    assert len(steps) == 7, steps
    for row in steps:
        assert 0 < row["floor_ms"] < row["median_ms"] <= row["p95_ms"], row
        assert row["bytes_per_cell"] == {"step, all effects": 168, "step, sand of the paper": 132}.get(row["row"], row["bytes_per_cell"]), row
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
    # Counters of two whole steps, of 100 and 60 us, half of whose issue slots and a quarter of whose memory were busy.
    barrier = "smsp__average_warps_issue_stalled_barrier_per_issue_active.ratio"
    columns = ["Kernel Name", limits.TIME, limits.EXECUTED, limits.RATE, limits.ISSUE, limits.MEMORY, limits.WARPS, limits.WAVES, barrier]
    kernel = lambda stage, ns: [f"void wadi_stage_cuda_{stage}::run<1, 1>(int)", ns, "1,000,000", 1e12, 50, 25, 40, 2, 1.5]
    rows = [columns, [""] * len(columns), kernel("transport_sand", 9000), *[kernel(limits.ONCE_A_STEP[0], 40000), kernel("transport_sand", 60000), kernel(limits.ONCE_A_STEP[0], 55000), kernel("transport_sand", 5000)],
            kernel(limits.ONCE_A_STEP[0], 40000)]

    def counters(rows):
        with gzip.open(pathlib.Path(folder) / "level_64.csv.gz", "wt", newline="") as file:
            csv.writer(file).writerows(rows)
        return subprocess.run([sys.executable, here / "limits.py", "--page", "--out", folder], capture_output=True, text=True)

    said = counters(rows)
    assert "| level_64 | 2 | 0.080 | 0.040 | 0.020 | 2 | 80 | 0.003 |" in said.stdout and "| `step_mixed_water` | 1 | 47.5 | 50 | 25 | 40 | 2.0 | barriers 1.5 |" in said.stdout, said
    alone = counters([columns, [""] * len(columns), *[["void run<1, 0>(WorldParams)", *kernel("x", 30000)[1:]]] * 3])
    assert "| level_64 | 1 | 0.030 |" in alone.stdout and "| `step_water` | 1 | 30.0 |" in alone.stdout, alone
    part = counters(rows[:5])
    assert part.returncode != 0 and "no whole step" in part.stderr, part
torch = subprocess.run([sys.executable, here / "torch_times.py", "64"], capture_output=True, text=True)
assert torch.returncode in (0, 77) and ("| water, 64 x 64 |" if torch.returncode == 0 else "SKIPPED") in torch.stdout, torch
print("five whole steps measured and compared, three drawn")
