#!/usr/bin/env python3
"""Runs an Emscripten program in headless Chromium, as `node PROGRAM.js` does in Node.js: its output and exit status are the program's.

The page is served with the headers that shared memory, and so threads, asks for. Exit status 1 too where the page fails or Chromium ends
before the program, 2 for a wrong command line or where Chromium is missing, 124 where the program has not ended in time.
"""
import argparse
import functools
import http.server
import json
import os
import pathlib
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

# Lines leave the page at once and in order, also while main() keeps the page's thread: requests wait for their answers.
PAGE = """<!doctype html><link rel="icon" href="data:,"><script>
const tell = (what, text) => {
    const request = new XMLHttpRequest();
    request.open("POST", "/" + what, false);
    request.send(text);
};
const fail = text => tell("failed", String(text));
addEventListener("error", e => fail(e.message), true);
addEventListener("unhandledrejection", e => fail(e.reason));
var Module = {
    arguments: %s,
    print: line => tell("out", line),
    printErr: line => tell("err", line),
    onExit: status => tell("exit", status),
    onAbort: fail,
};
if (!crossOriginIsolated) fail("the page is not isolated, threads have no shared memory");
</script><script src="%s" onerror="fail('cannot load ' + src)"></script>"""


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = {".js": "text/javascript", ".wasm": "application/wasm", "": "application/octet-stream"}

    def __init__(self, *args, page, told, **kwargs):
        self.page, self.told = page, told
        super().__init__(*args, **kwargs)

    def end_headers(self):
        # Without both a page has no shared memory, and so no threads.
        self.send_header("Cross-Origin-Opener-Policy", "same-origin")
        self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
        super().end_headers()

    def do_GET(self):
        if self.path != "/":
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(self.page)))
        self.end_headers()
        self.wfile.write(self.page)

    def do_POST(self):
        text = self.rfile.read(int(self.headers["Content-Length"])).decode(errors="replace")
        self.told.put((self.path[1:], text))
        self.send_response(204)
        self.end_headers()

    def log_message(self, *_):
        pass

    def log_error(self, *args):
        print("browser.py: served the page:", args[0] % args[1:], file=sys.stderr)


def seconds(text):
    value = float(text)
    if not 1 <= value <= 3600:
        raise argparse.ArgumentTypeError(f"{text} is not from 1 to 3600")
    return value


def follow(browser, told, limit):
    """The program's exit status, and why there is none of its own."""
    until = time.monotonic() + limit
    while time.monotonic() < until:
        try:
            what, text = told.get(timeout=0.1)
        except queue.Empty:
            if browser.poll() is not None:
                return 1, f"Chromium ended before the program, with status {browser.returncode}"
            continue
        if what == "exit":
            return int(text), None
        if what == "failed":
            return 1, f"the page failed: {text}"
        print(text, file=sys.stdout if what == "out" else sys.stderr, flush=True)
    return 124, f"the program has not ended after {limit:g} s"


def complaints(log):
    """The end of what Chromium wrote, the console of page and workers among it, without what every container lacks."""
    log.seek(0)
    lines = [line.rstrip() for line in log if "dbus/" not in line and "/idle_linux" not in line]
    return [f"chromium: {line}" for line in lines[-20:]]


def end(browser):
    """Chromium and all that it started: a program that hangs would keep a core."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(browser.pid, number)
            browser.wait(5)
        except (ProcessLookupError, subprocess.TimeoutExpired):
            pass


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--limit", type=seconds, default=120, metavar="SECONDS", help="the time a program has (1 to 3600, default 120)")
    parser.add_argument("program", type=pathlib.Path, metavar="PROGRAM.js")
    parser.add_argument("arguments", nargs=argparse.REMAINDER, metavar="ARGUMENT")
    options = parser.parse_args()
    if not options.program.is_file():
        parser.error(f"there is no program {options.program}")
    chromium = shutil.which("chromium")
    if chromium is None:
        parser.error("there is no chromium; Debian's package is called so: apt-get install chromium")

    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # as Ctrl-C does it: Chromium ends with us
    told = queue.Queue()
    arguments = json.dumps(options.arguments).replace("<", "\\u003c")
    page = (PAGE % (arguments, urllib.parse.quote(options.program.name))).encode()
    handler = functools.partial(Handler, page=page, told=told, directory=options.program.resolve().parent)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile, tempfile.TemporaryFile("w+", errors="replace") as log:
        # No sandbox: it asks for rights that a container lacks, and what runs is ours.
        browser = subprocess.Popen(
            [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", "--enable-logging=stderr",
             f"--user-data-dir={profile}", f"http://127.0.0.1:{server.server_port}/"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log, start_new_session=True)
        try:
            status, why = follow(browser, told, options.limit)
            if why:
                print(*complaints(log), f"browser.py: {options.program.name}: {why}", sep="\n", file=sys.stderr)
        finally:
            end(browser)
    return status


if __name__ == "__main__":
    sys.exit(main())
