"""The Unity package: what lies in it, what its scene refers to, its shaders read by a compiler, its scripts over the stand-in."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

here = pathlib.Path(__file__).resolve().parent
root = here.parents[2]
sys.path.insert(0, str(root / "plugin/csharp/unity"))
import make_package

# How libraries of other systems begin, for a package of all of them.
BEGINNINGS = {"windows-x86_64": b"MZ".ljust(60, b"\0") + b"\x40\0\0\0PE\0\0\x64\x86", "macos-arm64": b"\xcf\xfa\xed\xfe\x0c\0\0\x01",
              "macos-x86_64": b"\xcf\xfa\xed\xfe\x07\0\0\x01", "linux-aarch64": b"\x7fELF".ljust(18, b"\0") + b"\xb7\0"}
SOURCES = {".cs": "MonoImporter", ".shader": "ShaderImporter", ".hlsl": "ShaderIncludeImporter", ".mat": "NativeFormatImporter", ".bytes": "TextScriptImporter"}


def run(*arguments):
    return subprocess.run([sys.executable, root / "plugin/csharp/unity/make_package.py", *map(str, arguments)], capture_output=True, text=True)


def small_library(work, library):
    """The beginning of the library: for what looks at names and .meta files alone."""
    small = work / "small.so"
    small.write_bytes(library.read_bytes()[:4096])
    return small


def package(work, library, fail):
    """Layout, .meta files and archive of a package with all libraries; what stops it."""
    options, notices = {"linux-x86_64": small_library(work, library)}, work / "notices.md"
    notices.write_text("# Texts\n")
    for name, begin in BEGINNINGS.items():
        options[name] = work / name
        options[name].write_bytes(begin)
    given = [word for name, path in options.items() for word in (f"--{name}", path)] + ["--notices", notices]
    archives = []
    for attempt in ("first", "second"):
        done = run(*given, "--archive", work / attempt, work / f"{attempt} package")
        if done.returncode != 0:
            return fail(f"package: {done.stderr}")
        archives += (work / attempt).glob("*.tgz")
    version = json.loads((root / "plugin/csharp/unity/package.json").read_text())["version"]
    if [a.name for a in archives] != [f"com.wadi.terrain-{version}.tgz"] * 2 or archives[0].read_bytes() != archives[1].read_bytes():
        fail("package: two archives of the same input differ")
    count = contents(archives[0], fail)
    stopped(work, options, notices, version, fail)
    print(f"package: {count} files, {archives[0].stat().st_size / 1e3:.0f} kB with libraries cut off, twice the same")


def contents(archive, fail):
    """What lies in an archive with all libraries, with controls; the number of its files."""
    with tarfile.open(archive) as tar:
        members = tar.getmembers()
        names = [m.name.removeprefix("package/") for m in members]
        texts = {name: tar.extractfile("package/" + name).read().decode(errors="replace") for name in names}
    if not all(m.name.startswith("package/") and m.isfile() and m.mode == 0o644 and m.mtime == make_package.WHEN and m.uid == 0 and not m.uname for m in members) or names != sorted(names):
        fail("package: the archive is not as npm packs it, or not sorted")
    for name in ("package.json", "README.md", "CHANGELOG.md", "LICENSE.md", "Third Party Notices.md", "Documentation~/Wadi.md", "Samples~/Castle/Castle.unity", "Runtime/Wadi.asmdef",
                 "Shaders/WadiGround.shader", "Runtime/Plugins/Linux/x86_64/libwadi.so", "Runtime/Plugins/Linux/arm64/libwadi.so", "Runtime/Plugins/Windows/x86_64/libwadi.dll",
                 "Runtime/Plugins/macOS/arm64/libwadi.dylib", "Runtime/Plugins/macOS/x86_64/libwadi.dylib"):
        if name not in names:
            fail(f"package: no {name}")
    for text in (texts["README.md"][:200], json.loads(texts["package.json"])["description"]):
        if "Compiled against a stand-in" not in text.replace("is compiled", "Compiled"):
            fail(f"package: not said that it has not run: {text}")
    if "None has been chosen yet" not in texts["LICENSE.md"] or not texts["Third Party Notices.md"].strip():
        fail("package: it has no licence or no notices")
    for sample in json.loads(texts["package.json"])["samples"]:
        if not any(n.startswith(sample["path"] + "/") and n.endswith(".unity") for n in names):
            fail(f"package: no scene in {sample['path']}")
    metas(fail, names, texts)
    scene(fail, names, texts)
    # Each library is bound to one system and processor, no two to the same.
    bound = {}
    for name in (n for n in names if n.startswith("Runtime/Plugins/") and pathlib.PurePath(n).suffix in (".so", ".dll", ".dylib")):
        platforms = re.findall(r"  - first:\n      (.*?): (.*?)\n    second:\n      enabled: (\d)\n      settings:((?:\n        .*)*)", texts[name + ".meta"])
        on = {target: dict(re.findall(r"(\w+): (\w+)", settings)) for _, target, enabled, settings in platforms if enabled == "1"}
        for target, settings in on.items():
            bound.setdefault((target, settings["CPU"], settings.get("OS")), []).append(name)
    expected = {("Editor", "x86_64", "Linux"), ("Editor", "x86_64", "Windows"), ("Editor", "ARM64", "OSX"), ("Editor", "x86_64", "OSX"), ("Linux64", "x86_64", None),
                ("Win64", "x86_64", None), ("OSXUniversal", "ARM64", None), ("OSXUniversal", "x86_64", None), ("EmbeddedLinux", "ARM64", None)}
    if set(bound) != expected or any(len(libraries) != 1 for libraries in bound.values()):
        fail(f"package: libraries are bound to {bound}")
    return len(names)


def stopped(work, options, notices, version, fail):
    """What stops make_package.py, each time with a message and without a package."""

    def stops(text, *arguments):
        done = run(*arguments, work / "stopped")
        if done.returncode == 0 or not done.stderr.startswith("make_package.py: ") or text not in done.stderr or (work / "stopped").exists():
            fail(f"package: {text} does not stop it: {done.stderr}")

    for name, path in options.items():
        rest = [word for other, file in options.items() if other != name for word in (f"--{other}", file)] + ["--notices", notices]
        if name != make_package.OPTIONAL:
            stops(f"--{name} missing", *rest)
        stops("is not there", f"--{name}", work / "none", *rest)
        stops(f"{notices} is no library, not", f"--{name}", notices, *rest)
    stops("--notices missing", *(word for name, path in options.items() for word in (f"--{name}", path)))
    stops("is ELF 62, not Mach-O 16777228", "--partial", "--macos-arm64", options["linux-x86_64"])
    stops("without any library", "--partial")
    if run("--partial", "--linux-x86_64", options["linux-x86_64"], work).returncode == 0:
        fail("package: a folder that is no package is overwritten")
    copy = work / "copy"
    for folder in ("plugin/csharp", "samples/levels/castle"):
        shutil.copytree(root / folder, copy / folder)
    shutil.copy(root / "NOTICE.md", copy)
    shutil.copy(root / "CMakeLists.txt", copy)

    def in_copy():
        return subprocess.run([sys.executable, copy / "plugin/csharp/unity/make_package.py", "--partial", "--linux-x86_64", options["linux-x86_64"], work / "from copy"], capture_output=True, text=True)

    if in_copy().returncode != 0:
        fail("package: a copy of the sources makes none")
    for file, old, new, text in (("CMakeLists.txt", f"VERSION {version}", "VERSION 9.8.7", "CMakeLists.txt 9.8.7"), ("plugin/csharp/unity/CHANGELOG.md", f"[{version}]", "[0.0.1]", "no heading"),
                                 ("NOTICE.md", "## Licence of Wadi", "## Licences", "no section"),
                                 ("plugin/csharp/unity/Samples~/Castle/Castle.unity", "@Shaders/WadiWater.mat@", "@Shaders/None.mat@", "Shaders/None.mat is referred to")):
        kept = (copy / file).read_text()
        (copy / file).write_text(kept.replace(old, new))
        done = in_copy()
        if done.returncode == 0 or text not in done.stderr:
            fail(f"package: {file} with {new} does not stop it: {done.stderr}")
        (copy / file).write_text(kept)


def metas(fail, names, texts):
    """Each file and folder that Unity imports has one .meta file, with the importer of its kind and an id of its own."""
    folders = {str(parent) for name in names for parent in pathlib.PurePath(name).parents} - {"."}
    imported = {n for n in {*names, *folders} if not n.endswith(".meta") and ("~" not in n or n.startswith(make_package.CASTLE))}
    for name in sorted(imported ^ {n.removesuffix(".meta") for n in names if n.endswith(".meta")}):
        fail(f"package: {name} has no .meta file, or one for nothing")
    ids = re.findall(r"^guid: ([0-9a-f]{32})$", "\n".join(texts[n] for n in names if n.endswith(".meta")), re.M)
    if len(set(ids)) != len(imported):
        fail("package: ids are not one for each file")
    for name in imported & set(names):
        importer = SOURCES.get(pathlib.PurePath(name).suffix)
        if importer is not None and f"\n{importer}:\n" not in texts[name + ".meta"]:
            fail(f"package: {name} is not read by {importer}")


def scene(fail, names, texts):
    """What a scene or a material refers to is there: ids of files, of its own objects, fields of the scripts. With controls."""
    files = {re.search(r"^guid: (\w+)$", texts[n], re.M)[1]: n.removesuffix(".meta") for n in names if n.endswith(".meta")}
    own = "Samples~/Castle/Castle.unity"

    def breaches(text):
        found = []
        objects = set(re.findall(r"^--- !u!\d+ &(\d+)$", text, re.M))
        for identity, file in re.findall(r"\{fileID: (\d+)(?:, guid: (\w+), type: \d)?\}", text):
            if file and not re.fullmatch(r"0{16}[ef]0{15}", file) and file not in files:
                found.append(f"no file {file}")
            if not file and identity != "0" and identity not in objects:
                found.append(f"no object {identity}")
        for block in text.split("--- !u!114 ")[1:]:
            block = block.split("\n---")[0]
            script = files.get(re.search(r"m_Script: \{fileID: 11500000, guid: (\w+), type: 3\}", block)[1], "")
            source = texts.get(script, "")
            if f"class {pathlib.PurePath(script).stem} : MonoBehaviour" not in source:
                found.append(f"no component in {script}")
            for field in re.findall(r"^  (\w+):", block, re.M):
                if not field.startswith("m_") and not re.search(rf"^    (?:    )?public [\w\[\].]+ {field}( =.*)?;", source, re.M):
                    found.append(f"{script} has no field {field}")
        return found

    for name in names:
        if name.endswith((".unity", ".mat")):
            for text in breaches(texts[name]):
                fail(f"package: {name}: {text}")
    for old, new in (("  reach: 5", "  raech: 5"), ("{fileID: 401}", "{fileID: 499}"), (re.search(r"guid: (\w{32}), type: 2", texts[own])[1], "0123456789abcdef" * 2)):
        if old not in texts[own] or not breaches(texts[own].replace(old, new)):
            fail(f"package: {new} in the scene is not found")
    for component in ("Runtime/WadiTerrain.cs", "Runtime/WadiSurface.cs", "Runtime/WadiCollider.cs", "Samples~/Castle/Pour.cs"):
        if make_package.guid(component) not in texts[own]:
            fail(f"package: no {component} in the scene")
    for kind in (20, 108):
        if f"--- !u!{kind} &" not in texts[own]:
            fail(f"package: no camera or no light in the scene: class {kind}")


def read_shader(work, folder, shader):
    """What glslang's front end for HLSL says of each entry of each pass of a .shader file; "" of a good one."""
    text = (folder / shader).read_text()
    for number, source in enumerate(re.findall(r"HLSLPROGRAM\n(.*?)ENDHLSL", text, re.S)):
        file = work / f"{shader}.{number}.hlsl"
        file.write_text(source)
        for stage, word in (("vert", "vertex"), ("frag", "fragment")):
            entry = re.search(rf"#pragma {word} (\w+)", source)[1]
            done = subprocess.run(["glslangValidator", "-D", "-V", "-S", stage, "-e", entry, f"-I{here / 'shaders'}", f"-I{folder}", file, "-o", work / "shader.spv"], capture_output=True, text=True)
            yield f"{shader}: {entry}: {done.stdout}{done.stderr}" if done.returncode != 0 or "WARNING" in done.stdout else ""


