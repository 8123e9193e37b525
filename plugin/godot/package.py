#!/usr/bin/env python3
"""Makes wadi-godot-VERSION.zip, which is unpacked into a Godot project: addons/wadi with the libraries of all systems, levels, and the games of
samples/godot as demo. The same files give the same bytes.

    package.py --addon FOLDER ... --third-party FILE [--systems SYSTEM ...] [--out FOLDER]
      --addon FOLDER      addons/wadi as build.sh lays it out; several may have a system each
      --third-party FILE  texts of what is linked into the libraries; becomes addons/wadi/THIRD_PARTY.txt
      --systems SYSTEM    as build.sh has them; all of which none may be missing. With fewer wadi.gdextension in the zip names these alone
      --out FOLDER        where the zip is written (build/godot)
Prints the zip's path and a table of sizes."""
import argparse
import pathlib
import re
import sys
import zipfile

GODOT = pathlib.Path(__file__).resolve().parent
ROOT = GODOT.parents[1]
OWN = GODOT / "addons/wadi"
SAMPLES = ROOT / "samples"
EPOCH = (1980, 1, 1, 0, 0, 0)
# A map is read as it is, in exported games too: the engine must not turn it into a texture.
KEEP = b'[remap]\n\nimporter="keep"\n'
IMAGES = (".png", ".jpg", ".exr", ".hdr", ".bmp", ".tga", ".webp", ".svg")
SYSTEMS = ("linux.x86_64", "linux.arm64", "windows.x86_64", "macos.x86_64", "macos.arm64")
FAT = bytes.fromhex("cafebabe")  # a Mach-O file of several processors begins so
MAC = "macos"  # one folder, whose files have the programs of several processors
ENTRY = re.compile(r'^([\w.]+)\.single = .*"(bin/([\w.]+)/[^"]+)"', re.MULTILINE)
DEMO = ("*.gd", "*.tscn", "*.tres", "*.gdshader")


def end(why: str) -> None:
    sys.exit(f"package.py: {why}")


def version() -> str:
    stated = re.search(r"^project\(wadi VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE).group(1)
    plugin = re.search(r'^version="(.*)"', (OWN / "plugin.cfg").read_text(), re.MULTILINE).group(1)
    if plugin != stated:
        end(f'plugin.cfg has version "{plugin}", CMakeLists.txt "{stated}"')
    return stated


def libraries(folders: list[pathlib.Path], systems: list[str]) -> tuple[str, dict[str, bytes]]:
    """wadi.gdextension for these systems, and the files that it names."""
    for system in systems:
        if system not in SYSTEMS:
            end(f'--systems: "{system}" is none of {", ".join(SYSTEMS)}')
    wanted = [MAC if system.startswith(MAC) else system for system in systems]
    lines = (OWN / "wadi.gdextension").read_text().splitlines(keepends=True)
    text = "".join(line for line in lines if not ENTRY.match(line) or ENTRY.match(line).group(3) in wanted)
    files = {}
    for _, name, _ in ENTRY.findall(text):
        found = [folder / name for folder in folders if (folder / name).is_file()]
        if not found:
            end(f"none of the folders of --addon has {name}")
        if any(other.read_bytes() != found[0].read_bytes() for other in found):
            end(f"the folders of --addon have different files {name}")
        files[name] = found[0].read_bytes()
        if name.startswith(f"bin/{MAC}/") and wanted.count(MAC) > 1 and files[name][:4] != FAT:
            end(f"{found[0]} has the program of one processor alone, and --systems names {wanted.count(MAC)}")
    return text, files


def readme(there: set[str]) -> str:
    """The add-on's page without pictures, and with links to what the zip has not as words alone."""
    text = re.sub(r"^!\[.*\]\(.*\)\n", "", (GODOT / "README.md").read_text(), flags=re.MULTILINE)
    return re.sub(r"\[([^\]]+)\]\(([^)]+)\)", lambda link: link[0] if link[2] in there or ":" in link[2] or link[2].startswith("#") else link[1], text)


def levels() -> dict[str, bytes]:
    """Each level with the files that it names."""
    files = {}
    for level in sorted((SAMPLES / "levels").glob("*/level.json")):
        for file in [level, *(level.parent / name for name in re.findall(r'"file": *"([^"]+)"', level.read_text()))]:
            name = file.resolve().relative_to(SAMPLES).as_posix()
            files[name] = file.read_bytes()
            if file.suffix in IMAGES:
                files[name + ".import"] = KEEP
    return files


def demo() -> dict[str, bytes]:
    """The games, whose files name each other by path: in a folder of their own, so that they leave a project's own files alone."""
    folder = SAMPLES / "godot"
    paths = sorted(path for pattern in DEMO for path in folder.glob(pattern))
    own = re.compile("res://(?=(?:" + "|".join(re.escape(path.name) for path in paths) + ')")')
    return {f"demo/{path.name}": own.sub("res://demo/", path.read_text()).encode() for path in paths}


def contents(options: argparse.Namespace) -> dict[str, bytes]:
    extension, built = libraries(options.addon, options.systems)
    addon = {path.relative_to(OWN).as_posix(): path.read_bytes() for path in OWN.rglob("*") if path.is_file()}
    addon |= built
    addon["wadi.gdextension"] = extension.encode()
    addon["NOTICE.md"] = (ROOT / "NOTICE.md").read_bytes()
    addon["THIRD_PARTY.txt"] = options.third_party.read_bytes()
    addon["README.md"] = readme(set(addon)).encode()
    return {f"addons/wadi/{name}": data for name, data in addon.items()} | levels() | demo()


def part(name: str) -> str:
    if name.startswith("addons/wadi/bin/"):
        return "`" + "/".join(name.split("/")[2:4]) + "`"
    return "`addons/wadi`, the rest" if name.startswith("addons/") else f"`{name.split('/')[0]}`"


def main() -> None:
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--addon", type=pathlib.Path, nargs="+", required=True)
    parser.add_argument("--third-party", type=pathlib.Path, required=True)
    parser.add_argument("--systems", nargs="+", default=SYSTEMS)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/godot")
    options = parser.parse_args()
    if not options.third_party.is_file():
        end(f"--third-party: there is no file {options.third_party}")
    files = contents(options)
    path = options.out / f"wadi-godot-{version()}.zip"
    options.out.mkdir(parents=True, exist_ok=True)
    sizes = {}
    with zipfile.ZipFile(path, "w") as packed:
        for name in sorted(files):
            about = zipfile.ZipInfo(name, EPOCH)
            about.compress_type, about.external_attr, about.create_system = zipfile.ZIP_DEFLATED, 0o644 << 16, 3
            packed.writestr(about, files[name], compresslevel=9)
            row = sizes.setdefault(part(name), [0, 0, 0])
            for column, value in enumerate((1, len(files[name]), about.compress_size)):
                row[column] += value
    print(f"{path}\n\n| part | files | unpacked MB | in the zip MB |\n| --- | ---: | ---: | ---: |")
    for name, (count, unpacked, compressed) in [*sizes.items(), ("all", [sum(column) for column in zip(*sizes.values())])]:
        print(f"| {name} | {count} | {unpacked / 1e6:.2f} | {compressed / 1e6:.2f} |")


if __name__ == "__main__":
    main()
