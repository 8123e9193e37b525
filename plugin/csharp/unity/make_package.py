#!/usr/bin/env python3
"""Lays out the package for Unity's package manager: components, shaders, binding, sample, native libraries, and the .meta files without which
a package that Unity may not write to is ignored. With --archive the same as .tgz, as `npm pack` lays it out, of equal bytes for equal input.
Usage: make_package.py --linux-x86_64 FILE --windows-x86_64 FILE --macos-arm64 FILE --macos-x86_64 FILE [--linux-aarch64 FILE] --notices FILE
[--archive FOLDER] PACKAGE; PACKAGE is a folder, which must not exist or be an earlier package. With --partial what is not given is left out."""
import argparse
import gzip
import hashlib
import io
import json
import pathlib
import re
import shutil
import sys
import tarfile

here = pathlib.Path(__file__).resolve().parent
root = here.parents[2]
CASTLE = "Samples~/Castle"
WHEN = 499162500  # of each file in the archive, as npm sets it: 1985-10-26

IMPORTERS = {".asmdef": "AssemblyDefinitionImporter:\n  externalObjects: {}\n", ".md": "TextScriptImporter:\n  externalObjects: {}\n",
             ".json": "TextScriptImporter:\n  externalObjects: {}\n", ".bytes": "TextScriptImporter:\n  externalObjects: {}\n",
             ".shader": "ShaderImporter:\n  externalObjects: {}\n  defaultTextures: []\n  nonModifiableTextures: []\n",
             ".hlsl": "ShaderIncludeImporter:\n  externalObjects: {}\n",
             ".mat": "NativeFormatImporter:\n  externalObjects: {}\n  mainObjectFileID: 2100000\n",
             "package.json": "PackageManifestImporter:\n  externalObjects: {}\n", "": "DefaultImporter:\n  externalObjects: {}\n"}
# What a component begins with where it is added in the editor.
REFERENCES = {"Runtime/WadiSurface.cs": {"groundMaterial": "Shaders/WadiGround.mat", "waterMaterial": "Shaders/WadiWater.mat"}}


class Native:
    """A library: file in the package, how the file begins, system of the editor (None: there is no editor), group, target, CPU of players."""

    def __init__(self, path, format_of, editor, group, target, cpu):
        self.path, self.format_of, self.editor, self.group, self.target, self.cpu = "Runtime/Plugins/" + path, format_of, editor, group, target, cpu


NATIVES = {"linux-x86_64": Native("Linux/x86_64/libwadi.so", "ELF 62", "Linux", "Standalone", "Linux64", "x86_64"),
           "windows-x86_64": Native("Windows/x86_64/libwadi.dll", "PE 34404", "Windows", "Standalone", "Win64", "x86_64"),
           "macos-arm64": Native("macOS/arm64/libwadi.dylib", "Mach-O 16777228", "OSX", "Standalone", "OSXUniversal", "ARM64"),
           "macos-x86_64": Native("macOS/x86_64/libwadi.dylib", "Mach-O 16777223", "OSX", "Standalone", "OSXUniversal", "x86_64"),
           "linux-aarch64": Native("Linux/arm64/libwadi.so", "ELF 183", None, "EmbeddedLinux", "EmbeddedLinux", "ARM64")}
OPTIONAL = "linux-aarch64"  # Unity has no desktop player there


def stop(text):
    sys.exit(f"make_package.py: {text}")


def format_of(path):
    """How a library begins: its kind of file and the number of its processor."""
    with open(path, "rb") as file:
        begin = file.read(4096)

    def number(at, size):
        return int.from_bytes(begin[at:at + size], "little")

    if begin[:4] == b"\x7fELF":
        return f"ELF {number(18, 2)}"
    if begin[:2] == b"MZ" and begin[number(60, 4):][:4] == b"PE\0\0":
        return f"PE {number(number(60, 4) + 4, 2)}"
    if begin[:4] == b"\xcf\xfa\xed\xfe":
        return f"Mach-O {number(4, 4)}"
    return "no library"


