#!/usr/bin/env python3
"""What pages show as code is code: every block compiles, parses or names what is there.
Usage: check_code.py [LIBRARY] [--update] [--godot=COMMAND]
LIBRARY: libwadi.so of a build, to link whole programs with and to run hello with; without it they are compiled. The build's stagec and the
add-on for Godot need it. --update writes into hello.md what hello prints. COMMAND starts Godot (godot). Exit status 1 names every breach.

Nothing is left out by a list. A block's language says what is done with it, and one without a language is the shell's (README.md beside this
folder). What is not looked into has a language of its own: LEFT."""
import contextlib
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import textwrap

import godot_blocks

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
FOLDERS = ("engine", "backends", "shaders", "plugin", "samples", "tests")
INCLUDES = [f"-I{ROOT / 'plugin/include'}"]
WARNINGS = ["-Wall", "-Wextra", "-Werror", "-Wno-unused"]
LEFT = {"text", "bat"}  # prose in columns; Windows (release.sh runs them)
# Tools of others, whose options are theirs.
TOOLS = {"cmake", "ctest", "cpack", "cc", "cp", "mcs", "git", "godot", "python3", "pip", "pre-commit", "mkdir", "echo", "sed", "cat", "cd", "unzip"}
FENCE = re.compile(r"^( *)```(\w*)\s*$")
PRINTS = re.compile(r"(<!-- hello.c prints from here -->\n```text\n)(.*?)(```\n<!-- to here -->)", re.DOTALL)


def pages(root):
    return sorted([*root.glob("*.md"), *(p for top in FOLDERS for p in (root / top).rglob("*.md"))])


def blocks(page):
    """(line, language, text) of every block of code; one that is indented has no language."""
    lines = page.read_text(encoding="utf-8").splitlines()
    at, in_list, before = 0, False, ""
    while at < len(lines):
        line = lines[at]
        fence = FENCE.match(line)
        if fence:
            end = next((n for n in range(at + 1, len(lines)) if lines[n].strip() == "```"), len(lines))
            yield at + 1, fence[2], textwrap.dedent("\n".join(lines[at + 1:end])) + "\n"
            at, before = end + 1, "```"
            continue
        if re.match(r"\s*([-*]|\d+\.) ", line):
            in_list = True
        elif line.strip() and not line.startswith(" "):
            in_list = in_list and bool(before.strip())
        if line.startswith("    ") and not in_list and not before.strip():
            end = next((n for n in range(at, len(lines)) if lines[n].strip() and not lines[n].startswith("    ")), len(lines))
            yield at + 1, "", textwrap.dedent("\n".join(lines[at:end])).rstrip() + "\n"
            at, before = end, ""
            continue
        before = line
        at += 1


# C, C++ and C#

def run(*command):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return None if done.returncode == 0 else next((line for line in done.stdout.splitlines() if "error" in line.lower()), done.stdout.strip()[-300:])


def compiled(text, language, name, work, library):
    """None, or the compiler's first error."""
    whole = "#include" in text
    path = work / f"{re.sub(r'[^A-Za-z0-9]', '_', name)}.{language}"
    body = f'#line 1 "{name}"\n{text}'
    if not whole and not re.search(r"(?m)^(?!for|if|while|switch|else)\w[^;=]*\)\s*\{", text):
        body = f"void fragment(void);\nvoid fragment(void) {{\n{body}}}\n"
    path.write_text(("" if whole else f'#include "{HERE / "fragment.h"}"\n') + body, encoding="utf-8")
    compiler = ["cc", "-std=c99"] if language == "c" else ["c++", "-std=c++17"]
    if whole and library and "main(" in text:
        return run(*compiler, *WARNINGS, *INCLUDES, path, library, f"-Wl,-rpath,{library.parent}", "-o", path.with_suffix(""))
    return run(*compiler, *WARNINGS, *INCLUDES, "-fsyntax-only", path)


def csharp(text, name, work):
    path = work / f"{re.sub(r'[^A-Za-z0-9]', '_', name)}.cs"
    uses = "using System; using Wadi;"
    if not re.search(r"\bclass \w+", text):
        text = f"class Page {{ static void Main() {{\n{text}}} }}\n"
    path.write_text(f"{uses}\n#line 1 \"{name}\"\n{text}", encoding="utf-8")
    dll = work / "Wadi.dll"
    if not dll.exists():
        error = run("mcs", "-langversion:7", "-unsafe", "-target:library", f"-out:{dll}", *sorted((ROOT / "plugin/csharp/Wadi").glob("*.cs")))
        if error:
            return error
    return run("mcs", "-langversion:7", "-unsafe", f"-r:{dll}", f"-out:{path.with_suffix('.exe')}", path)