def shaders(work, fail):
    folder, planted = root / "plugin/csharp/unity/Shaders", work / "planted"
    read = 0
    for shader in sorted(p.name for p in folder.glob("*.shader")):
        for said in read_shader(work, folder, shader):
            read += 1
            if said:
                fail(f"shaders: {said}")
        text = (folder / shader).read_text()
        declared = set(re.findall(r"^\s+(_\w+) \(\"", text, re.M))
        used = set().union(*(set(re.findall(r"\b_\w+", line)) for line in re.findall(r"^float4? (.*);$", (folder / shader.replace(".shader", ".hlsl")).read_text(), re.M)))
        if declared != used:
            fail(f"shaders: {shader}: properties and variables differ: {declared ^ used}")
    # Faults of each file and kind: a name, a type, an argument too few.
    for file, old, new in (("WadiWater.hlsl", "w.fresnel = 0.02", "w.fresnell = 0.02"), ("WadiGround.hlsl", "float2 dx = ddx(at)", "float2 dx = _WadiSand"), ("WadiFields.hlsl", "Weight(y, t.y);", "Weight(y);"),
                           ("WadiShadow.hlsl", "v.normal =", "v.normals ="), ("WadiLight.hlsl", "DecodeHDR(texel, ", "DecodeHDR("), ("WadiNoise.hlsl", "return h ^", "return f ^"), ("WadiDepth.hlsl", "vertex)", "vertix)")):
        shutil.rmtree(planted, ignore_errors=True)
        shutil.copytree(folder, planted)
        text = (planted / file).read_text()
        (planted / file).write_text(text.replace(old, new))
        if old not in text or not any(any(read_shader(work, planted, shader)) for shader in ("WadiWater.shader", "WadiGround.shader")):
            fail(f"shaders: {new} in {file} is not found")
    print(f"shaders: {read} entries read, 7 faults found")


