#!/usr/bin/env python3
"""When each lane last passed, on what, and with which results: lanes.txt beside this names the lanes, stamps.csv holds their stamps.

usage: lanes.py list             the lanes that tests/run.sh runs
       lanes.py stale            names every lane whose code has changed since it passed
       lanes.py passed LANE [--tools TEXT] [--target NAME [--golden LOG] [--host HASH] [--ran TEXT]]
                                 stamps a lane with HEAD and today, and writes the table of tests/platforms/README.md; refused where
                                 tracked files have changes, or results are others than those kept
           --tools TEXT          what built and ran it, with versions: "g++ 12.2.0, QEMU 7.2.22"
           --target NAME         its row in that table, as "x86-64 Windows"; a lane may have several, and may have none
           --golden LOG          what "wadi-test-golden -s" printed there: every scene of tests/golden/hashes.txt must have its hash
           --host HASH           what the smallest host printed there: must be that of tests/platforms/minimal_host_hash.txt
           --ran TEXT            what else ran there and held: "conformance", "the demo in Godot 4.3". Without any of these three
                                 the row says "built, not run"
       lanes.py table            writes the table anew: after a change of golden hashes, rows say that results have changed since
       lanes.py self-check       tries all of that on a repository of its own; then this one's table against its stamps
"""
import argparse
import csv
import datetime
import hashlib
import io
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
LANES, STAMPS, PAGE = "tests/lanes.txt", "tests/stamps.csv", "tests/platforms/README.md"
GOLDEN, HOST = "tests/golden/hashes.txt", "tests/platforms/minimal_host_hash.txt"
HERE = "tests/run.sh"  # runs the lanes that "list" names
BEGIN, END = "<!-- lanes.py writes from here -->", "<!-- to here -->"
NO_CODE = [f":!*.{kind}" for kind in ("md", "png", "jpg", "webp", "svg", "csv")]
# results: the git blob of tests/golden/hashes.txt at that commit
COLUMNS = ["lane", "target", "commit", "day", "results", "tools", "held"]


def git(root, *words):
    return subprocess.run(["git", "-C", root, *words], capture_output=True, text=True, check=False)


def lanes(root):
    """lane: (what runs it, paths that it guards)"""
    lines = (root / LANES).read_text(encoding="utf-8").splitlines()
    words = [line.split() for line in lines if line and not line.startswith("#")]
    return {row[0]: (row[1], row[2:]) for row in words}


def stamps(root):
    file = root / STAMPS
    return list(csv.DictReader(file.open(encoding="utf-8", newline=""))) if file.exists() else []


def behind(root, commit, paths):
    """What a lane lacks since that commit; "" for nothing."""
    missing = [path for path in paths if not (root / path).exists()]
    if missing or not paths:
        return f"{LANES} names what is not there: {' '.join(missing) or 'no paths'}"
    if commit == "never":
        return "has never passed"
    told = git(root, "rev-list", "--count", f"{commit}..HEAD", "--", *paths, *NO_CODE)
    if told.returncode != 0:
        return f"passed at {commit}, which this clone does not have"
    return f"{told.stdout.strip()} commits changed what it guards since it passed ({commit})" if told.stdout.strip() != "0" else ""


def stale(root):
    found = []
    for lane, (by, paths) in lanes(root).items():
        commits = {row["commit"] for row in stamps(root) if row["lane"] == lane} or {"never"}
        found += [f"{lane}{'' if by == HERE else f' ({by})'}: {lacks}" for commit in sorted(commits) if (lacks := behind(root, commit, paths))]
    return found


def kept(root):
    """(scene: hash, their blob in git, the smallest host's hash), as they are kept today"""
    text = (root / GOLDEN).read_bytes()
    blob = hashlib.sha1(b"blob %d\0" % len(text) + text).hexdigest()[:12]
    return dict(line.split() for line in text.decode().splitlines()), blob, (root / HOST).read_text(encoding="utf-8").strip()


