"""A model with its experiment."""

from __future__ import annotations

import os
import tempfile
import threading
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Callable, Optional, Union

from . import _command, _names, _records
from ._hyde import Error
from ._hyde import Model as _Model
from ._records import Record
from ._run import Run
from ._shown import Study
from ._values import Value, Values, number, split, text

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
        try:
            return self._all[name]
        except KeyError:
            raise _names.unknown("the model has no parameter", name, self._all) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __repr__(self) -> str:
        return "\n".join(f"{name} = {own.value} [{own.unit}]" for name, own in self._all.items())


class Model:
    """A model with its experiment, compiled once. `load` makes it."""

    def __init__(self, file: File, experiment: Optional[str], options: dict[str, Any]) -> None:
        self.file: Path = Path(fspath(file))
        self._set: Values = options.get("set")
        self._model = options.get("model")
        self._data = options.get("data")
        self._folder: Optional[tempfile.TemporaryDirectory[str]] = None
        self._records = self._written(options.get("records") or {})
        numbers, texts = split(self._set)
        self._compiled = _Model(
            fspath(file), experiment, self._model, numbers, texts, list(self._records.items()), self._data
        )
        for fmu in self._compiled.fmus:
            warnings.warn(f"a run of `{self.name}` runs machine code of `{fmu}` in this process", stacklevel=3)

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
    def assumptions(self) -> list[str]:
        """What Hyde assumes of records, tables and FMUs, as `hyde run` prints it; each is a sentence."""
        return self._compiled.assumptions

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
        gradient: Union[str, Sequence[str]] = (),
        keep: Union[str, Sequence[str], None] = None,
    ) -> Run:
        """Solves the experiment. Nothing is compiled again; other threads of Python go on meanwhile.

        `set` has values of parameters: numbers in SI, or `"320 [kg]"`, or `(320, "kg")`. `stop` is in s. `gradient` names
        parameters by which every column is differentiated. `keep` names the columns that are made, all without it; channels
        are compared only then.
        """
        numbers, texts = split(set)
        kept = None if keep is None else _names.listed(keep)
        options = number("stop", stop, "s"), number("rtol", rtol), number("atol", atol)
        outcome = self._compiled.run(numbers, texts, *options, _names.listed(gradient), kept)
        return Run(outcome, f"{self.experiment or 'run'} of {self.name}", self._compiled)

    def modes(self, *arguments: str, set: Values = None) -> Study:
        """Natural frequencies and damping ratios, as `hyde modes --json`; further arguments are those of the command."""
        return self._study("modes", arguments, set)

    def bode(self, *arguments: str, set: Values = None) -> Study:
        """Frequency responses, as `hyde bode --json`."""
        return self._study("bode", arguments, set)

    def margins(self, *arguments: str, set: Values = None) -> Study:
        """Stability margins, as `hyde bode --margins --json`; `margins("--cut", "SIGNAL")` opens a loop at another signal."""
        return self._study("bode", ("--margins", *arguments), set)

    def fit(
        self, calibration: Optional[str] = None, *arguments: str, set: Values = None, data: Optional[File] = None
    ) -> Study:
        """Calibrates on records, as `hyde fit --json`. `data` is the folder of the records, that of the model without it."""
        return self._of_block("fit", calibration, arguments, set, data)

    def diagnose(
        self, diagnosis: Optional[str] = None, *arguments: str, set: Values = None, data: Optional[File] = None
    ) -> Study:
        """Finds missing effects, as `hyde diagnose --json`. `data` is the folder of the records, that of the model without
        it."""
        return self._of_block("diagnose", diagnosis, arguments, set, data)

    def _of_block(
        self, command: str, name: Optional[str], arguments: Sequence[str], set: Values, data: Optional[File]
    ) -> Study:
        if self._records or self._model:
            raise Error(f"`{command}` takes its model and its records from its block in the file: load without `records` and `model`")
        line = [command, str(self.file), *([name] if name else []), *self._settings(set)]
        folder = data if data is not None else self._data
        if folder is not None:
            line += ["--data", fspath(folder)]
        return _command.study(line + list(arguments))

    def _settings(self, set: Values) -> list[str]:
        known = self.parameters
        words: list[str] = []
        for name, value in {**(self._set or {}), **(set or {})}.items():
            unit = known[name].unit if name in known else ""
            words += ["--set", text(name, value, unit)]
        return words

    def _study(self, command: str, arguments: Sequence[str], set: Values) -> Study:
        line = [command, str(self.file), *([self.experiment] if self.experiment else [])]
        if self._model:
            line += ["--model", self._model]
        line += self._settings(set)
        for record, file in self._records.items():
            line += ["--record", f"{record}={file}"]
        if self._data is not None:
            line += ["--data", fspath(self._data)]
        return _command.study(line + list(arguments))

    def sweep(
        self,
        sets: Iterable[Mapping[str, Value]],
        *,
        keep: Union[str, Sequence[str]] = (),
        threads: Optional[int] = None,
        progress: Optional[Callable[[int, int], None]] = None,
    ) -> list[Union[Run, Error]]:
        """Runs each set of values in this process, on several threads; a run that fails is its error.

        Runs have the measures, and the columns that `keep` names. `progress` is called with the number of runs that are done
        and the number of all. Structural parameters cannot be in a set; `hyde sweep` compiles a variant for each of their
        values.
        """
        every = list(sets)
        stopped = threading.Event()

        def one(values: Mapping[str, Value]) -> Union[Run, Error, None]:
            if stopped.is_set():
                return None
            try:
                return self.run(values, keep=keep)
            except Error as error:
                return error

        found: list[Union[Run, Error]] = []
        with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
            runs = [pool.submit(one, values) for values in every]
            try:
                for number, run in enumerate(as_completed(runs), start=1):
                    run.result()
                    if progress is not None:
                        progress(number, len(runs))
            except BaseException:
                # Runs that have not begun are left out; those that go on are waited for.
                stopped.set()
                raise
            for run in runs:
                outcome = run.result()
                if outcome is not None:
                    found.append(outcome)
        return found

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
    column is the time in s, and `"x [mm]"` names a unit. `data` is the folder in which the files of records are looked for,
    that of the model without it.

    Raises ModelError with the diagnostics if the model is at fault. Warns of each FMU in the model, whose machine code runs in
    the process of Python.
    """
    return Model(file, experiment, {"model": model, "set": set, "records": records, "data": data})
