#!/usr/bin/env python3
"""Writes the viewer's compute shaders as fragment shaders of WebGL 2, so that the page has the viewer's look from the same lines.

Usage: shaders.py OUT.js. What a pass stores in images it writes to its targets; one that stores in images of different sizes becomes a
shader for each. The plugin's outputs are textures. prelude.glsl has what WebGL lacks."""
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
VIEWER = HERE.parent / "viewer" / "shaders"

# Name of the program: pass of the viewer, the images that it writes.
PROGRAMS = {
    "bake": ("bake", ["to_noise"]),
    "prepare": ("prepare", ["to_heights", "to_matter", "to_flow"]),
    "slopes": ("slopes", ["to_slopes"]),
    "base": ("slopes", ["to_pyramid"]),
    "reduce": ("reduce", ["levels"]),
    "summit": ("summit", ["to_summit"]),
    "light": ("light", ["to_light"]),
    "see": ("see", ["to_seen"]),
    "shade": ("shade", ["to_colour"]),
    "finish": ("finish", ["to_picture"]),
}
# Images that a pass reads, and the texture in place of each.
READ = {"seen_image": "seen_picture", "colours": "colour_picture", "levels": "pyramid"}


def expand(path, seen):
    """The text with what it includes, each file once."""
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines():
        include = re.match(r'#include "(.+)"', line)
        if include:
            name = include[1]
            if name not in seen:
                seen.add(name)
                lines += expand(VIEWER / name, seen)
        elif not re.match(r"#version|#extension", line):
            lines.append(line)
    return lines


def closing(text, at):
    """Where the bracket that opens at `at` is closed."""
    depth = 0
    for n in range(at, len(text)):
        depth += (text[n] in "([") - (text[n] in ")]")
        if depth == 0:
            return n
    raise ValueError("no closing bracket behind: " + text[at:at + 60])


def arguments(text):
    """The parts of a list between its outer commas."""
    parts, depth, begun = [], 0, 0
    for n, letter in enumerate(text):
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append(text[begun:n].strip())
            begun = n + 1
    return parts + [text[begun:].strip()]


def replace_calls(text, name, written):
    """Each `name(...)` by what `written` makes of its arguments."""
    at = 0
    while (found := re.search(r"\b" + name + r"\(", text[at:])) is not None:
        begin, bracket = at + found.start(), at + found.end() - 1
        end = closing(text, bracket)
        new = written(*arguments(text[bracket + 1:end]))
        text = text[:begin] + new + text[end + 1:]
        at = begin + 1
    return text


def replace_sources(text):
    """The plugin's outputs are textures: NAME[at(number, cell, floats)], behind it + 1 for the second float."""
    at = 0
    while (found := re.search(r"\b(\w+)\[at\(", text[at:])) is not None:
        begin, bracket = at + found.start(), at + found.end() - 1
        end = closing(text, bracket)
        cell = arguments(text[bracket + 1:end])[1]
        last = text.index("]", end)
        part = {"": "x", "+ 1": "y"}[text[end + 1:last].strip()]
        text = text[:begin] + f"texelFetch({found[1]}, {cell}, 0).{part}" + text[last + 1:]
        at = begin + 1
    return text


def translated(name):
    source, outputs = PROGRAMS[name]
    text = "\n".join(expand(VIEWER / (source + ".comp"), set()))
    text = re.sub(r"layout\(push_constant\) uniform \w+ \{ int level; \};", "", text)
    text = re.sub(r"layout\(local_size.*\n", "", text)
    text = re.sub(r"layout\(std430.*buffer \w+ \{ float (\w+)\[\]; \};", r"uniform sampler2D \1;", text)
    stored = re.findall(r"layout\(set = 0, binding = \d+, \w+\) ?(?:writeonly )?uniform image[23]D (\w+);", text)
    text = re.sub(r"layout\(set = 0, binding = \d+, \w+\).*uniform image[23]D \w+;\n", "", text)
    text = text.replace("layout(std140, set = 0, binding = 0)", "layout(std140)")
    text = re.sub(r"layout\(set = 0, binding = \d+\) uniform sampler", "uniform sampler", text)
    text = re.sub(r"int at\(int source.*\n", "", text)
    text = replace_sources(text)
    text = replace_calls(text, "imageStore", lambda image, place, value: f"{image} = {value}")
    text = replace_calls(text, "imageLoad", lambda image, place: f"texelFetch({READ[image]}, {place}, 0)" if image in READ else "vec4(0.0)")
    text = replace_calls(text, "imageSize", lambda image: "ivec3(64)" if image == "to_noise" else "picture_size")
    text = text.replace("textureGather(", "gathered(").replace("gl_GlobalInvocationID", "invocation()")
    text = re.sub(r"\bF\.view\b", "NO_VIEW", text)
    head = ["#version 300 es", "precision highp float;", "precision highp int;", "precision highp sampler2D;", "precision highp sampler3D;"]
    head += [f"layout(location = {n}) out vec4 {output};" for n, output in enumerate(outputs)]
    head += [f"vec4 {image};" for image in stored if image not in outputs and image not in READ]
    if name == "finish": # the picture's rows go upwards in WebGL
        head.append("#define ROWS_DOWN")
    text = (HERE / "prelude.glsl").read_text(encoding="utf-8") + text
    text = "\n".join(line.split("//")[0].rstrip() for line in text.splitlines())
    return "\n".join(head + [line for line in text.splitlines() if line.strip()]) + "\n"


def main():
    out = pathlib.Path(sys.argv[1])
    out.parent.mkdir(parents=True, exist_ok=True)
    texts = {name: translated(name) for name in PROGRAMS}
    out.write_text("// Written by samples/web/shaders.py.\nexport default " + json.dumps(texts, indent=0) + ";\n", encoding="utf-8")


if __name__ == "__main__":
    main()
