#!/usr/bin/env python3
"""wadi-mesh-host without a window and, where Xvfb and xdotool are, in one. Each check is also seen to fail: with a line of a shader changed
(SHADERS), or with a library between the host and Vulkan that does harm (faults.c).
Usage: mesh_host.py HOST RECORDER FAULTS_LIBRARY SOURCE_DIR"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "viewer"))
from pictures import pixels, read_png, share

LAYERS = {"VK_INSTANCE_LAYERS": "VK_LAYER_KHRONOS_validation", "VK_LAYER_ENABLES": "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT"}
MESSAGE = re.compile("Validation (Error|Warning)|VUID-|SYNC-HAZARD")  # of the layers
SHADERS = {  # what a line of a shader is changed to
    "no morphing": ("surface.vert", "morph = clamp((away - 0.75) / 0.24, 0.0, 1.0);", "morph = 0.0;"),
    "no water": ("water.frag", "if (depth <= 0.0) discard;", "if (depth < 1e6) discard;"),
    "no wetness": ("ground.frag", "smoothstep(0.02, 0.42, field(SATURATION, at))", "0.0"),
    "no shadows": ("ground.frag", "sun = SUNLIGHT * sunlit(at);", "sun = SUNLIGHT;"),
    "no foam": ("water.frag", "foam = field(FOAM, at)", "foam = 0.0"),
    "opaque water": ("water.frag", "cover = 1.0 - exp(-1.1 * path)", "cover = 1.0"),
}


class Host:
    def __init__(self, program, faults, shaders, folder):
        self.program, self.faults, self.shaders, self.folder = Path(program).resolve(), str(Path(faults).resolve()), shaders, folder
        self.number, self.peak, self.code = 0, 0, 0

    def run(self, *arguments, code=0, fault=None, environment=()):
        """What it prints. `peak`: the most memory it took [KiB]."""
        extra = {"LD_PRELOAD": self.faults, "WADI_FAULT": fault} if fault else {}
        with open(self.folder / "output", "w+", encoding="utf-8") as output:
            process = subprocess.Popen([self.program, *map(str, arguments)], cwd=self.folder, stdout=output, stderr=subprocess.STDOUT, env={**os.environ, **extra, **dict(environment)})
            _, status, used = os.wait4(process.pid, 0)
            self.code = process.returncode = os.waitstatus_to_exitcode(status)
            output.seek(0)
            text = output.read()
        self.peak = used.ru_maxrss
        assert code in (None, process.returncode), f"{arguments}: exit code {process.returncode}, not {code}\n{text}"
        return text

    def picture(self, level, *arguments):
        self.number += 1
        file = self.folder / f"{self.number}.png"
        self.run(level, "--picture", file, "--backend", "cpu", *arguments)
        return read_png(file)

    def changed(self, change):
        """The same host with one line of a shader changed."""
        shader, old, new = SHADERS[change]
        folder = self.folder / change.replace(" ", "_")
        if not folder.exists():
            shutil.copytree(self.shaders, folder / "sources")
            shutil.copytree(self.program.parent / "mesh_shaders", folder / "mesh_shaders")
            shutil.copy2(self.program, folder)
            source = folder / "sources" / shader
            text = source.read_text(encoding="utf-8")
            assert text.count(old) == 1, f"{shader} has the line of \"{change}\" {text.count(old)} times: {old}"
            source.write_text(text.replace(old, new), encoding="utf-8")
            subprocess.run(["glslangValidator", "-V", "--quiet", "--target-env", "vulkan1.1", f"-I{folder / 'sources'}", "-o", folder / "mesh_shaders" / f"{shader}.spv", source], check=True)
        return Host(folder / self.program.name, self.faults, self.shaders, folder)


def hash_in(text):
    return re.search(r"hash (\w{16})", text).group(1)


def part(picture, left, top, right, bottom):
    """A rectangle in shares of the whole."""
    width, height, rows = picture
    x0, x1, y0, y1 = int(left * width), int(right * width), int(top * height), int(bottom * height)
    return x1 - x0, y1 - y0, [row[3 * x0:3 * x1] for row in rows[y0:y1]]


def brightness(picture):
    return sum(map(sum, picture[2])) / (3 * picture[0] * picture[1])


def bluish(r, g, b):
    return b > r + 25 and b > 40


def background(r, g, b):
    """Some of the magenta that nothing was drawn over: no ground, water or sky has so little green."""
    return min(r, b) > g + 20


def test_holes(host):
    """Nowhere does the mesh let the background through, from two places, over levels of detail and beyond the grid's rim."""
    places = (("--yaw", -35, "--pitch", 35, "--distance", 0.5), ("--yaw", 130, "--pitch", 12, "--distance", 0.9))
    scene = ("canyon", "--seconds", 0.1, "--size", "480x270")
    for place in places:
        shot = host.picture(*scene, *place)
        holes = sum(background(*pixel) for pixel in pixels(shot))
        assert holes == 0, f"{place}: {holes} pixels of background"
    torn = [sum(background(*pixel) for pixel in pixels(host.changed("no morphing").picture(*scene, *place))) for place in places]
    print(f"holes: none; {torn[0]} and {torn[1]} pixels without morphing")
    assert sum(torn) > 4, "a mesh without morphing has no holes: this test sees nothing"


