#!/usr/bin/env python3
"""Sessions of wadi-viewer by scripts of input, without a window (default) or in a real one under Xvfb (--window; exit code 77
where Xvfb is missing). Usage: interaction.py VIEWER [--window] [test_NAME ...]"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from pictures import black_pixels, read_png, sandy, share

STATE = re.compile(r"state step (\d+) sand ([\d.]+) water ([\d.]+) sand_in ([\d.]+) water_in ([\d.]+) kept (\d+) hash (\w+)")


class Session:
    def __init__(self, program, folder, window):
        self.program, self.folder, self.window, self.number = str(Path(program).resolve()), folder, window, 0

    def start(self, script, frames, *arguments, size="480x270"):
        self.number += 1
        out = self.folder / str(self.number)
        out.mkdir()
        (out / "script.txt").write_text(script)
        command = [self.program, "dam_break", "--script", out / "script.txt", "--frames", frames, "--size", size, "--quality", "low", "--out", out, "--every", 0.05,
                   "--validate", *arguments]
        if not self.window:
            command.append("--offscreen")
        return out, subprocess.Popen([str(c) for c in command], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def finish(self, process, code=0):
        text, errors = process.communicate(timeout=600)
        assert process.returncode == code, f"exit code {process.returncode}, not {code}\n{text}\n{errors}"
        if code == 0:
            assert "validation 0 messages" in text, text
        return text, [dict(zip(("step", "sand", "water", "sand_in", "water_in", "kept", "hash"), found)) for found in STATE.findall(text)], errors

    def run(self, script, frames, *arguments, code=0, size="480x270"):
        out, process = self.start(script, frames, *arguments, size=size)
        return (out, *self.finish(process, code))


def test_painting(session):
    """Sand painted at a pixel lands there, is in the ledger, and is seen; with the tool "look" the same input changes nothing."""
    # The same place: the panel of a window moves the middle of the picture by half its 330 pixels.
    at, size = ("595 344", "960x540") if session.window else ("215 172", "480x270")
    stroke = f"1 print\n2 pointer {at}\n3 press left\n9 release left\n10 pointer 479 2\n11 print\n12 screenshot\n"
    for backend in ("cpu", "vulkan"):
        out, _, (before, after), _ = session.run("0 tool add-sand\n0 radius 8\n0 strength 6\n" + stroke, 15, "--backend", backend, size=size)
        poured = float(after["sand_in"])
        print(f"{backend}: {poured:.2f} m3 of sand painted")
        # 6 m/s for 6 frames of 0.05 s over a disc of 8 m whose mean is 0.3: 109 m3
        assert float(before["sand_in"]) == 0 and 100 < poured < 115
        painted = read_png(out / "screenshot_00000.png")
    out, _, (before, after), _ = session.run(stroke, 15, "--backend", "cpu", size=size)
    assert float(after["sand_in"]) == 0
    bare = read_png(out / "screenshot_00000.png")
    gained = share(painted, sandy) - share(bare, sandy)
    print(f"sand on {gained:.4f} more of the picture")
    assert gained > 0.01 and black_pixels(painted) == 0


def test_tools(session):
    """Water and ground by their brushes, a push, a placed source; the camera moves by drag, wheel and keys."""
    _, _, states, _ = session.run("0 tool add-water\n0 radius 6\n0 strength 2\n0 pointer 215 172\n1 press left\n4 release left\n5 print\n"
                                  "6 tool place-source\n7 press left\n8 release left\n8 tool look\n13 print\n"
                                  "14 tool take-sand\n14 pointer 300 120\n15 press left\n18 release left\n19 tool push\n20 press left\n"
                                  "21 pointer 320 130\n22 release left\n23 tool raise\n24 press left\n25 release left\n26 print\n", 28, "--backend", "cpu")
    first, second, third = states
    assert float(first["water_in"]) > 1 and float(second["water_in"]) > float(first["water_in"]) + 1
    assert float(third["sand"]) <= float(first["sand"])
    out, _, _, _ = session.run("0 pause\n2 screenshot\n4 pointer 300 150\n5 press right\n6 pointer 360 140\n7 release right\n8 wheel 3\n9 key W\n"
                               "12 screenshot\n", 14, "--backend", "cpu")
    assert read_png(out / "screenshot_00000.png") != read_png(out / "screenshot_00001.png"), "the camera did not move"
    out, _, _, _ = session.run("0 pause\n2 screenshot\n4 pointer 300 150\n12 screenshot\n", 14, "--backend", "cpu")
    assert read_png(out / "screenshot_00000.png") == read_png(out / "screenshot_00001.png"), "a paused picture changes"


def test_time(session):
    """Pause, single steps, roll-back, restart, determinism, slow motion."""
    script = ("0 keep 64 1\n3 pause\n5 print\n6 print\n7 step\n9 print\n10 resume\n14 pause\n15 print\n16 back {step}\n17 print\n"
              "18 determinism 4\n19 print\n20 restart\n22 print\n")
    for backend in ("cpu", "vulkan"):
        _, text, states, _ = session.run(script.format(step=2), 24, "--backend", backend)
        paused, still, stepped, later, back, checked, fresh = states
        assert paused == still, "a paused world went on"
        assert int(stepped["step"]) == int(paused["step"]) + 1
        assert int(later["step"]) > int(stepped["step"]) and int(later["kept"]) > 2
        assert int(back["step"]) == 2 and back["hash"] != later["hash"]
        assert checked["hash"] == back["hash"], "the determinism check changed the state"
        assert "determinism equal" in text
        assert int(fresh["step"]) == 0
    _, _, (whole,), _ = session.run("12 print\n", 13, "--backend", "cpu")
    _, _, (slow,), _ = session.run("0 speed 0.25\n12 print\n", 13, "--backend", "cpu")
    assert 0 < int(slow["step"]) < 0.5 * int(whole["step"])


def test_changes(session):
    """Another size, level, backend, view and quality in one run; recording makes numbered pictures and, with ffmpeg, a video."""
    levels = Path(__file__).resolve().parents[2] / "samples" / "levels"
    out, text, states, _ = session.run(f"2 resize 320 200\n5 view froude\n5 arrows\n6 section 10 48 80 48\n8 backend vulkan\n9 print\n10 level piles {levels}/piles/level.json\n"
                                       "12 quality medium\n13 quality low\n13 print\n14 view picture\n15 record on\n19 record off\n20 resize 400 240\n", 24, "--backend", "cpu")
    assert abs(float(states[0]["sand"]) - float(states[1]["sand"])) > 1, "the level did not change"
    recorded = sorted((out / "recording").glob("recording_*.png"))
    assert len(recorded) == 4, recorded
    assert (out / "recording" / "recording.mp4").exists() == (shutil.which("ffmpeg") is not None)
    if session.window:
        assert "window 400 x 240" in text, text
    else:
        assert read_png(out / "last.png")[:2] == (400, 240)


def test_panel(session):
    out, _, _, _ = session.run("1 section 10 48 80 48\n", 5, "--backend", "cpu", "--panel", size="960x540")
    _, _, rows = read_png(out / "last.png")
    dark = sum(1 for row in rows for x in range(40, 300) if max(row[3 * x:3 * x + 3]) < 80) / (260 * len(rows))
    assert dark > 0.5, f"the panel covers {dark:.2f} of its place"


def test_refusals(session):
    for script, says in (("0 dance\n", "dance"), ("x pause\n", "frame number"), ("0 pointer 3\n", "2 words"), ("0 tool spoon\n", "spoon")):
        _, _, _, errors = session.run(script, 3, "--backend", "cpu", code=2)
        assert says in errors, errors


def test_minimised(session):
    """Without area there is no picture; the world goes on."""
    _, text, (before, after), _ = session.run("2 print\n3 minimise\n8 restore\n11 print\n", 14, "--backend", "cpu")
    assert int(after["step"]) > int(before["step"])


def test_real_pointer(session):
    """A pointer and a key that come from the display server: a key chooses the tool, the button pours sand."""
    if shutil.which("xdotool") is None:
        print("xdotool is missing: no input from the display server")
        return
    _, process = session.start("1 strength 6\n1 radius 8\n" + "".join(f"{n} print\n" for n in range(10, 200, 10)), 200, "--backend", "cpu", size="800x450")
    for _ in range(200):
        found = subprocess.run(["xdotool", "search", "--name", "Wadi: dam_break"], capture_output=True, text=True, check=False).stdout.split()
        if found or process.poll() is not None:
            break
        time.sleep(0.2)
    assert found, "no window appeared"
    time.sleep(2)
    for words in (["windowfocus", found[0]], ["mousemove", "--window", found[0], "522", "286"], ["keydown", "2"], ["keyup", "2"], ["mousedown", "1"]):
        subprocess.run(["xdotool", *words], check=False, capture_output=True)
        time.sleep(2.5) # longer than a frame: a key that goes down and up within one is not seen
    subprocess.run(["xdotool", "mouseup", "1"], check=False)
    _, states, _ = session.finish(process)
    print(f"real pointer: {states[-1]['sand_in']} m3 of sand")
    assert float(states[0]["sand_in"]) == 0 and float(states[-1]["sand_in"]) > 1


def start_display():
    """An Xvfb of our own; its number comes through a pipe."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24"], pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        os.environ["DISPLAY"] = ":" + pipe.readline().strip()
    return server


def main():
    window = "--window" in sys.argv
    if window and shutil.which("Xvfb") is None:
        print("Xvfb is missing: no window")
        sys.exit(77)
    server = start_display() if window else None
    try:
        with tempfile.TemporaryDirectory() as folder:
            session = Session(sys.argv[1], Path(folder), window)
            if window:
                tests = (test_painting, test_changes, test_minimised, test_real_pointer)
            else:
                tests = (test_painting, test_tools, test_time, test_changes, test_panel, test_refusals)
            chosen = [word for word in sys.argv[2:] if word != "--window"]
            for test in (test for test in tests if not chosen or test.__name__ in chosen):
                start = time.time()
                test(session)
                print(f"{test.__name__}: well, {time.time() - start:.1f} s", flush=True)
    finally:
        if server is not None:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
