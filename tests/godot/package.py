#!/usr/bin/env python3
"""plugin/godot/package.py with files of a few bytes in the place of libraries: what the zip must and must not have, that every res:// path in it
leads to a file of it, that it is the same bytes again, and that what is missing or wrong is said. Usage: package.py SOURCE_DIR."""
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(sys.argv[1]).resolve()
wrong = 0


def expect(good: bool, what: str) -> None:
    global wrong
    if not good:
        wrong += 1
        print(f"WRONG: {what}")


def package(out: pathlib.Path, *options: str) -> subprocess.CompletedProcess:
    command = [sys.executable, str(ROOT / "plugin/godot/package.py"), "--out", str(out), *options]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def dangling(files: dict[str, str]) -> list[str]:
    """Paths in scenes, scripts and shaders that no file of the zip has."""
    found = []
    for name, text in files.items():
        for path in re.findall(r'"res://([^"%]+)"', text):
            if path not in files:
                found.append(f"{name}: {path}")
    return found


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        here = pathlib.Path(folder)
        extension = (ROOT / "plugin/godot/addons/wadi/wadi.gdextension").read_text()
        libraries = re.findall(r'"(bin/[^"]+)"', extension)
        expect(len(libraries) == 8, f"wadi.gdextension names two libraries of four systems: {libraries}")
        linux, others = here / "linux", here / "others"
        for name in libraries:
            file = (linux if "linux.x86_64" in name else others) / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes((b"\xca\xfe\xba\xbe" if "macos" in name else b"") + name.encode())
        texts = here / "texts"
        texts.write_text("licences")
        all_of_it = ["--addon", str(linux), str(others), "--third-party", str(texts)]

        made = package(here / "a", *all_of_it)
        expect(made.returncode == 0 and "| `bin/macos` | 2 |" in made.stdout, f"a zip and its table: {made.stdout}{made.stderr}")
        again = package(here / "b", *all_of_it)
        first, second = next((here / "a").glob("wadi-godot-*.zip")), next((here / "b").glob("*.zip"))
        expect(again.returncode == 0 and first.read_bytes() == second.read_bytes(), "the same bytes again")
        with zipfile.ZipFile(first) as packed:
            files = {name: packed.read(name).decode(errors="replace") for name in packed.namelist()}
        expect(list(files) == sorted(files), "names in order")
        for name in ["addons/wadi/" + library for library in libraries] + ["addons/wadi/THIRD_PARTY.txt", "addons/wadi/icon.png"]:
            expect(name in files, f"{name} is in the zip")
        unwanted = [name for name in files if re.search(r"\.(py|jpg|sh|cfg\.import)$|levels/.*\.md$|project\.godot$", name)]
        expect(not unwanted, f"not in the zip: {unwanted}")
        maps = [name for name in files if name.startswith("levels/") and name.endswith(".png")]
        expect(len(maps) >= 4 and all('importer="keep"' in files.get(name + ".import", "") for name in maps), f"maps are kept as they are: {maps}")
        expect(not dangling(files), f"paths lead somewhere: {dangling(files)}")
        expect(dangling({"a.gd": 'load("res://b.gd")'}) == ["a.gd: b.gd"], "control: a path that leads nowhere")
        expect("```gdscript" in files["addons/wadi/README.md"] and "](../" not in files["addons/wadi/README.md"], "the page has its lines and no dead link")

        fewer = package(here / "c", "--addon", str(linux), "--third-party", str(texts), "--systems", "linux.x86_64")
        with zipfile.ZipFile(next((here / "c").glob("*.zip"))) as packed:
            text = packed.read("addons/wadi/wadi.gdextension").decode()
        expect(fewer.returncode == 0 and "linux.x86_64" in text and "windows" not in text and "icons/WadiLevel.svg" in text, "an add-on of one system names it alone")

        for options, says in [
            (["--addon", str(linux), "--third-party", str(texts)], "has bin/linux.arm64/libwadi_godot.so"),
            ([*all_of_it, "--systems", "amiga"], '"amiga" is none of'),
            (["--addon", str(linux), "--third-party", str(here / "none")], "there is no file"),
        ]:
            refused = package(here / "d", *options)
            expect(refused.returncode == 1 and says in refused.stderr, f"refused with \"{says}\": {refused.stderr}")
        one = others / "bin/macos/libwadi.1.dylib"
        one.write_text("one processor's")
        refused = package(here / "d", *all_of_it)
        expect(refused.returncode == 1 and "of one processor alone" in refused.stderr, f"half of macOS: {refused.stderr}")
        partial = package(here / "e", *all_of_it, "--systems", "macos.arm64", "windows.x86_64")
        expect(partial.returncode == 0 and "| `bin/macos` | 2 |" in partial.stdout, f"one processor of macOS where one is asked for: {partial.stderr}")
        (others / libraries[0]).parent.mkdir(parents=True, exist_ok=True)
        (others / libraries[0]).write_text("another")
        refused = package(here / "d", *all_of_it)
        expect(refused.returncode == 1 and "different files" in refused.stderr, f"two different libraries of a name: {refused.stderr}")
    print("passed" if wrong == 0 else "FAILED")
    sys.exit(wrong != 0)


if __name__ == "__main__":
    main()
