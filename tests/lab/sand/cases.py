"""The register of cases: a case measures one scene on one grid and returns rows."""
import dataclasses
import typing

import scene


@dataclasses.dataclass
class Case:
    name: str
    measure: typing.Callable  # (lab, dx) -> rows
    dx: tuple
    control: dict
    quick: tuple  # of dx, those that ctest runs


CASES = {}


def case(name, dx=(0.1, 0.05), control=None, quick=()):
    """Registers measure(lab, dx). `control`: settings with which at least one of its rows must miss its limit; by default the neutral
    values of all laws."""
    def register(measure):
        if name in CASES:
            raise ValueError(f"case {name} twice")
        CASES[name] = Case(name, measure, tuple(dx), scene.NEUTRAL if control is None else control, tuple(quick))
        return measure
    return register
