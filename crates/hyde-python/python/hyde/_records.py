"""Records given as arrays or frames: written as a file that the reader takes like any other."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Union, cast

import numpy as np

from ._hyde import Error

Record = Union[str, "PathLike[str]", Mapping[str, Any], Any]


def written(record: Record, path: Path) -> str:
    """The path of a record; what is no path is written there, every number with all its digits."""
    if isinstance(record, (str, PathLike)):
        return fspath(record)
    columns = {str(name): np.asarray(record[name], dtype=float).ravel() for name in _names(record)}
    lengths = {len(values) for values in columns.values()}
    if len(lengths) != 1:
        raise Error(f"the columns of a record have one length, not {sorted(lengths)}")
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(columns)
        rows.writerows(zip(*([repr(float(value)) for value in values] for values in columns.values())))
    return str(path)


def _names(record: Any) -> list[str]:
    if isinstance(record, Mapping):
        return list(cast("Mapping[str, Any]", record))
    columns = getattr(record, "columns", None)
    if columns is None:
        raise Error("a record is a path, a mapping of names to arrays, or a frame")
    return list(columns)
