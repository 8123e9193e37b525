#!/usr/bin/env python3
"""That g++ turns the rows of every stage of cells and faces into vector code. Usage: vectorised.py STAGEC SOURCE_DIR CXX [STAGE ...].

On x86-64 that is set avx2; a cross compiler for another processor is asked for set base, which on 64-bit ARM may use NEON."""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

FLAGS = "-std=c++20 -O3 -ffp-contract=off -fno-math-errno -fno-trapping-math -fno-thread-jumps -DNDEBUG".split()


def half_bit(source):
    return int(re.search(r"EFFECT_HALF_STORAGE (\d+)u", (source / "shaders/effects.h").read_text())[1])


def fails(stage, stagec, source, cxx, isa, half=0, spoil=""):
    """Whether no loop over a row of the stage's largest mask, with bit `half` or without any half storage, is vectorised; None where no mask has the bit."""
    with tempfile.TemporaryDirectory() as folder:
        code = pathlib.Path(folder) / "stage.cpp"
        subprocess.run([stagec, "cpp", source / "shaders/effects.h", stage, code, isa, "all"], check=True)
        text = code.read_text()
        masks = [int(mask) for mask in re.findall(r"case (\d+)u: return wadi_stage_%s::block" % isa, text)]
        masks = [mask for mask in masks if mask & half_bit(source) == half]
        if not masks:
            return None
        largest = max(masks, key=lambda mask: (mask.bit_count(), mask))
        text = re.sub(rf"    case (?!{largest}u)\d+u: return wadi_stage_{isa}::block<\d+u>;\n", "", text)
        if spoil:
            text = text.replace("local.kernel(i, j);", spoil)
        code.write_text(text)
        said = subprocess.run([cxx, *FLAGS, *([] if isa == "base" else [f"-m{isa}"]), "-I", source / "shaders", "-I", source, "-c", code, "-o", os.devnull, "-fopt-info-vec-optimized"],
                              capture_output=True, text=True)
        if said.returncode != 0:
            sys.exit(said.stderr)
        return "loop vectorized" not in said.stderr


def main():
    stagec, source, cxx, *names = sys.argv[1:]
    source = pathlib.Path(source)
    if "clang" in subprocess.run([cxx, "--version"], capture_output=True, text=True, check=True).stdout:
        print("not g++: nothing to ask")
        return 0
    machine = subprocess.run([cxx, "-dumpmachine"], capture_output=True, text=True, check=True).stdout.strip()
    isa = "avx2" if machine.startswith("x86_64") else "base"
    stages = [path for path in sorted((source / "shaders/stages").glob("*/*.stage")) if not names or path.stem in names]
    stages = [path for path in stages if re.search(r"^EXTENT\((CELLS|FACES)\)", path.read_text(), re.M)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        asked = [(path, half) for path in stages for half in (0, half_bit(source))]
        found = list(pool.map(lambda one: fails(one[0], stagec, source, cxx, isa, one[1]), asked))
    bad = [path.stem + (" with half storage" if half else "") for (path, half), failed in zip(asked, found) if failed]
    halves = sum(half != 0 and failed is not None for (_, half), failed in zip(asked, found))
    if not halves and not names:
        bad.append("no stage")
    for name in bad:
        print(f"FAIL {name}: no row in vectors; see rule 8 of shaders/README.md")
    branch = "{ if (i % 7 == 3) return; local.kernel(i, j); }"  # leaves the loop: nothing to vectorise
    if stages and not fails(stages[0], stagec, source, cxx, isa, spoil=branch):
        bad.append("control")
        print("FAIL control: a loop that is left in its middle passes")
    print(f"{machine}, set {isa}: {len(stages)} stages, {halves} of them with half storage too, {len(bad)} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
