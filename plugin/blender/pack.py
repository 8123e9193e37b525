#!/usr/bin/env python3
"""Makes the extension for Blender: wadi_blender-VERSION.zip with the wheel of wadi inside.

usage: pack.py WHEEL [OUTPUT]   WHEEL: wadi-VERSION-...whl, for one system; OUTPUT: folder for the zip, the current one unless named
       pack.py --check ZIP      what is wrong with an extension that was packed
"""
import pathlib
import re
import sys
import tomllib
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE / "wadi_blender"
MANIFEST = "blender_manifest.toml"
PLATFORMS = {"linux_x86_64": "linux-x64", "win_amd64": "windows-x64", "macosx_x86_64": "macos-x64", "macosx_arm64": "macos-arm64"}
#: Blender's own rules on fields that this manifest has (docs.blender.org, "Extensions: getting started").
RULES = {
    "schema_version": r"1\.0\.0",
    "id": r"[a-z][a-z0-9_]*",
    "version": r"\d+\.\d+\.\d+",
    "name": r".*\w.*",
    "tagline": r".{0,63}[\w)]",  # at most 64 letters, no full stop at its end
    "maintainer": r".+",
    "type": r"add-on",
    "blender_version_min": r"(4\.[2-9]|[5-9]\.\d+)\.\d+",
}


def platform(wheel):
    """Blender's name of the system that a wheel is for."""
    tag = re.fullmatch(r"wadi-[^-]+-py3-none-([\w.]+)\.whl", wheel)
    if tag is None:
        raise ValueError(f"{wheel}: must be named wadi-VERSION-py3-none-SYSTEM.whl")
    found = {PLATFORMS.get(re.sub(r"(manylinux|macosx)(_?\d+)*_", lambda of: "linux_" if of[1] == "manylinux" else "macosx_", part))
             for part in tag[1].split(".")}
    if len(found) != 1 or None in found:
        raise ValueError(f"{wheel}: systems are {', '.join(PLATFORMS)}")
    return found.pop()


def check(file):
    """What is wrong with a packed extension, a list of texts."""
    with zipfile.ZipFile(file) as packed:
        names = set(packed.namelist())
        if MANIFEST not in names:
            return [f"no {MANIFEST}"]
        manifest = tomllib.loads(packed.read(MANIFEST).decode())
    wrong = [f"{key}: {manifest.get(key)!r} does not match {rule}" for key, rule in RULES.items()
             if not re.fullmatch(rule, str(manifest.get(key, "")))]
    wrong += [f"{key}: must be a list of texts" for key in ("license", "tags", "platforms", "wheels")
              if not manifest.get(key) or not all(isinstance(value, str) and value for value in manifest[key])]
    wrong += [f"permissions.{key}: at most 64 letters, no full stop at its end" for key, text in manifest.get("permissions", {}).items()
              if len(text) > 64 or text.endswith(".")]
    wrong += [f"wheels: {wheel} is not in the zip" for wheel in manifest.get("wheels", []) if wheel.removeprefix("./") not in names]
    if "__init__.py" not in names:
        wrong.append("no __init__.py")
    name = f"{manifest.get('id')}-{manifest.get('version')}.zip"
    return wrong + ([f"its name must be {name}"] if pathlib.Path(file).name != name else [])


def pack(wheel, output):
    """Writes the zip; returns its path."""
    manifest = (SOURCE / MANIFEST).read_text(encoding="utf-8")
    lists = f'platforms = ["{platform(wheel.name)}"]\nwheels = ["./wheels/{wheel.name}"]\n\n[permissions]'
    manifest = manifest.replace("\n[permissions]", "\n" + lists)
    version = tomllib.loads(manifest)["version"]
    if wheel.name.split("-")[1] != version:
        raise ValueError(f"{wheel.name}: the extension has version {version}")
    output.mkdir(parents=True, exist_ok=True)
    file = output / f"wadi_blender-{version}.zip"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr(MANIFEST, manifest)
        for source in sorted(SOURCE.glob("*.py")):
            packed.write(source, source.name)
        packed.write(wheel, f"wheels/{wheel.name}", zipfile.ZIP_STORED)
    return file


def main():
    words = sys.argv[1:]
    if len(words) == 2 and words[0] == "--check":
        file = pathlib.Path(words[1])
    elif len(words) in (1, 2) and not words[0].startswith("-"):
        try:
            file = pack(pathlib.Path(words[0]), pathlib.Path(words[1] if len(words) == 2 else "."))
        except (OSError, ValueError) as failed:
            sys.exit(f"pack.py: {failed}")
    else:
        sys.exit(__doc__)
    for text in (wrong := check(file)):
        print(f"{file.name}: {text}", file=sys.stderr)
    if wrong:
        sys.exit(1)
    print(file)


if __name__ == "__main__":
    main()