def test_water(host):
    """Seen from above dam_break has water on 39 m x 40 m of 96 m x 96 m, in the south-west. Through it the ground is seen."""
    scene = ("dam_break", "--cells", "96x96", "--yaw", 0, "--pitch", 89, "--distance", 1.3, "--size", "160x160")

    def shares(shot):
        return share(part(shot, 0.1, 0.6, 0.4, 0.9), bluish), share(part(shot, 0.55, 0.05, 0.95, 0.45), bluish)

    wet, dry = shares(host.picture(*scene))
    gone, _ = shares(host.changed("no water").picture(*scene))
    print(f"water: blue are {wet:.3f} of the south-west, {dry:.3f} of the north-east; {gone:.3f} of the south-west without water")
    assert wet > 0.95 and dry < 0.01 and gone < 0.01
    flood = (*scene, "--seconds", 3)
    shown, opaque, plain = (brightness(h.picture(*flood)) for h in (host, host.changed("opaque water"), host.changed("no foam")))
    print(f"a flood: brightness {shown:.1f}, {opaque:.1f} if nothing were seen through water, {plain:.1f} without foam")
    assert abs(shown - opaque) > 2 and shown - plain > 1


def test_sand(host):
    """The damp column of dam_break is darker than the dry one, and both throw shadows to the west."""
    scene = ("dam_break", "--cells", "96x96", "--yaw", 0, "--pitch", 89, "--distance", 1.3, "--size", "160x160")

    def measured(shot):
        dry, damp = part(shot, 0.58, 0.33, 0.66, 0.41), part(shot, 0.66, 0.68, 0.74, 0.76)
        shadow, lit = part(shot, 0.445, 0.33, 0.465, 0.40), part(shot, 0.30, 0.10, 0.45, 0.20)
        return brightness(dry) - brightness(damp), brightness(lit) - brightness(shadow)

    darker, shaded = measured(host.picture(*scene))
    alike, _ = measured(host.changed("no wetness").picture(*scene))
    _, flat = measured(host.changed("no shadows").picture(*scene))
    print(f"sand: damp is darker by {darker:.1f}, by {alike:.1f} without wetness; shadows by {shaded:.1f}, by {flat:.1f} without them")
    assert darker > 8 and alike < 3
    assert shaded > 25 and flat < 10


def test_state(host, recorder):
    """Drawing changes no bit of the world, on the host's own device or beside it; pictures of both ways to the outputs are alike."""
    shots, hashes = [], []
    for backend in ("cpu", "vulkan"):
        file = host.folder / f"{backend}.png"
        text = host.run("dam_break", "--cells", "64x64", "--seconds", 1.08, "--frames", 8, "--backend", backend, "--picture", file, "--size", "96x54")
        assert f"simulated by {backend}" in text, text
        hashes.append(hash_in(text))
        shots.append(read_png(file))
    report = subprocess.run([recorder, "dam_break", "--size", "64x64", "--seconds", "1.08", "--no-frames", "--backend", "cpu", "--out", host.folder / "recorded"], capture_output=True, text=True, check=True)
    undrawn = re.search(r"hash\W+(\w{16})", report.stdout + report.stderr).group(1)
    later = hash_in(host.run("dam_break", "--cells", "64x64", "--seconds", 1.3, "--backend", "cpu", "--picture", host.folder / "later.png", "--size", "96x54"))
    off = [abs(a - b) for one, other in zip(*(shot[2] for shot in shots)) for a, b in zip(one, other)]
    print(f"state: hashes {hashes}, {undrawn} without drawing, {later} later; pictures differ by {max(off)} at most")
    assert hashes == [undrawn, undrawn] and later != undrawn
    assert max(off) == 0


def test_memory(host):
    """200 frames more take no more memory."""
    scene = ("dam_break", "--cells", "64x64", "--seconds", 1, "--size", "48x32", "--backend", "vulkan", "--picture", host.folder / "m.png", "--frames")

    def growth(fault):
        host.run(*scene, 20, fault=fault)
        short = host.peak
        host.run(*scene, 220, fault=fault)
        return host.peak - short

    kept, leaking = growth(None), growth("leak")
    print(f"memory: 200 frames more take {kept} KiB, {leaking} KiB with 64 KiB of each lost")
    assert kept < 4096 < leaking


