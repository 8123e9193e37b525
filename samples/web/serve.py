#!/usr/bin/env python3
"""Serves a folder to this machine: compressed files where they lie beside, and the headers by which a page may have threads."""
import argparse
import functools
import http.server
import os
import pathlib
import sys

ENCODINGS = (("br", ".br"), ("gzip", ".gz"))


class Handler(http.server.SimpleHTTPRequestHandler):
    """A file is sent as it lies compressed beside itself, in the first way that the browser takes."""

    protocol_version = "HTTP/1.1"
    threads = True
    extensions_map = {".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".json": "application/json",
                      ".wasm": "application/wasm", ".png": "image/png", ".svg": "image/svg+xml", "": "application/octet-stream"}

    def end_headers(self):
        if self.threads:
            self.send_header("Cross-Origin-Opener-Policy", "same-origin")
            self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
        self.send_header("Cache-Control", "no-cache")
        super().end_headers()

    def send_head(self):
        path = pathlib.Path(self.translate_path(self.path))
        if path.is_dir():
            path /= "index.html"
        taken = [word.split(";")[0].strip() for word in self.headers.get("Accept-Encoding", "").split(",")]
        for encoding, ending in ENCODINGS:
            packed = path.with_name(path.name + ending)
            if encoding in taken and path.is_file() and packed.is_file():
                file = packed.open("rb")
                self.send_response(200)
                self.send_header("Content-Type", self.guess_type(str(path)))
                self.send_header("Content-Encoding", encoding)
                self.send_header("Content-Length", str(os.fstat(file.fileno()).st_size))
                self.end_headers()
                return file
        return super().send_head()

    def log_message(self, *args):
        pass


class Server(http.server.ThreadingHTTPServer):
    """Browsers that go away in the middle of an answer are no errors."""

    def handle_error(self, request, client_address):
        if not isinstance(sys.exc_info()[1], ConnectionError):
            super().handle_error(request, client_address)


def server_of(folder, port=0, threads=True):
    """A server on 127.0.0.1 that is not running yet; its port is server_port. Without threads pages get no memory that they can share."""
    kind = type("Handler", (Handler,), {"threads": threads})
    return Server(("127.0.0.1", port), functools.partial(kind, directory=str(folder)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--port", type=int, default=8080, help="0 ... 65535, 0 = a free one (default 8080)")
    options = parser.parse_args()
    if not (options.folder / "index.html").is_file():
        parser.error(f"there is no page in {options.folder}")
    try:
        server = server_of(options.folder, options.port)
    except (OSError, OverflowError) as error:
        parser.error(f"port {options.port}: {error}; choose another with --port")
    print(f"Wadi's page: http://localhost:{server.server_port}/    (Ctrl-C ends it)", flush=True)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        print()
    return 0


if __name__ == "__main__":
    sys.exit(main())
