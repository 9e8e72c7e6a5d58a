"""Simulates FMUs with FMPy, each in a process of its own: `random_models.py FMU...`.

Each FMU is validated and simulated by co-simulation and, if it has it, by model exchange. Prints one JSON object: for each FMU
"done", or what failed: a crash with its signal, a finding, a call that failed although the experiment runs in `hyde run`.
"""

import json
import os
import sys
import tempfile
import traceback
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

# Of the range of a quantity: the library's own solver repeats the run of the experiment.
SAME = 1e-9
# A process that takes longer hangs.
LONGEST_S = 120


def reference(fmu):
    """The results of `hyde run` that are in the FMU, if the experiment has a run."""
    with tempfile.TemporaryDirectory() as folder:
        extract(fmu, folder)
        found = list((Path(folder) / "extra/org.fmi-standard.fmi-ls-ref").glob("*_out.csv"))
        return read_csv(found[0]) if found else None


def deviation(expected, result):
    """The largest difference over the range of its quantity, where the reference has one row at an instant."""
    t = expected["time"]
    twice = np.isin(np.round(t, 9), np.round(t[1:][np.diff(t) < 1e-9], 9))
    rows = {round(time, 9): k for k, time in enumerate(result["time"])}
    pairs = [(k, rows[round(time, 9)]) for k, time in enumerate(t) if not twice[k] and round(time, 9) in rows]
    if not pairs:
        return 0.0
    own, other = (np.array([pair[n] for pair in pairs]) for n in (0, 1))
    worst = 0.0
    for name in expected.dtype.names[1:]:
        size = max(np.ptp(expected[name]), 1e-9 * np.max(np.abs(expected[name])), 1e-12)
        worst = max(worst, float(np.max(np.abs(expected[name][own] - result[name][other])) / size))
    return worst


def simulated(fmu):
    findings = validate_fmu(fmu)
    assert not findings, findings
    description = read_model_description(fmu)
    expected = reference(fmu)
    for kind, there in (("CoSimulation", description.coSimulation), ("ModelExchange", description.modelExchange)):
        if there is None:
            continue
        try:
            result = simulate_fmu(fmu, fmi_type=kind, validate=False)
        except Exception:
            # The model has no solution: `hyde run` says so too.
            if expected is None:
                continue
            raise
        if kind == "CoSimulation" and expected is not None:
            names = set(result.dtype.names)
            assert set(expected.dtype.names) <= names, "an output is missing"
            worst = deviation(expected, result)
            assert worst <= SAME, f"co-simulation deviates by {worst:.3g} of the range"


def guarded(fmu):
    """What came of an FMU in a process of its own."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        sys.stdout = sys.stderr = open(os.devnull, "w")
        try:
            import signal

            signal.alarm(LONGEST_S)
            simulated(fmu)
            text = "done"
        except Exception:
            text = traceback.format_exc()[-600:]
        os.write(write, text.encode())
        os._exit(0)
    os.close(write)
    with os.fdopen(read) as pipe:
        text = pipe.read()
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        return f"its process ended with the signal {os.WTERMSIG(status)}"
    return text


json.dump({fmu: guarded(fmu) for fmu in sys.argv[1:]}, sys.stdout)
