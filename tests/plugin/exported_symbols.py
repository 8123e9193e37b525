#!/usr/bin/env python3
"""The shared library exports the functions of its headers and nothing else, and wadi_api.json has all of them.
Usage: exported_symbols.py LIBRARY API_JSON HEADER ..."""
import json
import os
import re
import subprocess
import sys

library, headers = sys.argv[1], [path for path in sys.argv[3:] if path]
with open(sys.argv[2], encoding="utf-8") as file:
    described = {f["name"]: f.get("header", "wadi.h") for f in json.load(file)["functions"]}
listed = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
exported = {line.split()[-1] for line in listed.splitlines() if line.split()[-2] in "TDBRVWi"}
declared = {
    name for path in headers for name in re.findall(r"^WADI_API[^;(]*?(wadi_\w+)\(", open(path, encoding="utf-8").read(), re.MULTILINE)
}
print(f"{len(exported)} exported, {len(declared)} declared, {len(described)} in wadi_api.json")
wrong = [f"exported, not declared: {name}" for name in exported - declared]
wrong += [f"declared, not exported: {name}" for name in declared - exported]
wrong += [f"exported, not in wadi_api.json: {name}" for name in exported - set(described)]
given = {os.path.basename(path) for path in headers}
wrong += [f"in wadi_api.json, not exported: {name}" for name, header in described.items() if header in given and name not in exported]
print(*sorted(wrong), sep="\n")
sys.exit(1 if wrong or not declared else 0)
