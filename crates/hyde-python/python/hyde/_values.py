"""Values of parameters as users give them: numbers in SI, texts with a unit, pairs of number and unit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Optional, Union

from ._hyde import Error

Value = Union[float, int, bool, str, tuple[float, str]]
Values = Optional[Mapping[str, Value]]


def split(values: Values) -> tuple[list[tuple[str, float]], list[str]]:
    """Numbers in SI apart from texts as `--set` takes them."""
    numbers: list[tuple[str, float]] = []
    texts: list[str] = []
    for name, value in (values or {}).items():
        if isinstance(value, (bool, str, tuple)):
            texts.append(text(name, value))
        else:
            try:
                numbers.append((name, float(value)))
            except (TypeError, ValueError):
                raise Error(f"`{name}`: {value!r} is neither a number nor a text such as '320 [kg]'") from None
    return numbers, texts


def number(name: str, value: Optional[float], unit: str = "") -> Optional[float]:
    """An option of a run that is a number."""
    try:
        return None if value is None else float(value)
    except (TypeError, ValueError):
        raise Error(f"`{name}`: {value!r} is not a number{unit and f' in {unit}'}") from None


def text(name: str, value: Value, si: str = "") -> str:
    """A value as `--set` takes it; a number has the unit `si`."""
    if isinstance(value, bool):
        return f"{name}={'true' if value else 'false'}"
    if isinstance(value, tuple):
        number, unit = value
        return f"{name}={float(number)!r} [{unit}]"
    if isinstance(value, str):
        return f"{name}={value}"
    return f"{name}={float(value)!r} [{si}]" if si not in ("", "1") else f"{name}={float(value)!r}"
