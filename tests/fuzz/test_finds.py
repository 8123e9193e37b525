#!/usr/bin/env python3
"""The fuzzer finds what is broken on purpose, makes it small, and leaves a level that fails alone. Usage: test_finds.py WADI_FUZZ."""
import re
import subprocess
import sys
import tempfile


def run(*arguments):
    done = subprocess.run(arguments, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def main():
    program = sys.argv[1]
    common = ["--jobs", "1", "--backend", "cpu", "--shrink-seconds", "20"]
    for weaken, check, cells in (("limiter", "books", 64), ("bits", "bits", 4)):
        with tempfile.TemporaryDirectory() as folder:
            code, text = run(program, "--scenes", "30", "--seed", "3", "--weaken", weaken, "--check", check, "--out", folder, "--failures", "1", *common)
            assert code == 1, f"{weaken}: not found:\n{text}"
            shrunk = re.search(r"shrunk from (\d+) x (\d+) cells, .* to (\d+) x (\d+) cells, (\d+) steps, (\d+) commands", text)
            assert shrunk, text
            small = int(shrunk[3]) * int(shrunk[4])
            assert small <= cells and int(shrunk[6]) == 0, f"{weaken}: still {small} cells:\n{text}"
            level = re.search(r"--level (\S+)", text)[1]
            code, text = run(program, "--level", level, "--check", check, "--backend", "cpu", "--weaken", "bits" if weaken == "bits" else "nothing")
            assert code == 1 and f"FAILED {check}" in text, f"{weaken}: the level passes:\n{text}"
            code, text = run(program, "--level", level, "--check", "save", "--backend", "cpu")
            assert weaken != "bits" or code == 0, f"a sound level fails another check:\n{text}"
    for check in ("calls", "shift", "values"):
        with tempfile.TemporaryDirectory() as folder:
            code, text = run(program, "--scenes", "30", "--weaken", "bits", "--check", check, "--out", folder, "--failures", "1", *common)
            assert code == 1 and f"{check}: " in text, f"other bits are not found by {check}:\n{text}"
    with tempfile.TemporaryDirectory() as folder:
        code, text = run(program, "--scenes", "30", "--weaken", "rings", "--check", "tiles", "--out", folder, "--failures", "1", *common)
        assert code == 1 and "tiles of " in text, f"active tiles that wake no neighbour are not found:\n{text}"
    # NaN on the way that is gone in the end is no run to compare.
    code, text = run(program, "--scenes", "1", "--seed", "913000237", *common)
    assert code == 0 and "blown up 1" in text, text
    code, text = run(program, "--scenes", "30", "--stuck-seconds", "0.001", *common)
    assert code == 3 and re.search(r"seed \d+ runs for .* has not ended", text), f"a scene that takes too long goes on:\n{text}"
    code, text = run(program, "--scenes", "1", "--plain-set", "none", *common)
    assert code == 1 and "no instruction set 'none'" in text, text
    code, text = run(program, "--scenes", "3", *common)
    assert code == 0 and "0 failures" in text, text
    print("the fuzzer finds a missing limiter and other bits, and makes them small")


main()
