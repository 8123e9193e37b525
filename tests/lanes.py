#!/usr/bin/env python3
"""What tests/run.sh leaves to "long", lane by lane: tests/lanes.txt says at which commit each last passed and which paths it guards.

usage: lanes.py list            the lanes
       lanes.py stale           names every lane whose code has changed since it passed
       lanes.py passed LANE     stamps a lane with HEAD and today; refused where tracked files have changes
       lanes.py self-check      tries all of that on a repository of its own
"""
import datetime
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
FILE = "tests/lanes.txt"
NO_CODE = [f":!*.{kind}" for kind in ("md", "png", "jpg", "svg", "csv")]


def git(root, *words):
    return subprocess.run(["git", "-C", root, *words], capture_output=True, text=True, check=False)


def rows(root):
    """lane: (commit or "never", day, paths)"""
    lines = (root / FILE).read_text(encoding="utf-8").splitlines()
    words = [line.split() for line in lines if line and not line.startswith("#")]
    return {row[0]: (row[1], row[2], row[3:]) for row in words}


def behind(root, commit, paths):
    """What a lane lacks since that commit; "" for nothing."""
    missing = [path for path in paths if not (root / path).exists()]
    if missing or not paths:
        return f"{FILE} names what is not there: {' '.join(missing) or 'no paths'}"
    if commit == "never":
        return "has never passed"
    told = git(root, "rev-list", "--count", f"{commit}..HEAD", "--", *paths, *NO_CODE)
    if told.returncode != 0:
        return f"passed at {commit}, which this clone does not have"
    return f"{told.stdout.strip()} commits changed what it guards since it passed ({commit})" if told.stdout.strip() != "0" else ""


def stale(root):
    return [f"{lane}: {lacks}" for lane, (commit, _, paths) in rows(root).items() if (lacks := behind(root, commit, paths))]


def passed(root, lane):
    """A message where that is refused, else ""."""
    if lane not in rows(root):
        return f"no lane \"{lane}\"; the lanes are: {' '.join(rows(root))}"
    changes = git(root, "status", "--porcelain", "--untracked-files=no", "--", ".", f":!{FILE}")
    head = git(root, "rev-parse", "--short=7", "HEAD")
    if changes.returncode != 0 or head.returncode != 0:
        return "no repository: nothing to stamp with"
    if changes.stdout:
        return f"{lane} passed, and is not stamped: tracked files have changes"
    text = (root / FILE).read_text(encoding="utf-8").splitlines()
    for n, line in enumerate(text):
        if line.split()[:1] == [lane]:
            text[n] = " ".join([f"{lane:<12}", head.stdout.strip(), f"{datetime.date.today():%Y-%m-%d}", *line.split()[3:]])
    (root / FILE).write_text("\n".join(text) + "\n", encoding="utf-8")
    return ""


def self_check():
    failures = []

    def expect(held, what):
        if not held:
            failures.append(what)

    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)

        def commit(path, text):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
            git(root, "add", "-A")
            done = git(root, "-c", "user.name=n", "-c", "user.email=e", "commit", "-qm", path)
            expect(done.returncode == 0, f"a commit: {done.stderr}")

        git(root, "init", "-q")
        (root / "engine").mkdir()
        commit("engine/a", "1")
        commit(FILE, "# words\nthreads      never - engine\nother        never - engine\n")
        expect(stale(root) == ["threads: has never passed", "other: has never passed"], "a lane that never passed is named")
        expect(passed(root, "threads") == "" and len(stale(root)) == 1, "a lane that has passed is fresh, and no other one")
        commit("README", "what no lane guards")
        commit("engine/README.md", "no code")
        expect(len(stale(root)) == 1, "a commit elsewhere makes nothing stale, nor does the stamp's own")
        commit("engine/a", "2")
        commit("engine/a", "3")
        expect(stale(root)[0].startswith("threads: 2 commits changed"), "a lane is stale once its code changes")
        (root / "engine/a").write_text("4")
        expect("have changes" in passed(root, "threads") and len(stale(root)) == 2, "with changes nothing is stamped")
        git(root, "checkout", "engine/a")
        expect(passed(root, "threads") == "" and len(stale(root)) == 1, "the stamp is renewed, with the last stamp not committed, too")
        expect("no lane" in passed(root, "thread"), "an unknown lane is refused")
        text = (root / FILE).read_text()
        expect(text.startswith("# words\n") and text.count("\n") == 3, "the rest of the file stays")
        (root / FILE).write_text(text.replace("engine", "engines"))
        expect("not there: engines" in stale(root)[0], "a path that is gone is named")
        (root / FILE).write_text("threads 0123456 2026-01-01 engine\n")
        expect("does not have" in stale(root)[0], "a commit that is not there is named")
    failures += [f"{lane}: {lacks}" for lane, lacks in ((lane, behind(ROOT, "never", paths)) for lane, (_, _, paths) in rows(ROOT).items()) if "not there" in lacks]
    for failure in failures:
        print(f"FAIL not so: {failure}")
    print(f"lanes: {len(failures)} failed")
    return 1 if failures else 0


def main():
    match sys.argv[1:]:
        case ["list"]:
            print(*rows(ROOT))
        case ["stale"]:
            for line in stale(ROOT):
                print(f"  {line}")
        case ["passed", lane]:
            if message := passed(ROOT, lane):
                print(f"lanes.py: {message}", file=sys.stderr)
                return 1
        case ["self-check"]:
            return self_check()
        case _:
            print(__doc__, file=sys.stderr)
            return 2
    return 0


sys.exit(main())
