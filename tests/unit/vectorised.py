#!/usr/bin/env python3
"""That g++ turns the rows of every stage of cells and faces into vector code. Usage: vectorised.py [--clang] STAGEC SOURCE_DIR CXX [-OPTION ...] [STAGE ...].

On x86-64 that is set avx2; a cross compiler for another processor is asked for set base, which on 64-bit ARM may use NEON.
-OPTION: how stages are optimised, -O3 unless said. Of a clang that is asked with --clang alone: one that a release is made by."""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

FLAGS = "-std=c++20 -ffp-contract=off -fno-math-errno -fno-trapping-math -DNDEBUG".split()
ASK_GCC, SAID_BY_GCC = ["-fno-thread-jumps", "-fopt-info-vec-optimized"], "loop vectorized"
ASK_CLANG, SAID_BY_CLANG = ["-Rpass=loop-vectorize", "-Wno-everything"], "vectorized loop"


def bits(source):
    return {name.lower(): int(bit) for name, bit in re.findall(r"EFFECT_(\w+) (\d+)u", (source / "shaders/effects.h").read_text())}


def effects(mask, source):
    return "+".join(name for name, bit in bits(source).items() if mask & bit) or "no effect"


def stage_text(stage, stagec, source, isa, masks):
    with tempfile.TemporaryDirectory() as folder:
        code = pathlib.Path(folder) / "stage.cpp"
        subprocess.run([stagec, "cpp", source / "shaders/effects.h", stage, code, isa, masks, *([] if isa == "base" else ["base"])], check=True)
        return code.read_text()


def largest_masks(stage, stagec, source):
    """The largest of each choice of methods, which stagec leaves a vector set that is to be small."""
    return sorted({int(mask) for mask in re.findall(r"case (\d+)u: return wadi_stage_avx2::block", stage_text(stage, stagec, source, "avx2", "largest"))})


def fails(text, mask, source, cxx, isa, optimise, clang, spoil=""):
    """Whether no loop over a row is vectorised in the stage's text with this mask alone."""
    text = re.sub(rf"    case (?!{mask}u)\d+u: return wadi_stage_{isa}::block<\d+u>;\n", "", text)
    if spoil:
        text = text.replace("local.kernel(i, j);", spoil)
    with tempfile.TemporaryDirectory() as folder:
        code = pathlib.Path(folder) / "stage.cpp"
        code.write_text(text)
        said = subprocess.run([cxx, *FLAGS, *optimise, *([] if isa == "base" else [f"-m{isa}"]), "-I", source / "shaders", "-I", source, "-c", code, "-o", code.with_suffix(".o"),
                               *(ASK_CLANG if clang else ASK_GCC)], capture_output=True, text=True)
    if said.returncode != 0:
        sys.exit(said.stderr)
    return (SAID_BY_CLANG if clang else SAID_BY_GCC) not in said.stderr


def main():
    clang = "--clang" in sys.argv
    stagec, source, cxx, *words = [word for word in sys.argv[1:] if word != "--clang"]
    optimise = [word for word in words if word.startswith("-")] or ["-O3"]
    names = [word for word in words if not word.startswith("-")]
    source = pathlib.Path(source)
    version = subprocess.run([cxx, "--version"], capture_output=True, text=True, check=True).stdout
    if not clang and "clang" in version:
        print("not g++: nothing to ask")
        return 0
    if clang:
        machine = re.search(r"^Target: (\S+)", version, re.M)[1]
    else:
        machine = subprocess.run([cxx, "-dumpmachine"], capture_output=True, text=True, check=True).stdout.strip()
    isa = "avx2" if machine.startswith("x86_64") else "base"
    stages = [path for path in sorted((source / "shaders/stages").glob("*/*.stage")) if not names or path.stem in names]
    stages = [path for path in stages if re.search(r"^EXTENT\((CELLS|FACES)\)", path.read_text(), re.M)]
    texts = {path.stem: stage_text(path, stagec, source, isa, "all") for path in stages}
    asked = [(path.stem, mask) for path in stages for mask in largest_masks(path, stagec, source)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda one: fails(texts[one[0]], one[1], source, cxx, isa, optimise, clang), asked))
    bad = [f"{name} {effects(mask, source)}" for (name, mask), failed in zip(asked, found) if failed]
    for name in bad:
        print(f"FAIL {name}: no row in vectors; see rule 8 of shaders/README.md")
    branch = "{ if (i % 7 == 3) return; local.kernel(i, j); }"  # leaves the loop: nothing to vectorise
    if asked and not fails(texts[asked[0][0]], asked[0][1], source, cxx, isa, optimise, clang, spoil=branch):
        bad.append("control")
        print("FAIL control: a loop that is left in its middle passes")
    print(f"{machine}, set {isa}, {' '.join(optimise)}: {len(stages)} stages, {len(asked)} masks, {len(bad)} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