def unpacked(work, archive):
    """The package in an archive, and its library for this system."""
    with tarfile.open(archive) as tar:
        tar.extractall(work / "archive")
    return work / "archive/package", work / "archive/package" / make_package.NATIVES["linux-x86_64"].path


def laid_out(work, library):
    made = work / "package"
    make_package.lay_out(made, {"linux-x86_64": small_library(work, library)}, None)
    return made


def scripts(work, made, compile_program, mono, ends_well):
    """A package's scripts, compiled and run over the stand-in."""
    stand_in = compile_program(work, "UnityEngine", here / "UnityEngineStub.cs", library_file=True)
    runtime = compile_program(work, "WadiUnity", *sorted((made / "Runtime").rglob("*.cs")), references=[stand_in], library_file=True)
    sample = compile_program(work, "Sample", *sorted((made / make_package.CASTLE).rglob("*.cs")), references=[stand_in, runtime], library_file=True)
    program = compile_program(work, "UnityHost", *(here / name for name in ("Host.cs", "Surface.cs", "Solid.cs", "Sample.cs")), references=[stand_in, runtime, sample])
    shutil.copytree(root / "samples/levels/castle", work / "StreamingAssets/castle")
    ends_well("unity", mono(work, program, work / "StreamingAssets", made / make_package.CASTLE))
