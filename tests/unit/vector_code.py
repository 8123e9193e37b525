#!/usr/bin/env python3
"""That rows of every stage of cells and faces are vector code in a build's own objects, under every mask that set avx2 has there.
Usage: vector_code.py BUILD_DIR SOURCE_DIR. `vectorised.py` asks g++ itself, as people get it, and takes a minute longer."""
import pathlib
import re
import subprocess
import sys

ARITHMETIC = r"\tv(add|sub|mul|div|max|min|and|cmp\w*|sqrt){} .*{}"  # not moves: parameters are copied by vectors, too
VECTORS = re.compile(ARITHMETIC.format("ps", "%ymm"))
SCALARS = re.compile(ARITHMETIC.format("ss", "%xmm"))


def blocks(objdump):
    """Each block of an object by its mask: the instructions."""
    for part in re.split(r"^[0-9a-f]+ <", objdump, flags=re.M)[1:]:
        if found := re.match(r"_ZN15wadi_stage_avx2L5blockILj(\d+)E", part):
            yield int(found[1]), part


def in_vectors(code):
    """A mask that leaves a stage nothing to compute has neither."""
    return bool(VECTORS.search(code) or not SCALARS.search(code))


def main():
    build, source = map(pathlib.Path, sys.argv[1:])
    folder = build / "shaders/CMakeFiles/wadi_cpu_stages_avx2.dir/__/generated"
    stages = [path.stem for path in sorted((source / "shaders/stages").glob("*/*.stage")) if re.search(r"^EXTENT\((CELLS|FACES)\)", path.read_text(), re.M)]
    found, bad = 0, 0
    for stage in stages:
        said = subprocess.run(["objdump", "-d", "--no-show-raw-insn", folder / f"{stage}.avx2.cpp.o"], capture_output=True, text=True, check=True).stdout
        masks = list(blocks(said))
        found += len(masks)
        for mask, code in masks or [("none", "")]:
            if not in_vectors(code):
                bad += 1
                print(f"FAIL {stage} mask {mask}: no row in vectors; see rule 8 of shaders/README.md")
    if in_vectors("\tvmulss %xmm1,%xmm2,%xmm3\n\tvmovups %ymm0,(%rax)\n"):
        bad += 1
        print("FAIL control: a row whose arithmetic is scalar passes")
    print(f"{len(stages)} stages, {found} blocks, {bad} failed")
    return 1 if bad or not found else 0


if __name__ == "__main__":
    sys.exit(main())