# The stage language

class Stages:
    """`missing` says why they cannot be compiled, or is empty."""

    def __init__(self, library, work):
        self.tool = library.parents[1] / "tools/stagec" if library else None
        self.glslang = shutil.which("glslangValidator") or shutil.which("glslang")
        self.folder = work / "shaders"
        self.missing = ""
        if not self.tool or not self.tool.is_file():
            self.missing = "no stagec of a build beside the library: stages are not compiled"
        elif not self.glslang:
            self.missing = "no glslangValidator: stages are not compiled"
        if self.missing or self.folder.exists():
            return
        (self.folder / "stages/page").mkdir(parents=True)
        for name in ("physics", "language", "step_params.h", "effects.h"):
            (self.folder / name).symlink_to(ROOT / "shaders" / name)

    def breach(self, text):
        stage, out = self.folder / "stages/page/page.stage", self.folder.parent / "page.comp"
        if "STAGE(" not in text:
            before = '#include "../../physics/flux.glsl"\n' + (HERE / "fragment.stage").read_text(encoding="utf-8")
            text = before.replace("    // the block\n", textwrap.indent(text, "    "))
        stage.write_text(text, encoding="utf-8")
        return (run(self.tool, "glsl", self.folder / "effects.h", stage, out)
                or run(self.glslang, "-V", "--quiet", "--target-env", "vulkan1.1", "-S", "comp", f"-I{ROOT / 'shaders'}", out, "-o", out.with_suffix(".spv")))


# Shell

class Repository:
    """Programs, presets and scripts that commands may name."""

    def __init__(self, root):
        self.root, self.programs, self.targets = root, {}, set()
        for path in [root / "CMakeLists.txt", *(p for top in FOLDERS for p in (root / top).rglob("CMakeLists.txt"))]:
            text = path.read_text(encoding="utf-8")
            for name in re.findall(r"add_executable\(\s*([\w-]+)", text):
                self.programs.setdefault(name, path.parent)
            self.targets.update(re.findall(r"add_(?:executable|library|custom_target)\(\s*([\w:-]+)", text))
            for name in re.findall(r"wadi_test\((\w+)", text):
                self.programs[f"wadi-test-{name}"] = path.parent / name
        presets = root / "CMakePresets.json"
        self.presets = {p["name"] for p in json.loads(presets.read_text(encoding="utf-8"))["configurePresets"]} if presets.exists() else set()
        self.texts = {}

    def sources(self, folder):
        if folder not in self.texts:
            self.texts[folder] = "\n".join(p.read_text(encoding="utf-8", errors="ignore") for p in sorted(folder.rglob("*")) if p.suffix in (".py", ".sh", ".cpp", ".hpp", ".c"))
        return self.texts[folder]

    def breach(self, words):
        while words and (re.match(r"\w+=", words[0]) or words[0] in ("sudo", "nice")):
            words = words[1:]
        if not words or re.fullmatch(r"[A-Z][A-Z_]*(/.*)?|\.\.\.|[.]/hello", words[0]):
            return None  # nothing; what a page names in capitals for the reader to fill in; what it has just compiled
        command, options = words[0], [w for w in words[1:] if w.startswith("--") and len(w) > 2]
        if command in TOOLS:
            if command in ("cmake", "ctest"):
                for option, name in zip(words[1:], words[2:]):
                    if option == "--preset" and name not in self.presets:
                        return f"there is no preset {name}"
            if command == "cmake" and "--target" in words:
                for name in words[words.index("--target") + 1:]:
                    if not name.startswith("-") and name not in self.targets:
                        return f"there is no target {name}"
            if command == "python3" and len(words) > 1 and words[1].endswith(".py") and not (self.root / words[1]).is_file():
                return f"there is no script {words[1]}"
            return None
        script = self.root / command
        if command.startswith("build/"):
            preset = command.split("/")[1]
            if preset not in self.presets:
                return f"there is no preset {preset}"
            command = pathlib.Path(command).name
        elif command.startswith("bin/"):  # of an unpacked zip
            command = command[4:]
        elif "/" in command or command.endswith((".sh", ".py")):
            if not script.is_file():
                return f"there is no script {command}"
            if not script.stat().st_mode & 0o100:
                return f"{command} may not be run"
            text = script.read_text(encoding="utf-8") + self.sources(script.resolve().parent)
            return next((f"{command} knows no {o}" for o in options if o.split("=")[0] not in text), None)
        if command not in self.programs:
            return f"{command} is no script, no program of the build and no tool that check_code.py knows"
        text = self.sources(self.programs[command]) + self.sources(self.root / "samples/common")
        return next((f"{command} knows no {o.split('=')[0]}" for o in options if o.split("=")[0] not in text and o not in ("--help", "--version")), None)


