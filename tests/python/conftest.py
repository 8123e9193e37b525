import pathlib

import pytest


@pytest.fixture(scope="session")
def source():
    """The source tree."""
    return pathlib.Path(__file__).resolve().parents[2]
