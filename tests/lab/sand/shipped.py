"""The levels that come with the library, on grids of any fineness."""
import json
import pathlib
import re

from scene import override

LEVELS = pathlib.Path(__file__).parents[3] / "samples" / "levels"


def with_paths(value, folder):
    if isinstance(value, dict):
        return {key: folder / part if key == "file" else with_paths(part, folder) for key, part in value.items()}
    return [with_paths(part, folder) for part in value] if isinstance(value, list) else value


def flat(section, path=""):
    for key, value in section.items():
        if isinstance(value, dict):
            yield from flat(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value


def shipped(name, dx=None, variant=None):
    """A level as a dict, on cells of dx; its time step follows the cells."""
    folder = LEVELS / name
    text = (folder / "level.json").read_text()
    # Comments go, strings stay.
    scene = json.loads(re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda found: found[1] or "", text, flags=re.DOTALL))
    variants = scene.pop("variants", {})
    scene = with_paths({key: value for key, value in scene.items() if not key.startswith("$")}, folder)
    if variant:
        scene = override(scene, dict(flat(variants[variant])))
    cells = scene["grid"]
    factor = cells["dx"] / dx if dx else 1
    scene["dt"] /= factor
    scene["grid"] = {"nx": round(cells["nx"] * factor), "ny": round(cells["ny"] * factor), "dx": cells["dx"] / factor}
    return scene