def passed(root, lane, target="", tools="", golden=None, host="", ran=""):
    """Stamps a lane; `golden` is what the golden test printed. A message where that is refused, else ""."""
    if lane not in lanes(root):
        return f"no lane \"{lane}\"; the lanes are: {' '.join(lanes(root))}"
    if target and not tools or not target and (golden is not None or host or ran):
        return "a target wants --tools, and what ran wants a --target"
    hashes, blob, kept_host = kept(root)
    if golden is not None:
        found = dict(re.findall(r"(\w+) is ([0-9a-f]{16})\b", golden))
        if wrong := [f"{scene} is {found.get(scene, 'not there')}, not {hash}" for scene, hash in hashes.items() if found.get(scene) != hash]:
            return f"{target}, golden hashes: {'; '.join(wrong)}"
    if host not in ("", kept_host):
        return f"{target}, smallest host: hash {host}, not {kept_host}"
    changes = git(root, "status", "--porcelain", "--untracked-files=no", "--", ".", f":!{STAMPS}", f":!{PAGE}")
    head = git(root, "rev-parse", "--short=7", "HEAD")
    if changes.returncode != 0 or head.returncode != 0:
        return "no repository: nothing to stamp with"
    if changes.stdout:
        return f"{lane} passed, and is not stamped: tracked files have changes"
    held = [name for name, ok in (("golden hashes", golden is not None), ("smallest host", host), (ran, ran)) if ok]
    row = dict(zip(COLUMNS, [lane, target, head.stdout.strip(), f"{datetime.date.today():%Y-%m-%d}", blob, tools, ", ".join(held)]))
    same = [old["lane"] == lane and old["target"] in ("", target) for old in stamps(root)]
    rows = [row if replaced else old for replaced, old in zip(same, stamps(root))] + ([] if any(same) else [row])
    rows.sort(key=lambda row: [*lanes(root), row["lane"]].index(row["lane"]))
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    (root / STAMPS).write_text(text.getvalue(), encoding="utf-8")
    (root / PAGE).write_text(with_table(root), encoding="utf-8")
    return ""


def with_table(root):
    """The page, with the table that the stamps make."""
    blob = kept(root)[1]
    lines = ["| target | compiler, device | what held | at | results since |", "| --- | --- | --- | --- | --- |"]
    for row in stamps(root):
        since = "-" if not row["held"] else "the same" if row["results"] == blob else "have changed"
        if row["target"]:
            lines.append(f"| {row['target']} | {row['tools']} | {row['held'] or 'built, not run'} | {row['commit']}, {row['day']} | {since} |")
    page = (root / PAGE).read_text(encoding="utf-8")
    return page[: page.index(BEGIN)] + "\n".join([BEGIN, *lines, ""]) + page[page.index(END) :]


def wrong_stamps(root):
    """What is not so in this repository: stamps of no lane, stamps with results that their commit did not keep, a table of other stamps."""
    found = [f"{STAMPS} has a stamp of no lane: {row['lane']}" for row in stamps(root) if row["lane"] not in lanes(root)]
    for row in stamps(root):
        then = git(root, "rev-parse", f"{row['commit']}:{GOLDEN}")
        if then.returncode == 0 and not (row["results"] and then.stdout.startswith(row["results"])):
            found.append(f"{STAMPS}: {row['lane']} {row['target']}: {row['commit']} kept other results than \"{row['results']}\"")
    if with_table(root) != (root / PAGE).read_text(encoding="utf-8"):
        found.append(f"the table of {PAGE} is not that of {STAMPS} and {GOLDEN}: run tests/lanes.py table")
    return found


