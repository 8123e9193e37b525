#!/usr/bin/env python3
"""Installs a built tree and uses it as hosts do: find_package, pkg-config, add_subdirectory, the zip.

Usage: consumers.py SOURCE_DIR BUILD_DIR"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

source, build = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
host = source / "samples/minimal_host/main.c"
consumer = source / "tests/packaging"


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(part) for part in command)}\n{done.stdout}\nexit status {done.returncode}")
    return done.stdout


def expect(held, demand):
    if not held:
        sys.exit(f"not so: {demand}")


def check_host(program, **options):
    text = run(program, **options)
    expect("hash" in text, f"{program} prints the state's hash; it printed {text}")


def dead_links(folder):
    """Links of the pages in a folder that lead to nothing there."""
    pages = sorted(folder.rglob("*.md"))
    found = []
    for page in pages:
        for target in re.findall(r"\]\(([^()\s]+)\)", page.read_text(encoding="utf-8")):
            name = target.partition("#")[0]
            if name and not re.match(r"[a-z]+:", name) and not (page.parent / name).exists():
                found.append(f"{page.relative_to(folder)}: {target}")
    return len(pages), found


def check_pages(folder):
    number, dead = dead_links(folder)
    expect(number > 10 and not dead, f"{number} installed pages have no dead links: {dead}")
    page = next(folder.rglob("NOTICE.md")).parent / "README.md"
    expect(page.read_text(encoding="utf-8").startswith("# The plugin\n"), f"{page} is the page it was")
    planted = folder / "planted.md"  # a control
    planted.write_text("[gone](gone.md) [there](planted.md)", encoding="utf-8")
    expect(dead_links(folder)[1] == ["planted.md: gone.md"], "a dead link is found")
    planted.unlink()


def check_installed(prefix):
    for path in prefix.rglob("*"):
        if path.suffix in (".cmake", ".pc"):
            text = path.read_text(encoding="utf-8")
            expect(str(build) not in text and str(source) not in text, f"{path.name} has no path of the build machine")
    library = next(prefix.rglob("libwadi.so"))
    dynamic = run("readelf", "-d", library)
    expect("RPATH" not in dynamic and "RUNPATH" not in dynamic, "the installed library looks nowhere of its own")
    needed = {line.split("[")[1].rstrip("]\n") for line in dynamic.splitlines() if "(NEEDED)" in line}
    allowed = ("libstdc++.", "libm.", "libgcc_s.", "libc.", "ld-linux", "libpthread.", "libdl.", "librt.")
    expect(all(name.startswith(allowed) for name in needed), f"only system libraries are needed, not {needed}")
    check_pages(prefix / "share")
    return library.parent


def cmake_consumer(folder, *options):
    run("cmake", "-S", consumer, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", f"-DMINIMAL_HOST={host}", *options)


def check_package(prefix, folder):
    run("cmake", "-S", prefix / "share/wadi/examples", "-B", folder / "example", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", folder / "example")
    check_host(folder / "example/minimal_host")
    cmake_consumer(folder, "-DWADI_AS=package", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", folder)
    check_host(folder / "consumer")
    run(folder / "header_cpp17")


def check_pkg_config(prefix, folder, libraries):
    if shutil.which("pkg-config") is None:
        print("pkg-config is not installed: not tried")
        return
    environment = dict(os.environ, PKG_CONFIG_PATH=str(libraries / "pkgconfig"), LD_LIBRARY_PATH=str(libraries))
    flags = run("pkg-config", "--cflags", "--libs", "wadi", env=environment).split()
    expect(any(str(prefix) in flag for flag in flags), f"pkg-config finds the moved prefix: {flags}")
    levels = pathlib.Path(run("pkg-config", "--variable=levelsdir", "wadi", env=environment).strip())
    expect((levels / "canyon/level.json").exists(), f"pkg-config's levelsdir {levels} has the levels")
    run("cc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", host, "-o", folder / "pkg", *flags)
    check_host(folder / "pkg", env=environment)


def check_first_page(folder, archive):
    """The steps of the site's first page; a page that shows another water is a control."""
    page, steps = source / "plugin/docs/hello.md", source / "plugin/packaging/first_steps.py"
    print(run(sys.executable, steps, page, archive), end="")
    other = folder / "other.md"
    other.write_text(page.read_text(encoding="utf-8").replace(" 6.0 s  |++", " 6.0 s  |+-"), encoding="utf-8")
    refused = subprocess.run([sys.executable, str(steps), str(other), str(archive)], capture_output=True, text=True)
    expect(refused.returncode == 1 and "came 0 times" in refused.stderr, "a page that shows what is not printed is found")


