"""Compiles exported classes with rumoca, simulates them and compares with `hyde run`: `modelica.py FOLDER NAME:QUANTITIES:TOLERANCE…`.
Without quantities a class is only compiled.

FOLDER has NAME.mo and NAME/results.json."""

import json
import sys
from pathlib import Path

import numpy as np
import rumoca

folder = Path(sys.argv[1])
for own in sys.argv[2:]:
    name, quantities, tolerance = own.split(":")
    model = rumoca.Session().load(str(folder / f"{name}.mo"), model=name)
    if not quantities:
        # Too stiff for a test: compiled alone.
        assert len(model.states) > 50
        continue
    run = json.loads((folder / name / "results.json").read_text())
    time = np.array(run["t"]["values"])
    found = model.simulate(t=(0, float(time[-1])), dt=float(time[-1]) / 200)
    columns = found.to_numpy()
    names = list(found.names)
    at = np.array(found.time)
    for quantity in quantities.split(","):
        values = np.asarray(columns)
        column = names.index(f"'{quantity}'") if f"'{quantity}'" in names else names.index(quantity)
        values = values[:, column] if values.shape[0] == len(at) else values[column]
        expected = np.array(run[quantity]["values"])
        # Beside events both sides of a jump are right.
        inside = np.array([np.min(np.abs(time[np.nonzero(np.diff(time) == 0)[0]] - t), initial=1) > 2e-3 for t in at])
        inside &= at <= time[-1]
        off = np.max(np.abs(values - np.interp(at, time, expected))[inside])
        span = np.ptp(expected)
        print(name, quantity, off / span)
        assert span > 0 and off <= float(tolerance) * span, (name, quantity, off, span)
print("done")
