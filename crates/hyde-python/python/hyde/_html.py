"""A run in a notebook: what it is, its measures and channels."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._run import Run


def table(title: str, run: Run) -> str:
    """A small table of HTML."""
    rows = [(name, f"{value:.6g}") for name, value in run.measures.items()]
    rows += [(f"expect {name}", "holds" if holds else "does not hold") for name, holds in run.expectations.items()]
    rows += [(f"rms of {own.name}", f"{own.rms:.4g} {own.unit}") for own in run.channels.values()]
    cells = "".join(f"<tr><td>{escape(name)}</td><td>{escape(value)}</td></tr>" for name, value in rows)
    head = f"{len(run.time)} rows, {len(run)} columns, {len(run.events)} events, {run.steps} steps"
    return f"<b>{escape(title)}</b><br>{escape(head)}<table>{cells}</table>"
