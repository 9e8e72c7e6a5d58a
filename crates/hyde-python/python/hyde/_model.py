"""A model with its experiment."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Optional, Union

from . import _command, _records
from ._hyde import Error
from ._hyde import Model as _Model
from ._records import Record
from ._run import Run
from ._values import Value, Values, split, text

File = Union[str, "PathLike[str]"]


@dataclass(frozen=True, repr=False)
class Parameter:
    """A parameter: its value in SI (a list if it is an array) and its unit.

    `display_unit` is the unit in which the model writes it, `spread` its declared spread in SI. A structural parameter is
    compiled into the equations: it is set by `load`.
    """

    name: str
    value: Union[float, list[float]]
    unit: str
    display_unit: str
    spread: Optional[float]
    source: Optional[str]
    structural: bool

    def __repr__(self) -> str:
        return f"Parameter({self.value!r}, {self.unit!r})"

    def __float__(self) -> float:
        if isinstance(self.value, list):
            raise TypeError(f"`{self.name}` is an array")
        return self.value


class Parameters(Mapping[str, Parameter]):
    """The parameters of a model by their names."""

    def __init__(self, model: _Model) -> None:
        self._all: dict[str, Parameter] = {}
        for name, values, display, unit, spread, source, structural in model.parameters():
            value = values[0] if len(values) == 1 else values
            self._all[name] = Parameter(name, value, unit, display, spread, source, structural)

    def __getitem__(self, name: str) -> Parameter:
        return self._all[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __repr__(self) -> str:
        return "\n".join(f"{name} = {own.value} [{own.unit}]" for name, own in self._all.items())


class Model:
    """A model with its experiment, compiled once. `load` makes it."""

    def __init__(self, file: File, experiment: Optional[str], options: dict[str, Any]) -> None:
        self.file = Path(fspath(file))
        self._set: Values = options.get("set")
        self._model = options.get("model")
        self._data = options.get("data")
        self._folder: Optional[tempfile.TemporaryDirectory[str]] = None
        self._records = self._written(options.get("records") or {})
        self._compiled = _Model(
            fspath(file),
            experiment,
            self._model,
            [text(name, value) for name, value in (self._set or {}).items()],
            list(self._records.items()),
            self._data,
        )

    def _written(self, records: Mapping[str, Record]) -> dict[str, str]:
        if any(not isinstance(record, (str, PathLike)) for record in records.values()):
            self._folder = tempfile.TemporaryDirectory(prefix="hyde-")
        folder = Path(self._folder.name) if self._folder else Path()
        return {name: _records.written(record, folder / f"{name}.csv") for name, record in records.items()}

    @property
    def name(self) -> str:
        """The name of the model."""
        return self._compiled.name

    @property
    def experiment(self) -> Optional[str]:
        """The name of the experiment."""
        return self._compiled.experiment

    @property
    def warnings(self) -> str:
        """What the compiler warns of, with the lines of the file; empty if nothing."""
        return self._compiled.warnings

    @property
    def parameters(self) -> Parameters:
        """All parameters with units."""
        return Parameters(self._compiled)

    def run(
        self,
        set: Values = None,
        *,
        stop: Optional[float] = None,
        rtol: Optional[float] = None,
        atol: Optional[float] = None,
        gradient: Sequence[str] = (),
        keep: Optional[Sequence[str]] = None,
    ) -> Run:
        """Solves the experiment. Nothing is compiled again; other threads of Python go on meanwhile.

        `set` has values of parameters: numbers in SI, or `"320 [kg]"`, or `(320, "kg")`. `gradient` names parameters by
        which every column is differentiated. `keep` names the columns that are made, all without it; channels are compared
        only then.
        """
        numbers, texts = split(set)
        outcome = self._compiled.run(numbers, texts, stop, rtol, atol, list(gradient), None if keep is None else list(keep))
        return Run(outcome, f"{self.experiment or 'run'} of {self.name}")

    def _arguments(self, command: str, name: Optional[str], more: Sequence[str], set: Values) -> list[str]:
        arguments = [command, str(self.file)]
        if name:
            arguments.append(name)
        if self._model:
            arguments += ["--model", self._model]
        for values in (self._set, set):
            for key, value in (values or {}).items():
                arguments += ["--set", text(key, value)]
        for record, file in self._records.items():
            arguments += ["--record", f"{record}={file}"]
        if self._data:
            arguments += ["--data", fspath(self._data)]
        return arguments + list(more)

    def modes(self, *arguments: str, set: Values = None) -> dict[str, Any]:
        """Natural frequencies and damping ratios, as `hyde modes --json`; further arguments are those of the command."""
        return self._study("modes", self.experiment, arguments, set)

    def bode(self, *arguments: str, set: Values = None) -> dict[str, Any]:
        """Frequency responses, as `hyde bode --json`."""
        return self._study("bode", self.experiment, arguments, set)

    def margins(self, *arguments: str, set: Values = None) -> dict[str, Any]:
        """Stability margins, as `hyde bode --margins --json`."""
        return self._study("bode", self.experiment, ("--margins", *arguments), set)

    def fit(self, calibration: Optional[str] = None, *arguments: str) -> dict[str, Any]:
        """Calibrates on records, as `hyde fit --json`."""
        return self._of_block("fit", calibration, arguments)

    def diagnose(self, diagnosis: Optional[str] = None, *arguments: str) -> dict[str, Any]:
        """Finds missing effects, as `hyde diagnose --json`."""
        return self._of_block("diagnose", diagnosis, arguments)

    def _of_block(self, command: str, name: Optional[str], arguments: Sequence[str]) -> dict[str, Any]:
        if self._set or self._records or self._model:
            raise Error(f"`{command}` takes values and records from its block in the file: load the model without them")
        line = [command, str(self.file), *([name] if name else []), *arguments]
        if self._data:
            line += ["--data", fspath(self._data)]
        answer: dict[str, Any] = _command.json_of(line)
        return answer

    def _study(self, command: str, name: Optional[str], more: Sequence[str], set: Values) -> dict[str, Any]:
        answer: dict[str, Any] = _command.json_of(self._arguments(command, name, more, set))
        return answer

    def sweep(
        self, sets: Sequence[Mapping[str, Value]], *, keep: Sequence[str] = (), threads: Optional[int] = None
    ) -> list[Union[Run, Error]]:
        """Runs each set of values in this process, on several threads; a run that fails is its error.

        Runs have the measures, and the columns that `keep` names. Structural parameters cannot be in a set; `hyde sweep`
        compiles a variant for each of their values.
        """

        def one(values: Mapping[str, Value]) -> Union[Run, Error]:
            try:
                return self.run(values, keep=keep)
            except Error as error:
                return error

        with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
            return list(pool.map(one, sets))

    def __repr__(self) -> str:
        return f"<hyde.Model {self.name}, experiment {self.experiment}, {len(self.parameters)} parameters>"


def load(
    file: File,
    experiment: Optional[str] = None,
    *,
    model: Optional[str] = None,
    set: Values = None,
    records: Optional[Mapping[str, Record]] = None,
    data: Optional[File] = None,
) -> Model:
    """Loads a file and compiles one experiment of it.

    `records` replaces the files of records: a path, or a mapping of names to arrays, or a frame of pandas or polars; the first
    column is the time in s, and `"x [mm]"` names a unit.

    Raises ModelError with the diagnostics if the model is at fault.
    """
    return Model(file, experiment, {"model": model, "set": set, "records": records, "data": data})
