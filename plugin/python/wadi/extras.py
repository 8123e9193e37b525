"""Packages that are only needed for some things."""
import importlib

from ._library import Error


class MissingExtraError(Error, ImportError):
    """A package is not installed; the message names the extra that brings it."""


def need(module, extra, what):
    """The module, or MissingExtraError that says what to install."""
    try:
        return importlib.import_module(module)
    except ImportError as failed:
        raise MissingExtraError(f'{what} needs {module.partition(".")[0]} ({failed}): pip install "wadi[{extra}]"') from None
