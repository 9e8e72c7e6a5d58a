"""What a run leaves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from importlib import import_module
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _html, _names
from ._hyde import Model, Outcome, figures_of, page
from ._shown import Page, Plot

Array = NDArray[np.float64]


class Event(NamedTuple):
    """An entry of the event log."""

    time: float
    cause: str


@dataclass(frozen=True)
class Channel:
    """A measured channel beside the model; all values SI."""

    name: str
    unit: str
    rms: float
    noise: Optional[float]
    time: Array
    measured: Array
    simulated: Array


def _tables(package: str) -> Any:
    """A package for tables; only those who ask for its tables need it."""
    return import_module(package)


class Run(Mapping[str, Array]):
    """The columns of a run by their names, over `time`, in SI. An instant with an event has two rows: its limits.

    Columns are NumPy arrays on the memory of the run, not copies; they cannot be written to.
    """

    def __init__(self, outcome: Outcome, title: str, model: Model) -> None:
        self._outcome = outcome
        self._title = title
        self._model = model

    def __getitem__(self, name: str) -> Array:
        try:
            return self._outcome.columns[name]
        except KeyError:
            raise _names.unknown("the run has no column", name, self._outcome.columns) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._outcome.columns)

    def __len__(self) -> int:
        return len(self._outcome.columns)

    @property
    def time(self) -> Array:
        """Times of the rows, s."""
        return self._outcome.time

    @property
    def units(self) -> dict[str, str]:
        """The SI unit of each column."""
        return self._outcome.units

    @property
    def measures(self) -> dict[str, float]:
        """Values of the measures, SI."""
        return {name: value for name, value, expectation, _ in self._outcome.measures if not expectation}

    @property
    def expectations(self) -> dict[str, bool]:
        """Whether each `expect` holds."""
        return {name: holds for name, _, expectation, holds in self._outcome.measures if expectation}

    @property
    def channels(self) -> dict[str, Channel]:
        """What was measured beside what the model has."""
        found: dict[str, Channel] = {}
        for name, unit, rms, noise in self._outcome.channels:
            time, measured, simulated = self._outcome.compared[name]
            found[name] = Channel(name, unit, rms, noise, time, measured, simulated)
        return found

    @property
    def events(self) -> list[Event]:
        """The event log."""
        return [Event(time, cause) for time, cause in self._outcome.events]

    @property
    def gradient(self) -> dict[str, dict[str, Array]]:
        """Derivatives of columns, SI: by the name of the parameter, then of the column."""
        return self._outcome.gradient

    @property
    def steps(self) -> int:
        """Accepted steps of the solver."""
        return self._outcome.counts[0]

    def _columns(self) -> dict[str, Array]:
        return {"t": self.time, **self._outcome.columns}

    def to_pandas(self) -> Any:
        """A frame of pandas over the time; `frame.attrs["units"]` has the units."""
        pandas = _tables("pandas")

        frame = pandas.DataFrame(self._outcome.columns, index=pandas.Index(self.time, name="t"), copy=False)
        frame.attrs["units"] = {"t": "s", **self.units}
        return frame

    def to_arrow(self) -> Any:
        """A table of pyarrow; each field has its unit in its metadata."""
        pyarrow = _tables("pyarrow")

        units = {"t": "s", **self.units}
        fields = [pyarrow.field(name, pyarrow.float64(), metadata={"unit": units[name]}) for name in self._columns()]
        return pyarrow.table(list(self._columns().values()), schema=pyarrow.schema(fields))

    def to_polars(self) -> Any:
        """A frame of polars; names have their unit behind them, for polars keeps no metadata."""
        polars = _tables("polars")

        units = {"t": "s", **self.units}
        return polars.DataFrame({f"{name} [{units[name]}]": values for name, values in self._columns().items()})

    def plot(self, *panels: Union[str, Sequence[str]], title: Optional[str] = None) -> Plot:
        """Columns over time, a panel for each argument: `run.plot("r,table.s", "motor.i")`.

        Without arguments, what the page of the run has: the figures of the experiment, what was measured beside the model,
        and what the run is about.
        """
        names = [panel.split(",") if isinstance(panel, str) else list(panel) for panel in panels]
        stripped = [[name.strip() for name in panel] for panel in names]
        return Plot(figures_of(self._model, self._outcome, self._title if title is None else title, stripped))

    @property
    def page(self) -> Page:
        """The report of the run, as `hyde run --out` writes it. It is made when it is asked for."""
        return Page(page(self._model, self._outcome, f"{datetime.now(timezone.utc):%Y-%m-%d %H:%M} UTC"))

    def __repr__(self) -> str:
        return f"<hyde.Run {self._title}: {len(self.time)} rows, {len(self)} columns, {len(self._outcome.events)} events>"

    def _repr_html_(self) -> str:
        return _html.table(self._title, self) + self.plot(title="")._repr_html_()
