#!/usr/bin/env python3
"""The C# binding (plugin/csharp) under Mono against the library and against the C compiler. Exit status 77 where a program that it needs is
missing. Usage: check.py LIBRARY SOURCE_DIR [PART ...]; parts: layout session behaviour collector missing unity unity_package unity_shaders
readme; all where none is named. Or check.py PACKAGE.tgz SOURCE_DIR: a Unity package with all libraries, its scripts over its own for Linux."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

library, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
here = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(source / "plugin/csharp"), str(here / "unity")]
import checks
import write_csharp
binding = sorted((source / "plugin/csharp/Wadi").glob("*.cs"))
failures = []


def fail(text):
    failures.append(text)
    print(f"FAILED: {text}")


def compile_program(work, name, *sources, references=(), library_file=False):
    """As C# 7, which Mono's compiler and Unity 2021 take, with every warning an error."""
    out = work / (name + (".dll" if library_file else ".exe"))
    command = ["mcs", "-langversion:7", "-unsafe", "-warnaserror", "-warn:4", f"-out:{out}", *(f"-r:{r}" for r in references), *map(str, sources)]
    if library_file:
        command.insert(1, "-target:library")
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{name} cannot be compiled:\n{done.stdout}{done.stderr}")
    return out


def mono(work, program, *arguments, with_library=True):
    environment = dict(os.environ, MONO_PATH=str(work), LD_LIBRARY_PATH=str(work / "library" if with_library else work / "empty"))
    return subprocess.run(["mono", "--debug", str(program), *map(str, arguments)], capture_output=True, text=True, env=environment, cwd=work, timeout=300)


def c_layout(work, api):
    """The lines that Layout.cs must print, by the C compiler."""
    names, lines = write_csharp.Binding(api), []

    def line(text, *values):
        lines.append(f'    printf("{text}{" %ld" * len(values)}\\n"{"".join(f", (long)({v})" for v in values)});')

    for struct in api["structs"]:
        own, name = struct["name"], names.type_name(struct["name"])
        line(f"struct {name}", f"sizeof({own})", f"sizeof({own})")
        for field in struct["fields"]:
            wrapped = field["type"] in ("wadi_bool", "char") or field["name"] == "struct_size"
            label = (write_csharp.camel if wrapped else write_csharp.pascal)(field["name"])
            elements = [("", "")] if field["type"] == "char" or "count" not in field else [(write_csharp.AXES[n], f"[{n}]") for n in range(field["count"])]
            for suffix, index in elements:
                line(f"field {name}.{label}{suffix}", f"offsetof({own}, {field['name']}{index})", f"sizeof((({own}*)0)->{field['name']}{index})")
    for enum in api["enums"]:
        members = [l.split(" = ")[0].strip() for l in names.enum(enum).splitlines() if " = " in l and not l.strip().startswith("///")]
        for member, value in zip(members, enum["values"], strict=True):
            line(f"number {names.type_name(enum['name'])}.{member}", value)
    line("number OutputMask.None", 0)
    line("number OutputMask.Tiles", "WADI_OUTPUT_TILES_BIT")
    for value in next(e for e in api["enums"] if e["name"] == "wadi_output")["values"]:
        if value != "WADI_OUTPUT_COUNT":
            line(f"number OutputMask.{write_csharp.pascal(value.removeprefix('WADI_OUTPUT_'))}", f"WADI_OUTPUT_BIT({value})")
    for call in api["functions"] + api["callbacks"]:
        types = [call["returns"]] + [a["type"] for a in call["arguments"]]
        line(f"call {call['name'] if call in api['functions'] else names.type_name(call['name'])}", *("0" if t == "void" else f"sizeof({t})" for t in types))
    (work / "layout.c").write_text("#include <stddef.h>\n#include <stdio.h>\n#include <wadi/wadi.h>\nint main(void) {\n" + "\n".join(lines) + "\n    return 0;\n}\n")
    subprocess.run(["cc", "-std=c99", "-I", source / "plugin/include", work / "layout.c", "-o", work / "layout"], check=True)
    return set(subprocess.run([work / "layout"], check=True, capture_output=True, text=True).stdout.splitlines())


def cs_layout(work, folder):
    """What a binding of the generated files in a folder lays out."""
    dll = compile_program(work, "Wadi", *sorted(folder.glob("*.cs")), source / "plugin/csharp/Wadi/Text.cs", library_file=True)
    program = compile_program(work, "Layout", here / "Layout.cs", references=[dll])
    done = mono(work, program)
    if done.returncode != 0:
        sys.exit(f"Layout.cs: {done.stdout}{done.stderr}")
    return set(done.stdout.splitlines())


