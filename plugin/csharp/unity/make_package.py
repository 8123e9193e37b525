#!/usr/bin/env python3
"""Lays out the Unity package: component, binding, native libraries, notices, and the .meta files without which a package that Unity may not
write to is ignored. Usage: make_package.py --linux LIBRARY [--windows LIBRARY] FOLDER; FOLDER must not exist or be an earlier package."""
import argparse
import hashlib
import json
import pathlib
import shutil
import sys

here = pathlib.Path(__file__).resolve().parent
root = here.parents[2]
NATIVE = "Runtime/Plugins/x86_64"
IMPORTERS = {".cs": "MonoImporter:\n  externalObjects: {}\n  serializedVersion: 2\n  defaultReferences: []\n  executionOrder: 0\n  icon: {instanceID: 0}\n",
             ".asmdef": "AssemblyDefinitionImporter:\n  externalObjects: {}\n", ".md": "TextScriptImporter:\n  externalObjects: {}\n",
             "package.json": "PackageManifestImporter:\n  externalObjects: {}\n", "": "DefaultImporter:\n  externalObjects: {}\n"}
# suffix of a native library: system of the editor, its build target, the other build target
SYSTEMS = {".so": ("Linux", "Linux64", "Win64"), ".dll": ("Windows", "Win64", "Linux64")}


def plugin_importer(suffix):
    """A library for one system: in the editor there and in its 64-bit players."""
    system, target, other = SYSTEMS[suffix]

    def platform(group, name, on, settings):
        return f"  - first:\n      {group}: {name}\n    second:\n      enabled: {int(on)}\n      settings:\n" + "".join(f"        {k}: {v}\n" for k, v in settings.items())

    return ("PluginImporter:\n  externalObjects: {}\n  serializedVersion: 2\n  iconMap: {}\n  executionData: {}\n  defineConstraints: []\n  isPreloaded: 0\n"
            "  isOverridable: 0\n  isExplicitlyReferenced: 0\n  validateReferences: 1\n  platformData:\n"
            "  - first:\n      Any: \n    second:\n      enabled: 0\n      settings: {}\n"
            + platform("Editor", "Editor", True, {"CPU": "x86_64", "DefaultValueInitialized": "true", "OS": system})
            + platform("Standalone", target, True, {"CPU": "x86_64"}) + platform("Standalone", other, False, {"CPU": "None"}))


def meta(package, path):
    """The same file has the same id in every package, so that scenes keep their references."""
    name = path.relative_to(package).as_posix()
    identity = hashlib.md5(f"com.wadi.terrain/{name}".encode()).hexdigest()
    text = f"fileFormatVersion: 2\nguid: {identity}\n"
    if path.is_dir():
        return text + "folderAsset: yes\n" + IMPORTERS[""]
    if path.suffix in SYSTEMS:
        return text + plugin_importer(path.suffix)
    return text + IMPORTERS.get(path.name, IMPORTERS.get(path.suffix, IMPORTERS[""]))


def make(package, linux, windows):
    if package.exists():
        if not (package / "package.json").is_file() or json.loads((package / "package.json").read_text(encoding="utf-8")).get("name") != "com.wadi.terrain":
            sys.exit(f"make_package.py: {package} is there and is no package of Wadi")
        shutil.rmtree(package)
    shutil.copytree(here / "Runtime", package / "Runtime")
    shutil.copy(here / "package.json", package)
    shutil.copytree(here.parent / "Wadi", package / "Runtime/Binding")
    (package / NATIVE).mkdir(parents=True)
    for library, name in ((linux, "libwadi.so"), (windows, "libwadi.dll")):
        if library is not None:
            shutil.copy(library, package / NATIVE / name)
    shutil.copy(here.parent / "README.md", package)
    shutil.copy(root / "NOTICE.md", package)
    for path in sorted(package.rglob("*")):
        path.with_name(path.name + ".meta").write_text(meta(package, path), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--linux", type=pathlib.Path, help="libwadi.so of a release build")
    parser.add_argument("--windows", type=pathlib.Path, help="libwadi.dll")
    parser.add_argument("folder", type=pathlib.Path)
    options = parser.parse_args()
    for library in (options.linux, options.windows):
        if library is not None and not library.is_file():
            sys.exit(f"make_package.py: {library} is not there")
    if options.linux is None and options.windows is None:
        sys.exit("make_package.py: a package without any library is of no use: give --linux, --windows or both")
    make(options.folder, options.linux, options.windows)
    print(f"{options.folder}: {sum(p.is_file() for p in options.folder.rglob('*'))} files, "
          f"{sum(p.stat().st_size for p in options.folder.rglob('*') if p.is_file()) / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
