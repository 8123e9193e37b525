#!/usr/bin/env python3
"""Runs the notebooks beside it and fails where a cell does. Usage: run.py [--write] [NAME ...]; all of them where none is named; 3 is the one that begins with 3.
  --write   keeps what the cells print and draw in the files; without it they stay as they are
Needs nbclient and ipykernel, and the package wadi with matplotlib, xarray and rasterio."""
import argparse
import json
import os
import pathlib
import sys
import tempfile
import time

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

here = pathlib.Path(__file__).resolve().parent
MOST_BYTES = 80000  # of what a cell shows, as text in the file: a picture of 60 kB
SECONDS = 300  # of a cell


def kernel(folder):
    """This Python as the kernel "python3", whatever the machine has of that name."""
    spec = pathlib.Path(folder) / "kernels" / "python3"
    spec.mkdir(parents=True)
    command = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    (spec / "kernel.json").write_text(json.dumps({"argv": command, "display_name": "Python 3", "language": "python"}), encoding="utf-8")
    os.environ["JUPYTER_PATH"] = str(folder)


def clean(notebook):
    """Without what changes from run to run and nobody looks at; complains of pictures that are too large."""
    large = []
    for cell in notebook.cells:
        cell.metadata = {}
        for output in cell.get("outputs", []):
            output.pop("metadata", None) if output.output_type == "stream" else output.update(metadata={})
            for kind, data in output.get("data", {}).items():
                if len(data) > MOST_BYTES:
                    large.append(f"{kind} of {len(data)} bytes in cell {cell.id}")
    return large


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    files = [file for file in sorted(here.glob("*.ipynb")) if not options.names or file.name.startswith(tuple(options.names))]
    if not files:
        sys.exit(f"run.py: no notebook begins with {' or '.join(options.names)}")
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        kernel(folder)
        for file in files:
            notebook = nbformat.read(file, as_version=4)
            kept = sum(len(cell.get("outputs", [])) for cell in notebook.cells)
            begun = time.perf_counter()
            room = tempfile.mkdtemp(dir=folder)
            try:
                NotebookClient(notebook, timeout=SECONDS, kernel_name="python3", resources={"metadata": {"path": room}}).execute()
            except CellExecutionError as error:
                print(f"{file.name}: FAILED\n{error}")
                failed += 1
                continue
            large = clean(notebook)
            print(f"{file.name}: {time.perf_counter() - begun:.1f} s", *large, sep="\n  ", flush=True)
            failed += bool(large)
            if options.write:
                nbformat.write(notebook, file)
            elif kept == 0:
                print(f"{file.name}: has no outputs; run.py --write keeps them")
                failed += 1
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
