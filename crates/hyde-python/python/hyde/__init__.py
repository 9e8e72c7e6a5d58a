"""Hyde: models of machine-tool feed drives, compiled once and simulated in the process.

>>> import hyde
>>> axis = hyde.load("examples/first/first.hyde")
>>> axis.parameters["table.M"]
Parameter(300.0, 'kg')
>>> run = axis.run()
>>> bool(run["table.s"].max() < 0.002)
True
>>> heavier = axis.run(set={"table.M": "320 [kg]"})
>>> heavier.measures["way"] < run.measures["way"]
True

All numbers are SI; a text with a unit is converted. Studies (`fit`, `diagnose`, `modes`, …) run the command `hyde` in a
process of its own and give its JSON as dictionaries, with the page of the study.
"""

from ._hyde import VERSION as __version__
from ._hyde import Error, ModelError, SolverError
from ._look import look
from ._model import Model, Parameter, Parameters, load
from ._run import Channel, Event, Run
from ._shown import Page, Plot, Study

__all__ = [
    "Channel",
    "Error",
    "Event",
    "Model",
    "ModelError",
    "Page",
    "Parameter",
    "Parameters",
    "Plot",
    "Run",
    "SolverError",
    "Study",
    "__version__",
    "load",
    "look",
]
