"""Structs of the C interface as Python sees them: texts are str, flags bool, short arrays tuples, enums members of their enum."""
from __future__ import annotations

import operator
from collections.abc import Iterable
from ctypes import Structure, sizeof
from enum import IntEnum
from typing import Any, ClassVar, Generic, SupportsIndex, TypeVar, overload

Kind = TypeVar("Kind", bound=IntEnum)


class Text:
    """A text of the library, UTF-8. None where there is none."""

    def __init__(self, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, instance: None, owner: type | None = None) -> Text: ...

    @overload
    def __get__(self, instance: Struct, owner: type | None = None) -> str | Any: ...

    def __get__(self, instance: Struct | None, owner: type | None = None) -> Any:
        if instance is None:
            return self
        value = getattr(instance, self.name)
        return None if value is None else value.decode("utf-8", "replace")

    def __set__(self, instance: Struct, value: str | None) -> None:
        data = None if value is None else str(value).encode("utf-8")
        if data is not None and b"\0" in data:
            raise ValueError(f"{self.name[1:]}: a text may hold no zero character")
        setattr(instance, self.name, data)


class Flag:
    """0 or 1."""

    def __init__(self, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, instance: None, owner: type | None = None) -> Flag: ...

    @overload
    def __get__(self, instance: Struct, owner: type | None = None) -> bool: ...

    def __get__(self, instance: Struct | None, owner: type | None = None) -> Any:
        return self if instance is None else bool(getattr(instance, self.name))

    def __set__(self, instance: Struct, value: object) -> None:
        setattr(instance, self.name, 1 if value else 0)


class Whole:
    """A whole number; one that the C type cannot hold is a ValueError."""

    least: int
    most: int

    def __init__(self, name: str, kind: type[Any]) -> None:
        bits = 8 * sizeof(kind)
        self.name = name
        self.least, self.most = (0, 2**bits - 1) if kind(-1).value > 0 else (-2**(bits - 1), 2**(bits - 1) - 1)

    @overload
    def __get__(self, instance: None, owner: type | None = None) -> Whole: ...

    @overload
    def __get__(self, instance: Struct, owner: type | None = None) -> int: ...

    def __get__(self, instance: Struct | None, owner: type | None = None) -> Any:
        return self if instance is None else getattr(instance, self.name)

    def __set__(self, instance: Struct, value: SupportsIndex) -> None:
        setattr(instance, self.name, whole(value, self.name[1:], self.least, self.most))


class Member(Generic[Kind]):
    """A member of an enum; its name in lower case is taken, too."""

    name: str
    enum: type[Kind]

    def __init__(self, name: str, enum: type[Kind]) -> None:
        self.name, self.enum = name, enum

    @overload
    def __get__(self, instance: None, owner: type | None = None) -> Member[Kind]: ...

    @overload
    def __get__(self, instance: Struct, owner: type | None = None) -> Kind: ...

    def __get__(self, instance: Struct | None, owner: type | None = None) -> Any:
        return self if instance is None else self.enum(getattr(instance, self.name))

    def __set__(self, instance: Struct, value: Kind | int | str) -> None:
        setattr(instance, self.name, member(self.enum, value, self.name[1:]))


class Row:
    """A few numbers, as a tuple."""

    def __init__(self, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, instance: None, owner: type | None = None) -> Row: ...

    @overload
    def __get__(self, instance: Struct, owner: type | None = None) -> tuple[float, ...]: ...

    def __get__(self, instance: Struct | None, owner: type | None = None) -> Any:
        return self if instance is None else tuple(getattr(instance, self.name))

    def __set__(self, instance: Struct, value: Iterable[float]) -> None:
        numbers, room = tuple(value), len(getattr(instance, self.name))
        if len(numbers) != room:
            raise ValueError(f"{self.name[1:]}: {len(numbers)} numbers, must be {room}")
        setattr(instance, self.name, numbers)


def whole(value: SupportsIndex, what: str, least: int, most: int) -> int:
    """`value` as int; TypeError where it is none, ValueError that names `what` and the range where it is outside."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{what}: {value!r} is no whole number") from None
    if not least <= number <= most:
        raise ValueError(f"{what}: {number}, must be {least} ... {most}")
    return number


def member(enum: type[Kind], value: Kind | int | str, what: str) -> Kind:
    """A member of `enum` by itself, its number or its name ("water_depth"); ValueError that names `what` and the choices."""
    if isinstance(value, str):
        found = enum.__members__.get(value.upper())
        if found is not None:
            return found
    else:
        try:
            return enum(value)
        except ValueError:
            pass
    choices = ", ".join(name.lower() for name in enum.__members__ if name != "COUNT")
    raise ValueError(f"{what}: there is no {value!r}; there are {choices}")


class Struct(Structure):
    """A struct with the header's defaults. Fields by keyword; another name is a TypeError."""

    _defaults_: ClassVar[dict[str, Any]] = {}

    def __init__(self, **fields: Any) -> None:
        super().__init__()
        if hasattr(type(self), "struct_size"):
            self.struct_size: int = sizeof(self)
        for name, value in {**self._defaults_, **fields}.items():
            if name not in self.names():
                raise TypeError(f"{type(self).__name__} has no field {name!r}; it has {', '.join(self.names())}")
            setattr(self, name, value)

    @classmethod
    def names(cls) -> list[str]:
        """Names of the fields, but for the struct's own size."""
        return [name[1:] if name.startswith("_") else name for name, _ in cls._fields_ if name != "struct_size"]  # type: ignore[misc]

    def as_dict(self) -> dict[str, Any]:
        """Fields by name; addresses are left out."""
        plain = ((name, getattr(self, name)) for name in self.names())
        return {name: value for name, value in plain if isinstance(value, (int, float, str, tuple))}

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self.as_dict().items())})"
