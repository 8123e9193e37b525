#!/usr/bin/env python3
"""Markdown table of two `conformance perf` CSVs of one device, row by row: what equal bits cost.

Usage: compare_perf.py STRICT.csv RELAXED.csv [SIZE ...]
RELAXED is the same command on a build with -DWADI_STRICT_FLOAT=OFF (fused multiply-adds, approximate division and root)."""
import sys

import perf_table

if len(sys.argv) < 3:
    raise SystemExit(__doc__)
strict, relaxed = perf_table.by_row_and_size(sys.argv[1]), perf_table.by_row_and_size(sys.argv[2])
sizes = [int(size) for size in sys.argv[3:]] or sorted({size for _, size in strict})
rows = list(dict.fromkeys(row for row, size in strict if (row, size) in relaxed))
print("| row | " + " | ".join(f"{size}² strict ms | relaxed ms | ratio" for size in sizes) + " |")
print("| --- |" + " ---: | ---: | ---: |" * len(sizes))
for row in rows:
    cells = []
    for size in sizes:
        a, b = strict.get((row, size)), relaxed.get((row, size))
        cells.append("| |" if a is None or b is None else f"{a:.4f} | {b:.4f} | {a / b:.2f}")
    print(f"| {row} | " + " | ".join(cells) + " |")
