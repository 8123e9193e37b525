#!/usr/bin/env python3
"""A wheel as a newcomer meets it: installed into an empty environment, in a folder where nothing of the sources is. Measures the time from
"pip install" to the picture of a dam break. Usage: wheel.py WHEEL [PICTURE.png]; needs PyPI for NumPy and matplotlib."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

MOST_SECONDS = 120
root = pathlib.Path(__file__).resolve().parents[2]

# What the page of the package shows first, with a plot.
DAM_BREAK = """
import numpy as np
import wadi
import matplotlib
matplotlib.use("Agg")
from matplotlib import pyplot

water = np.zeros((32, 128))
water[:, :64] = 1
with wadi.World(water=water, dx=0.25) as world:
    world.run(2)
    pyplot.plot(world.x, world.read("water_depth")[16])
pyplot.xlabel("x [m]")
pyplot.ylabel("depth [m]")
pyplot.savefig("dam_break.png")
"""
SMOKE = """
import importlib.metadata, pathlib, subprocess, sys
import numpy as np
import wadi

assert (pathlib.Path(wadi.__file__).parent / "py.typed").is_file()
assert wadi.__version__ == importlib.metadata.version("wadi"), wadi.__version__
assert pathlib.Path(wadi._library.path).parent == pathlib.Path(wadi.__file__).parent / "lib", wadi._library.path
water = np.zeros((32, 128))
water[:, :64] = 1
with wadi.World(water=water, dx=0.078125, dt=0.01, backend="cpu", log=False) as world:
    world.step(60)
    print(f"hash {world.hash():016x}")
levels = wadi.levels()
assert len(levels) == LEVELS, levels
for name, file in levels.items():
    with wadi.World(file, backend="cpu", log=False) as world:
        world.step(1)
try:
    world = wadi.World(water=water, dx=1, backend="cpu", log=False)
    world.run(0.1, progress=True)
    sys.exit("a bar without tqdm")
except wadi.MissingExtraError as error:
    assert 'pip install "wadi[progress]"' in str(error), error
for program in ("record", "tune", "import"):
    done = subprocess.run([sys.executable, "-m", "wadi", program, "--help"], capture_output=True, text=True)
    assert done.returncode == 0 and "--" in done.stdout, done
done = subprocess.run([sys.executable, "-m", "wadi", "record", "castle", "--seconds", "0.5", "--every", "0.25", "--out", "frames", "--backend", "cpu"],
                      capture_output=True, text=True)
assert done.returncode == 0 and list(pathlib.Path("frames").rglob("*.png")), done
done = subprocess.run([sys.executable, "-m", "wadi", "record", "no_such_level"], capture_output=True, text=True)
assert done.returncode != 0 and "no_such_level" in done.stderr, done
done = subprocess.run([sys.executable, "-m", "wadi", "view"], capture_output=True, text=True)
assert done.returncode == 1 and "wadi-viewer" in done.stderr, done
done = subprocess.run([sys.executable, "-m", "wadi", "draw"], capture_output=True, text=True)
assert done.returncode == 2 and 'there is no program "draw"' in done.stderr, done
"""


def main():
    wheel = pathlib.Path(sys.argv[1]).resolve()
    picture = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
    environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "WADI_LIBRARY", "VIRTUAL_ENV", "WADI_LEVELS")}
    levels = len(list((root / "samples/levels").glob("*/level.json")))
    with tempfile.TemporaryDirectory() as folder:
        def run(*command):
            done = subprocess.run([str(word) for word in command], cwd=folder, env=environment, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{' '.join(map(str, command))[:200]} failed:\n{done.stdout}{done.stderr}")
            return done.stdout

        run("/usr/bin/python3" if pathlib.Path("/usr/bin/python3").exists() else "python3", "-m", "venv", "bare")
        run("bare/bin/pip", "install", "--quiet", "--disable-pip-version-check", wheel)
        said = run("bare/bin/python", "-c", SMOKE.replace("LEVELS", str(levels)))
        expected = (root / "tests/platforms/minimal_host_hash.txt").read_text(encoding="utf-8").strip()
        if f"hash {expected}" not in said:
            sys.exit(f"the smallest host's scene has another hash: {said}, not {expected}")
        print(f"bare environment: hash {expected}, {levels} levels, programs")
        run("/usr/bin/python3" if pathlib.Path("/usr/bin/python3").exists() else "python3", "-m", "venv", "plots")
        begun = time.perf_counter()
        run("plots/bin/pip", "install", "--quiet", "--disable-pip-version-check", f"{wheel}[plot]")
        installed = time.perf_counter()
        run("plots/bin/python", "-c", DAM_BREAK)
        done = time.perf_counter()
        print(f"from pip install to a plot of a dam break: {done - begun:.1f} s, of which {installed - begun:.1f} s install")
        if picture:
            shutil.copy(pathlib.Path(folder) / "dam_break.png", picture)
        if done - begun > MOST_SECONDS:
            sys.exit(f"that is more than {MOST_SECONDS} s")


if __name__ == "__main__":
    main()
