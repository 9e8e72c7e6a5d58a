"""The compiled module below the package."""

from os import PathLike
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

VERSION: str

class Error(Exception):
    diagnostics: list[dict[str, Any]]

class ModelError(Error): ...
class SolverError(Error): ...

class Model:
    name: str
    experiment: Optional[str]
    warnings: str
    assumptions: list[str]
    fmus: list[str]
    def __init__(
        self,
        file: Union[str, PathLike[str]],
        experiment: Optional[str] = None,
        model: Optional[str] = None,
        numbers: list[tuple[str, float]] = ...,
        texts: list[str] = ...,
        records: list[tuple[str, Union[str, PathLike[str]]]] = ...,
        data: Optional[Union[str, PathLike[str]]] = None,
    ) -> None: ...
    def parameters(self) -> list[tuple[str, list[float], str, str, Optional[float], Optional[str], bool]]: ...
    def run(
        self,
        numbers: list[tuple[str, float]] = ...,
        texts: list[str] = ...,
        stop: Optional[float] = None,
        rtol: Optional[float] = None,
        atol: Optional[float] = None,
        gradient: list[str] = ...,
        keep: Optional[list[str]] = None,
    ) -> Outcome: ...

class Outcome:
    time: NDArray[np.float64]
    columns: dict[str, NDArray[np.float64]]
    units: dict[str, str]
    gradient: dict[str, dict[str, NDArray[np.float64]]]
    measures: list[tuple[str, float, bool, bool]]
    events: list[tuple[float, str]]
    channels: list[tuple[str, str, float, Optional[float]]]
    compared: dict[str, tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]]
    counts: tuple[int, int, int]

def page(model: Model, outcome: Outcome, made: str) -> str: ...
def figures_of(model: Model, outcome: Outcome, title: str, panels: list[list[str]]) -> list[str]: ...
