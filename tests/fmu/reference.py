"""Checks the reference results in an FMU as FMI-LS-REF has them, and repeats the experiment with FMPy.

Usage: reference.py FMU EXPERIMENT

Prints one JSON object: findings of fmpy.validation, the related files by role, the numbers of inputs and outputs, the largest
deviation of FMPy's co-simulation from the reference over the range of an output, and the expectations.
"""

import csv
import json
import sys
import tempfile
import xml.etree.ElementTree as tree
from pathlib import Path

import numpy as np
from fmpy import extract, simulate_fmu
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

LS = "{http://fmi-standard.org/fmi-ls-manifest}"
ROLES = {"result", "experiment/smoke-test", "testcase"}


def manifest(folder):
    """The related files by role; all of them exist, and no other file is there."""
    root = tree.parse(folder / "fmi-ls-manifest.xml").getroot()
    assert root.tag == "fmiReferences"
    assert root.get(LS + "fmi-ls-name") == "org.fmi-standard.fmi-ls-ref"
    assert root.get(LS + "fmi-ls-version") == "1.0.0-alpha.1"
    assert root.get(LS + "fmi-ls-description").startswith("Layered Standard providing")
    related = {own.get("role"): own.get("source") for own in root}
    assert set(related) <= ROLES, related
    for own in root:
        assert own.tag == "Related" and (folder / own.get("source")).is_file(), own.attrib
    return related


def last_of_instants(t):
    return np.append(np.diff(t) > 1e-9 * (1.0 + np.abs(t[1:])), True)


def repeated(fmu, folder, experiment):
    """The experiment in FMPy, held against the reference where its rows have no event."""
    times = experiment.find("TransientSimulation")
    stimuli, references = experiment.find("Stimuli"), experiment.find("References")
    expected = read_csv(folder / references.get("source"))
    given = None if stimuli is None else read_csv(folder / stimuli.get("source"))
    names = list(expected.dtype.names[1:])
    result = simulate_fmu(
        fmu,
        fmi_type="CoSimulation",
        start_time=float(times.get("startTime")),
        stop_time=float(times.get("stopTime")),
        output_interval=float(times.get("stepSize")),
        input=given,
        output=names,
    )
    t = expected["time"]
    twice = np.isin(np.round(t, 9), np.round(t[1:][np.diff(t) < 1e-9], 9))
    rows = {round(time, 9): k for k, time in enumerate(result["time"])}
    pairs = [(k, rows.get(round(time, 9))) for k, time in enumerate(t) if not twice[k]]
    pairs = [pair for pair in pairs if pair[1] is not None]
    own, other = (np.array([pair[n] for pair in pairs]) for n in (0, 1))
    worst = 0.0
    for name in names:
        size = max(np.ptp(expected[name]), 1e-12)
        worst = max(worst, float(np.max(np.abs(expected[name][own] - result[name][other])) / size))
    return {
        "inputs": 0 if given is None else len(given.dtype.names) - 1,
        "outputs": len(names),
        "compared": len(pairs),
        "deviation": worst,
    }


def main():
    fmu, name = sys.argv[1:]
    found = {"findings": validate_fmu(fmu)}
    with tempfile.TemporaryDirectory() as unzipped:
        extract(fmu, unzipped)
        folder = Path(unzipped) / "extra/org.fmi-standard.fmi-ls-ref"
        found["related"] = manifest(folder)
        (experiment,) = tree.parse(folder / f"{name}.exp").getroot()
        assert experiment.get("name") == name and float(experiment.get("tolerance")) > 0
        found |= repeated(fmu, folder, experiment)
        expected = folder / f"{name}_expect.json"
        found["expected"] = json.loads(expected.read_text()) if expected.is_file() else None
        with open(folder / f"{name}_out.csv") as file:
            assert next(csv.reader(file))[0] == "time"
    json.dump(found, sys.stdout)


main()
