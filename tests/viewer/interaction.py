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
from session import POINTED, SMALL, SPOT, STATE, Session, start_display


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
            f"0 radius 8\n0 rate 3\n1 print\n2 pointer {session.place}\n3 press left\n9 release left\n10 pointer 479 2\n11 print\n12 screenshot\n"
            f"13 tool pour-sand\n13 pointer {session.place}\n14 press left\n20 release left\n21 pointer 479 2\n22 print\n23 screenshot\n", 26, backend=backend, size=POINTED)
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
        f"0 tool pour-water\n0 radius 6\n0 rate 2\n0 pointer {session.place}\n1 press left\n4 release left\n5 print\n"
        "6 tool spring\n7 press left\n8 release left\n8 tool look\n13 print\n"
        "14 tool dig\n14 pointer 200 80\n15 press left\n18 release left\n19 tool push\n20 press left\n"
        "21 pointer 213 86\n22 release left\n23 tool raise-ground\n24 press left\n25 release left\n26 print\n"
        "26 tool look\n27 pause\n29 screenshot\n31 pointer 200 100\n33 screenshot\n"
        "34 press right\n35 pointer 240 93\n36 release right\n37 wheel 3\n38 key W\n40 screenshot\n", 42, size=POINTED)
    assert float(first["water_in"]) > 1 and float(second["water_in"]) > float(first["water_in"]) + 1
    assert float(third["sand"]) <= float(first["sand"])
    still, later, moved = (read_png(out / f"screenshot_0000{n}.png") for n in (0, 1, 2))
    assert still == later, "a paused picture changes"
    assert still != moved, "the camera did not move"


def test_gamepad(session):
    """A gamepad pours sand in the middle of the picture, undoes it and brings it back, pauses, takes the next tool and moves the camera. A stick
    hardly moved is not meant."""
    rest = "pad 0 0 0 0 0 0"
    tap = lambda frame, button: f"{frame} {rest} {button}\n{frame + 1} {rest} -\n"
    out, _, (before, poured, undone, paused, redone, dug), _ = session.run(
        f"0 tool pour-sand\n0 radius 8\n0 rate 3\n1 print\n2 {rest} a\n8 {rest} -\n9 print\n" + tap(10, "u") + tap(12, "p") + "13 print\n14 print\n" +
        tap(15, "r") + "16 print\n" + tap(17, "u") + tap(19, "p") + tap(21, ">") + f"23 {rest} a\n27 {rest} -\n28 print\n29 pause\n30 screenshot\n"
        f"31 pad 0.1 0.1 0.1 0.1 0 0 -\n33 screenshot\n34 pad 0.8 0 0 0 0 0 -\n36 {rest} -\n37 screenshot\n38 pad 0 0 0.8 0 0 0 -\n40 {rest} -\n41 screenshot\n"
        f"42 pad 0 0 0 0 0 1 -\n44 {rest} -\n45 screenshot\n", 47, size=POINTED)
    assert float(poured["sand_in"]) > 50 and float(undone["sand"]) == float(before["sand"])
    assert paused == undone, "the world goes on although it is paused"
    assert redone["sand"] == poured["sand"], "what was undone does not come back"
    assert float(dug["sand"]) < float(undone["sand"]) - 1, "the next tool digs"
    still, dead, moved, turned, nearer = (read_png(out / f"screenshot_0000{n}.png") for n in range(5))
    assert still == dead, "a stick within its dead zone moves the camera"
    assert still != moved and moved != turned and turned != nearer


NUMBERS = re.compile(r"numbers (.*)")


def volumes(text):
    """The last number of each line of a tool's numbers."""
    return [float(re.findall(r"([+-]?[\d.]+) m3", line)[-1]) for line in NUMBERS.findall(text)]


