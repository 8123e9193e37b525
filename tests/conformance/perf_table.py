"""Reads the CSV of `conformance perf`."""
import csv


def read(path):
    """All rows of a file as dictionaries; numbers as float, empty cells as None."""
    rows = []
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            for key, value in row.items():
                if key in ("backend", "device", "driver", "clock", "row"):
                    continue
                row[key] = float(value) if value else None
            row["size"] = int(row["size"])
            rows.append(row)
    if not rows:
        raise SystemExit(f"{path}: no rows; is it the output of `conformance perf --output csv`?")
    return rows


def by_row_and_size(path):
    """{(row, size): median ms}; a stage that runs more than once in a step counts with the mean of its passes."""
    sums = {}
    for row in read(path):
        total, count = sums.get((row["row"], row["size"]), (0.0, 0))
        sums[row["row"], row["size"]] = (total + row["median_ms"], count + 1)
    return {key: total / count for key, (total, count) in sums.items()}
