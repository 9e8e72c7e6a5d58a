"""What is in a trace."""

from __future__ import annotations

from os import PathLike, fspath
from typing import Any, Union

from . import _command


def look(*files: Union[str, PathLike[str]]) -> list[dict[str, Any]]:
    """Layout, channels, rates, gaps, noise and delays of traces, as `hyde look --json` prints them.

    >>> look("examples/new_axis/strokes.csv")[0]["channels"][0]["name"]
    'Sollposition'
    """
    answer = _command.json_of(["look", *(fspath(file) for file in files)])
    found: list[dict[str, Any]] = answer["files"]
    return found