def test_shaping(session):
    """Walls, stamps, smoothing and flattening do what their numbers say ahead of it; smoothing makes no sand; the log plays all of it."""
    x, y = SPOT
    for backend in ("cpu", "vulkan"):
        _, text, states, _ = session.run(
            f"0 pause\n0 radius 5\n0 height 2\n0 tool wall\n0 pointer {x} {y}\n1 print\n2 press left\n4 pointer {x + 10} {y + 4}\n5 numbers\n6 release left\n8 print\n"
            f"8 pointer {x} {y}\n8 tool stamp\n8 stamp castle\n8 radius 6\n9 wet 0.25\n10 numbers\n10 press left\n12 release left\n14 print\n"
            f"15 tool smooth\n15 press left\n18 release left\n20 print\n21 tool flatten\n21 rate 4\n21 press left\n24 numbers\n24 release left\n26 print\n27 replay\n28 undo\n29 print\n",
            31, backend=backend, size=SMALL)
        first, wall, stamp, smooth, flat, undone = states
        sand = lambda state: float(state["sand"])
        raised, stamped, flattened = volumes(text)
        print(f"{backend}: wall {sand(wall) - sand(first):.2f} m3, said {raised}; stamp {sand(stamp) - sand(wall):.2f}, said {stamped}; "
              f"flattened {sand(flat) - sand(smooth):+.2f}, said {flattened:+.2f}")
        assert abs(sand(wall) - sand(first) - raised) < 0.02 * raised and raised > 100, (first, wall, text)
        assert abs(sand(stamp) - sand(wall) - stamped) < 0.02 * stamped and stamped > 50, (wall, stamp, text)
        assert abs(float(stamp["water"]) - float(wall["water"]) - 0.25 * stamped) < 0.01 * stamped, (wall, stamp)
        assert sand(smooth) == sand(stamp) and smooth["hash"] != stamp["hash"], (stamp, smooth)
        assert abs(sand(flat) - sand(smooth) - flattened) < 1e-2 and abs(flattened) > 1, (smooth, flat, text)
        assert "replay equal" in text and undone["hash"] == smooth["hash"], (undone, smooth)
    _, _, _, errors = session.run("0 stamp nowhere.png\n", 2, code=2)
    assert "nowhere.png" in errors and "castle, cone, crater, ring" in errors, errors


def test_springs(session):
    """A spring runs until it is closed, a drain takes; both go with undo, and the log has them."""
    _, text, states, _ = session.run(
        f"0 pause\n0 radius 6\n0 rate 0.5\n0 tool spring\n0 pointer {SPOT[0]} {SPOT[1]}\n1 print\n1 press left\n2 release left\n{stepped(3, 4)}7 print\n8 close\n9 step\n10 print\n11 step\n12 step\n13 print\n"
        "14 undo\n15 step\n16 step\n17 print\n18 tool drain\n18 pointer 30 45\n19 press left\n20 release left\n21 step\n22 step\n23 print\n24 replay\n", 26, size=SMALL)
    first, running, closed, still, open_again, drained = states[0], states[5], states[6], states[7], states[8], states[9]
    water_in = lambda state: float(state["water_in"])
    assert water_in(first) == 0 < 1 < water_in(running) < water_in(closed) + 1e-9, (first, running, closed)
    assert water_in(still) == water_in(closed), "a closed spring runs"
    assert water_in(open_again) > water_in(running), "undo left the spring closed"
    assert float(drained["water_out"]) > 1, drained
    assert "replay equal" in text, text


def test_presets(session):
    """Kinds of sand are numbers of the material, undone as one; an unknown one is refused by name."""
    steps = lambda first: "".join(f"{n} step\n" for n in range(first, first + 4))
    _, text, (plain, mud, undone), _ = session.run(f"0 pause\n{steps(1)}6 print\n7 scrub 0\n8 preset mud\n{steps(9)}14 print\n15 undo\n{steps(16)}21 print\n22 replay\n", 24)
    assert plain["step"] == mud["step"] == undone["step"] == "4"
    assert plain["hash"] == undone["hash"] != mud["hash"], (plain, mud, undone)
    assert "replay equal" in text, text
    _, _, _, errors = session.run("0 preset soup\n", 2, code=2)
    assert "dry, damp, mud and gravel" in errors, errors


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
    strokes = (f"0 pause\n0 radius 8\n0 rate 3\n0 tool pour-sand\n0 pointer {SPOT[0]} {SPOT[1]}\n3 press left\n6 release left\n"
               "9 tool pour-water\n9 press left\n12 release left\n")
    for backend in ("cpu", "vulkan"):
        _, text, states, _ = session.run(
            f"{strokes}{stepped(0, 16)}16 print\n17 undo\n18 print\n19 undo\n20 print\n21 redo\n22 print\n23 redo\n24 print\n"
            "25 undo\n26 step\n27 step\n28 redo\n29 print\n30 undo\n31 material friction 0.3\n32 step\n33 print\n34 key ctrl+Z\n36 print\n37 key ctrl+Y\n39 print\n40 replay\n41 print\n",
            43, backend=backend, size=SMALL)
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
    _, _, _, errors = session.run(f"{strokes}{stepped(0, 14)}15 undo\n16 material friction 0.3\n17 redo\n", 19, code=2, size=SMALL)
    assert "nothing to redo" in errors, errors