def self_check():
    failures = []

    def expect(held, what):
        if not held:
            failures.append(what)

    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)

        def write(path, text):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)

        def commit(path, text):
            write(path, text)
            git(root, "add", "-A")
            done = git(root, "-c", "user.name=n", "-c", "user.email=e", "commit", "-qm", path)
            expect(done.returncode == 0, f"a commit: {done.stderr}")

        def row_of(target):
            return next((line for line in (root / PAGE).read_text().splitlines() if line.startswith(f"| {target} |")), "")

        git(root, "init", "-q")
        write("engine/a", "1")
        first, other, host = "0123456789abcdef", "fedcba9876543210", "00ff00ff00ff00ff"
        write(GOLDEN, f"piles_50 {first}\nlake_50 {other}\n")
        write(HOST, f"{host}\n")
        write(PAGE, f"# Words\n{BEGIN}\n{END}\nmore words\n")
        commit(LANES, f"# words\nthreads {HERE} engine\nother   {HERE} engine\nzip     release.sh engine\n")
        expect(stale(root) == ["threads: has never passed", "other: has never passed", "zip (release.sh): has never passed"], "a lane that never passed is named")
        expect(passed(root, "threads") == "" and len(stale(root)) == 2, "a lane that has passed is fresh, and no other one")
        expect((root / PAGE).read_text().count("|\n") == 2, "it has no row without a target")
        commit("README", "what no lane guards")
        commit("engine/README.md", "no code")
        expect(len(stale(root)) == 2, "a commit elsewhere makes nothing stale, nor does the stamp's own")
        commit("engine/a", "2")
        commit("engine/a", "3")
        expect(stale(root)[0].startswith("threads: 2 commits changed"), "a lane is stale once its code changes")
        write("engine/a", "4")
        expect("have changes" in passed(root, "threads") and len(stale(root)) == 3, "with changes nothing is stamped")
        git(root, "checkout", "engine/a")
        expect(passed(root, "threads") == "" and len(stale(root)) == 2, "the stamp is renewed, with the last stamp not committed, too")
        expect("no lane" in passed(root, "thread"), "an unknown lane is refused")
        expect("wants --tools" in passed(root, "zip", "A zip") and "wants a --target" in passed(root, "zip", host=host), "a row without tools is refused, and what ran without a row")

        log = f"INFO: piles_50 is {first}, golden {first}\nlake_50 is {other}, golden {other}\n"
        expect(f"lake_50 is not there, not {other}" in passed(root, "zip", "A zip", "g++ 1", log.splitlines()[0]), "a log that lacks a scene is refused")
        expect(f"piles_50 is {other}" in passed(root, "zip", "A zip", "g++ 1", log.replace(first, other)), "another golden hash is refused")
        expect(f"not {host}" in passed(root, "zip", "A zip", "g++ 1", host=first), "another hash of the smallest host is refused")
        expect(row_of("A zip") == "" and len(stale(root)) == 2, "what is refused leaves no stamp")
        expect(passed(root, "zip", "A zip", "g++ 1, a, b", log, host) == "" and len(stale(root)) == 1, "a target is stamped")
        expect("| g++ 1, a, b | golden hashes, smallest host |" in row_of("A zip") and row_of("A zip").endswith("| the same |"), "its row says what held")
        expect(passed(root, "zip", "B zip", "g++ 1") == "" and "| built, not run |" in row_of("B zip") and row_of("A zip") != "", "a second target has a row of its own")
        expect(passed(root, "other", "C", "g++ 1", ran="conformance") == "" and "| conformance |" in row_of("C"), "so has what ran without hashes")
        text = (root / PAGE).read_text()
        expect(text.index("| C |") < text.index("| A zip |") < text.index("| B zip |") and text.startswith("# Words\n") and text.endswith(f"{END}\nmore words\n"), "rows stand as lanes do, the rest of the page stays")
        expect(wrong_stamps(root) == [], "what passed() writes is right")
        write(PAGE, text.replace("g++ 1, a, b", "g++ 2"))
        expect(["run tests/lanes.py table" in said for said in wrong_stamps(root)] == [True], "a table of other stamps is found")
        write(PAGE, text)
        blob = kept(root)[1]
        commit(GOLDEN, f"piles_50 {other}\nlake_50 {other}\n")
        expect(["run tests/lanes.py table" in said for said in wrong_stamps(root)] == [True], "so is one of other results")
        write(PAGE, with_table(root))
        expect(row_of("A zip").endswith("| have changed |") and row_of("B zip").endswith("| - |") and row_of("C").endswith("| have changed |"), "a row says that results have changed since")
        expect(wrong_stamps(root) == [], "and is right then")
        git(root, "commit", "-qam", "table", "--author", "n <e>")
        csv_text = (root / STAMPS).read_text()
        write(STAMPS, csv_text.replace(blob, kept(root)[1]))
        expect([said for said in wrong_stamps(root) if "kept other results" in said], "a stamp with results that its commit did not keep is found")
        write(STAMPS, csv_text.replace("threads,", "thread,"))
        expect([said for said in wrong_stamps(root) if "no lane: thread" in said], "a stamp of no lane is found")
        write(STAMPS, csv_text)

        write(LANES, (root / LANES).read_text().replace("engine", "engines"))
        expect("not there: engines" in stale(root)[0], "a path that is gone is named")
        write(LANES, f"threads {HERE} engine\n")
        write(STAMPS, re.sub("(threads,,)[0-9a-f]{7}", r"\g<1>0123456", csv_text))
        expect("does not have" in stale(root)[0], "a commit that is not there is named")
    failures += [f"{lane}: {lacks}" for lane, (_, paths) in lanes(ROOT).items() if "not there" in (lacks := behind(ROOT, "never", paths))]
    failures += wrong_stamps(ROOT)
    for failure in failures:
        print(f"FAIL not so: {failure}")
    print(f"lanes: {len(failures)} failed")
    return 1 if failures else 0


def main():
    match sys.argv[1:]:
        case ["list"]:
            print(*[lane for lane, (by, _) in lanes(ROOT).items() if by == HERE])
        case ["stale"]:
            for line in stale(ROOT):
                print(f"  {line}")
        case ["table"]:
            (ROOT / PAGE).write_text(with_table(ROOT), encoding="utf-8")
        case ["passed", *words]:
            parser = argparse.ArgumentParser("lanes.py passed", allow_abbrev=False)
            parser.add_argument("lane")
            for option in ("--target", "--tools", "--host", "--ran"):
                parser.add_argument(option, default="")
            parser.add_argument("--golden", type=pathlib.Path)
            stamp = vars(parser.parse_args(words))
            if stamp["golden"]:
                stamp["golden"] = stamp["golden"].read_text(encoding="utf-8", errors="replace")
            if message := passed(ROOT, **stamp):
                print(f"lanes.py: {message}", file=sys.stderr)
                return 1
        case ["self-check"]:
            return self_check()
        case _:
            print(__doc__, file=sys.stderr)
            return 2
    return 0


sys.exit(main())
