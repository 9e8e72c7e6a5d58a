"""The examples in Python on the pages of the book run as they are printed, and give what the pages say."""

import os
import re
import shlex
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hyde import _command

ROOT = Path(__file__).resolve().parents[4]
PAGES = {str(path.relative_to(ROOT)): path for path in sorted((ROOT / "book/src").rglob("*.md"))}
BLOCK = re.compile(r"^```(\w+)[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(path: Path, language: str) -> list[str]:
    """The texts of all blocks in a language, in the order of the page."""
    return [text for own, text in BLOCK.findall(path.read_text(encoding="utf-8")) if own == language]


def executed(path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The names after all blocks of a page, one after the other.

    The folder has the models of the page, and what its commands write to the folders that the blocks read.
    """
    monkeypatch.chdir(folder)
    os.symlink(ROOT / "examples", folder / "examples")
    for model in blocks(path, "hyde"):
        package = re.match(r"package (\w+)", model)
        if package:
            (folder / f"{package[1]}.hyde").write_text(model, encoding="utf-8")
    read = set(re.findall(r'"(\w+)/', "".join(blocks(path, "python"))))
    for line in "".join(blocks(path, "console")).splitlines():
        written = re.search(r"^\$ hyde .*--out (\w+)\b(?!/)", line)
        if written and written[1] in read:
            subprocess.run([_command.path(), *shlex.split(line)[2:]], check=True, capture_output=True)
    names: dict[str, Any] = {}
    for text in blocks(path, "python"):
        try:
            exec(compile(text, path.name, "exec"), names)
        except ModuleNotFoundError as absent:
            pytest.skip(f"{absent.name} is not installed")
    return names


WITH_PYTHON = [name for name, path in PAGES.items() if blocks(path, "python")]


def test_pages_with_python_are_found() -> None:
    assert "book/src/python.md" in WITH_PYTHON and len(WITH_PYTHON) >= 3


@pytest.mark.parametrize("page", WITH_PYTHON)
def test_examples_of_a_page_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    executed(PAGES[page], tmp_path, monkeypatch)


def test_the_optimiser_and_jax_have_right_gradients(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = PAGES["book/src/python.md"]
    names = executed(page, tmp_path, monkeypatch)
    found, end, jax, x = (names[name] for name in ("found", "end", "jax", "x"))
    assert found.success and found.fun < 1e-6
    printed = re.search(r"^found\.x\[0\] +# (\S+) N$", page.read_text(encoding="utf-8"), re.MULTILINE)
    assert printed is not None and f"{found.x[0]:.1f}" == printed[1]

    steps = [np.array([1.0, 0.0]), np.array([0.0, 0.5])]
    differences = [(end(x + step) - end(x - step)) / (2 * step.sum()) for step in steps]
    for gradient in (jax.grad(end), jax.jit(jax.grad(end)), jax.jacfwd(end)):
        assert np.asarray(gradient(x)) == pytest.approx(np.asarray(differences), rel=1e-3)
