#!/usr/bin/env python3
"""Errors of water and sand whose right answer is a formula or a law of the laboratory (water_scenes.py, sand_scenes.py), by cells and order; and that they
are what the solver promises.

usage: tests/lab/report/known_answers.py BIN_FOLDER [--only SCENE ...] [--cells N ...]     a table, the scene's own three sizes by default
       tests/lab/report/known_answers.py BIN_FOLDER --check                                bounds, each with a control that must be worse
"""
import argparse
import pathlib
import sys

import recordings
import sand_scenes
import water_scenes

SCENES = {scene.key: scene for scene in [*water_scenes.all_scenes(), *sand_scenes.all_scenes()]}
ORDERS = {1: {}, 2: {"water_transport_order": 2}}
NO_ORDER = "dry sand"  # where there is no water to move by second order
# By scene: (cells, order, share): the error on those cells by that order is less than the share of it on half of them by first order.
BETTER = {"stoker": (200, 1, 0.77), "ritter": (200, 1, 0.77), "thacker": (96, 1, 0.8), "transcritical": (100, 1, 0.8), "jump": (100, 1, 0.8), "mound": (128, 1, 0.7), "drag_pair": (64, 1, 0.9)}
# On the same cells by second order, less than the share by first, and less than by first on twice the cells.
SECOND = {"wave": (240, 0.5), "stoker": (200, 0.8), "ritter": (200, 0.6), "transcritical": (50, 0.6), "jump": (50, 0.6), "mound": (64, 0.6), "planar": (100, 0.2)}
MOST = {"planar": (200, 4), "thacker": (96, 4), "transcritical": (100, 4), "jump": (100, 2.5), "dupuit": (112, 0.5), "mound": (128, 1.5), "drag_pair": (64, 1), "column": (96, 8), "slide": (160, 0.01),
        "drained_slide": (160, 0.01), "soaked_slide": (160, 0.01)}  # [%] on those cells by first order; a cell of the column's run-out is 3.4


def measured(recorder, scene, n, order):
    """Measures of a scene on n cells along x at its base step, three sand substeps a water step."""
    level = scene.make(n)
    level = recordings.choose({**level, "dt": scene.step(level["grid"]["dx"])}, substeps=3, **ORDERS[order])
    run, summary = recorder.record(level, seconds=scene.seconds, times=(0, scene.seconds), fields=scene.fields, files=scene.files(n) if scene.files else None)
    return scene.measure(run, summary, level)


def tell(recorder, keys, cells):
    print("| case | cells | order 1 [%] | order 2 [%] | by order 1 |\n| --- | ---: | ---: | ---: | --- |")
    for scene in (SCENES[key] for key in keys):
        for n in cells or (scene.n // 4, scene.n // 2, scene.n):
            first = measured(recorder, scene, n, 1)
            second = f"{measured(recorder, scene, n, 2)[0][2]:.3g}" if scene.kind != NO_ORDER else ""
            others = "; ".join(f"{name} {value:.4g} {unit}" + (f" (right {right:.4g})" if right else "") for name, unit, value, right in first[1:])
            print(f"| {scene.title} (`{scene.key}`) | {n} | {first[0][2]:.3g} | {second} | {others} |", flush=True)


def check(recorder):
    kept, failed = {}, []

    def measures(key, n, order=1):
        if (key, n, order) not in kept:
            kept[key, n, order] = measured(recorder, SCENES[key], n, order)
        return kept[key, n, order]

    def insist(holds, what):
        print("OK    " if holds else "FAILED", what, flush=True)
        if not holds:
            failed.append(what)

    error = lambda *of: measures(*of)[0][2]
    for key, (n, order, share) in BETTER.items():
        insist(error(key, n, order) < share * error(key, n // 2), f"{key}: {error(key, n, order):.3g} % on {n} cells, {error(key, n // 2):.3g} % on {n // 2}")
    for key, (n, share) in SECOND.items():
        insist(error(key, n, 2) < min(share * error(key, n), error(key, 2 * n)), f"{key}: {error(key, n, 2):.3g} % by order 2 on {n} cells, {error(key, n):.3g} % by order 1, {error(key, 2 * n):.3g} % on {2 * n}")
    for key, (n, most) in MOST.items():
        insist(error(key, n) < most, f"{key}: {error(key, n):.3g} % on {n} cells, under {most:g}")
    for key in ("drained_slide", "soaked_slide"):  # control: what they would be without buoyancy
        found = {name: value for name, _, value, _ in measures(key, 160)}
        insist(found["velocity"] > 1.5 * found["velocity of dry sand"], f"{key}: {found['velocity']:.3g} m/s, {found['velocity of dry sand']:.3g} without buoyancy")
    return 1 if failed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--only", nargs="+", choices=SCENES, default=SCENES, metavar="SCENE", help=f"of {', '.join(SCENES)}")
    parser.add_argument("--cells", nargs="+", type=int, metavar="N", help="along x")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    with recordings.Recorder(options.programs / "wadi-recorder", "cpu", 1) as recorder:
        if options.check:
            return check(recorder)
        tell(recorder, options.only, options.cells)
    return 0


if __name__ == "__main__":
    sys.exit(main())