def guid(name):
    """The same file has the same id in every package, so that scenes keep their references."""
    return hashlib.md5(f"com.wadi.terrain/{name}".encode()).hexdigest()


def plugin_importer(native):
    """A library for one system and processor: in the editor there and in its players."""

    def platform(group, name, on, settings):
        return f"  - first:\n      {group}: {name}\n    second:\n      enabled: {int(on)}\n      settings:\n" + "".join(f"        {k}: {v}\n" for k, v in settings.items())

    others = sorted({one.target for one in NATIVES.values() if one.group == "Standalone"} - {native.target})
    return ("PluginImporter:\n  externalObjects: {}\n  serializedVersion: 2\n  iconMap: {}\n  executionOrder: {}\n  defineConstraints: []\n  isPreloaded: 0\n"
            "  isOverridable: 0\n  isExplicitlyReferenced: 0\n  validateReferences: 1\n  platformData:\n"
            "  - first:\n      Any: \n    second:\n      enabled: 0\n      settings: {}\n"
            + platform("Editor", "Editor", native.editor is not None, {"CPU": native.cpu, "DefaultValueInitialized": "true", "OS": native.editor or "Linux"})
            + platform(native.group, native.target, True, {"CPU": native.cpu}) + "".join(platform("Standalone", other, False, {"CPU": "None"}) for other in others))


def meta(package, path):
    name = path.relative_to(package).as_posix()
    text = f"fileFormatVersion: 2\nguid: {guid(name)}\n"
    if path.is_dir():
        return text + "folderAsset: yes\n" + IMPORTERS[""]
    native = next((one for one in NATIVES.values() if one.path == name), None)
    if native is not None:
        return text + plugin_importer(native)
    if path.suffix == ".cs":
        materials = REFERENCES.get(name, {})
        references = "".join(f"\n  - {field}: {{fileID: 2100000, guid: {guid(material)}, type: 2}}" for field, material in materials.items())
        return (text + f"MonoImporter:\n  externalObjects: {{}}\n  serializedVersion: 2\n  defaultReferences:{references or ' []'}\n"
                "  executionOrder: 0\n  icon: {instanceID: 0}\n")
    return text + IMPORTERS.get(path.name, IMPORTERS.get(path.suffix, IMPORTERS[""]))


def section(page, heading):
    """The text of a section of a page."""
    found = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", page.read_text(encoding="utf-8"), re.M | re.S)
    if found is None:
        stop(f'{page.name} has no section "{heading}"')
    return found[1].strip() + "\n"


def version():
    """Of the package, which must be the library's."""
    own = json.loads((here / "package.json").read_text(encoding="utf-8"))["version"]
    built = re.search(r"^project\(wadi VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"), re.M)[1]
    if own != built:
        stop(f"package.json has version {own}, CMakeLists.txt {built}")
    if f"## [{own}]" not in (here / "CHANGELOG.md").read_text(encoding="utf-8"):
        stop(f"CHANGELOG.md of the package has no heading \"## [{own}]\"")
    return own


def check(libraries, notices, partial):
    """Stops where something is missing, or is not what its option says."""
    for name, library in libraries.items():
        if library is None:
            continue
        if not library.is_file():
            stop(f"--{name}: {library} is not there")
        if format_of(library) != NATIVES[name].format_of:
            stop(f"--{name}: {library} is {format_of(library)}, not {NATIVES[name].format_of}")
    if notices is not None and not notices.is_file():
        stop(f"--notices: {notices} is not there")
    missing = [f"--{name}" for name, library in libraries.items() if library is None and name != OPTIONAL] + ["--notices"] * (notices is None)
    if missing and not partial:
        stop(f"{', '.join(missing)} missing; with --partial the package does without, for yourself")
    if all(library is None for library in libraries.values()):
        stop("a package without any library is of no use: give at least one")


