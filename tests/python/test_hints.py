"""Type hints: every public name of the package has them, and type checkers can see them."""
import ast
import inspect
import pathlib

import numpy as np
import wadi

package = pathlib.Path(wadi.__file__).parent


def of_package(value):
    return str(getattr(value, "__module__", "")).split(".")[0] in ("wadi", __name__)


def public(name):
    return not name.startswith("_") or name.startswith("__")


def lacks_of_function(function, name, bound):
    signature = inspect.signature(function)
    takes = list(signature.parameters.values())[bound:]
    lacks = [f"{name}({given.name})" for given in takes if given.annotation is given.empty]
    return lacks + ([f"{name} ->"] if signature.return_annotation is signature.empty else [])


def hinted(kind):
    return {name for base in kind.__mro__ if of_package(base) for name in getattr(base, "__annotations__", {})}


def lacks_of_class(kind):
    lacks, fields = [], hinted(kind)
    for base in filter(of_package, kind.__mro__):
        for name, value in vars(base).items():
            what = f"{kind.__name__}.{name}"
            if isinstance(value, property):
                value = value.fget
            bound = not isinstance(value, staticmethod)
            value = getattr(value, "__func__", value)
            if not public(name):
                continue
            if inspect.isfunction(value):
                lacks += lacks_of_function(value, what, bound) if of_package(value) else []
            elif not name.startswith("__") and not isinstance(value, base) and name not in fields:
                lacks.append(what)
    return lacks


def lacks_of(value, name):
    if inspect.isclass(value):
        return lacks_of_class(value)
    return lacks_of_function(value, name, 0) if inspect.isfunction(value) else []


def lacks_of_text(file):
    """Values at the top of a file that are given without a type."""
    lines = ast.parse(file.read_text(encoding="utf-8")).body
    targets = [target for line in lines if isinstance(line, ast.Assign) for target in line.targets]
    names = [node.id for target in targets for node in ast.walk(target) if isinstance(node, ast.Name)]
    return [f"{file.name}: {name}" for name in names if not name.startswith("_")]


def test_every_public_name_has_a_type():
    lacks, seen = [], 0
    for name in wadi.__all__:
        value = getattr(wadi, name)
        if inspect.ismodule(value):
            lacks += lacks_of_text(pathlib.Path(value.__file__))
            inside = {f"{name}.{own}": found for own, found in vars(value).items() if not own.startswith("_") and of_package(found)}
        else:
            inside = {name: value}
        seen += len(inside)
        for own, found in inside.items():
            lacks += lacks_of(found, own)
    assert seen > 100
    assert not lacks


def test_attributes_of_objects_have_a_type():
    with wadi.World(water=np.ones((8, 8)), dx=1, backend="cpu", log=False) as world:
        world.set_outputs("flow")
        world.publish()
        objects = [world, world.view("flow"), world.record(0, 1), wadi.HeightMap(np.zeros((2, 2), np.float32), 1.0, (0.0, 0.0), None)]
        assert not [f"{type(one).__name__}.{name}" for one in objects for name in vars(one)
                    if not name.startswith("_") and name not in hinted(type(one))]


def test_type_checkers_see_the_package():
    """PEP 561: py.typed, and names of the package as "X as X"."""
    assert (package / "py.typed").is_file()
    lines = ast.parse((package / "__init__.py").read_text(encoding="utf-8")).body
    assert not [alias.name for line in lines if isinstance(line, ast.ImportFrom) for alias in line.names if alias.asname != alias.name]


class Lacking:
    known: int = 1
    unknown = 2

    def method(self, given: int, other) -> int: ...

    @property
    def value(self): ...

    @staticmethod
    def alone(given): ...


def test_what_lacks_a_type_is_named(tmp_path):
    assert lacks_of_class(Lacking) == ["Lacking.unknown", "Lacking.method(other)", "Lacking.value ->", "Lacking.alone(given)",
                                       "Lacking.alone ->"]
    assert lacks_of(public, "public") == ["public(name)", "public ->"]
    file = tmp_path / "values.py"
    file.write_text("known: int = 1\n_own = 2\nlow, high = 3, 4\n")
    assert lacks_of_text(file) == ["values.py: low", "values.py: high"]
