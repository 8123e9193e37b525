#!/usr/bin/env python3
"""What browser.py makes of small programs in Chromium: output, exit statuses, hangs, failures of page, worker and Chromium itself."""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

BROWSER = pathlib.Path(__file__).with_name("browser.py")
WORKER = "const worker = new Worker(URL.createObjectURL(new Blob([%r])));"
SHARES = """const cells = new Int32Array(new SharedArrayBuffer(4));
worker.onmessage = () => { Module.print(cells[0]); Module.onExit(0); };
worker.postMessage(cells);"""
HANGS = "(?s)busy.*has not ended after 10 s"

# What the program does, its arguments; the exit status, the lines of standard output, and what standard error has (nothing else than "").
PROGRAMS = [
    ("Module.print(Module.arguments.join('|')); Module.print('second'); Module.onExit(0)", ["-s", "</script> é"], 0, ["-s|</script> é", "second"], ""),
    ("Module.printErr('a complaint'); Module.onExit(0)", [], 0, [], "^a complaint\n$"),
    ("Module.print('done'); Module.onExit(1)", [], 1, ["done"], ""),
    ("Module.print('begun'); console.log('busy'); for (;;);", [], 124, ["begun"], HANGS),
    ("console.log('busy'); setInterval(() => Module.printErr('again'))", [], 124, [], HANGS),
    ("unknown()", [], 1, [], "the page failed: Uncaught ReferenceError: unknown is not defined"),
    ("Promise.reject(new Error('no module'))", [], 1, [], "the page failed: Error: no module"),
    ("Module.onAbort('out of memory')", [], 1, [], "the page failed: out of memory"),
    (WORKER % "console.log('a worker speaks'); unknown()" + "worker.onerror = e => { throw Error(e.message); }", [], 1, [],
     "(?s)a worker speaks.*the page failed: .*unknown is not defined"),
    (WORKER % "onmessage = e => { e.data[0] = 42; postMessage(0); }" + SHARES, [], 0, ["42"], ""),
]

failed = []


def check(what, seen, expected):
    if seen != expected:
        failed.append(what)
        print(f"test_browser.py: {what}: {seen!r}, expected {expected!r}", file=sys.stderr)


def run(arguments, path=None):
    environment = os.environ | ({"PATH": path} if path else {})
    return subprocess.run([sys.executable, BROWSER, *map(str, arguments)], env=environment, capture_output=True, text=True, timeout=300)


def check_run(what, done, status, lines, complaint):
    check(f"{what}: status", done.returncode, status)
    check(f"{what}: output", done.stdout.splitlines(), lines)
    right = re.search(complaint, done.stderr) if complaint else not done.stderr
    check(f"{what}: {done.stderr!r} has {complaint!r}", bool(right), True)


def processes_of(folder):
    """Processes whose command line names the folder."""
    found = 0
    for file in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            found += os.fsencode(folder) in file.read_bytes()
        except OSError:  # it has ended
            pass
    return found


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program = folder / "program.js"
        for script, arguments, status, lines, complaint in PROGRAMS:
            program.write_text(script)
            limit = 10 if status == 124 else 60
            check_run(script, run(["--limit", limit, program, *arguments]), status, lines, complaint)

        check_run("no program", run([folder / "none.js"]), 2, [], "there is no program .*none.js")
        check_run("no time", run(["--limit", "0", program]), 2, [], "0 is not from 1 to 3600")
        check_run("no Chromium", run([program], path=name), 2, [], "there is no chromium.*apt-get install chromium")
        fake = folder / "chromium"
        fake.write_text("#!/bin/sh\necho no display >&2\nexit 7\n")
        fake.chmod(0o755)
        check_run("Chromium that dies", run([program], path=f"{name}:{os.environ['PATH']}"), 1, [], "(?s)no display.*with status 7")

        # Ended from outside, it takes Chromium along.
        program.write_text("Module.print('begun'); for (;;);")
        started = subprocess.Popen([sys.executable, BROWSER, program], env=os.environ | {"TMPDIR": name}, stdout=subprocess.PIPE, text=True)
        check("begins", started.stdout.readline(), "begun\n")
        check("Chromium runs", processes_of(name) > 2, True)
        started.send_signal(signal.SIGTERM)
        check("SIGTERM: status", started.wait(60), 143)
        for _ in range(50):
            if processes_of(name) == 0:
                break
            time.sleep(0.1)
        check("SIGTERM: processes left", processes_of(name), 0)
    print(f"test_browser.py: {len(PROGRAMS)} programs, {len(failed)} checks failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
