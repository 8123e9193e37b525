"""tests/lab/report/frontier.py on small grids: its page answers, and what it measures has the order that theory and experience give it.
Controls: an exact solution for another depth ahead of the dam must fail, and a time step at which gravity is capped makes no row. Needs numpy.

usage: frontier_quick.py FRONTIER BIN_FOLDER"""
import csv
import dataclasses
import pathlib
import subprocess
import sys
import tempfile

script, programs = pathlib.Path(sys.argv[1]), sys.argv[2]
sys.path.insert(0, str(script.parent))
import exact  # noqa: E402
import frontier  # noqa: E402
import recordings  # noqa: E402


def run(*arguments):
    return subprocess.run([sys.executable, str(script), programs, "--processor-time", *arguments], capture_output=True, text=True, check=False)


with tempfile.TemporaryDirectory() as folder:
    sizes = ("--sizes", "24", "48", "--out", folder)
    done = run(*sizes)
    assert done.returncode == 0, done
    page = (pathlib.Path(folder) / "README.md").read_text()
    rows = {(row["case"], int(row["n"]), row["method"]): row for row in csv.DictReader((pathlib.Path(folder) / "results.csv").open())}
    error = {key: float(row["error"]) for key, row in rows.items() if row["error"]}
    assert len(rows) == 4 * 2 * 4 and len(error) >= 28, (len(rows), len(error))
    for case in ("bore", "bowl", "mound"):
        assert error[case, 48, "order 1"] < 0.8 * error[case, 24, "order 1"], (case, error)
        assert error[case, 48, "order 2"] < 0.8 * error[case, 48, "order 1"], (case, error)
    for case in ("bore", "bowl", "column", "mound"):  # which traces velocities back, and heaps dry sand as a fluid
        assert error[case, 48, "published"] > 1.3 * error[case, 48, "order 1"], (case, error)
        assert (pathlib.Path(folder) / f"{case}_cpu.svg").stat().st_size > 2000, case
    assert error["column", 48, "order 1"] < 8, error
    assert "| what moves | 0.25 ms a frame |" in page and "the paper's own method" in page and "`balanced` of 24²" in page, page
    again = run(*sizes)
    assert again.returncode == 0 and (pathlib.Path(folder) / "README.md").read_text() == page, "kept rows give another page"

    written = subprocess.run([sys.executable, str(script), "--page", "--out", folder], capture_output=True, text=True, check=False)
    assert written.returncode == 0 and (pathlib.Path(folder) / "README.md").read_text() == page, written

    rows_file = pathlib.Path(folder) / "rows_cpu.jsonl"  # as if they had come from a GPU: both kinds on one page
    (pathlib.Path(folder) / "rows_gpu.jsonl").write_text(rows_file.read_text())
    subprocess.run([sys.executable, str(script), "--page", "--out", folder], check=True)
    both = (pathlib.Path(folder) / "README.md").read_text()
    assert both.count("| what moves |") == 2 and both.index("## On a GPU") < both.index("## On a CPU") and "bore_gpu.svg" in both, both
    stale = pathlib.Path(folder) / "rows_gpu.jsonl"  # control: rows of other sources have no place there
    stale.write_text(stale.read_text().replace('"sources": "', '"sources": "0'))
    written = subprocess.run([sys.executable, str(script), "--page", "--out", folder], capture_output=True, text=True, check=True)
    assert "rows_gpu.jsonl: of other sources" in written.stdout and (pathlib.Path(folder) / "README.md").read_text() == page, written

    short = run("--sizes", "16", "24", "48", "--only", "bore", "--row-seconds", "0", "--out", f"{folder}/short")
    left_out = (pathlib.Path(folder) / "short" / "README.md").read_text()
    assert short.returncode == 0 and left_out.count("left out: some") == 4 and "| 24², order 1" in left_out, left_out

    case = frontier.CASES["bore"]
    wrong = dataclasses.replace(case, error=lambda now, dx, t: frontier.frontier_cases.of_truth(
        now[now.shape[0] // 2], [exact.stoker((i + 0.5) * dx, t, 1, 0.3, 25) for i in range(now.shape[1])], 1))
    frontier.CASES["bore"] = wrong
    with recordings.Recorder(f"{programs}/wadi-recorder", "cpu", 1, True) as recorder:
        row = frontier.measure(recorder, "bore", 48, "order 1")
        frontier.CASES["mound"] = dataclasses.replace(frontier.CASES["mound"], step=0.2)  # whose error would be that of the cap
        capped = frontier.measure(recorder, "mound", 48, "order 1")
    assert row["error"] > 3 * error["bore", 48, "order 1"], row
    assert capped["error"] is None and "gravity is capped" in capped["why"], capped
    for refused in (("--sizes", "8", "16"), ("--sizes", "64"), ("--only", "bores"), ("--backend", "vulkan"), ("--page",)):
        done = run(*refused, "--out", folder)
        assert done.returncode == 2 and "error: " in done.stderr, done
print("OK")