def check_zip(folder):
    run("cpack", "-G", "ZIP", "-B", folder, cwd=build)
    archive = zipfile.ZipFile(next(folder.glob("wadi-*.zip")))
    names = [name for name in archive.namelist() if not name.endswith("/")]
    tops = {name.split("/")[0] for name in names}
    expect(len(tops) == 1, f"the zip has one folder, not {tops}")
    inner = {name.split("/", 1)[1] for name in names}
    expect({name.split("/")[0] for name in inner} == {"plugin"}, "the zip holds plugin/ alone")
    expect({name.split("/")[1] for name in inner} == {"bin", "include", "lib", "levels", "examples", "cmake", "wadi_api.json", "README.md", "NOTICE.md", "THIRD_PARTY.txt"}, f"plugin/ holds {inner}")
    size = sum(file.compress_size for file in archive.infolist())
    expect(size < 10e6, f"the zip is below 10 MB; it has {size / 1e6:.1f}")
    headers = {f"plugin/include/wadi/{path.name}" for path in (source / "plugin/include/wadi").iterdir()}
    expect(headers <= inner, f"every header is in the zip: {headers - inner} is not")
    archive.extractall(folder / "engine")
    plugin = folder / "engine" / tops.pop() / "plugin"
    check_pages(plugin)
    library = next((plugin / "lib").iterdir())
    check_first_page(folder, pathlib.Path(archive.filename))
    texts = (plugin / "THIRD_PARTY.txt").read_text(encoding="utf-8")
    for part in ("volk", "Vulkan-Headers", "JSON for Modern C++", "stb_image", "Permission is hereby granted", "Apache License"):
        expect(part in texts, f"THIRD_PARTY.txt has {part}")
    run("cc", "-std=c99", host, "-o", folder / "zipped", "-I", plugin / "include", library)
    environment = dict(os.environ, LD_LIBRARY_PATH=str(library.parent))
    check_host(folder / "zipped", env=environment)
    run("cmake", "-S", plugin / "examples", "-B", folder / "example", "-G", "Ninja", f"-Dwadi_DIR={plugin / 'cmake'}")
    run("cmake", "--build", folder / "example")
    check_host(folder / "example/minimal_host")
    if shutil.which("pkg-config") is not None:
        flags = run("pkg-config", "--cflags", "--libs", "wadi", env=dict(os.environ, PKG_CONFIG_PATH=str(plugin / "cmake"))).split()
        run("cc", "-std=c99", host, "-o", folder / "zipped_pkg", *flags)
        check_host(folder / "zipped_pkg", env=environment)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    run("cmake", "--install", build, "--prefix", folder / "installed", "--component", "plugin")
    moved = folder / "moved"
    (folder / "installed").rename(moved)
    libraries = check_installed(moved)
    check_package(moved, folder / "package")
    check_pkg_config(moved, folder, libraries)
    cmake_consumer(folder / "source", "-DWADI_AS=source", f"-DWADI_SOURCE={source}", "-DWADI_BACKENDS=OFF")
    check_zip(folder)
print("find_package, pkg-config, add_subdirectory and the zip work")
