"""Blocks of GDScript and of Godot's shader language on pages, compiled by Godot in a project that has the add-on."""
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import textwrap

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
SUFFIX = {"gdscript": "gd", "gdshader": "gdshader"}
# A member that a type does not have is a mere warning there, since the object might be of a type that extends it.
PROJECT = """config_version=5
[application]
config/name="Pages"
[debug]
gdscript/warnings/unsafe_method_access=2
gdscript/warnings/unsafe_property_access=2
gdscript/warnings/unsafe_call_argument=2
"""


def whole(text, language):
    """The block as a file of its own."""
    text = text.expandtabs(4)
    if re.search(r"(?m)^(extends|class_name) " if language == "gdscript" else r"(?m)^shader_type ", text):
        return text
    before = (HERE / f"fragment.{SUFFIX[language]}").read_text(encoding="utf-8")
    if language == "gdscript" and not re.search(r"(?m)^(static )?func ", text):
        text = "func block() -> void:\n" + textwrap.indent(text + "pass\n", "    ")
    if language == "gdshader" and not re.search(r"(?m)^void \w+\(", text):
        text = f"void fragment() {{\n{text}}}\n"
    return before + text


class Godot:
    """`missing` says why there is none, or is empty."""

    def __init__(self, command, library):
        self.folder, self.missing = None, ""
        self.command = shlex.split(command) if command else ["godot"]
        if not command and not shutil.which("godot"):
            self.missing = "no Godot: GDScript and its shaders are not compiled"
        elif not library:
            self.missing = "no library: Godot's add-on is not built, so GDScript and its shaders are not compiled"
        else:
            version = subprocess.run([*self.command, "--version"], capture_output=True, text=True)
            if version.returncode != 0:
                self.missing = f"GDScript and its shaders are not compiled: {version.stderr.strip() or 'Godot does not start'}"
        if not self.missing:
            self.make_project(library)

    def make_project(self, library):
        (ROOT / "build").mkdir(exist_ok=True)  # where a Godot of another root finds it, too (tests/godot/godot.sh)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="page_code_", dir=ROOT / "build"))
        self.must([ROOT / "plugin/godot/build.sh", "--godot", shlex.join(self.command), "--library", library, "--output", self.folder])
        (self.folder / "project.godot").write_text(PROJECT, encoding="utf-8")
        (self.folder / ".godot").mkdir()
        (self.folder / ".godot/extension_list.cfg").write_text("res://addons/wadi/wadi.gdextension\n", encoding="utf-8")
        shutil.copy(HERE / "load_blocks.gd", self.folder)
        self.must([*self.command, "--headless", "--path", self.folder, "--import"])

    def must(self, command):
        done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            raise SystemExit(f"check_code.py: {command[0]} failed:\n{done.stdout[-2000:]}")

    def breaches(self, blocks):
        """What the engine says of (where, language, text) of each block, as "where: message"."""
        to = self.folder / "blocks"
        shutil.rmtree(to, ignore_errors=True)
        to.mkdir()
        names = {}
        for n, (where, language, text) in enumerate(blocks):
            name = f"block_{n}.{SUFFIX[language]}"
            names[name] = where
            (to / name).write_text(whole(text, language), encoding="utf-8")
        done = subprocess.run([*self.command, "--headless", "--path", str(self.folder), "--script", "load_blocks.gd"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        found, seen, name = {}, set(), None
        for line in done.stdout.splitlines():
            if line.startswith("BLOCK "):
                name = line.split()[1]
                seen.add(name)
            elif "ERROR: " in line and name:
                found.setdefault(name, re.sub(r"^.*ERROR: (Parse Error: )?", "", line))
        if done.returncode != 0 or seen != set(names):
            raise SystemExit(f"check_code.py: Godot did not load every block:\n{done.stdout[-2000:]}")
        return [f"{names[name]}: {message}" for name, message in found.items()]

    def close(self):
        if self.folder:
            shutil.rmtree(self.folder)