def shell(text, repository):
    """(line within the block, breach) of a block for the shell."""
    done = subprocess.run(["bash", "-n"], input=text, capture_output=True, text=True)
    if done.returncode != 0:
        yield 0, done.stderr.strip().splitlines()[0]
        return
    for number, line in enumerate(text.replace("\\\n", " ").splitlines()):
        lexer = shlex.shlex(line, posix=True, punctuation_chars="|&;<>()")
        lexer.whitespace_split = True
        try:
            words = list(lexer)
        except ValueError as error:
            yield number, str(error)
            continue
        command = []
        for word in [*words, ";"]:
            if re.fullmatch(r"[|&;()]+", word):
                breach = repository.breach([w for w in command if w not in ("<", ">")])
                if breach:
                    yield number, breach
                command = []
            else:
                command.append(word)


def check(root, work, library, godot, said):
    found, counts, of_godot = [], {}, []
    repository = Repository(root)
    vulkan = run("cc", *INCLUDES, "-fsyntax-only", "-x", "c", "-include", "vulkan/vulkan_core.h", "/dev/null") is None
    if not vulkan:
        said.append("no headers of Vulkan: C is not compiled but for whole programs")
    if not shutil.which("mcs"):
        said.append("no Mono compiler: C# is not compiled")
    stages = Stages(library, work)
    said += [missing for missing in (stages.missing, godot.missing) if missing]
    for page in pages(root):
        name = page.relative_to(root).as_posix()
        for line, language, text in blocks(page):
            where = f"{name}:{line}"
            counts[language or "shell"] = counts.get(language or "shell", 0) + 1
            breach = None
            if language in ("c", "cpp"):
                if vulkan or "#include" in text:
                    breach = compiled(text, language, where, work, library)
            elif language in ("cs", "csharp"):
                breach = csharp(text, where, work) if shutil.which("mcs") else None
            elif language == "glsl":
                breach = None if stages.missing else stages.breach(text)
            elif language in godot_blocks.SUFFIX:
                of_godot.append((where, language, text))
            elif language in ("", "sh", "bash", "console"):
                if language == "console":  # commands behind "$ ", and what they print
                    text = "\n".join(row[2:] if row.startswith("$ ") else "" for row in text.splitlines()) + "\n"
                    breach = None if text.strip() else 'a console without a command behind "$ "'
                found += [f"{name}:{line + 1 + number}: {what}" for number, what in shell(text, repository)]
            elif language == "python":
                try:
                    compile(text, where, "exec")
                except SyntaxError as error:
                    breach = str(error)
            elif language == "json":
                try:
                    json.loads(text if text.lstrip().startswith(("{", "[")) else f"{{{text}}}")  # some keys of an object
                except ValueError as error:
                    breach = str(error)
            elif language not in LEFT:
                breach = f"no rule for the language {language}; there are c, cpp, cs, glsl, gdscript, gdshader, python, sh, console, json and, not looked into, {', '.join(sorted(LEFT))}"
            if breach:
                found.append(f"{where}: {breach}")
    if not godot.missing:
        found += godot.breaches(of_godot)
    return found, counts


def hello(work, library, update, said):
    """What the first page's program prints is what that page shows."""
    source = ROOT / "plugin/docs/examples/hello.c"
    breach = compiled(source.read_text(encoding="utf-8"), "c", "plugin/docs/examples/hello.c", work, library)
    if breach or not library:
        said.append("no library: hello was compiled and not run")
        return [breach] if breach else []
    done = subprocess.run([work / "plugin_docs_examples_hello_c", ROOT / "samples/levels/dam_break/level.json"], capture_output=True, text=True)
    page = ROOT / "plugin/docs/hello.md"
    text = page.read_text(encoding="utf-8")
    shown = PRINTS.search(text)
    if done.returncode != 0 or not shown:
        return [f"hello ends with {done.returncode}: {done.stderr}" if shown else "hello.md shows nothing that hello prints"]
    if shown[2] == done.stdout:
        return []
    if update:
        page.write_text(text[:shown.start(2)] + done.stdout + text[shown.end(2):], encoding="utf-8")
        said.append("hello.md has what hello prints now")
        return []
    return [f"plugin/docs/hello.md shows other lines than hello prints; build.sh --update writes them:\n{done.stdout}"]


