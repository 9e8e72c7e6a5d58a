"""Runs `lifecycle.c` on FMUs under valgrind: `lifecycle.py PROGRAM FMU...`.

Prints one JSON object: for each FMU the bytes that are definitely lost, and the errors of memory that valgrind counts.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from fmpy import extract, read_model_description


def checked(program, fmu):
    description = read_model_description(fmu)
    identifier = description.coSimulation.modelIdentifier
    two = description.fmiVersion == "2.0"
    with tempfile.TemporaryDirectory() as folder:
        extract(fmu, folder)
        platform = "linux64" if two else "x86_64-linux"
        library = os.path.join(folder, "binaries", platform, identifier + ".so")
        stop = description.defaultExperiment.stopTime or "1"
        resources = os.path.join(folder, "resources") + "/"
        arguments = [program, library, "2" if two else "3", description.guid or description.instantiationToken, resources, str(stop)]
        valgrind = ["valgrind", "--leak-check=full", "--show-leak-kinds=definite", "--errors-for-leak-kinds=none"]
        # The library writes its machine code while it runs.
        valgrind += ["--smc-check=all-non-file", "--num-callers=30"]
        valgrind += [f"--suppressions={Path(__file__).parent / 'valgrind.supp'}"]
        ran = subprocess.run(valgrind + arguments, capture_output=True, text=True)
    lost = re.search(r"definitely lost: ([\d,]+) bytes", ran.stderr)
    freed = "no leaks are possible" in ran.stderr
    errors = re.search(r"ERROR SUMMARY: (\d+) errors", ran.stderr)
    if ran.stdout != "done\n" or errors is None or not (lost or freed):
        return {"failed": (ran.stdout + ran.stderr)[-4000:]}
    found = {"lost": int(lost.group(1).replace(",", "")) if lost else 0, "errors": int(errors.group(1))}
    if found["lost"] or found["errors"]:
        found["told"] = ran.stderr[:6000]
    return found


program, *fmus = sys.argv[1:]
json.dump({fmu: checked(program, fmu) for fmu in fmus}, sys.stdout)
