#!/usr/bin/env python3
"""The quick report from start to end: its pages, that a run that was broken off goes on, that a point repeats, that bad input is refused
in one line, and that what it measures is what the solver promises.

usage: quick.py WADI_REPORT BIN_FOLDER"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile


def run(report, programs, *arguments, code=0):
    done = subprocess.run([sys.executable, str(report), str(programs), *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == code, f"{arguments}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def main():
    report, programs = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    quick = ("--quick", "--repeats", "1", "--price-rounds", "1", "--processor-time")  # other tests want the other cores
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        first = run(report, programs, *quick, "--out", out).stdout
        kept = (out / "results.jsonl").read_text().splitlines()
        stored = [line for line in kept if '"point": "price: ' not in line]
        assert "100 %" in first and len(stored) > 60, first
        assert "Broken off" not in (out / "README.md").read_text()

        # Broken off: the last ten rows are lost, one of them in mid-line. A page made in no time lacks them and says so; then only they are
        # measured again.
        (out / "results.jsonl").write_text("\n".join(kept[:-10]) + "\n" + kept[-10][:40])
        prices = (out / "prices.csv").read_text()
        run(report, programs, *quick, "--out", out, "--minutes", "0", code=1)
        assert f"Broken off: 10 of {len(stored)} points are not measured." in (out / "README.md").read_text()
        second = run(report, programs, *quick, "--out", out).stdout
        assert f"{len(stored) - 10} of {len(stored)} points are there already" in second, second

        assert (out / "prices.csv").read_text() == prices  # measured once

        rows = {row["point"]: row for row in csv.DictReader((out / "results.csv").open())}
        assert len(rows) == len(stored)
        assert all(row["failed"] == "" for row in rows.values())

        def error(point):
            return float(rows[point]["error"])

        # Each with a control: what must not be as good.
        assert error("stoker@n400,dt1,T3,robust") < 0.6 * error("stoker@n100,dt1,T3,robust") < error("stoker@n400,dt1,T3,published")
        assert error("ritter@n400,dt1,T3,robust") < 0.6 * error("ritter@n100,dt1,T3,robust") < error("ritter@n400,dt1,T3,published")
        for scene, most in (("wave", 0.5), ("stoker", 0.8), ("ritter", 0.6), ("transcritical", 0.6), ("jump", 0.6), ("mound", 0.6), ("planar", 0.2)):  # second order pays
            sizes = sorted(int(point.split("@n")[1].split(",")[0]) for point in rows if point.startswith(scene + "@") and point.endswith("second_order"))
            assert error(f"{scene}@n{sizes[1]},dt1,T3,second_order") < error(f"{scene}@n{sizes[2]},dt1,T3,robust"), scene
            assert error(f"{scene}@n{sizes[1]},dt1,T3,second_order") < most * error(f"{scene}@n{sizes[1]},dt1,T3,robust"), scene
        assert error("thacker@n96,dt1,T3,second_order") < 0.6 * error("thacker@n96,dt1,T3,robust")
        assert error("planar@n200,dt1,T3,robust") < 4 < error("planar@n200,dt1,T3,published")
        assert error("transcritical@n100,dt1,T3,robust") < 4 < error("transcritical@n50,dt1,T3,robust")
        assert error("jump@n100,dt1,T3,robust") < 2.5 < error("jump@n50,dt1,T3,robust")
        assert error("dupuit@n112,dt1,T3,robust") < 0.5 < error("dupuit@n56,dt1,T3,robust") < 5 < error("dupuit@n112,dt1,T3,published")
        for scene in ("drained_slide", "soaked_slide"):
            assert error(f"{scene}@n160,dt1,T3,robust") < 0.01, scene
            found = dict(re.findall(r"(velocity of dry sand|velocity): ([\d.]+) m/s", rows[f"{scene}@n160,dt1,T3,robust"]["measures"]))
            assert float(found["velocity"]) > 1.5 * float(found["velocity of dry sand"]), found  # what it would be without buoyancy
        assert error("thacker@n96,dt1,T3,robust") < 4 < error("thacker@n48,dt1,T3,robust")
        assert error("mound@n128,dt1,T3,robust") < 1.5 < error("mound@n32,dt1,T3,robust")
        assert error("drag_pair@n64,dt1,T3,robust") < 1 < error("drag_pair@n16,dt1,T3,robust")
        assert error("column@n96,dt1,T3,robust") < 8 < error("column@n96,dt1,T3,published")  # a cell is 3.4
        for scene in ("island", "heap", "wall"):
            assert error(f"{scene}@n64,dt1,T3,robust") < 2, scene
            assert error(f"{scene}@n64,dt1,T3,robust") < error(f"{scene}@n32,dt2,T3,robust"), scene
        for point in ("island@n128,dt1,T3", "wall@n128,dt1,T2"):
            assert error(f"{point},second_order") < error(f"{point},robust"), point
        assert error("wall@n64,dt1,T3,robust,elastoplastic=off") > 1.5 * error("wall@n64,dt1,T3,robust")
        assert float(rows["wall@n64,dt4,T3,no_quantum"]["drift"]) > 1e-9 > float(rows["wall@n64,dt1,T3,robust"]["drift"]) == 0

        priced = {row["point"].removeprefix("price: "): row for row in csv.DictReader((out / "prices.csv").open())}
        passes = {what: int(row["passes"] or 0) for what, row in priced.items()}  # a busy machine cannot change these
        assert passes["effect elastoplastic off"] < passes["everything"] == passes["no_limiter"] < passes["published"], passes
        assert 0 < float(priced["ledger"]["saved"]) < 20, priced
        # One pair of runs. The ci preset has vector code of most masks for AVX-512 alone: checked code of -Og takes thirty times as long, and
        # where it runs beside other tests one pair scatters by more than half.
        if float(priced["everything"]["ms_per_step"]) < 3:
            assert float(priced["effect elastoplastic off"]["saved"]) > 15, priced

        for point in ("stoker@n100,dt1,T3,robust", "stoker@n100,dt1,T3,second_order"):
            again = run(report, programs, "--point", point).stdout
            assert re.search(r"^error: ([\d.]+)", again, re.M)[1] == rows[point]["error"], again

        page = (out / "report.html").read_text()
        assert page.count("<svg") >= 4 and "http://" not in page.replace("http://www.w3.org/2000/svg", "") and "https://" not in page
        text = (out / "README.md").read_text()
        assert "| pays? |" in text and re.search(r"Smooth wave[^\n]*\| yes", text), text
        frontiers = re.findall(r"`((?:island|wall)@n128[^`]*second_order)`", text)
        assert {point[:4] for point in frontiers} == {"isla", "wall"}, frontiers
        for chart in re.findall(r"\]\(([^)]+\.svg)\)", text):
            assert (out / chart).is_file(), chart
        # Either half alone, from rows that are there.
        for half, there, lacks in (("--prices", "## What safety costs", "Error against time"), ("--no-prices", "## Error against time", "What safety costs")):
            part = out / half.strip("-")
            part.mkdir()
            (part / "results.jsonl").write_text("\n".join(kept) + "\n")
            run(report, programs, *quick, half, "--out", part)
            written = (part / "README.md").read_text()
            assert there in written and lacks not in written and (part / "prices.csv").exists() == (half == "--prices") != (part / "results.csv").exists(), written
        assert json.loads(stored[0])["point"] in rows
        assert all(f"\n| {what} |" in text for what in priced), text

    for arguments, says in ((("--point", "stoker@100"), "SCENE@nCELLS"), (("--point", "moon@n8,dt1,T1,robust"), "no scene"),
                            (("--point", "wall@n8,dt1,T1,magic"), "no choice"), (("--only", "moon"), "no scene"), (("--prices", "--only", "wall"), "--prices")):
        last = run(report, programs, *arguments, code=2).stderr.strip().splitlines()[-1]
        assert says in last, last
    print("OK")


if __name__ == "__main__":
    main()
