"""Makes the FMUs that tests import: `foreign.py FOLDER`. Those of pythonfmu are FMI 2.0, those of pythonfmu3 FMI 3.0;
`Container.fmu` is FMPy's container FMU around `lag.fmu`, if that is in the folder."""
import subprocess
import sys
import textwrap
from pathlib import Path

import fmpy  # noqa: F401  the importer is there
import pythonfmu  # noqa: F401
import pythonfmu3  # noqa: F401

folder = Path(sys.argv[1])

TWO = """
import ctypes
from pythonfmu import Boolean, Fmi2Causality as C, Fmi2Slave, Fmi2Variability as V, Integer, Real
"""

THREE = """
import math
from pythonfmu3 import Boolean, DefaultExperiment, Float64, Fmi3Causality as C, Fmi3Slave, Fmi3Variability as V, Int32, Unit
"""

MODELS = {
    # Counts its steps; stops where its input reaches 3, ends its process where it reaches 5.
    "Stair": (TWO, """
        class Stair(Fmi2Slave):
            def __init__(self, **kwargs):
                super().__init__(**kwargs)
                self.height, self.u, self.y, self.n, self.odd = 0.5, 0.0, 0.0, 0, False
                self.register_variable(Real("height", causality=C.parameter, variability=V.tunable))
                self.register_variable(Real("u", causality=C.input))
                self.register_variable(Real("y", causality=C.output))
                self.register_variable(Integer("n", causality=C.output))
                self.register_variable(Boolean("odd", causality=C.output))

            def do_step(self, current_time, step_size):
                print("a library may print")
                if self.u >= 5:
                    ctypes.string_at(0)
                self.n += 1
                self.odd = self.n % 2 == 1
                self.y = self.height * self.n
                return self.u < 3
        """),
    # The position controller of the Y axis without its quantiser: an error in m, a voltage.
    "Position": (TWO, """
        class Position(Fmi2Slave):
            def __init__(self, **kwargs):
                super().__init__(**kwargs)
                self.A, self.r, self.s, self.V1 = 1.0, 0.0, 0.0, 0.0
                self.register_variable(Real("A", causality=C.parameter, variability=V.fixed))
                self.register_variable(Real("r", causality=C.input))
                self.register_variable(Real("s", causality=C.input))
                self.register_variable(Real("V1", causality=C.output))

            def do_step(self, current_time, step_size):
                self.V1 = self.A * min(max(1000 * (self.r - self.s), -10), 10)
                return True
        """),
    # A ball that bounces, in closed form; its parameter is in mm, its height in m.
    "Ball": (THREE, """
        class Ball(Fmi3Slave):
            def __init__(self, **kwargs):
                super().__init__(**kwargs)
                self.default_experiment = DefaultExperiment(step_size=0.01)
                self.register_units([Unit(name="mm", m=1, factor=0.001), Unit(name="m", m=1)])
                self.time, self.drop, self.h, self.bounces = 0.0, 1000.0, 1.0, 0
                self.register_variable(Float64("time", causality=C.independent, variability=V.continuous))
                self.register_variable(Float64("start.height", causality=C.parameter, variability=V.fixed, unit="mm",
                    getter=lambda: self.drop, setter=lambda value: setattr(self, "drop", value)))
                self.register_variable(Float64("h", causality=C.output, unit="m"))
                self.register_variable(Int32("bounces", causality=C.output))

            def exit_initialization_mode(self):
                self.at(0.0)

            def at(self, t):
                g, fall = 9.81, self.drop / 1000
                first, self.bounces = math.sqrt(2 * fall / g), 0
                if t < first:
                    self.h = fall - g * t * t / 2
                    return
                t, v, self.bounces = t - first, g * first / 2, 1
                while t >= 2 * v / g and self.bounces < 30:
                    t, v, self.bounces = t - 2 * v / g, v / 2, self.bounces + 1
                self.h = v * t - g * t * t / 2

            def do_step(self, current_time, step_size):
                self.at(current_time + step_size)
                return True
        """),
    # A lag, exact for an input that is held.
    "Lag": (THREE, """
        class Lag(Fmi3Slave):
            def __init__(self, **kwargs):
                super().__init__(**kwargs)
                self.time, self.T, self.u, self.y = 0.0, 0.02, 0.0, 0.0
                self.register_variable(Float64("time", causality=C.independent, variability=V.continuous))
                self.register_variable(Float64("T", causality=C.parameter, variability=V.fixed))
                self.register_variable(Float64("u", causality=C.input))
                self.register_variable(Float64("y", causality=C.output))

            def do_step(self, current_time, step_size):
                self.y += (self.u - self.y) * -math.expm1(-step_size / self.T)
                return True
        """),
}


def container(lag: Path) -> None:
    from fmpy import read_model_description
    from fmpy.container_fmu.cli import create_container_fmu
    from fmpy.container_fmu.config import Component, Configuration
    from fmpy.model_description import CoSimulation, ModelDescription, ModelVariable

    inner = read_model_description(lag)
    variables = {own.name: own for own in inner.modelVariables}
    component = Component(name="lag", filename=lag, modelDescription=inner)
    outer = ModelDescription(
        fmiVersion="3.0", modelName="Container", instantiationToken="container",
        coSimulation=CoSimulation(modelIdentifier="container_fmu", fixedInternalStepSize=1e-3),
    )
    mapped = {}
    for name, causality, start in (("time", "independent", None), ("u", "input", None), ("F", "output", None)):
        own = ModelVariable(
            type="Float64", name=name, causality=causality, variability="continuous", start=start,
            initial="calculated" if causality == "output" else None,
        )
        outer.modelVariables.append(own)
        if name != "time":
            mapped[name] = (own, [(component, variables[name])])
    configuration = Configuration(
        parallelDoStep=False, modelDescription=outer, components=[component], connections=[],
        variableMappings=Mapping(mapped.values()),
    )
    unpacked = folder / "unpacked"
    unpacked.mkdir()
    create_container_fmu(configuration, unpacked, folder / "Container.fmu")


class Mapping:
    """A dictionary whose keys need no hash: variables of FMPy have none."""

    def __init__(self, pairs):
        self.pairs = list(pairs)

    def items(self):
        return self.pairs


for name, (imports, text) in MODELS.items():
    script = folder / f"{name.lower()}.py"
    script.write_text(imports + textwrap.dedent(text))
    module = "pythonfmu" if imports is TWO else "pythonfmu3"
    subprocess.run([sys.executable, "-m", module, "build", "-f", script, "-d", folder], check=True)
if (folder / "lag.fmu").is_file():
    container(folder / "lag.fmu")
