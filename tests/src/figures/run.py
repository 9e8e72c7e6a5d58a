"""An experiment in this process: `run.py MODEL EXPERIMENT`. Prints the time of loading and running, and the channels."""

import json
import sys
import time

import hyde

start = time.perf_counter()
run = hyde.load(sys.argv[1], sys.argv[2]).run()
channels = {name: channel.rms for name, channel in run.channels.items()}
elapsed = time.perf_counter() - start
print(json.dumps({"s": elapsed, "channels": channels}))
