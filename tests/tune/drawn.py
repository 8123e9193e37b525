#!/usr/bin/env python3
"""Levels that samples/tune/drawn_levels.py draws: the same from the same seed, others from others, all load and move. Usage: drawn.py BIN; needs numpy."""
import json
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "samples" / "tune"))
import drawn_levels  # noqa: E402

SEEDS = (1, 2, 3)
KINDS = len(drawn_levels.KINDS)


def loads(recorder, level):
    """What the recorder says where it refuses the level, else nothing."""
    with tempfile.TemporaryDirectory() as scratch:
        drawn_levels.write(level, pathlib.Path(scratch))
        done = subprocess.run([str(recorder), scratch, "--backend", "cpu", "--print-plan"], capture_output=True, text=True, timeout=60)
        return "" if done.returncode == 0 else done.stderr


def test_drawing():
    levels = [drawn_levels.draw(seed, number, attempt) for seed in SEEDS for number in range(2 * KINDS) for attempt in (0, 1)]
    texts = [json.dumps({key: value for key, value in level.items() if key != "name"}) for level in levels]
    assert len(set(texts)) == len(texts), "two are alike"
    assert levels == [drawn_levels.draw(seed, number, attempt) for seed in SEEDS for number in range(2 * KINDS) for attempt in (0, 1)]
    for seed in SEEDS:
        kinds = [drawn_levels.draw(seed, number)["name"].split()[1] for number in range(2 * KINDS)]
        assert len(set(kinds[:KINDS])) == len(set(kinds[KINDS:])) == KINDS, kinds
    for level in levels:
        sides = [level["grid"][key] * level["grid"]["dx"] for key in ("nx", "ny")]
        assert 9 < min(sides) < 66 and max(sides) < 2.1 * min(sides) and 3 <= level["duration"] <= 10, level


def test_loading(recorder):
    for seed in SEEDS:
        for number in range(KINDS):
            said = loads(recorder, drawn_levels.draw(seed, number))
            assert not said, (seed, number, said)
    wrong = drawn_levels.draw(1, 0)
    wrong["terrain"] = [{"shape": "plain", "height": 0}]
    assert "plain" in loads(recorder, wrong)  # the check fails where a level is wrong


def test_moving(recorder):
    """One that is taken moves; a lake at rest is not taken, nor what does not load."""
    level = drawn_levels.drawn(recorder, 1, 0)
    assert not drawn_levels.refusal(recorder, level)
    still = {key: value for key, value in level.items() if key not in ("sand", "sources", "sides", "rain")} | {"water": [{"shape": "plane", "surface": 0.5}], "terrain": []}
    assert "0 % of the cells" in drawn_levels.refusal(recorder, still), drawn_levels.refusal(recorder, still)
    assert "does not run" in drawn_levels.refusal(recorder, level | {"dt": -1})


def main():
    recorder = pathlib.Path(sys.argv[1]).resolve() / "wadi-recorder"
    for test, arguments in ((test_drawing, ()), (test_loading, (recorder,)), (test_moving, (recorder,))):
        test(*arguments)
        print(f"{test.__name__}: ok", flush=True)


if __name__ == "__main__":
    main()