def spoil(api, name):
    """A header's description with one fault, and the beginning of a line that must give it away."""
    structs, calls = {s["name"]: s for s in api["structs"]}, {f["name"]: f for f in api["functions"]}
    if name == "field of another type":
        next(f for f in structs["wadi_edit"]["fields"] if f["name"] == "capsule")["type"] = "uint64_t"
        return "struct Edit"
    if name == "last field of another type, in a size that stays":
        next(f for f in structs["wadi_edit"]["fields"] if f["name"] == "stamp")["type"] = "uint64_t"
        return "field Edit.Stamp"
    if name == "fields in another order":
        structs["wadi_frame"]["fields"][3:5] = structs["wadi_frame"]["fields"][4:2:-1]
        return "field Frame.Time"
    if name == "field that is missing":
        del structs["wadi_tile"]["fields"][2]
        return "field Tile.Nx"
    if name == "text of another length":
        structs["wadi_world_info"]["fields"][1]["count"] = 60
        return "field WorldInfo.name"
    if name == "another number":
        next(e for e in api["enums"] if e["name"] == "wadi_layer")["values"]["WADI_LAYER_SAND"] = 7
        return "number Layer.Sand"
    if name == "argument of another type":
        calls["wadi_world_update"]["arguments"][1]["type"] = "uint32_t"
        return "call wadi_world_update"
    raise ValueError(name)


def layout(work):
    api = json.loads((source / "plugin/wadi_api.json").read_text(encoding="utf-8"))
    for part in ("functions", "structs"):  # wadi_vulkan.h has no binding
        api[part] = [entry for entry in api[part] if entry.get("header") != "wadi_vulkan.h"]
    expected, generated = c_layout(work, api), work / "generated"
    generated.mkdir()
    for name in ("Enums.cs", "Structs.cs", "Native.cs"):
        shutil.copy(source / "plugin/csharp/Wadi" / name, generated)
    found = cs_layout(work, generated)
    for text in sorted(expected ^ found):
        fail(f"layout: {'C' if text in expected else 'C#'} alone says: {text}")
    counted = {kind: sum(t.startswith(kind) for t in found) for kind in ("struct", "field", "number", "call")}
    if counted["struct"] != len(api["structs"]) or counted["call"] != len(api["functions"]) + len(api["callbacks"]):
        fail(f"layout: not all was compared: {counted}")
    # Negative controls.
    faults = ("field of another type", "last field of another type, in a size that stays", "fields in another order", "field that is missing", "text of another length",
              "another number", "argument of another type")
    for fault in faults:
        spoilt = json.loads(json.dumps(api))
        sign = spoil(spoilt, fault)
        for name, text in write_csharp.files(spoilt):
            (generated / name).write_text(text, encoding="utf-8")
        if not any(text.startswith(sign) for text in expected - cs_layout(work, generated)):
            fail(f"layout: a binding with a {fault} is not found")
    print(f"layout: {', '.join(f'{n} {kind}s' for kind, n in counted.items())} as the C compiler says; {len(faults)} faults found")


def session(work, dll):
    level = source / "samples/levels/castle/level.json"
    subprocess.run(["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-I", source / "plugin/include", here / "session.c", "-o", work / "session", library,
                    f"-Wl,-rpath,{library.parent}"], check=True)
    c = subprocess.run([work / "session", level, work / "c.snapshot"], capture_output=True, text=True)
    cs = mono(work, compile_program(work, "Session", here / "Session.cs", references=[dll]), level, work / "cs.snapshot")
    if c.returncode != 0 or cs.returncode != 0:
        return fail(f"session: C: {c.stderr}C#: {cs.stderr}")
    lines = dict(zip(c.stdout.splitlines(), cs.stdout.splitlines()))
    for ours, theirs in lines.items():
        if ours != theirs:
            fail(f"session: C says \"{ours}\", C# \"{theirs}\"")
    if c.stdout != cs.stdout or len(lines) < 30 or (work / "c.snapshot").read_bytes() != (work / "cs.snapshot").read_bytes():
        fail("session: lines or snapshots differ")
    hashes = dict(line.split(" ", 1) for line in c.stdout.splitlines())
    if hashes["after"] != hashes["again"] or hashes["played"] == hashes["back"] or hashes["hash"] == hashes["after"]:
        fail(f"session: hashes that must be equal or differ: {hashes}")
    print(f"session: {len(lines)} lines as a C host's, hash {hashes['hash']}")


