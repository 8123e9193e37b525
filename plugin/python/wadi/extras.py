"""Packages that are only needed for some things."""
from __future__ import annotations

import importlib
from typing import Any

from ._library import Error


class MissingExtraError(Error, ImportError):
    """A package is not installed; the message names the extra that brings it."""


def need(module: str, extra: str, what: str) -> Any:
    """The module, or MissingExtraError that says what to install."""
    try:
        return importlib.import_module(module)
    except ImportError as failed:
        raise MissingExtraError(f'{what} needs {module.partition(".")[0]} ({failed}): pip install "wadi[{extra}]"') from None
