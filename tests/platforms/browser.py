#!/usr/bin/env python3
"""What an Emscripten program prints in headless Chromium. Usage: browser.py PROGRAM.js; exit status 1 where it has not ended after 120 s."""
import functools
import http.server
import pathlib
import subprocess
import sys
import tempfile
import threading

PAGE = """<!doctype html><script>
const lines = [];
const tell = () => fetch("/printed", { method: "POST", body: lines.join("\\n") });
var Module = { print: line => lines.push(line), printErr: line => lines.push(line), onExit: tell };
addEventListener("error", e => { lines.push("error: " + e.message); tell(); });
</script><script src="%s"></script>"""


class Handler(http.server.SimpleHTTPRequestHandler):
    program = ""
    printed = ""
    done = threading.Event()

    def end_headers(self):
        # Without both a page has no shared memory, and so no threads.
        self.send_header("Cross-Origin-Opener-Policy", "same-origin")
        self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
        super().end_headers()

    def do_GET(self):
        if self.path != "/":
            return super().do_GET()
        page = (PAGE % Handler.program).encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(page)))
        self.end_headers()
        self.wfile.write(page)

    def do_POST(self):
        Handler.printed = self.rfile.read(int(self.headers["Content-Length"])).decode()
        self.send_response(204)
        self.end_headers()
        Handler.done.set()

    def log_message(self, *_):
        pass


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    Handler.program = program.name
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=program.parent))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        page = f"http://127.0.0.1:{server.server_port}/"
        browser = subprocess.Popen(["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}", page],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        ended = Handler.done.wait(120)
        browser.terminate()
        browser.wait()
    print(Handler.printed)
    return 0 if ended else 1


if __name__ == "__main__":
    sys.exit(main())
