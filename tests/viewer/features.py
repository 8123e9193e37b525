#!/usr/bin/env python3
"""Each feature of a picture, taken away, must be noticed: small pictures from close by, each against its stored one with everything drawn and
without one feature at a time. Usage: features.py VIEWER [--store]   --store writes the stored pictures anew, after a look at them."""
import sys
import tempfile
from pathlib import Path

from offscreen import IMAGES, Viewer
from pictures import read_png

# Scene: what the viewer is asked for, and the features that it shows.
SCENES = {
    "ground": ("spring --grid 64x64 --start 0.01 --camera=-110,-24,0.06,0.3,0.3", "grain ripples glitter"),
    "sea": ("beach --grid 160x128 --start 0.2 --camera=-20,-30,0.2,0.5,0.3", "waves reflection refraction caustics"),
    "shore": ("dam_break --grid 96x96 --start 3 --camera=-40,-12,0.3,0.5,0.5", "flow-map foam wet-sand"),
    "swash": ("flush --grid 64x64 --start 4 --camera=low", "mud wetness"),
    "horizon": ("castle --grid 128x64 --start 0.1 --camera=-60,-2,0.6,0.5,0.5", "haze clouds"),
    "cliffs": ("canyon --grid 100x128 --start 0.1 --camera=-25,-30,0.3,0.5,0.7", "rock shadows"),
}
SAME, OTHER = 0.12, 0.24  # mean difference of the channels, in steps of 255: below the first two pictures are one, above the second they are not


def difference(a, b):
    assert a[:2] == b[:2], f"sizes {a[:2]} and {b[:2]}"
    return sum(sum(abs(p - q) for p, q in zip(*rows)) for rows in zip(a[2], b[2])) / (3 * a[0] * a[1])


def main():
    store = "--store" in sys.argv
    with tempfile.TemporaryDirectory() as folder:
        viewer = Viewer(sys.argv[1], Path(folder))
        unnamed = viewer.run("piles", "--offscreen", "--without", "everything", code=2).stderr
        known = set(unnamed.split("is none of", 1)[1].split())
        tested = [feature for _, names in SCENES.values() for feature in names.split()]
        assert sorted(tested) == sorted(known), f"features without a test or tests without a feature: {known.symmetric_difference(tested)}"
        for scene, (words, names) in SCENES.items():
            level, *arguments = [*words.split(), "--backend", "cpu", "--size", "240x135"]
            shot, file = viewer.picture(scene, level, *arguments), IMAGES / f"feature_{scene}.png"
            if store:
                file.write_bytes((viewer.folder / scene / "frame_00000.png").read_bytes())
            stored = read_png(file)
            off = difference(shot, stored)
            print(f"{scene}: {off:.3f} from its stored picture")
            assert off < SAME, f"{scene} differs from its stored picture by {off:.3f}, allowed are {SAME}"
            for feature in names.split():
                off = difference(viewer.picture(f"{scene}_{feature}", level, *arguments, "--without", feature), stored)
                print(f"  without {feature}: {off:.3f}")
                assert off > OTHER, f"{scene}: nobody would notice that {feature} is gone: {off:.3f}"
    print("features: each is seen")


if __name__ == "__main__":
    main()
