#!/usr/bin/env python3
"""What stagec refuses, by file and line, and that compilers name a stage's own line. Usage: stagec_messages.py STAGEC SOURCE_DIR CXX [GLSLANG]."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

GOOD = """// A stage.
#include "../../physics/scalar.glsl"
STAGE(Trial)
EXTENT(FACES)
IN(0, float, height)
IN(1, float, velocity_x)
IN(2, float, velocity_y)
OUT(3, float, rise_x)
OUT(4, float, rise_y)
KERNEL {
    int c = IDX(i, j);
    EACH_AXIS {
        int low = IDX(i - 1, j);
        float slope = height[c] - height[low] + velocity_x[c];
        rise_x[c] = j < P.ny ? slope : 0.0f;
    }
}
END_STAGE
"""
LIKE = "STAGE_LIKE(Other, trial, height = height)\n"
FUSED = """// A fused stage.
FUSED(TrialFused)
NEEDS(EFFECT_WATER)
PHASE(0, 0, 0, 0)
RUN(trial)
KEEP(rise_x, rise_y)
"""
# (line that is replaced, its text, line that the message names, message)
STAGE_FAULTS = [
    (5, "INN(0, float, height)", 5, "INN is no word of the stage language"),
    (5, "IN(0, float, height) // c\n/* IN(1, float, more) */", 6, "a block comment"),
    (5, "IN(1, float, height)", 5, "slot of height is 1, expected 0"),
    (5, "IN(0, double, height)", 5, "type double of height"),
    (5, "IN(0, height)", 5, "IN takes (slot, type, name)"),
    (5, "IN_IF(EFFECT_WATR, 0, float, height)", 5, "EFFECT_WATR is no word of the stage language"),
    (3, "", 19, "no STAGE"),
    (4, "EXTENT(EVERYWHERE)", 4, "EVERYWHERE is no word of the stage language"),
    (4, "EXTENT(STRIP)", 4, "EXTENT STRIP is none of"),
    (4, "EXTENT(FACES)\nEXTENT(CELLS)", 5, "a second EXTENT"),
    (10, "{", 19, "no KERNEL"),
    (10, "KERNEL {\n}\nKERNEL {", 12, "a second KERNEL"),
    (18, "", 19, "no END_STAGE"),
    (18, "END_STAGE\nEMPTY_WITHOUT(depth)", 19, "EMPTY_WITHOUT names depth, which the stage does not bind"),
    (18, "END_STAGE\nLEAN_WITHOUT(EFFECT_WATER, rise_x)", 19, "LEAN_WITHOUT names rise_x, which is an OUT"),
    (18, "END_STAGE\nEMPTY_WRITES(height = 1.0f)", 19, "EMPTY_WRITES names height, which is no OUT"),
    (11, "    int c = IDX(i);", 11, "IDX takes (i, j)"),
    (11, "    int c = IDX(i - 3, j);", 10, "reads more than 2 cells away"),
    (11, "    int c = IDX(i, j;", 11, "nothing closes this ("),
    (12, "    EACH_AXIS", 12, "EACH_AXIS stands before a block or a HELPER"),
    (13, "        int low_x = IDX(i - 1, j);", 13, "low_x has an axis in its name"),
    (13, "        int low = IDX(i - 1, j); if (i > 0) { low = c; }", 13, "the condition is another for each axis"),
    (13, "        int low = IDX(i - 1, j); return;", 13, "no return in EACH_AXIS"),
    (13, "        int low = IDX(i - 1, j), high = c;", 13, "one declaration a statement"),
    (13, "        int low = IDX(i - 1, j); if (HAS(EFFECT_WATER)) { low = c; } else low = c;", 13, "braces behind else"),
    (13, "        int low = IDX(i - 1, j); float velocity = velocity_x[c];", 6, "velocity of EACH_AXIS would be named as this binding"),
    (14, "        float slope = height[c] - height[low] + velocity_x[c] * S.mapped_rain.x;", 14, "S.mapped_rain.x would be another number for the other axis"),
    (12, "    EACH_AXIS { float pace_of = velocity_x[c] * S.side_pace[0].y; }\n    EACH_AXIS {", 12, "S.side_pace[0].y would be another number for the other axis"),
    (10, "EACH_AXIS HELPER float one_x(int c) HELPER_CONST { return velocity_x[c] * S.mapped_rain.x; }\nKERNEL {", 10, "S.mapped_rain.x would be another number for the other axis"),
    (12, "    EACH_AXIS { float one = 1.0f; }\n    EACH_AXIS {", 12, "nothing in EACH_AXIS is another for each axis"),
    (10, "EACH_AXIS HELPER float one(float u) HELPER_CONST { return u; }\nKERNEL {", 10, "nothing in this function is another for each axis"),
    (10, "EACH_OF(water) HELPER float one(float u) HELPER_CONST { return u; }\nKERNEL {", 10, "EACH_OF takes (name, other name)"),
    (10, "EACH_OF(water, mixed) HELPER float one(float u) HELPER_CONST { return u; }\nKERNEL {", 10, "nothing in this function is named for water"),
    (10, "EACH_OF(water, mixed) KERNEL {", 10, "EACH_OF stands before a HELPER"),
]
LIKE_FAULTS = [
    (1, "STAGE_LIKE(Other, trial)", 1, "STAGE_LIKE takes (Name, stage, word = other)"),
    (1, "STAGE_LIKE(Other, trail, k = ks)", 1, 'no stage "trail"'),
    (1, "STAGE_LIKE(Other, trial, k = ks)", 1, "trial has no word k"),
]
FUSED_FAULTS = [
    (3, "NEED(EFFECT_WATER)", 3, "unknown word NEED"),
    (3, "NEEDS(EFFECT_WATR)", 3, "unknown effect EFFECT_WATR"),
    (3, "NEEDS", 3, "NEEDS takes arguments in parentheses"),
    (4, "CELLS_EACH(3)\nPHASE(0, 0, 0, 0)", 4, "CELLS_EACH takes 1 or 2"),
    (4, "GROUPS(7)\nPHASE(0, 0, 0, 0)", 4, "GROUPS takes a number from 2 to 6"),
    (4, "PHASE(0, 0, 0)", 4, "PHASE takes (west, south, east, north)"),
    (4, "PHASE(0, 0, 0, 3)", 4, "PHASE takes (west, south, east, north)"),
    (4, "", 5, "RUN ahead of the first PHASE"),
    (5, "RUN(trail)", 5, 'no stage "trail"'),
    (5, "RUN(trial, hight = height_next)", 5, "trial has no binding hight"),
    (5, "RUN(trial, height)", 5, "is neither binding = field nor binding > field"),
    (6, "KEEP(rise_x, rise_z)", 6, "KEEP names rise_z, which no part writes"),
    (6, "KEEP(rise_x)", 5, "nobody reads rise_y"),
    (6, "KEEP(rise_x, rise_y)\nEMPTY_WITHOUT(rise_x)", 7, "no part reads rise_x from memory"),
    (6, "KEEP(rise_x, rise_y)\nLEAN_WITHOUT(EFFECT_SAND, depth)", 7, "no part reads depth from memory"),
    (6, "KEEP(rise_x, rise_y)\nEMPTY_WITHOUT(height)\nEMPTY_COPIES(rise_x, height)", 8, '"rise_x" is not kept field = field'),
    (6, "KEEP(rise_x, rise_y)\nEMPTY_WITHOUT(height)\nEMPTY_COPIES(height = height)", 7, "height is not kept"),
    (6, "KEEP(rise_x, rise_y)\nSTAGED(height, depth)", 7, "no part reads depth from memory"),
    (2, "", 1, "no FUSED(Name)"),
]


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


class Trial:
    def __init__(self, stagec, source, folder):
        self.stagec, self.source, self.shaders, self.failed, self.checked = stagec, source, folder / "shaders", 0, 0
        (self.shaders / "stages" / "room").mkdir(parents=True)
        (self.shaders / "fused").mkdir()
        for name in ("physics", "language", "step_params.h", "effects.h"):
            (self.shaders / name).symlink_to(source / "shaders" / name)
        self.paths = {"trial": self.shaders / "stages/room/trial.stage", "other": self.shaders / "stages/room/other.stage", "fused": self.shaders / "fused/trial_fused.fused"}

    def write(self, which, text):
        self.paths["trial"].write_text(GOOD)
        self.paths[which].write_text(text)

    def make(self, which, mode="cpp"):
        out = self.shaders.parent / f"out.{mode}"
        rest = {"cpp": ["base", "all"], "cuda": ["all"], "glsl": []}[mode]
        return out, *run(self.stagec, mode, self.shaders / "effects.h", self.paths[which], out, *rest)

    def expect(self, what, holds, seen):
        self.checked += 1
        if not holds:
            self.failed += 1
            print(f"{what}\n    got: {seen}")

    def faults(self, which, good, faults):
        self.write(which, good)
        _, code, text = self.make(which)
        self.expect(f"{which} as it should be passes", code == 0, text)
        for line, replacement, named, message in faults:
            lines = good.split("\n")
            lines[line - 1] = replacement
            self.write(which, "\n".join(lines))
            _, code, text = self.make(which)
            path = self.paths[which]
            self.expect(f"{which}, line {line}: {replacement!r}: {named}: {message}", code == 1 and text.startswith(f"{path}:{named}: ") and message in text, text)

    def compilers(self, which, cxx, glslang):
        """An undeclared name in line 14 of the stage is reported there, by the compilers of what stagec wrote."""
        lines = GOOD.split("\n")
        lines[13] = lines[13].replace("height[low]", "hight_of_low")
        self.write(which, FUSED if which == "fused" else "\n".join(lines))
        self.paths["trial"].write_text("\n".join(lines))
        out, code, text = self.make(which)
        self.expect(f"{which} is written", code == 0, text)
        _, text = run(cxx, "-std=c++20", "-fsyntax-only", "-I", self.source / "shaders", "-x", "c++", out)
        self.expect(f"{cxx} names the line of {which}", re.search(r"trial\.stage:14:\d+: error: .*hight_of_low", text), text)
        if not glslang:
            return
        out, code, text = self.make(which, "glsl")
        _, text = run(glslang, "-V", "--target-env", "vulkan1.1", "-S", "comp", f"-I{self.source / 'shaders'}", out, "-o", "/dev/null")
        self.expect(f"{glslang} names the line of {which}", re.search(r"trial\.stage:14: 'hight_of_low'", text), text)


def main():
    stagec, source, cxx = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
    glslang = sys.argv[4] if len(sys.argv) > 4 else shutil.which("glslangValidator")
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(stagec, source, pathlib.Path(folder))
        trial.faults("trial", GOOD, STAGE_FAULTS)
        trial.faults("other", LIKE, LIKE_FAULTS)
        trial.paths["other"].unlink()
        trial.faults("fused", FUSED, FUSED_FAULTS)
        trial.compilers("trial", cxx, glslang)
        trial.compilers("fused", cxx, glslang)
    print(f"{trial.checked} checks, {trial.failed} failed")
    return 1 if trial.failed else 0


if __name__ == "__main__":
    sys.exit(main())
