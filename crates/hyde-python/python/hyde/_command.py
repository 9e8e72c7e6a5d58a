"""The command `hyde` that comes with the package, for studies that run in a process of their own."""

from __future__ import annotations

import json
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any, Callable, Optional, cast

from ._hyde import Error, ModelError, SolverError
from ._shown import Page, Study

_EXPECTATION = 4
_ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_OVERWRITTEN = re.compile(r"[^\n]*\r(?!\n)|\r")


def path() -> str:
    """Where the command is: in the package, named by the variable HYDE, or on the path."""
    own = Path(__file__).with_name("bin") / "hyde"
    named = os.environ.get("HYDE")
    found = named or (str(own) if own.exists() else shutil.which("hyde"))
    if found is None:
        raise Error("the command `hyde` is not there: install the wheel, or name it, HYDE=/path/to/hyde")
    return found


def study(arguments: list[str]) -> Study:
    """What a command prints as JSON, with the page that it writes."""
    with tempfile.TemporaryDirectory(prefix="hyde-") as folder:
        out = arguments[arguments.index("--out") + 1] if "--out" in arguments[:-1] else folder
        more = [] if out != folder else ["--out", folder]
        found = json_of(arguments + more)
        pages = sorted(Path(out).glob("*.html"))
        return Study(found, Page(pages[0].read_text(encoding="utf-8") if pages else ""))


def json_of(arguments: list[str]) -> Any:
    """What a command prints as JSON. A terminal or a notebook shows how far it is; Ctrl-C interrupts it."""
    printed, said, status = _run([path(), *arguments, "--json"])
    try:
        answer = json.loads(printed)
    except json.JSONDecodeError:
        answer = None
    if status in (0, _EXPECTATION) and answer is not None:
        return answer
    told = cast("dict[str, Any]", answer) if isinstance(answer, dict) else {}
    diagnostics: list[dict[str, Any]] = told.get("diagnostics", [])
    messages = [_message(entry) for entry in diagnostics]
    if not messages:
        messages = [str(told[key]) for key in ("error", "reason") if key in told]
        messages += [f"{own['file']}: {own['error']}" for own in told.get("errors", [])]
    kind = {1: ModelError, 3: SolverError}.get(status, Error)
    error = kind("\n".join(messages) or said.strip() or f"`hyde {arguments[0]}` ended with {status}")
    error.diagnostics = diagnostics
    raise error


def _message(diagnostic: dict[str, Any]) -> str:
    """A diagnostic on two lines: what is wrong and where, and what to do."""
    place = next((f"{own['file']}:{own['line']}: " for own in diagnostic.get("labels", []) if own.get("line")), "")
    text = f"{place}{diagnostic.get('message', '')}"
    return f"{text}\n  help: {diagnostic['help']}" if diagnostic.get("help") else text


def _run(line: list[str]) -> tuple[str, str, int]:
    """What a command prints and says, and its status. It draws how far it is where somebody looks on."""
    show = _shown()
    watched = show is not None
    ours, its = pty.openpty() if watched else os.pipe()
    said: list[str] = []

    def listen() -> None:
        while True:
            try:
                heard = os.read(ours, 4096).decode(errors="replace")
            except OSError:
                return
            if not heard:
                return
            said.append(heard)
            if show is not None and "\r" in heard.replace("\r\n", ""):
                show(heard)

    listener = threading.Thread(target=listen, daemon=True)
    try:
        with subprocess.Popen(line, stdout=subprocess.PIPE, text=True, stderr=its) as child:
            os.close(its)
            listener.start()
            try:
                printed = child.communicate()[0]
            except KeyboardInterrupt:
                child.send_signal(signal.SIGINT)
                child.wait()
                raise
            listener.join()
            if show is not None:
                show("")
    finally:
        os.close(ours)
    return printed, _OVERWRITTEN.sub("", _ESCAPE.sub("", "".join(said))), child.returncode


def _shown() -> Optional[Callable[[str], None]]:
    """What shows a line that replaces the one before: a terminal or a notebook; nothing where nobody looks on."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if hasattr(shell, "kernel"):
        from IPython import display

        made: Any = display.DisplayHandle
        handle = made()
        handle.display({"text/plain": ""}, raw=True)

        def replace(heard: str) -> None:
            lines = _ESCAPE.sub("", heard).strip().split("\r")
            handle.update({"text/plain": lines[-1].strip()}, raw=True)

        return replace
    if sys.stderr is None or not sys.stderr.isatty():
        return None

    def write(heard: str) -> None:
        sys.stderr.write(heard)
        sys.stderr.flush()

    return write


def main() -> None:
    """The command itself, as `pip` installs it."""
    sys.exit(subprocess.call([path(), *sys.argv[1:]]))
