"""Shared fixtures."""

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="session")
def scenes() -> Path:
    """The repository's scenes."""
    return ROOT / "scenes"
