#!/usr/bin/env python3
"""A wheel of plugin/python over a library that is built already, as the released one is laid out, for this machine alone.
Usage: wheel.py LIBRARY FOLDER; prints the wheel's path."""
import base64
import hashlib
import pathlib
import re
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEVELS = ("castle", "canyon", "dam_break")


def main(library, folder):
    version = re.search(r"project\(wadi VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
    package = ROOT / "plugin/python/wadi"
    files = {f"wadi/{file.relative_to(package)}": file.read_bytes() for file in sorted(package.rglob("*.py"))}
    files["wadi/lib/libwadi.so.1"] = pathlib.Path(library).read_bytes()
    for level in LEVELS:
        for file in sorted((ROOT / "samples/levels" / level).iterdir()):
            if file.name == "level.json" or file.suffix == ".png":
                files[f"wadi/share/wadi/levels/{level}/{file.name}"] = file.read_bytes()
    info = f"wadi-{version}.dist-info"
    files[f"{info}/METADATA"] = f"Metadata-Version: 2.1\nName: wadi\nVersion: {version}\n".encode()
    files[f"{info}/WHEEL"] = b"Wheel-Version: 1.0\nGenerator: wheel.py\nRoot-Is-Purelib: false\nTag: py3-none-linux_x86_64\n"
    lines = [f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}" for name, data in files.items()]
    files[f"{info}/RECORD"] = "\n".join([*lines, f"{info}/RECORD,,", ""]).encode()
    wheel = pathlib.Path(folder) / f"wadi-{version}-py3-none-linux_x86_64.whl"
    wheel.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, data in files.items():
            packed.writestr(name, data)
    print(wheel)


if __name__ == "__main__":
    main(*sys.argv[1:])
