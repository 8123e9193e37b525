#!/usr/bin/env python3
"""What an error of so many percent looks like: ends of scenes of the report beside their references. Writes pictures and the page
samples/report/errors/README.md.

usage: samples/report/errors.py BIN_FOLDER [--out DIR]"""
import argparse
import pathlib
import sys

import pairs
import recordings
import scenes
import stamps
import sweep

POINTS = ("island@n128,dt0.5,T3,second_order", "island@n32,dt0.5,T3,second_order", "island@n64,dt2.7,T3,robust",
          "wall@n256,dt1,T3,second_order", "wall@n64,dt2,T2,robust", "wall@n64,dt5,T1,robust")
NX, NY = scenes.REFERENCE_N, scenes.REFERENCE_N // 2


def on_reference(values, nx):
    """Cells as they are, each as a block of the reference's."""
    f = NX // nx
    return [values[j // f * nx + i // f] for j in range(NY) for i in range(NX)]


def drawn(recorder, scene, fields, scale):
    """A state as the recorder draws it; fields: {name: values on the reference's cells}."""
    level = {**scene.make(NX), "dt": 1e-6}
    files = {f"{name}.npy": (NX, NY, values) for name, values in fields.items()}
    level |= {layer: [{"file": f"{name}.npy"}] for name, layer in scenes.LAYERS if name in fields}
    run, _ = recorder.record(level, seconds=level["dt"], pictures=2, files=files, water_scale=scale)
    return pairs.map_of(run.folder / "frame_00000.png", NX, NY)


def measured(recorder, name, out):
    """A row of the table, and NAME.png: the reference, then the point."""
    point = sweep.parse(name)
    scene = next(scene for scene in scenes.all_scenes() if scene.key == point.scene)
    level = sweep.level_of(scene, point)
    run, summary = recorder.record(level, seconds=scene.seconds, times=scene.times, fields=scene.fields)
    end = {field: scenes.measures.read_npy(scenes.REFERENCES / f"{scene.key}_{field}.npy")[2] for field, layer in scenes.LAYERS if layer in level}
    scale = max(end["W"])
    got = {field: on_reference(run.field(field, scene.seconds), run.nx) for field in end}
    picture = f"{scene.key}_{run.nx}_{point.dt:g}.png"
    pairs.write(out / picture, *(drawn(recorder, scene, fields, scale) for fields in (end, got)))
    errors = [f"{value:.2g}" for _, _, value, _ in scene.measure(run, summary, level)]
    print(f"{name}: {errors[0]} %", flush=True)
    return scene, errors, picture


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent / "errors")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    lines = ["# What an error looks like", "",
             "Ends of two scenes of the report: left the reference, right a run that errs by so much, its cells as they are. The error is that of the",
             "charts: mean absolute, of sand and water surface, in percent of the range over which they moved. At 0.5 % every wave is in its place, only",
             "softer; at 2 % the picture is the same, drawn in large cells; at 8 %, with time steps too long for the flow, fronts lag behind and what they",
             "should have torn away stands. Made by `samples/report/errors.py BIN`.", ""]
    with recordings.Recorder(options.programs / "wadi-recorder", "cpu", 1) as recorder:
        title = None
        for name in POINTS:
            scene, errors, picture = measured(recorder, name, options.out)
            if scene.title != title:
                title = scene.title
                lines += [f"## {title}", ""]
            parts = f" (sand {errors[1]} %, water surface {errors[2]} %)" if len(errors) > 2 else ""
            lines += [f"**{errors[0]} %**{parts}: `{name}`", "", f"![reference, and {errors[0]} % from it]({picture})", ""]
    (options.out / "README.md").write_text("\n".join([*lines, stamps.stamp("errors"), ""]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
