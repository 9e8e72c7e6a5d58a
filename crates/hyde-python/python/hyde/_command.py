"""The command `hyde` that comes with the package, for studies that run in a process of their own."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

from ._hyde import Error, ModelError, SolverError

_EXPECTATION = 4


def path() -> str:
    """Where the command is: in the package, named by the variable HYDE, or on the path."""
    own = Path(__file__).with_name("bin") / "hyde"
    named = os.environ.get("HYDE")
    found = named or (str(own) if own.exists() else shutil.which("hyde"))
    if found is None:
        raise Error("the command `hyde` is not there: install the wheel, or name it, HYDE=/path/to/hyde")
    return found


def json_of(arguments: list[str]) -> Any:
    """What a command prints as JSON. Its progress and warnings go to standard error; Ctrl-C interrupts it."""
    with subprocess.Popen([path(), *arguments, "--json"], stdout=subprocess.PIPE, text=True, stderr=subprocess.PIPE) as child:
        try:
            printed, said = child.communicate()
        except KeyboardInterrupt:
            child.send_signal(signal.SIGINT)
            child.wait()
            raise
    try:
        answer = json.loads(printed)
    except json.JSONDecodeError:
        answer = None
    if child.returncode in (0, _EXPECTATION) and answer is not None:
        return answer
    diagnostics = answer.get("diagnostics", []) if isinstance(answer, dict) else []
    messages = [entry.get("message", "") for entry in diagnostics]
    if isinstance(answer, dict) and not messages:
        messages = [str(answer[key]) for key in ("error", "reason") if key in answer]
        messages += [f"{own['file']}: {own['error']}" for own in answer.get("errors", [])]
    kind = {1: ModelError, 3: SolverError}.get(child.returncode, Error)
    error = kind("\n".join(messages) or said.strip() or f"`hyde {arguments[0]}` ended with {child.returncode}")
    error.diagnostics = diagnostics
    raise error


def main() -> None:
    """The command itself, as `pip` installs it."""
    sys.exit(subprocess.call([path(), *sys.argv[1:]]))