CONTROLS = (  # (block, what must be said of it)
    ("```c\nwadi_world_updat(world, 1, NULL);\n```\n", "wadi_world_updat"),
    ("```c\n#include <wadi/wadi.h>\nint main(void) { return wadi_get_abi_version(1); }\n```\n", "wadi_get_abi_version"),
    ("```c\nint helper(int n) { return n + unknown; }\n```\n", "unknown"),
    ("```cpp\nauto world2 = wadi_default_world();\n```\n", "wadi_default_world"),
    ("```cs\nWorld.FromNowhere(1);\n```\n", "FromNowhere"),
    ("```glsl\nfloat flux = upwind_flux(sand_velocity_x[c], sand_hight[c], sand, P.ks);\nsand_flux_x[c] = flux;\n```\n", "sand_hight"),
    ("```glsl\nEACH_AXIS {\n    float low_x = sand;\n}\n```\n", "has an axis in its name"),
    ("```glsl\nSTAGE(Other)\nEXTENT(CELLS)\nINN(0, float, depth)\nKERNEL {\n}\nEND_STAGE\n```\n", "INN is no word"),
    ("```gdscript\nterrain.brushes(1)\n```\n", "brushes"),
    ("```gdscript\nextends Node3D\nfunc _ready() -> void:\n    terrain.step(1)\n```\n", '"terrain" not declared'),
    ("```gdshader\nALBEDO = vec3(surfaces_at(at).froth);\n```\n", "froth"),
    ("```gdshader\nshader_type spatial;\nvoid fragment() {\n    ALBEDO = surfaces_of(UV);\n}\n```\n", "surfaces_of"),
    ("```\nsamples/gone.sh --now\n```\n", "no script samples/gone.sh"),
    ("```\nsamples/there.sh --gone\n```\n", "knows no --gone"),
    ("```sh\nif true; then\n```\n", "syntax error"),
    ("```\ncmake --preset gone\n```\n", "no preset gone"),
    ("    no-such-program --fast\n", "no-such-program is no script"),
    ("```console\n$ samples/there.sh --nowhere\nsome (words\n```\n", "knows no --nowhere"),
    ("```console\nsome words\n```\n", "console without a command"),
    ("```json\n{ 1 }\n```\n", "property name"),
    ("```fortran\nend\n```\n", "no rule for the language fortran"),
)
GOOD = "```gdscript\nterrain.step(1)\n```\n```gdscript\nfunc more() -> int:\n    return terrain.get_step()\n```\n```gdshader\nALBEDO = vec3(surfaces_at(at).foam);\n```\n" \
       "```glsl\nsand_flux_x[c] = sand;\n```\n" \
       "```c\nfor (int n = 0; n < 2; ++n) wadi_world_step(world, 1);\n```\n\n```\nsamples/there.sh --there    # a comment; isn't it\n```\n```text\nanything: (at all\n```\n- an item\n\n      more of it\n"


def control(work, library, godot):
    """Planted breaches must be seen, and nothing else."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        (root / "samples").mkdir()
        (root / "CMakeLists.txt").write_text("")
        (root / "samples/there.sh").write_text("case $1 in --there) ;; esac\n")
        (root / "samples/there.sh").chmod(0o755)
        there = {"cs": shutil.which("mcs"), "glsl": not Stages(library, work).missing, "gdscript": not godot.missing, "gdshader": not godot.missing}
        wanted = [sign for block, sign in CONTROLS if there.get(re.match(r"\W*(\w*)", block)[1], True)]
        for n, (block, _) in enumerate(CONTROLS):
            (root / f"samples/{n}.md").write_text("# Page\n\n" + block)
        (root / "README.md").write_text(GOOD)
        seen, _ = check(root, work, library, godot, [])
    missing = [sign for sign in wanted if sum(sign in breach for breach in seen) != 1]
    return missing + ([] if len(seen) == len(wanted) else seen)


def main():
    given = [a for a in sys.argv[1:] if not a.startswith("--")]
    library = pathlib.Path(given[0]).resolve() if given else None
    said = []
    godot = godot_blocks.Godot(next((a.partition("=")[2] for a in sys.argv[1:] if a.startswith("--godot=")), ""), library)
    with contextlib.closing(godot), tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        wrong = control(work, library, godot)
        if wrong:
            print("the checker does not see what is planted, or sees what is none:", *wrong, sep="\n")
            return 1
        found, counts = check(ROOT, work, library, godot, said)
        found += hello(work, library, "--update" in sys.argv, said)
    print(*dict.fromkeys(said), *found, f"blocks of code: {', '.join(f'{n} {what}' for what, n in sorted(counts.items()))}; {len(found)} breaches", sep="\n")
    return 1 if found or sum(counts.values()) < 30 else 0


if __name__ == "__main__":
    sys.exit(main())
