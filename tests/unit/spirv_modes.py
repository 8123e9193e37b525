#!/usr/bin/env python3
"""Every SPIR-V module of a build keeps drivers from fast math: each float operation is decorated NoContraction, and each entry point
asks for SignedZeroInfNanPreserve of 32 bits. Modules that lack a piece of that must be refused.

usage: spirv_modes.py BUILD_FOLDER SOURCE_FOLDER"""
import pathlib
import struct
import sys

CAPABILITY, EXTENSION, ENTRY, MODE, DECORATE = 17, 10, 15, 16, 71
PRESERVE_CAPABILITY, PRESERVE_MODE, NO_CONTRACTION = 4466, 4461, 42
# OpFNegate, OpFAdd, OpFSub, OpFMul, OpFDiv, OpFRem, OpFMod, products of vectors and matrices, OpDot
ARITHMETIC = {127, 129, 131, 133, 136, *range(140, 149)}


def instructions(path):
    words = struct.unpack(f"<{path.stat().st_size // 4}I", path.read_bytes())
    at, found = 5, []
    while at < len(words):
        found.append((words[at] & 0xFFFF, words[at + 1 : at + (words[at] >> 16)]))
        at += words[at] >> 16
    return found


def lacks(module):
    """What of all that a module lacks; nothing where it is as it must be."""
    entries = {operands[1] for op, operands in module if op == ENTRY}
    asking = {operands[0] for op, operands in module if op == MODE and operands[1:] == (PRESERVE_MODE, 32)}
    decorated = {operands[0] for op, operands in module if op == DECORATE and operands[1] == NO_CONTRACTION}
    bare = [operands[1] for op, operands in module if op in ARITHMETIC and operands[1] not in decorated]
    texts = [struct.pack(f"<{len(operands)}I", *operands).rstrip(b"\0") for op, operands in module if op == EXTENSION]
    found = []
    if not entries or asking != entries:
        found.append("mode")
    if (CAPABILITY, (PRESERVE_CAPABILITY,)) not in module:
        found.append("capability")
    if b"SPV_KHR_float_controls" not in texts:
        found.append("extension")
    if bare:
        found.append(f"decoration of {len(bare)} operations")
    return found


def main():
    build, source = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    names = sorted(path.stem for kind in ("stages/*/*.stage", "fused/*.fused") for path in (source / "shaders").glob(kind))
    paths = [build / "generated" / f"{name}.spv" for name in names] + [build / "backends/vulkan/self_test.spv"]
    failures, operations = [], 0
    for path in paths:
        module = instructions(path)
        operations += sum(op in ARITHMETIC for op, _ in module)
        if missing := lacks(module):
            failures.append(f"{path.name} lacks {', '.join(missing)}")

    # As glslang writes it, and good ones less one instruction.
    good = instructions(paths[-1])
    controls = {"all": (instructions(paths[-1].with_suffix(".raw.spv")), 4)}
    for what, op, second in (("mode", MODE, PRESERVE_MODE), ("capability", CAPABILITY, None), ("extension", EXTENSION, None), ("decoration", DECORATE, NO_CONTRACTION)):
        at = max(n for n, (kind, operands) in enumerate(good) if kind == op and second in (None, *operands[1:2]))
        controls[what] = good[:at] + good[at + 1 :], 1
    for what, (module, count) in controls.items():
        found = lacks(module)
        if len(found) != count or (count == 1 and not found[0].startswith(what)):
            failures.append(f"a module without {what} is said to lack {', '.join(found) or 'nothing'}")

    for failure in failures:
        print(f"FAIL {failure}")
    print(f"spirv_modes: {len(paths)} modules, {operations} float operations, {len(failures)} failed")
    return 1 if failures or not operations else 0


sys.exit(main())
