#!/usr/bin/env python3
"""Sessions of wadi-viewer by scripts of input, without a window (default) or in a real one under Xvfb and twm (--window; exit code
77 where a program for that is missing). Usage: interaction.py VIEWER [--window] [test_NAME ...]"""
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
POINTED = "320x180" # pictures in which a script points at places


# Sessions test input, not the land beyond the block, which takes half of a picture's time: they draw the block alone.
class Session:
    def __init__(self, program, folder, window):
        self.program, self.folder, self.window, self.number = str(Path(program).resolve()), folder, window, 0
        self.size = "640x360" if window else "96x54" # a window has the panel in it
        # A place beside the damp column, in a window and in POINTED. The panel moves the middle of the picture by half its 330 pixels.
        self.place = "452 229" if window else "143 115"

    def start(self, script, frames, *arguments, backend="cpu", size=None):
        self.number += 1
        out = self.folder / str(self.number)
        out.mkdir()
        (out / "script.txt").write_text(script)
        command = [self.program, "dam_break", "--script", out / "script.txt", "--frames", frames, "--quality", "low", "--out", out, "--every", 0.1, "--grid", "96x96",
                   "--validate", "--block", "--backend", backend, "--size", size or self.size, *arguments]
        if not self.window:
            command.append("--offscreen")
        return out, subprocess.Popen([str(c) for c in command], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def finish(self, process, code=0, before=""):
        text, errors = process.communicate(timeout=600)
        text = before + text
        assert process.returncode == code, f"exit code {process.returncode}, not {code}\n{text}\n{errors}"
        if code == 0:
            assert "validation 0 messages" in text, text
        return text, [dict(zip(("step", "sand", "water", "sand_in", "water_in", "kept", "hash"), found)) for found in STATE.findall(text)], errors

    def run(self, script, frames, *arguments, code=0, **options):
        out, process = self.start(script, frames, *arguments, **options)
        return (out, *self.finish(process, code))


def test_accuracy(session):
    """An accuracy preset makes the world anew (here, where --grid fixes the cells, with other sand substeps); without one it is as before."""
    _, _, (level, draft, again), _ = session.run("0 pause\n1 step\n2 print\n3 accuracy draft\n4 step\n5 print\n6 accuracy level\n7 step\n8 print\n", 10)
    assert level["step"] == draft["step"] == again["step"] == "1", (level, draft, again)
    assert level["hash"] == again["hash"] != draft["hash"], (level, draft, again)


def test_device(session):
    """A world moves to a device by number with the same bits; one that is not there is refused by name."""
    _, _, (first, moved), _ = session.run("0 pause\n1 step\n2 print\n3 device 0\n4 step\n5 print\n", 7)
    assert first["step"] == moved["step"] == "1" and first["hash"] == moved["hash"], (first, moved)
    _, _, _, errors = session.run("2 device 41\n", 4, code=2)
    assert "41" in errors, errors


def test_budget(session):
    """Settings found for a budget of milliseconds make the world anew, whatever --grid said; an impossible budget changes nothing and says so."""
    _, text, (before, after, again), _ = session.run("0 pause\n1 step\n2 print\n3 budget 1 0.05\n4 step\n5 print\n6 restart\n7 step\n8 print\n", 10)
    found = re.search(r"budget dam_break: (\d+) x (\d+) cells, .* ms of the 1 ms a frame", text)
    assert found and found.group(1) == found.group(2) != "96", text
    assert before["step"] == after["step"] == again["step"] == "1" and before["hash"] != after["hash"] == again["hash"], (before, after, again)
    _, text, (before, after), _ = session.run("0 pause\n1 step\n2 print\n3 budget 0.00001 0.05\n4 print\n", 6)
    assert "is too small: the cheapest settings" in text and before == after, text


def test_painting(session):
    """Sand painted at a pixel lands there, is in the ledger, and is seen; with the tool "look" the same input changes nothing."""
    for backend in ("cpu", "vulkan"):
        out, _, (before, looked, after), _ = session.run(
            f"0 radius 8\n0 strength 3\n1 print\n2 pointer {session.place}\n3 press left\n9 release left\n10 pointer 479 2\n11 print\n12 screenshot\n"
            f"13 tool add-sand\n13 pointer {session.place}\n14 press left\n20 release left\n21 pointer 479 2\n22 print\n23 screenshot\n", 26, backend=backend, size=POINTED)
        assert float(before["sand_in"]) == float(looked["sand_in"]) == 0
        poured = float(after["sand_in"])
        # 3 m/s for 6 frames of 0.1 s over a disc of 8 m whose mean is 0.3: 109 m3
        print(f"{backend}: {poured:.2f} m3 of sand painted")
        assert 100 < poured < 115
        bare, painted = (read_png(out / f"screenshot_0000{n}.png") for n in (0, 1))
        gained = share(painted, sandy) - share(bare, sandy)
        print(f"sand on {gained:.4f} more of the picture")
        assert gained > 0.006 and black_pixels(painted) == 0


def test_tools(session):
    """Water and ground by their brushes, a push, a placed source; the camera moves by drag, wheel and keys; a paused picture stays."""
    out, _, (first, second, third), _ = session.run(
        f"0 tool add-water\n0 radius 6\n0 strength 2\n0 pointer {session.place}\n1 press left\n4 release left\n5 print\n"
        "6 tool place-source\n7 press left\n8 release left\n8 tool look\n13 print\n"
        "14 tool take-sand\n14 pointer 200 80\n15 press left\n18 release left\n19 tool push\n20 press left\n"
        "21 pointer 213 86\n22 release left\n23 tool raise\n24 press left\n25 release left\n26 print\n"
        "26 tool look\n27 pause\n29 screenshot\n31 pointer 200 100\n33 screenshot\n"
        "34 press right\n35 pointer 240 93\n36 release right\n37 wheel 3\n38 key W\n40 screenshot\n", 42, size=POINTED)
    assert float(first["water_in"]) > 1 and float(second["water_in"]) > float(first["water_in"]) + 1
    assert float(third["sand"]) <= float(first["sand"])
    still, later, moved = (read_png(out / f"screenshot_0000{n}.png") for n in (0, 1, 2))
    assert still == later, "a paused picture changes"
    assert still != moved, "the camera did not move"


def test_time(session):
    """Pause, single steps, restart, slow motion."""
    script = "3 pause\n5 print\n6 print\n7 step\n9 print\n10 restart\n12 print\n12 resume\n18 print\n18 restart\n18 speed 0.25\n24 print\n"
    _, _, (paused, still, stepped, fresh, whole, slow), _ = session.run(script, 26)
    assert paused == still, "a paused world went on"
    assert int(stepped["step"]) == int(paused["step"]) + 1
    assert int(fresh["step"]) == 0
    assert 0 < int(slow["step"]) < 0.5 * int(whole["step"])


def stepped(first, frames):
    """A step in each frame, and the state ahead of it."""
    return "".join(f"{n} print\n{n} step\n" for n in range(first, first + frames))


def test_undo(session):
    """A stroke undone leaves the very state it began in, redone that which undo left, also after steps; a new one ends what could be redone."""
    strokes = (f"0 pause\n0 radius 8\n0 strength 3\n0 tool add-sand\n0 pointer {session.place}\n3 press left\n6 release left\n"
               "9 tool add-water\n9 press left\n12 release left\n")
    for backend in ("cpu", "vulkan"):
        _, text, states, _ = session.run(
            f"{strokes}{stepped(0, 16)}16 print\n17 undo\n18 print\n19 undo\n20 print\n21 redo\n22 print\n23 redo\n24 print\n"
            "25 undo\n26 step\n27 step\n28 redo\n29 print\n30 undo\n31 material friction 0.3\n32 step\n33 print\n34 key ctrl+Z\n36 print\n37 key ctrl+Y\n39 print\n40 replay\n41 print\n",
            43, backend=backend, size=POINTED)
        live = {state["step"]: state["hash"] for state in states[:16]}
        end, one, none, again_one, again_two, later, changed, unchanged, again_changed, replayed = states[16:]
        hashes = [state["hash"] for state in states[:17]]
        assert len(set(hashes)) == 17, hashes
        assert one["hash"] == live[one["step"]] and one["water_in"] == "0.000000" and float(one["sand_in"]) > 1, one
        assert none["hash"] == live[none["step"]] and none["sand_in"] == "0.000000", none
        assert again_one == {**one, "kept": again_one["kept"]}, (again_one, one)
        assert again_two["hash"] == later["hash"] == end["hash"], (again_two, later, end)
        assert unchanged["step"] == one["step"] and unchanged["hash"] == one["hash"], (unchanged, one)
        assert again_changed["hash"] == changed["hash"] == replayed["hash"] != one["hash"], (again_changed, changed, replayed)
        assert re.search(r"replay equal: \d+ bytes of commands", text), text
    _, _, _, errors = session.run("0 pause\n1 undo\n", 3, code=2)
    assert "nothing to undo" in errors, errors
    _, _, _, errors = session.run(f"{strokes}{stepped(0, 14)}15 undo\n16 material friction 0.3\n17 redo\n", 19, code=2, size=POINTED)
    assert "nothing to redo" in errors, errors


def test_scrub(session):
    """Each step of the past has the hash that it had, with what was done ahead of it and at it; from there the recorded goes on, or something new does."""
    _, text, states, _ = session.run(
        f"0 pause\n0 radius 8\n0 strength 3\n0 tool add-sand\n0 pointer {session.place}\n3 press left\n6 release left\n"
        "8 material friction 0.3\n9 tool push\n9 press left\n11 pointer 150 115\n12 release left\n13 material young_modulus 1e5\n"
        f"{stepped(0, 18)}18 print\n" + "".join(f"{20 + n} scrub {step}\n{21 + n} print\n" for n, step in enumerate((11, 8, 9, 13, 14, 2, 3, 18, 5))) +
        "".join(f"{n} step\n" for n in range(30, 43)) + "43 print\n44 replay\n45 scrub 10\n46 material friction 0.9\n47 step\n48 step\n49 print\n50 replay\n", 52, size=POINTED)
    live = {int(state["step"]): state["hash"] for state in states[:19]}
    assert len(live) == 19 and len(set(live.values())) == 19, live
    for state, step in zip(states[19:28], (11, 8, 9, 13, 14, 2, 3, 18, 5)):
        assert int(state["step"]) == step and state["hash"] == live[step], (state, step, live)
    followed, other = states[28:]
    assert int(followed["step"]) == 18 and followed["hash"] == live[18], (followed, live[18])
    assert int(other["step"]) == 12 and other["hash"] != live[12], other
    assert text.count("replay equal") == 2, text
    _, _, _, errors = session.run("0 pause\n1 step\n2 scrub 7\n", 4, code=2)
    assert "step 7 is not one of 0 ... 1" in errors, errors


def test_saves(session):
    """A state saved by key comes back by key, in another run of the level, too; another level refuses it and goes on."""
    out, _, (saved, later, loaded, stepped_again), _ = session.run("0 pause\n1 step\n2 step\n3 print\n4 key F5\n5 step\n6 print\n7 key F8\n9 print\n10 step\n11 print\n", 13)
    assert saved["hash"] == loaded["hash"] != later["hash"] == stepped_again["hash"], (saved, later, loaded, stepped_again)
    levels = Path(__file__).resolve().parents[2] / "samples" / "levels"
    script = f"0 pause\n1 load\n2 print\n3 level piles {levels}/piles/level.json\n"
    again, process = session.start(script + "5 print\n6 key F8\n8 print\n", 10)
    shutil.copy(out / "saved.wadi", again)
    text, (other_run, piles, kept), _ = session.finish(process)
    assert other_run["hash"] == saved["hash"], (other_run, saved)
    assert piles == kept and "other settings" in text, text


def test_changes(session):
    """Another size, level, backend, view and quality in one run; recording makes numbered pictures and, with ffmpeg, a video."""
    levels = Path(__file__).resolve().parents[2] / "samples" / "levels"
    out, text, states, _ = session.run(f"1 resize 360 200\n3 view froude\n3 arrows\n4 section 10 48 80 48\n5 backend vulkan\n6 print\n7 level piles {levels}/piles/level.json\n"
                                       "8 quality medium\n9 quality low\n9 print\n10 view picture\n11 record on\n14 record off\n15 resize 400 240\n", 19)
    assert abs(float(states[0]["sand"]) - float(states[1]["sand"])) > 1, "the level did not change"
    recorded = sorted((out / "recording").glob("recording_*.png"))
    assert len(recorded) == 3, recorded
    assert (out / "recording" / "recording.mp4").exists() == (shutil.which("ffmpeg") is not None)
    assert read_png(out / "last.png")[:2] == (400, 240)


def test_material(session):
    """A number of the material counts at once and outlives a restart; an effect switched off and on again leaves other states."""
    steps = lambda first: "".join(f"{n} step\n" for n in range(first, first + 6))
    _, _, (plain, slippery, again, back, without), _ = session.run(
        f"0 pause\n{steps(1)}8 print\n9 material friction 0.02\n9 restart\n{steps(10)}17 print\n18 restart\n{steps(19)}26 print\n"
        f"27 material friction 0.5\n27 restart\n{steps(28)}35 print\n36 effect elastoplastic off\n36 restart\n{steps(37)}44 print\n45 effect elastoplastic on\n", 47)
    assert plain["step"] == slippery["step"] == without["step"] == "6"
    assert slippery["hash"] == again["hash"] and plain["hash"] == back["hash"]
    assert len({plain["hash"], slippery["hash"], without["hash"]}) == 3
    for script, says in (("0 material friction 99\n", "0 ... 10"), ("0 material fiction 1\n", "friction"), ("0 effect water off\n", "water")):
        _, _, _, errors = session.run(script, 2, code=2)
        assert says in errors, errors


def test_panel(session):
    out, _, _, _ = session.run("1 section 10 48 80 48\n", 5, "--panel", size="800x450")
    _, _, rows = read_png(out / "last.png")
    dark = sum(1 for row in rows for x in range(40, 300) if max(row[3 * x:3 * x + 3]) < 80) / (260 * len(rows))
    assert dark > 0.5, f"the panel covers {dark:.2f} of its place"


def test_one_queue(session):
    """Pictures, panel and world share one queue, chosen by what it can do. Software devices have no other family, so every test
    here runs without a compute-only queue; devices that have one leave it alone, by the same code."""
    _, text, _, _ = session.run("0 print\n", 1)
    used, families = map(int, re.search(r"queue family (\d+) of (\d+)", text).groups())
    print(f"queue family {used} of {families}")
    assert 0 <= used < families


def test_refusals(session):
    for script, says in (("0 dance\n", "dance"), ("x pause\n", "frame number"), ("0 pointer 3\n", "2 words"), ("0 tool spoon\n", "spoon")):
        _, _, _, errors = session.run(script, 3, code=2)
        assert says in errors, errors
    _, _, _, errors = session.run("1 step\n", 3, "--start", 1, code=2)  # which a scripted session would not heed
    assert "--start" in errors and "--script" in errors, errors


def test_minimised(session):
    """Without area there is no picture; the world goes on, and the picture is back with the window."""
    _, text, (before, after), _ = session.run("2 print\n3 minimise\n10 restore\n16 print\n", 20)
    frames = int(re.search(r"minimised for (\d+) frames", text).group(1))
    print(f"minimised for {frames} frames of 20")
    assert 2 <= frames <= 12
    assert int(after["step"]) > int(before["step"])


def test_real_input(session):
    """Input from the display server: a key chooses the tool, the button pours sand, the window is resized, minimised and closed."""
    _, process = session.start("1 strength 3\n1 radius 8\n" + "".join(f"{n} print\n" for n in range(2, 400, 2)), 400)
    seen = []

    def wait_frames(frames):
        """The world's states are the clock: one is printed every second frame."""
        for _ in range(frames // 2):
            line = ""
            while not STATE.search(line):
                line = process.stdout.readline()
                assert line, "the viewer ended: " + process.stderr.read()
                seen.append(line)
        return float(STATE.search(seen[-1]).group(4))

    def xdotool(*words):
        return subprocess.run(["xdotool", *map(str, words)], check=False, capture_output=True, text=True).stdout.split()

    assert wait_frames(4) == 0
    window = xdotool("search", "--name", "Wadi: dam_break")[0]
    xdotool("windowfocus", window)
    xdotool("mousemove", "--window", window, *session.place.split())
    wait_frames(4)
    xdotool("keydown", 2)
    wait_frames(4) # a key that goes down and up within one frame is not seen
    xdotool("keyup", 2)
    xdotool("mousedown", 1)
    wait_frames(8)
    xdotool("mouseup", 1)
    poured = wait_frames(4)
    xdotool("windowsize", window, 660, 370)
    wait_frames(4)
    xdotool("key", "F11") # the window manager's key for minimising, below
    wait_frames(8)
    xdotool("windowmap", window)
    wait_frames(4)
    xdotool("key", "F10") # and for closing
    text, _, _ = session.finish(process, before="".join(seen))
    print(f"real input: {poured} m3 of sand; {text.splitlines()[-2]}")
    assert poured > 1
    assert re.search(r"window 660 x 370, minimised for [1-9]\d* frames", text), text


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


def main():
    window = "--window" in sys.argv
    missing = [program for program in ("Xvfb", "twm", "xdotool") if window and shutil.which(program) is None]
    if missing:
        print("no window without", ", ".join(missing))
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        running = start_display(Path(folder)) if window else []
        try:
            session = Session(sys.argv[1], Path(folder), window)
            if window:
                tests = (test_minimised, test_real_input)
            else:
                tests = (test_painting, test_tools, test_time, test_undo, test_scrub, test_saves, test_accuracy, test_budget, test_device, test_changes, test_material, test_panel, test_one_queue, test_refusals)
            chosen = [word for word in sys.argv[2:] if word != "--window"]
            for test in (test for test in tests if not chosen or test.__name__ in chosen):
                start = time.time()
                test(session)
                print(f"{test.__name__}: well, {time.time() - start:.1f} s", flush=True)
        finally:
            for program in running:
                program.terminate()
                program.wait()


if __name__ == "__main__":
    main()