def ends_well(name, done):
    text = (done.stdout + done.stderr).strip()
    if done.returncode != 0:
        fail(f"{name}: exit status {done.returncode}: {text}")
    else:
        print(f"{name}: {text}")


def behaviour(work, dll):
    hand_written = [path for path in binding if path.name not in ("Enums.cs", "Structs.cs", "Native.cs")]
    ends_well("behaviour", mono(work, compile_program(work, "Behaviour", here / "Behaviour.cs", references=[dll]), work, *hand_written))


def collector(work, dll):
    program = compile_program(work, "CollectorStress", here / "CollectorStress.cs", references=[dll])
    ends_well("collector", mono(work, program))
    forgotten = mono(work, program, "forgotten") # a delegate that nobody keeps: the control
    if forgotten.returncode in (0, 3):
        fail(f"collector: the control ended with {forgotten.returncode}: {forgotten.stdout}")


def missing(work, dll):
    done = mono(work, compile_program(work, "MissingLibrary", here / "MissingLibrary.cs", references=[dll]), with_library=False)
    lines = done.stdout.splitlines()
    if len(lines) != 3 or not all(line.startswith("DllNotFoundException: Wadi's library was not found. libwadi.so") for line in lines):
        fail(f"missing: {done.stdout}{done.stderr}")
    (work / "empty/libwadi.so").symlink_to(next(p for p in map(pathlib.Path, ("/lib/x86_64-linux-gnu/libm.so.6", "/lib64/libm.so.6", "/usr/lib/libm.so.6")) if p.exists()))
    other = mono(work, work / "MissingLibrary.exe", with_library=False).stdout.splitlines()
    if len(other) != 3 or not all("is not Wadi's" in line for line in other):
        fail(f"missing: another library of that name: {other}")
    print(f"missing: {lines[0] if lines else 'nothing'}")


def readme(work, dll):
    """The page's example compiles and prints an elevation."""
    text = (source / "plugin/csharp/README.md").read_text(encoding="utf-8")
    example = text.split("```cs\n")[1].split("```")[0]
    (work / "Example.cs").write_text("using System;\nusing Wadi;\nstatic class Example\n{\n    static void Main()\n    {\n" + example.replace("world.Update(16666667)", "Updated(world)")
                                     + "    }\n    static Frame Updated(World world)\n    {\n        HostOutput surface;\n        Frame frame;\n        do frame = world.Update(16666667);\n"
                                     "        while (!world.TryGetHostOutput(Output.FreeSurface, out surface));\n        return frame;\n    }\n}\n")
    program = compile_program(work, "Example", work / "Example.cs", references=[dll])
    (work / "canyon").symlink_to(source / "samples/levels/canyon")
    done = mono(work, program)
    if done.returncode != 0 or not re.fullmatch(r"[1-9][\d.]* m at [\d.]+ s\n\d{4,} cells\n", done.stdout):
        fail(f"readme: {done.stdout}{done.stderr}")
    else:
        print(f"readme: the example says {', '.join(done.stdout.splitlines())}")


def unity(work, _):
    checks.scripts(work, checks.laid_out(work, library), compile_program, mono, ends_well)


def unity_package(work, _):
    checks.package(work, library, fail)


def unity_shaders(work, _):
    checks.shaders(work, fail)


def main():
    absent = [name for name in ("mcs", "mono", "cc", "glslangValidator") if shutil.which(name) is None]
    if absent:
        print(f"skipped: no {', '.join(absent)} here (packages mono-mcs, mono-runtime, gcc, glslang-tools)")
        return 77
    parts = {"session": session, "behaviour": behaviour, "collector": collector, "missing": missing, "unity": unity, "unity_package": unity_package, "unity_shaders": unity_shaders, "readme": readme}
    wanted = sys.argv[3:] or ["layout", *parts]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "library").mkdir()
        (work / "empty").mkdir()
        if library.suffix == ".tgz":
            print(f"{library.name}: {checks.contents(library, fail)} files")
            package, own = checks.unpacked(work, library)
            (work / "library/libwadi.so").symlink_to(own)
            checks.scripts(work, package, compile_program, mono, ends_well)
            return 1 if failures else 0
        (work / "library/libwadi.so").symlink_to(library)
        if "layout" in wanted:
            layout(work)
        dll = compile_program(work, "Wadi", *binding, library_file=True)
        for name in wanted:
            if name != "layout":
                parts[name](work, dll)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
