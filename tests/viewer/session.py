"""wadi-viewer run by a script of input, without a window or in one, and what it prints of its world."""
import os
import re
import subprocess
from pathlib import Path

STATE = re.compile(r"state step (\d+) sand ([\d.]+) water ([\d.]+) sand_in ([\d.]+) water_in ([\d.]+) water_out ([\d.]+) kept (\d+) hash (\w+) ground (-?[\d.]+)")
POINTED = "320x180" # pictures in which a script points at places
SMALL, SPOT = "160x90", (72, 58) # the same where nobody looks at them, and the place in them


# Sessions test input, not the land beyond the block, which takes half of a picture's time: they draw the block alone.
class Session:
    def __init__(self, program, folder, window):
        self.program, self.folder, self.window, self.number = str(Path(program).resolve()), folder, window, 0
        self.size = "640x360" if window else "96x54" # a window has the panel in it
        # A place beside the damp column, in a window and in POINTED. The panel moves the middle of the picture by half its 330 pixels.
        self.place = "452 229" if window else "143 115"

    def start(self, script, frames, *arguments, backend="cpu", size=None, level="dam_break", environment=()):
        self.number += 1
        out = self.folder / str(self.number)
        out.mkdir()
        (out / "script.txt").write_text(script)
        command = [self.program, *([level] if level else []), "--script", out / "script.txt", "--frames", frames, "--quality", "low", "--out", out, "--every", 0.1, "--grid", "96x96",
                   "--validate", "--block", "--backend", backend, "--size", size or self.size, *arguments]
        if not self.window:
            command.append("--offscreen")
        return out, subprocess.Popen([str(c) for c in command], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                     env={**os.environ, **dict(environment)})

    def finish(self, process, code=0, before=""):
        text, errors = process.communicate(timeout=600)
        text = before + text
        assert process.returncode == code, f"exit code {process.returncode}, not {code}\n{text}\n{errors}"
        if code == 0:
            assert "validation 0 messages" in text, text
        return text, [dict(zip(("step", "sand", "water", "sand_in", "water_in", "water_out", "kept", "hash", "ground"), found)) for found in STATE.findall(text)], errors

    def run(self, script, frames, *arguments, code=0, **options):
        out, process = self.start(script, frames, *arguments, **options)
        return (out, *self.finish(process, code))


def start_display(folder):
    """An Xvfb of our own, whose number comes through a pipe, and a window manager."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24"], pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        os.environ["DISPLAY"] = ":" + pipe.readline().strip()
    rules = folder / "twmrc"
    fonts = "".join(f'{use}Font "fixed"\n' for use in ("Title", "Resize", "Menu", "Icon", "IconManager")) # the server's own
    rules.write_text(fonts + 'RandomPlacement\nNoTitle\nBorderWidth 0\nNoGrabServer\nIconManagerDontShow\n"F11" = : all : f.iconify\n"F10" = : all : f.delete\n')
    return [subprocess.Popen(["twm", "-quiet", "-f", str(rules)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL), server]