def test_scrub(session):
    """Each step of the past has the hash that it had, with what was done ahead of it and at it; from there the recorded goes on, or something new does."""
    _, text, states, _ = session.run(
        f"0 pause\n0 radius 8\n0 rate 3\n0 tool pour-sand\n0 pointer {SPOT[0]} {SPOT[1]}\n3 press left\n6 release left\n"
        "8 material friction 0.3\n9 tool push\n9 press left\n11 pointer 75 58\n12 release left\n13 material young_modulus 1e5\n"
        f"{stepped(0, 18)}18 print\n" + "".join(f"{20 + n} scrub {step}\n{21 + n} print\n" for n, step in enumerate((11, 8, 9, 13, 14, 2, 3, 18, 5))) +
        "".join(f"{n} step\n" for n in range(30, 43)) + "43 print\n44 replay\n45 scrub 10\n46 material friction 0.9\n47 step\n48 step\n49 print\n50 replay\n", 52, size=SMALL)
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

    # The third picture of the tool bar pours sand, the first turns the view; the folded panel leaves the whole picture.
    pour = "{0} pointer 450 200\n{0} press left\n{1} release left\n{1} print\n"
    _, _, (poured, looked), _ = session.run("0 radius 6\n0 rate 3\n1 pointer 100 298\n2 press left\n3 release left\n" + pour.format(4, 6) +
                                            "7 pointer 24 298\n8 press left\n9 release left\n" + pour.format(10, 12), 13, "--panel", size="560x330")
    assert float(poured["sand_in"]) == float(looked["sand_in"]) > 10, (poured, looked)
    out, _, _, _ = session.run("1 key Tab\n", 5, "--panel", size="800x450")
    _, _, rows = read_png(out / "last.png")
    folded = sum(1 for row in rows for x in range(40, 300) if max(row[3 * x:3 * x + 3]) < 80) / (260 * len(rows))
    assert folded < 0.3, f"the folded panel covers {folded:.2f} of its place"


