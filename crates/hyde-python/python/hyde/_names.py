"""Names of parameters and columns, as users give them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Union


def listed(names: Union[str, Sequence[str]]) -> list[str]:
    """The names, or the only one."""
    return [names] if isinstance(names, str) else list(names)


class UnknownName(KeyError):
    """Prints its text as it is; a KeyError prints the quotes of a name."""

    def __str__(self) -> str:
        return str(self.args[0])


def unknown(what: str, name: object, known: Iterable[str]) -> KeyError:
    """A name that there is not, with those that are like it or end in the same way."""
    every = list(known)
    word = str(name)
    near = get_close_matches(word, every, n=3) or [own for own in every if own.rpartition(".")[2] == word.rpartition(".")[2]][:3]
    hint = f"; did you mean `{'`, `'.join(near)}`?" if near else ""
    return UnknownName(f"{what} `{word}`{hint}")
