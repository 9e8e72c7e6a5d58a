"""Simulates an FMU with FMPy or fmi-rs and compares it with the results of `hyde run`.

Usage: compare.py FMU RESULTS.json EVENTS.csv TOLERANCE KIND...

KIND is CoSimulation, CoSimulationEvents or ModelExchange; TOLERANCE the relative one of the integrator for the last. FmiRs and
FmiRsEvents are co-simulation with the program of `fmi-rs/`, which the variable FMI_RS names.

Prints one JSON object: findings of fmpy.validation, and for each kind the largest deviation over the range of a quantity, and
the largest distance of an event from the one of `hyde run`, in us.
"""

import csv
import functools
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import fmpy.sundials
import numpy as np
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

# At tolerances of 1e-11 the first steps behind an event are so short that the 500 of FMPy do not reach the next sample.
fmpy.sundials.CVodeSolver = functools.partial(fmpy.sundials.CVodeSolver, maxNumSteps=100_000)


def expected(path):
    """The results of `hyde run` as arrays, the right limit alone where there are two rows at an instant."""
    with open(path) as file:
        columns = {name: np.array(c["values"], float) for name, c in json.load(file).items()}
    t = columns.pop("t")
    last = np.append(np.diff(t) > 1e-9 * (1.0 + np.abs(t[1:])), True)
    return t[last], {name: c[last] for name, c in columns.items()}


def events(path):
    """The times of the events, each once."""
    with open(path) as file:
        rows = list(csv.reader(file))[1:]
    times = sorted(float(row[0]) for row in rows)
    return [t for k, t in enumerate(times) if k == 0 or t - times[k - 1] > 1e-9]


def deviation(t, columns, result, near):
    """The largest difference over the range of its quantity, but for instants of events, where both limits are right."""
    last = {round(time, 9): k for k, time in enumerate(result["time"])}
    near = np.array(near or [np.inf])
    rows = [(k, last.get(round(time, 9))) for k, time in enumerate(t)]
    rows = [(k, j) for k, j in rows if j is not None and np.min(np.abs(near - t[k])) > 1e-6]
    of_run, of_fmu = (np.array([row[n] for row in rows], int) for n in (0, 1))
    worst, where = 0.0, "" if len(rows) else "no common times"
    for name in result.dtype.names[1:]:
        own = columns[name]
        size = max(np.ptp(own), 1e-9 * np.max(np.abs(own)), 1e-12)
        errors = np.abs(result[name][of_fmu] - own[of_run]) / size
        k = int(np.argmax(errors))
        if not errors[k] <= worst:
            worst, where = float(errors[k]), f"{name} at {t[of_run[k]]:.9g} s"
    return worst, where, len(rows)


def run(fmu, kind, tolerance, t, columns, messages):
    description = read_model_description(fmu)
    known = {v.name for v in description.modelVariables if v.type in ("Real", "Float64")}
    names = [name for name in columns if name in known]
    every = float(description.defaultExperiment.stepSize or (t[-1] - t[0]) / 1000.0)
    return simulate_fmu(
        fmu,
        validate=False,
        fmi_type="ModelExchange" if kind == "ModelExchange" else "CoSimulation",
        start_time=float(t[0]),
        stop_time=float(t[-1]),
        output=names,
        output_interval=every,
        relative_tolerance=tolerance if kind == "ModelExchange" else None,
        use_event_mode=kind == "CoSimulationEvents",
        early_return_allowed=kind == "CoSimulationEvents",
        record_events=kind == "ModelExchange",
        debug_logging=True,
        logger=lambda *arguments: messages.append(arguments),
    )


def run_fmi_rs(fmu, events, t, columns, messages):
    description = read_model_description(fmu)
    # fmi-rs knows no aliases.
    known = {v.name for v in description.modelVariables if v.type in ("Real", "Float64") and v.alias is None}
    steps = round((t[-1] - t[0]) / float(description.defaultExperiment.stepSize or (t[-1] - t[0]) / 1000.0))
    with tempfile.TemporaryDirectory() as folder:
        names, results, log = (Path(folder) / name for name in ("names", "results.csv", "log"))
        names.write_text("".join(name + "\n" for name in columns if name in known))
        how = "events" if events else "steps"
        asked = [os.environ["FMI_RS"], fmu, how, repr(float(t[0])), repr(float(t[-1])), str(steps), results, log, names]
        ran = subprocess.run(asked, capture_output=True, text=True)
        if ran.returncode != 0:
            raise RuntimeError(ran.stderr)
        messages += [(line.split("] ", 2)[-1],) for line in log.read_text().splitlines()]
        return read_csv(results)


def distance(times, others):
    """How far the farthest of some times is from the nearest of others."""
    if not times:
        return 0.0
    others = np.array(others or [np.inf])
    return max(float(np.min(np.abs(others - t))) for t in times)


def as_text(message):
    return message.decode() if isinstance(message, bytes) else str(message)


def main():
    fmu, results, log, tolerance, *kinds = sys.argv[1:]
    t, columns = expected(results)
    known = events(log)
    found = {"findings": validate_fmu(fmu), "kinds": {}}
    for kind in kinds:
        messages = []
        try:
            if kind.startswith("FmiRs"):
                result = run_fmi_rs(fmu, kind == "FmiRsEvents", t, columns, messages)
            else:
                result = run(fmu, kind, float(tolerance), t, columns, messages)
        except Exception as error:
            texts = [as_text(message[-1]) for message in messages[-3:]]
            found["kinds"][kind] = {"failed": str(error), "log": texts}
            continue
        worst, where, compared = deviation(t, columns, result, known)
        texts = [as_text(message[-1]) for message in messages]
        own = sorted(float(text.split(" s, ")[0]) for text in texts if " s, " in text)
        # Both ways: an event that one of them misses is as wrong as one at another time.
        apart = max(distance(known, own), distance(own, known))
        found["kinds"][kind] = {
            "deviation": worst,
            "where": where,
            "compared": compared,
            "quantities": len(result.dtype.names) - 1,
            "events": len(known),
            "event_time_error_us": 1e6 * apart,
        }
    json.dump(found, sys.stdout)


main()
