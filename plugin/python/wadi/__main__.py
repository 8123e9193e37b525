"""python -m wadi PROGRAM [ARGUMENT ...]: runs a program of Wadi's that comes along, with the arguments as they are."""
from __future__ import annotations

import os
import sys

from . import _library

PROGRAMS: dict[str, tuple[str, str]] = {"record": ("wadi-recorder", "records a level: pictures, a video, fields, figures"),
                                        "view": ("wadi-viewer", "a window to play with a level, where this build has it"),
                                        "tune": ("wadi-tune", "finds settings for a time per step or an error"),
                                        "import": ("wadi-import", "makes a level of a map of heights")}


def usage() -> str:
    lines = ["usage: python -m wadi PROGRAM [ARGUMENT ...]", ""]
    lines += [f"  {name:8}{what} ({program})" for name, (program, what) in PROGRAMS.items()]
    lines += [f"  {'levels':8}names of the levels that come along", "", 'Each program lists its options: "python -m wadi record --help"']
    return "\n".join(lines)


def main(given: list[str]) -> int | None:
    if not given or given[0] in ("-h", "--help"):
        print(usage())
        return 0 if given else 2
    if given[0] == "levels":
        for name, file in _library.levels().items():
            print(f"{name:12}{file}")
        return 0
    if given[0] not in PROGRAMS:
        print(f'python -m wadi: there is no program "{given[0]}"\n\n{usage()}', file=sys.stderr)
        return 2
    try:
        program = _library.program(PROGRAMS[given[0]][0])
    except _library.Error as error:
        print(f"python -m wadi {given[0]}: {error}", file=sys.stderr)
        return 1
    sys.stdout.flush()
    os.execv(program, [str(program), *given[1:]])
    return None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
