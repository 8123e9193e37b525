#!/usr/bin/env python3
"""The shared library exports the functions of its headers and nothing else. Usage: exported_symbols.py LIBRARY HEADER ..."""
import re
import subprocess
import sys

library, headers = sys.argv[1], [path for path in sys.argv[2:] if path]
listed = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
exported = {line.split()[-1] for line in listed.splitlines() if line.split()[-2] in "TDBRVWi"}
declared = {
    name for path in headers for name in re.findall(r"^WADI_API[^;(]*?(wadi_\w+)\(", open(path, encoding="utf-8").read(), re.MULTILINE)
}
print(f"{len(exported)} exported, {len(declared)} declared")
for name in sorted(exported - declared):
    print("exported, not declared:", name)
for name in sorted(declared - exported):
    print("declared, not exported:", name)
sys.exit(0 if exported == declared and declared else 1)