def card(n, count, width, height):
    """Where start_screen.cpp puts the picture of a level: left, top, width, height [pixels]. Lines of text are 17 pixels high."""
    for columns in range(1, count + 1):
        across = (width - 12) / columns - 12
        down = across * 180 / 320
        rows = (count + columns - 1) // columns
        if 2.5 * 17 + rows * (down + 3 * 17 + 12) <= height:
            break
    return int(12 + n % columns * (across + 12)), int(2.5 * 17 + n // columns * (down + 3 * 17 + 12)), int(across), int(down)


def colours(picture, left, top, width, height):
    """Different colours in a rectangle of a picture."""
    return len({row[3 * x:3 * x + 3] for row in picture[2][top:top + height] for x in range(left, left + width)})


def test_start_screen(session):
    """Without a level there are pictures of all; a click opens one, Escape leads back. A level without a picture gets its last one."""
    levels = session.folder / "own_levels"
    source = Path(__file__).resolve().parents[2] / "samples" / "levels" / "dam_break" / "level.json"
    (levels / "aaa").mkdir(parents=True)
    shutil.copy(source, levels / "aaa")
    environment = {"WADI_LEVELS": str(levels), "XDG_CACHE_HOME": str(session.folder / "cache")}
    listed = subprocess.run([session.program, "--list-levels"], check=True, capture_output=True, text=True, env={**os.environ, **environment}).stdout.split("\n")
    names = [line.split()[0] for line in listed if line]
    assert names[0] == "aaa" and "dam_break" in names, names
    at = [card(n, len(names), 640, 360) for n in range(len(names))]
    middle = lambda n: f"{at[n][0] + at[n][2] // 2} {at[n][1] + at[n][3] // 2}"
    own, text, (opened,), _ = session.run(f"1 pointer {middle(0)}\n2 press left\n3 release left\n5 pause\n7 print\n8 key Escape\n", 12, level=None, size="640x360", environment=environment)
    assert abs(float(opened["sand"]) - 4644.88) < 0.01, opened
    before = read_png(own / "last.png")
    again, _, _, _ = session.run("0 pointer 1 1\n", 3, level=None, size="640x360", environment=environment)
    after = read_png(again / "last.png")
    shipped = at[names.index("castle")]
    for picture in (before, after):
        assert colours(picture, *shipped) > 500, "the castle has no picture"
        assert colours(picture, *at[0]) > 200, "the level that was left has no picture"
    assert len(list((session.folder / "cache" / "wadi" / "pictures").glob("*.png"))) == 1
    _, _, _, errors = session.run("0 pause\n", 1, level="no_such_level", code=2)
    assert "no_such_level" in errors, errors


def test_scale(session):
    """Fewer pixels are drawn where a picture takes longer than it may, and all again where it does not; files have all of them."""
    scale = re.compile(r"scale ([\d.]+)")
    plain, text, _, _ = session.run("0 pause\n9 scale\n9 screenshot\n", 12, size=SMALL)
    assert scale.findall(text) == ["1"], text
    coarse, text, _, _ = session.run("0 pause\n0 hold 0.001\n9 scale\n9 screenshot\n", 12, size=SMALL)
    assert scale.findall(text) == ["0.25"], text
    assert (plain / "screenshot_00000.png").read_bytes() == (coarse / "screenshot_00000.png").read_bytes(), "a file lacks pixels"
    fine, few = read_png(plain / "last.png"), read_png(coarse / "last.png")
    off = sum(abs(a - b) for x, y in zip(fine[2], few[2]) for a, b in zip(x, y)) / (3 * fine[0] * fine[1])
    print(f"a sixteenth of the pixels, enlarged: {off:.2f} of 255 off")
    assert fine[:2] == few[:2] and 0.5 < off < 15
    _, text, _, _ = session.run(f"0 pause\n0 hold 0.001\n9 scale\n9 hold 1000000\n19 scale\n20 tool pour-sand\n20 pointer {SPOT[0]} {SPOT[1]}\n21 press left\n23 release left\n24 print\n", 26, size=SMALL)
    assert scale.findall(text) == ["0.25", "1"], text


def test_hot_reload(session):
    """A level that is saved by another program begins again; one with an error is told, and the world goes on."""
    folder = session.folder / "edited"
    folder.mkdir()
    file = folder / "level.json"
    shipped = (Path(__file__).resolve().parents[2] / "samples" / "levels" / "dam_break" / "level.json").read_text()
    file.write_text(shipped)
    _, process = session.start("0 pause\n1 step\n" + "".join(f"{n} print\n{n} message\n" for n in range(3, 3000, 2)), 3000, level=file)

    def wait_for(words):
        state = None
        while True:
            line = process.stdout.readline()
            assert line, process.stderr.read()
            found = STATE.search(line)
            state = found or state
            if words in line and state:
                return state

    try:
        first = wait_for("message")
        file.write_text(shipped.replace('"radius": 14', '"radius": "wide"'))
        broken = wait_for("the world goes on")
        assert broken.group(1, 8) == first.group(1, 8) and first.group(1) == "1", (first, broken)
        file.write_text(shipped.replace('"radius": 14', '"radius": 7'))
        wait_for("begun again")
        again = wait_for("message")
        assert again.group(1) == "0" and float(again.group(2)) < 0.6 * float(first.group(2)), (first, again)
    finally:
        process.kill()
        process.communicate()


def test_write_world(session):
    """A world written as a level begins with the ground, sand, water and springs that it had."""
    out, _, (written,), _ = session.run(f"0 radius 8\n0 rate 2\n0 tool raise-ground\n0 pointer {SPOT[0]} {SPOT[1]}\n1 press left\n3 release left\n4 tool spring\n4 press left\n5 release left\n"
                                        "8 pause\n9 print\n9 write-world\n", 11, size=SMALL)
    _, _, (begun, later), _ = session.run("0 pause\n0 print\n1 step\n2 step\n3 print\n", 5, level=out / "level" / "level.json")
    assert begun["step"] == "0" and all(begun[key] == written[key] for key in ("sand", "water", "ground")), (written, begun)
    assert float(later["water_in"]) > 1, later


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
    _, process = session.start("1 rate 3\n1 radius 8\n" + "".join(f"{n} print\n" for n in range(2, 400, 2)), 400)
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
    xdotool("keydown", 3)
    wait_frames(4) # a key that goes down and up within one frame is not seen
    xdotool("keyup", 3)
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
                tests = (test_painting, test_tools, test_gamepad, test_shaping, test_springs, test_presets, test_time, test_undo, test_scrub, test_saves, test_accuracy, test_budget, test_device, test_changes, test_material, test_panel, test_start_screen, test_scale, test_hot_reload, test_write_world, test_one_queue, test_refusals)
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
