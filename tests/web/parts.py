#!/usr/bin/env python3
"""Parts of the page that need no browser: levels, shaders, compression, the server, and what link.js and tools.js calculate, under Node.js."""
import gzip
import http.client
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parents[1] / "samples" / "web"
sys.path.insert(0, str(PAGE))
import serve  # noqa: E402

SKIPPED = 77
faults = []


def check(good, what):
    if not good:
        faults.append(what)
        print("parts.py:", what, file=sys.stderr)


def levels_and_shaders(folder):
    subprocess.run([sys.executable, PAGE / "levels.py", folder], check=True)
    told = json.loads((folder / "levels.json").read_text(encoding="utf-8"))
    check(list(told) == ["beach", "castle", "canyon", "piles"], "the page's levels")
    for name, level in told.items():
        for file in ["level.json", *level["files"]]:
            check((folder / "levels" / name / file).is_file(), f"{name} lacks {file}")
    check("no_wave" in told["castle"]["variants"], "the castle's presets")
    beach = (folder / "levels" / "beach" / "level.json").read_text(encoding="utf-8")
    check('"edits": []' in beach and beach.count("[") > 700, "the beach's waves")
    subprocess.run([sys.executable, PAGE / "shaders.py", folder / "shaders.js"], check=True)
    text = (folder / "shaders.js").read_text(encoding="utf-8")
    shaders = json.loads(text[text.index("{"):text.rindex("}") + 1])
    check(len(shaders) == 10, "ten shaders")
    for name, shader in shaders.items():
        left = [word for word in ("imageStore", "imageLoad", "textureGather", "gl_GlobalInvocationID", "binding", "#include", "[at(") if word in shader]
        check(not left, f"shader {name} has what WebGL lacks: {left}")
        check(shader.count("layout(location = ") == (3 if name == "prepare" else 1), f"targets of shader {name}")


def served(folder):
    (folder / "index.html").write_text("<p>plain</p>", encoding="utf-8")
    (folder / "index.html.gz").write_bytes(gzip.compress(b"<p>packed</p>"))
    for threads in (True, False):
        server = serve.server_of(folder, threads=threads)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        for takes, body in (("gzip, br", b"<p>packed</p>"), ("identity", b"<p>plain</p>")):
            connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=10)
            connection.request("GET", "/", headers={"Accept-Encoding": takes})
            answer = connection.getresponse()
            data = answer.read()
            check((gzip.decompress(data) if answer.headers["Content-Encoding"] == "gzip" else data) == body, f"what is sent for {takes}")
            check((answer.headers["Cross-Origin-Embedder-Policy"] == "require-corp") == threads, "headers for threads")
            connection.request("GET", "/nothing.js")
            check(connection.getresponse().status == 404, "a file that is not there")
        server.shutdown()


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        levels_and_shaders(folder / "site")
        served(folder / "site")
        if shutil.which("node") is None:
            print("parts.py: link.js and tools.js are not tried: there is no node (Debian's package nodejs)")
            return 1 if faults else SKIPPED
        for script in ("link.js", "tools.js"):  # as modules, which Node.js knows by their ending
            shutil.copy(PAGE / "page" / script, (folder / script).with_suffix(".mjs"))
        shutil.copy(HERE / "parts.mjs", folder)
        check(subprocess.run(["node", folder / "parts.mjs"], check=False).returncode == 0, "parts.mjs")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
