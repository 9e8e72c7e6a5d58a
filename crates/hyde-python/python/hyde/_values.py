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


def text(name: str, value: Value) -> str:
    """A value as `--set` takes it."""
    if isinstance(value, bool):
        return f"{name}={'true' if value else 'false'}"
    if isinstance(value, tuple):
        number, unit = value
        return f"{name}={float(number)!r} [{unit}]"
    if isinstance(value, str):
        return f"{name}={value}"
    return f"{name}={float(value)!r}"