def lay_out(package, libraries, notices):
    if package.exists():
        if not (package / "package.json").is_file() or json.loads((package / "package.json").read_text(encoding="utf-8")).get("name") != "com.wadi.terrain":
            stop(f"{package} is there and is no package of Wadi")
        shutil.rmtree(package)
    for folder in ("Runtime", "Shaders", "Documentation~", "Samples~"):
        shutil.copytree(here / folder, package / folder)
    for file in ("package.json", "README.md", "CHANGELOG.md"):
        shutil.copy(here / file, package)
    shutil.copytree(here.parent / "Wadi", package / "Runtime/Binding")
    shutil.copy(root / "NOTICE.md", package)
    (package / "LICENSE.md").write_text("# Licence of Wadi\n" + section(root / "NOTICE.md", "Licence of Wadi"), encoding="utf-8")
    if notices is not None:
        shutil.copy(notices, package / "Third Party Notices.md")
    level = package / CASTLE / "Level"
    level.mkdir()
    shutil.copy(root / "samples/levels/castle/level.json", level)
    shutil.copy(root / "samples/levels/castle/sand.png", level / "sand.png.bytes")  # an asset of bytes, not a picture that Unity converts
    for name, library in libraries.items():
        if library is not None:
            (package / NATIVES[name].path).parent.mkdir(parents=True)
            shutil.copy(library, package / NATIVES[name].path)
    names = {path.relative_to(package).as_posix() for path in package.rglob("*")}

    def reference(found):
        if found[1] not in names:
            stop(f"{found[1]} is referred to and not in the package")
        return guid(found[1])

    for path in [*package.rglob("*.unity"), *package.rglob("*.mat")]:
        path.write_text(re.sub(r"@([\w~./]+)@", reference, path.read_text(encoding="utf-8")), encoding="utf-8")
    for name in sorted(names):
        # Unity does not look into folders whose name ends with ~. A sample is copied out of there, its .meta files with it.
        if not re.search(r"(^|/)[^/]*~(/|$)", name) or name.startswith(CASTLE):
            path = package / name
            path.with_name(path.name + ".meta").write_text(meta(package, path), encoding="utf-8")


def pack(package, archive):
    """All files sorted below package/, without times or owners of this machine."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.USTAR_FORMAT) as tar:
        for path in sorted((p for p in package.rglob("*") if p.is_file()), key=lambda p: p.relative_to(package).as_posix()):
            info = tarfile.TarInfo("package/" + path.relative_to(package).as_posix())
            info.size, info.mtime, info.mode = path.stat().st_size, WHEN, 0o644
            with open(path, "rb") as file:
                tar.addfile(info, file)
    with open(archive, "wb") as file, gzip.GzipFile(filename="", mode="wb", compresslevel=9, fileobj=file, mtime=WHEN) as compressed:
        compressed.write(packed.getvalue())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in NATIVES:
        parser.add_argument(f"--{name}", type=pathlib.Path, metavar="FILE", dest=name)
    parser.add_argument("--notices", type=pathlib.Path, metavar="FILE", help="texts of what is linked into the libraries")
    parser.add_argument("--partial", action="store_true", help="leave out what is not given, for a package that is not handed on")
    parser.add_argument("--archive", type=pathlib.Path, metavar="FOLDER", help="also write com.wadi.terrain-VERSION.tgz there")
    parser.add_argument("package", type=pathlib.Path, metavar="PACKAGE")
    options = vars(parser.parse_args())
    libraries, package = {name: options[name] for name in NATIVES}, options["package"]
    number = version()
    check(libraries, options["notices"], options["partial"])
    lay_out(package, libraries, options["notices"])
    files = [p for p in package.rglob("*") if p.is_file()]
    print(f"{package}: {len(files)} files, {sum(p.stat().st_size for p in files) / 1e6:.1f} MB")
    if options["archive"] is not None:
        options["archive"].mkdir(parents=True, exist_ok=True)
        archive = options["archive"] / f"com.wadi.terrain-{number}.tgz"
        pack(package, archive)
        print(f"{archive}: {archive.stat().st_size / 1e6:.1f} MB, sha256 {hashlib.sha256(archive.read_bytes()).hexdigest()}")


if __name__ == "__main__":
    main()
