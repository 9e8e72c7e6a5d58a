"""What a notebook shows and a file keeps: pages and figures."""

from __future__ import annotations

from html import escape
from os import PathLike
from pathlib import Path
from typing import Any, Union

from ._hyde import Error

File = Union[str, "PathLike[str]"]


class Page:
    """A report: `html` is its text, one page that needs no other file. A notebook shows it."""

    def __init__(self, html: str) -> None:
        self.html = html

    def save(self, path: File) -> None:
        """Writes the page to a file, `page.html`."""
        Path(_ending(path, ".html", ".htm")).write_text(self.html, encoding="utf-8")

    def __repr__(self) -> str:
        return f"<hyde.Page of {len(self.html)} characters: save(PATH) writes it>"

    def _repr_html_(self) -> str:
        style = "width:100%;height:36em;border:1px solid #8886"
        return f'<iframe sandbox="allow-scripts" style="{style}" srcdoc="{escape(self.html)}"></iframe>'


def _ending(path: File, *known: str) -> Path:
    """The path, which may not promise another format than is written."""
    path = Path(path)
    if path.suffix and path.suffix.lower() not in known:
        raise Error(f"`{path.name}`: this writes {known[0][1:].upper()}, so name the file `{path.with_suffix(known[0]).name}`")
    return path


class Plot:
    """Figures as SVG, one text each in `svgs`. A notebook shows them."""

    def __init__(self, svgs: list[str]) -> None:
        self.svgs = svgs

    def save(self, path: File) -> None:
        """Writes `plot.svg`; further figures become `plot-2.svg`, `plot-3.svg`, …"""
        path = _ending(path, ".svg")
        for number, svg in enumerate(self.svgs, start=1):
            own = path if number == 1 else path.with_name(f"{path.stem}-{number}{path.suffix}")
            own.write_text(svg, encoding="utf-8")

    def __repr__(self) -> str:
        count = len(self.svgs)
        return f"<hyde.Plot of {count} figure{'s' * (count != 1)}: save('plot.svg') writes {'it' if count == 1 else 'them'}>"

    def _repr_html_(self) -> str:
        return "".join(f"<div>{svg[svg.find('<svg') :]}</div>" for svg in self.svgs)


class Study(dict[str, Any]):
    """What a study found, as its command prints it with `--json`; `page` is its report. A notebook shows the page."""

    def __init__(self, found: dict[str, Any], page: Page) -> None:
        super().__init__(found)
        self.page = page

    def _repr_html_(self) -> str:
        return self.page._repr_html_()
