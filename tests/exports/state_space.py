"""Reads exported state spaces with SciPy and python-control, and trajectories with DyMat: `state_space.py FOLDER`."""

import json
import runpy
import sys
from pathlib import Path

import DyMat
import numpy as np
import scipy.io

folder = Path(sys.argv[1])


def texts(cells):
    return [str(cell[0][0]) if cell[0].size else "" for cell in cells]


def close(found, expected, most=1e-12):
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape, (found.shape, expected.shape)
    scale = max(1.0, np.max(np.abs(expected), initial=0.0))
    off = np.max(np.abs(found - expected), initial=0.0)
    assert off <= most * scale, (off, found, expected)


# An oscillator: the matrices are known.
m, c, d = 2.0, 800.0, 4.0
mat = scipy.io.loadmat(folder / "oscillator.mat")
states = texts(mat["states"])
order = [states.index(name) for name in ["s", "v"]]
close(mat["A"][np.ix_(order, order)], [[0, 1], [-c / m, -d / m]])
close(mat["B"][order], [[0], [1 / m]])
outputs = texts(mat["outputs"])
assert outputs == ["v", "spring"], outputs
close(mat["C"][:, order], [[0, 1], [c, 0]])
close(mat["D"], [[0], [0]])
assert texts(mat["inputs"]) == ["F"] and texts(mat["input_units"]) == ["N"]
assert texts(mat["output_units"]) == ["m/s", "N"], texts(mat["output_units"])
assert mat["dt"].item() == 0
assert "linearised at the start" in str(mat["about"][0])

# The same in the other forms.
data = json.loads((folder / "oscillator.json").read_text())
for name in "ABCD":
    close(np.array(data[name]).reshape(mat[name].shape), mat[name], 0)
assert [own["name"] for own in data["states"]] == states
made = runpy.run_path(str(folder / "oscillator.py"))["system"]
for name in "ABCD":
    close(getattr(made, name), mat[name], 0)
assert made.state_labels == states and made.output_labels == outputs and made.dt == 0
script = (folder / "oscillator.m").read_text()
for name in "ABCD":
    rows = script.split(f"{name} = reshape([", 1)[1].split("]", 1)[0].split("\n")
    rows = [[float(x) for x in row.split()] for row in rows if row.strip()]
    close(np.array(rows).reshape(mat[name].shape), mat[name], 0)
assert "'s'" in script and "sys = ss (A, B, C, D, dt);" in script

# A loop of two clocks: its exact map gives the samples of the run.
loop = runpy.run_path(str(folder / "servo.py"))
system, period = loop["system"], loop["dt"]
assert abs(period - 2e-3) < 1e-15 and loop["t0"] == 0
run = json.loads((folder / "servo" / "results.json").read_text())
time = np.array(run["t"]["values"])
x = np.zeros(system.nstates)
compared = 0
for k in range(50):
    y = system.C @ x + system.D @ np.ones(1)
    # Just before the ticks: the first of the rows of this instant.
    row = np.argmin(np.abs(time - k * period))
    while row > 0 and abs(time[row - 1] - k * period) < 1e-9:
        row -= 1
    for number, name in enumerate(system.output_labels):
        if name in ["s", "v"]:
            off = abs(run[name]["values"][row] - y[number])
            assert off < 1e-8, (k, name, off)
            compared += 1
    x = system.A @ x + system.B @ np.ones(1)
assert compared == 100
assert abs(x[system.state_labels.index("s")]) > 0.3, "it has moved"
held = [name for name in system.state_labels if name.startswith("hold(")]
assert held, system.state_labels

# The plant of that loop: what controllers hold are inputs.
plant = runpy.run_path(str(folder / "plant.py"))["system"]
assert plant.dt == 0 and plant.input_labels == ["r", "v_ref", "a"], plant.input_labels
order = [plant.state_labels.index(name) for name in ["s", "v"]]
close(plant.A[np.ix_(order, order)], [[0, 1], [0, 0]], 0)
close(plant.B[order], [[0, 0, 0], [0, 0, 1]], 0)

# Trajectories as Modelica tools write them.
results = DyMat.DyMatFile(str(folder / "ball" / "results.mat"))
expected = json.loads((folder / "ball-json" / "results.json").read_text())
for name in ["h", "v", "bounces"]:
    close(results.data(name), expected[name]["values"], 0)
    close(results.abscissa(name)[0], expected["t"]["values"], 0)
assert "[m/s]" in results.description("v"), results.description("v")
print("done")
