#!/usr/bin/env python3
"""Pages of numbers (tests/lab/report, tests/lab/sand) are as new as the sources that decide them (tests/lab/report/stamps.py), or say in their first
lines "Measured before ...", or stand in tests/lab/report/kept_pages.md with the reason why their numbers hold.
Usage: page_stamps.py SOURCE_DIR. Exit status 1 names every page that does none of it, or more than it needs."""
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import stamps  # noqa: E402

FIRST_LINES = 12


def breaches(root, page, kind, kept):
    """kept: [(state, reason)] of this page's rows."""
    text = (root / page).read_text(encoding="utf-8")
    found, now = stamps.stamped(text), stamps.digests(kind, root)
    if found is None:
        return ["has no stamp, or several"]
    commit, then = found
    changed = [part for part in now if then.get(part) != now[part]]
    told = any("Measured before" in line for line in text.splitlines()[:FIRST_LINES])
    holds = [state for state, _ in kept] == [stamps.state(kind, root)]
    if changed and not told and not holds:
        judged = ", judged since, but at yet another state" if kept else ""
        return [f"is of {commit}: since then {', '.join(changed)} changed{judged}"]
    if told and not changed:
        return ["says that it is older than it is"]
    return [f"needs no row in {stamps.KEPT}"] if kept and (told or not changed) else []


def check(root):
    found, rows = [], stamps.kept_rows(root)
    there = {path.relative_to(root).as_posix() for path in (root / "tests/lab/report").rglob("README.md")}
    found += [f"{page}: unknown to tests/lab/report/stamps.py" for page in sorted(there - set(stamps.PAGES))]
    found += [f"{stamps.KEPT}: {page} is no such page" for page, *_ in rows if page not in stamps.PAGES]
    for page, kind in stamps.PAGES.items():
        kept = [row[1:] for row in rows if row[0] == page]
        found += [f"{page}: {breach}" for breach in breaches(root, page, kind, kept)] if (root / page).exists() else [f"{page}: is not there"]
    return found


def sees_included():
    """A formula that a stage includes counts as the stage does."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        for path, text in (("shaders/stages/sand/a.stage", '#include "../../physics/a.glsl"\n'), ("shaders/physics/a.glsl", "1"), ("shaders/physics/b.glsl", "1")):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        found = []
        for name in ("b", "a"):
            (root / f"shaders/physics/{name}.glsl").write_text("2")
            found.append(stamps.digest(root, stamps.PARTS["stages"]))
        return found[0] != found[1]


def controls():
    """Planted faults must be seen, and nothing else."""
    page, kind = next(iter(stamps.PAGES.items()))
    source = stamps.KINDS[kind][1][0].replace("*", "a")
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for path in (root / page, root / source):
            path.parent.mkdir(parents=True, exist_ok=True)

        def seen(text, source_text, kept=()):
            (root / source).write_text("as measured // a remark")
            fresh = stamps.stamp(kind, root)
            (root / source).write_text(source_text)
            (root / page).write_text(text.replace("STAMP", fresh))
            return len(breaches(root, page, kind, kept))

        (root / source).write_text("changed")
        judged = [(stamps.state(kind, root), "a reason")]
        return [what for what, wrong, arguments in (
            ("a fresh page", 0, ("STAMP", "as  measured // another remark")), ("no stamp", 1, ("", "as measured")), ("two stamps", 1, ("STAMP\nSTAMP", "as measured")),
            ("a changed source", 1, ("STAMP", "changed")), ("an old page that says so", 0, ("Measured before it.\nSTAMP", "changed")),
            ("one that says so too late", 1, ("\n" * FIRST_LINES + "Measured before it.\nSTAMP", "changed")),
            ("a fresh page that calls itself old", 1, ("Measured before it.\nSTAMP", "as measured")),
            ("a page judged as it is", 0, ("STAMP", "changed", judged)), ("a page judged at another state", 1, ("STAMP", "changed again", judged)),
            ("a row for a fresh page", 1, ("STAMP", "as measured", judged)), ("a row for one that says so", 1, ("Measured before it.\nSTAMP", "changed", judged)),
        ) if seen(*arguments) != wrong]


def main():
    wrong = controls() + ([] if sees_included() else ["a changed formula"])
    print(*(f"the checker is wrong about {what}" for what in wrong), sep="\n", end="\n" if wrong else "")
    found = check(pathlib.Path(sys.argv[1]).resolve())
    print(*found, f"{len(stamps.PAGES)} pages, {len(found)} breaches", sep="\n")
    if found:
        print("after measuring anew tests/lab/report/stamps.py --update; where the numbers hold all the same --keep ... --reason ...")
    return 1 if wrong or found else 0


if __name__ == "__main__":
    sys.exit(main())
