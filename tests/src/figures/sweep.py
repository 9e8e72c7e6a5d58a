"""A thousand masses of the first example in this process: `sweep.py MODEL`. Prints the time and the smallest and largest way."""

import json
import sys
import time

import hyde

start = time.perf_counter()
axis = hyde.load(sys.argv[1])
runs = axis.sweep([{"table.M": 200 + 200 * index / 999} for index in range(1000)])
elapsed = time.perf_counter() - start
for run in runs:
    if isinstance(run, hyde.Error):
        raise run
ways = [run.measures["way"] for run in runs]
print(json.dumps({"s": elapsed, "ways": [min(ways), max(ways)]}))