def test_validation(host):
    """The validation layers say nothing, in both ways to the outputs."""
    if not any(Path(folder).glob("vulkan/explicit_layer.d/VkLayer_khronos_validation.json") for folder in ("/usr/share", "/usr/local/share", "/etc")):
        print("validation: no layers here")
        return
    for backend in ("cpu", "vulkan"):
        scene = ("dam_break", "--cells", "32x32", "--seconds", 0.5, "--frames", 3, "--size", "64x48", "--backend", backend, "--picture", host.folder / "v.png")
        text = host.run(*scene, environment=LAYERS)
        assert not MESSAGE.search(text), text
    wrong = host.run(*scene, environment=LAYERS, fault="layouts")
    assert MESSAGE.search(wrong), f"the layers do not notice images without their layout: this test sees nothing\n{wrong}"
    print(f"validation: silent; {len(MESSAGE.findall(wrong))} messages without layouts")


def test_refusals(host):
    for arguments, words in ((("nowhere",), ("nowhere",)), (("dam_break", "--size", "10x9000"), ("--size", "16", "8192")),
                             (("dam_break", "--cells", "0x4"), ("--cells", "1", "16384")), (("dam_break", "--seconds", -1), ("--seconds", "0", "3600")),
                             (("dam_break", "--pitch", 0), ("--pitch", "2", "89")), (("dam_break", "--distance", "nan"), ("--distance", "0.05", "4")),
                             (("dam_break", "--backend", "abacus"), ("--backend", "vulkan", "cpu")), (("dam_break", "--frames", 0), ("--frames", "1", "100000")),
                             (("dam_break", "--size", "100"), ("--size",)), ((), ("LEVEL",)),
                             (("dam_break", "--cells", "32x32", "--picture", "/nowhere/a.png", "--size", "32x32"), ("--picture", "/nowhere/a.png"))):
        text = host.run(*arguments, *(() if "--picture" in arguments else ("--picture", host.folder / "no.png")), code=2)
        assert all(word in text for word in words), f"{arguments}: {text}"
        assert not (host.folder / "no.png").exists()
    lost = host.run("dam_break", "--cells", "32x32", "--frames", 9, "--size", "32x32", "--picture", host.folder / "no.png", fault="lost", code=2)
    assert "vkQueueSubmit: the device is lost" in lost, lost
    assert "--pitch" in host.run("--help")
    print("refusals: option and range are named, a lost device is told")


def test_window(host):
    """In a window that changes its size. The world is in the state that as many steps without a window lead to."""
    missing = [program for program in ("Xvfb", "xdotool") if shutil.which(program) is None]
    if missing:
        print("window: none without", *missing)
        return
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24"], pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as pipe:
            display = {"DISPLAY": ":" + pipe.readline().strip()}
        for backend in ("vulkan", "cpu"):
            scene = ("dam_break", "--cells", "48x48", "--backend", backend)
            process = subprocess.Popen(["stdbuf", "-oL", host.program, *scene, "--size", "200x120", "--seconds", "10"], env={**os.environ, **display, **LAYERS},
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            text = ""
            while "simulated by" not in text and process.poll() is None:
                text += process.stdout.readline()
            time.sleep(2) # the window has its first pictures
            window = subprocess.run(["xdotool", "search", "--name", "Wadi: dam_break"], env={**os.environ, **display}, capture_output=True, text=True, check=False).stdout.split()
            subprocess.run(["xdotool", "windowsize", *window[:1], "150", "200"], env={**os.environ, **display}, check=False)
            text += process.communicate(timeout=400)[0]
            assert process.returncode == 0 and not MESSAGE.search(text), f"exit code {process.returncode}\n{text}"
            frames, size, seconds = re.search(r"(\d+) frames of (.*) pixels, t = ([\d.]+) s", text).groups()
            alone = host.run(*scene, "--size", "32x32", "--seconds", seconds, "--picture", host.folder / "w.png")
            print(f"window, {backend}: {frames} frames, {size} at last, hash {hash_in(text)} at {seconds} s, {hash_in(alone)} without it")
            assert hash_in(alone) == hash_in(text) and size == "150 x 200"
        no_display = {"DISPLAY": "", "WAYLAND_DISPLAY": "", "XDG_RUNTIME_DIR": ""}
        assert "no display" in host.run("dam_break", code=77, environment=no_display)
    finally:
        server.terminate()
        server.wait()


def main():
    program, recorder, faults, source = sys.argv[1:5]
    with tempfile.TemporaryDirectory() as folder:
        host = Host(program, faults, Path(source) / "samples/mesh_host/shaders", Path(folder))
        print(host.run("dam_break", "--cells", "32x32", "--size", "32x32", "--picture", "first.png", code=None))
        if host.code == 77:
            sys.exit(77)
        chosen = sys.argv[5:]
        for test in (test_refusals, test_state, test_holes, test_water, test_sand, test_memory, test_validation, test_window):
            if chosen and test.__name__ not in chosen:
                continue
            start = time.time()
            test(*((host, recorder) if test is test_state else (host,)))
            print(f"{test.__name__}: well, {time.time() - start:.1f} s", flush=True)


if __name__ == "__main__":
    main()
