"""The generated part against the C compiler, what a missing library says, and what a call costs."""
import ctypes
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np
import pytest
import wadi
from wadi import _native


def compiled(source, folder, text=None, file=None, *link):
    program = folder / "program"
    if text is not None:
        file = folder / "program.c"
        file.write_text(text)
    subprocess.run(["cc", "-std=gnu99", "-O1", "-I", source / "plugin/include", file, "-o", program, *link], check=True)
    return subprocess.run([program], check=True, capture_output=True, text=True).stdout


def python_layout(native, api):
    lines = set()
    for struct in api["structs"]:
        kind = getattr(native, struct["name"].removeprefix("wadi_").title().replace("_", ""))
        lines.add(f"{struct['name']} {ctypes.sizeof(kind)}")
        for field, (name, _) in zip(struct["fields"], kind._fields_):
            member = getattr(kind, name)
            lines.add(f"{struct['name']}.{field['name']} {member.offset} {member.size}")
    for call in api["functions"]:
        returns, takes = native.CALLS[call["name"]]
        lines.add(" ".join([call["name"], *(str(0 if kind is None else ctypes.sizeof(kind)) for kind in [returns, *takes])]))
    for enum in api["enums"]:
        values = list(getattr(native, enum["name"].removeprefix("wadi_").title().replace("_", "")))
        lines |= {f"{name} {int(value)}" for name, value in zip(enum["values"], values)}
    return lines


@pytest.fixture(scope="module")
def api(source):
    api = json.loads((source / "plugin/wadi_api.json").read_text())
    for part in ("functions", "structs"):
        api[part] = [entry for entry in api[part] if entry.get("header") != "wadi_vulkan.h"]
    return api


@pytest.fixture(scope="module")
def c_layout(source, api, tmp_path_factory):
    lines = []

    def line(text, *values):
        lines.append(f'printf("{text}{" %ld" * len(values)}\\n"{"".join(f", (long)({value})" for value in values)});')

    for struct in api["structs"]:
        line(struct["name"], f"sizeof({struct['name']})")
        for field in struct["fields"]:
            line(f"{struct['name']}.{field['name']}", f"offsetof({struct['name']}, {field['name']})", f"sizeof((({struct['name']}*)0)->{field['name']})")
    for call in api["functions"]:
        line(call["name"], *("0" if kind == "void" else f"sizeof({kind})" for kind in [call["returns"], *(a["type"] for a in call["arguments"])]))
    for enum in api["enums"]:
        for value in enum["values"]:
            line(value, value)
    text = "#include <stddef.h>\n#include <stdio.h>\n#include <wadi/wadi_cuda.h>\nint main(void) {\n" + "\n".join(lines) + "\nreturn 0; }\n"
    return set(compiled(source, tmp_path_factory.mktemp("layout"), text).splitlines())


def test_layout_is_that_of_the_c_compiler(api, c_layout):
    assert python_layout(_native, api) == c_layout
    assert len(c_layout) > 400


@pytest.mark.parametrize("old, new, sign", [
    ('("softness", c_double)', '("softness", c_float)', "wadi_edit.softness"),
    ('"wadi_world_step": (c_int32, [WorldId, c_uint32])', '"wadi_world_step": (c_int32, [WorldId, c_uint64])', "wadi_world_step"),
    ("SATURATION = 5", "SATURATION = 6", "WADI_OUTPUT_SATURATION"),
    ('("_name", c_char * 64)', '("_name", c_char * 60)', "wadi_world_info.name")])
def test_layout_with_a_fault_is_found(api, c_layout, source, old, new, sign):
    text = (source / "plugin/python/wadi/_native.py").read_text()
    assert old in text
    import types

    spoilt = types.ModuleType("wadi._spoilt")
    spoilt.__package__ = "wadi"
    exec(text.replace(old, new), spoilt.__dict__)
    assert any(line.startswith(sign) for line in c_layout - python_layout(spoilt, api))


def test_header_defaults_and_names():
    edit = wadi.Edit(kind="push", layer="sand", step=np.int64(7))
    assert (edit.kind, edit.layer, edit.step, edit.radius, edit.softness) == (wadi.EditKind.PUSH, wadi.Layer.SAND, 7, 1.0, 0.5)
    assert edit.struct_size == ctypes.sizeof(edit)
    with pytest.raises(TypeError, match="Edit has no field 'radios'; it has kind,"):
        wadi.Edit(radios=1)
    with pytest.raises(ValueError, match="step: -1, must be 0"):
        wadi.Edit(step=-1)
    with pytest.raises(ValueError, match="layer: there is no 'mud'; there are terrain, sand, water"):
        wadi.Edit(layer="mud")
    with pytest.raises(ValueError, match="position: 2 numbers, must be 3"):
        wadi.Body(position=(1, 2))


@pytest.mark.parametrize("library, text", [(None, "name a built libwadi.so in the environment variable WADI_LIBRARY"), ("/nowhere/libwadi.so", "WADI_LIBRARY names it")])
def test_missing_library(library, text):
    environment = {key: value for key, value in os.environ.items() if key != "WADI_LIBRARY"}
    if library:
        environment["WADI_LIBRARY"] = library
    elif (pathlib.Path(wadi.__file__).parent / "lib").exists():
        pytest.skip("this package carries its library")
    done = subprocess.run([sys.executable, "-c", "import wadi"], env=environment, capture_output=True, text=True)
    assert done.returncode == 1 and "ImportError: wadi: there is no library" in done.stderr and text in done.stderr


def call_cost(call, calls):
    """Microseconds of the calling thread's processor per call, of some rounds the least: other programs' work is not in it."""
    least = 1e9
    for _ in range(10):
        begun = time.thread_time()
        for _ in range(calls):
            call()
        least = min(least, (time.thread_time() - begun) / calls * 1e6)
    return least


def test_overhead_of_a_step_is_below_20_us(source, tmp_path):
    library = pathlib.Path(os.environ["WADI_LIBRARY"])
    c = float(compiled(source, tmp_path, None, pathlib.Path(__file__).with_name("loop.c"), library, f"-Wl,-rpath,{library.parent}"))
    with wadi.World(water=np.zeros((4, 4)), dx=1, dt=0.01, backend="cpu") as world:
        python = call_cost(world.step, 2000)
        empty = call_cost(lambda: world.step(0), 10000)
    print(f"a step of 4 x 4 cells: {c:.2f} us from C, {python:.2f} us from Python; a call without a step {empty:.2f} us")
    assert python - c < 20 and empty < 20
