"""What an importer may rely on, tried with FMPy: each function is one behaviour. Usage: behaviour.py FOLDER

FOLDER has the FMUs of tests/models/fmu.hyde: lag3.fmu, lag2.fmu (u is an input), crushed3.fmu, crushed2.fmu, ball3.fmu,
moved3.fmu, moved2.fmu; and of tests/models/exported.hyde: bounded3.fmu, bounded2.fmu.
"""

import math
import shutil
import sys
import threading

from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Model, FMU3Slave

folder = sys.argv[1]
# While FMPy loads a library it changes the working directory, which all threads share.
loading = threading.Lock()


class Fmu:
    """An FMU that is unpacked, with its value references by name."""

    def __init__(self, name):
        self.path = f"{folder}/{name}.fmu"
        self.description = read_model_description(self.path)
        self.folder = extract(self.path)
        self.vr = {v.name: v.valueReference for v in self.description.modelVariables}
        self.messages = []

    def instance(self, kind=None, **options):
        fmi3 = self.description.fmiVersion.startswith("3")
        kind = kind or (FMU3Slave if fmi3 else FMU2Slave)
        identifier = self.description.coSimulation.modelIdentifier
        with loading:
            fmu = kind(
                guid=self.description.guid or self.description.instantiationToken,
                unzipDirectory=self.folder,
                modelIdentifier=identifier,
                instanceName="one",
            )
        fmu.instantiate(loggingOn=False, **options)
        return fmu

    def remove(self):
        shutil.rmtree(self.folder)


def begin(fmu, **times):
    if isinstance(fmu, FMU2Slave):
        fmu.setupExperiment(tolerance=1e-9, startTime=0.0, **times)
        fmu.enterInitializationMode()
    else:
        fmu.enterInitializationMode(tolerance=1e-9, startTime=0.0, **times)
    fmu.exitInitializationMode()


def get(fmu, *references):
    return fmu.getReal(references) if isinstance(fmu, FMU2Slave) else fmu.getFloat64(references)


def put(fmu, reference, value):
    if isinstance(fmu, FMU2Slave):
        fmu.setReal([reference], [value])
    else:
        fmu.setFloat64([reference], [value])


def close(value, true, tolerance):
    assert abs(value - true) <= tolerance, f"{value} instead of {true}"


def an_input_between_steps_acts_from_there(name):
    """u is 1 for 100 ms, then 3: x is two pieces of an exponential."""
    lag = Fmu(name)
    fmu = lag.instance()
    begin(fmu)
    x, t, step = 0.0, 0.0, 0.01
    for k in range(20):
        u = 1.0 if k < 10 else 3.0
        put(fmu, lag.vr["u"], u)
        fmu.doStep(t, step)
        t += step
        x = u + (x - u) * math.exp(-step / 0.05)
        close(get(fmu, lag.vr["x"])[0], x, 1e-7)
    fmu.terminate()
    fmu.freeInstance()
    lag.remove()


def parameters_are_set_and_wrong_ones_refused(name):
    lag = Fmu(name)
    fmu = lag.instance()
    put(fmu, lag.vr["T"], 0.1)
    if name.endswith("2"):
        fmu.setBoolean([lag.vr["doubled"]], [True])
        fmu.setInteger([lag.vr["steps"]], [7])
    else:
        fmu.setBoolean([lag.vr["doubled"]], [True])
        fmu.setInt32([lag.vr["steps"]], [7])
    for reference, value in [(lag.vr["T"], 0.0), (lag.vr["T"], math.nan), (lag.vr["x"], 1.0)]:
        try:
            put(fmu, reference, value)
        except Exception:
            continue
        raise AssertionError(f"variable {reference} may be {value}")
    begin(fmu)
    put(fmu, lag.vr["u"], 1.0)
    fmu.doStep(0.0, 0.1)
    x, y, count = get(fmu, lag.vr["x"], lag.vr["y"], lag.vr["count"])
    close(x, 1.0 - math.exp(-1.0), 1e-7)
    close(y, 2.0 * x, 1e-12)
    close(count, 7.0, 0.0)
    # A tunable parameter acts from here on.
    put(fmu, lag.vr["T"], 0.02)
    fmu.doStep(0.1, 0.02)
    close(get(fmu, lag.vr["x"])[0], 1.0 - (1.0 - x) * math.exp(-1.0), 1e-7)
    # Reset is as new.
    fmu.reset()
    begin(fmu)
    fmu.doStep(0.0, 0.1)
    close(get(fmu, lag.vr["x"])[0], 0.0, 0.0)
    close(get(fmu, lag.vr["T"])[0], 0.05, 0.0)
    fmu.freeInstance()
    lag.remove()


def bounds_of_parameters_that_follow_are_kept(name):
    """F = 2*Fc must not be negative: Fc = -1 N is refused where it is used."""
    bounded = Fmu(name)
    for steps in (False, True):
        fmu = bounded.instance()
        if steps:
            begin(fmu)
            fmu.doStep(0.0, 0.1)
        put(fmu, bounded.vr["Fc"], -1.0)
        try:
            fmu.doStep(0.1, 0.1) if steps else begin(fmu)
        except Exception:
            continue
        raise AssertionError("F may be -2 N")
    bounded.remove()


def an_error_leaves_a_usable_instance(name):
    """The assert of the model fails at 0.5 s; values are those of the last good time, and a reset runs again."""
    crushed = Fmu(name)
    fmu = crushed.instance()
    for _ in range(2):
        begin(fmu)
        t = 0.0
        failed = False
        for _ in range(10):
            try:
                fmu.doStep(t, 0.1)
            except Exception:
                failed = True
                break
            t += 0.1
        assert failed, "nothing has failed"
        close(t, 0.4, 1e-9)
        x = get(fmu, crushed.vr["x"])[0]
        assert 0.4 - 1e-9 <= x <= 0.5 + 1e-6, x
        try:
            fmu.doStep(t, 0.1)
            raise AssertionError("it goes on behind the failure")
        except AssertionError:
            raise
        except Exception:
            pass
        fmu.reset()
    fmu.freeInstance()
    crushed.remove()


def no_step_goes_beyond_the_stop_time(name):
    """A step beyond it is an error that changes nothing; without a stop time there is none."""
    lag = Fmu(name)
    fmu = lag.instance()
    begin(fmu, stopTime=0.1)
    put(fmu, lag.vr["u"], 1.0)
    for k in range(3):
        fmu.doStep(0.03 * k, 0.03)
    x = get(fmu, lag.vr["x"])[0]
    try:
        fmu.doStep(0.09, 0.03)
    except Exception:
        pass
    else:
        raise AssertionError("a step goes beyond the stop time")
    close(get(fmu, lag.vr["x"])[0], x, 0.0)
    fmu.doStep(0.09, 0.01 + 1e-17)
    close(get(fmu, lag.vr["x"])[0], 1.0 - math.exp(-2.0), 1e-7)
    fmu.reset()
    begin(fmu)
    fmu.doStep(0.0, 5.0)
    fmu.freeInstance()
    lag.remove()


def instances_in_threads_do_not_disturb_each_other(name):
    lag = Fmu(name)
    results = {}

    def run(u):
        fmu = lag.instance()
        begin(fmu)
        put(fmu, lag.vr["u"], u)
        for k in range(100):
            fmu.doStep(0.002 * k, 0.002)
        results[u] = get(fmu, lag.vr["x"])[0]
        fmu.freeInstance()

    threads = [threading.Thread(target=run, args=(float(u),)) for u in range(1, 9)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for u in range(1, 9):
        close(results[float(u)], u * (1.0 - math.exp(-4.0)), 1e-6 * u)
    lag.remove()


def a_saved_state_is_returned_to(name):
    """Also as bytes and in another instance: the run goes on as it did."""
    lag = Fmu(name)
    fmu = lag.instance()
    get_state, set_state, free_state, serialize, deserialize = (
        (fmu.getFMUstate, fmu.setFMUstate, fmu.freeFMUstate, fmu.serializeFMUstate, fmu.deSerializeFMUstate)
        if name.endswith("2")
        else (fmu.getFMUState, fmu.setFMUState, fmu.freeFMUState, fmu.serializeFMUState, fmu.deserializeFMUState)
    )

    def on(instance, first):
        for k in range(first, 10):
            instance.doStep(0.01 * k, 0.01)
        return get(instance, lag.vr["x"], lag.vr["count"], lag.vr["u"])

    begin(fmu)
    put(fmu, lag.vr["u"], 1.0)
    for k in range(3):
        fmu.doStep(0.01 * k, 0.01)
    state = get_state()
    data = serialize(state)
    there = get(fmu, lag.vr["x"])[0]
    straight = on(fmu, 3)
    put(fmu, lag.vr["u"], 7.0)
    fmu.doStep(0.1, 0.05)
    set_state(state)
    close(get(fmu, lag.vr["x"])[0], there, 0.0)
    again = on(fmu, 3)
    free_state(state)
    other = lag.instance()
    begin(other)
    state = (other.deSerializeFMUstate if name.endswith("2") else other.deserializeFMUState)(data)
    (other.setFMUstate if name.endswith("2") else other.setFMUState)(state)
    moved = on(other, 3)
    (other.freeFMUstate if name.endswith("2") else other.freeFMUState)(state)
    for result in (again, moved):
        close(result[0], straight[0], 1e-7)
        close(result[1], straight[1], 0.0)
        close(result[2], 1.0, 0.0)
    close(straight[0], 1.0 - math.exp(-2.0), 1e-7)
    fmu.freeInstance()
    other.freeInstance()
    lag.remove()


def directional_derivatives_are_those_of_the_equations(name):
    """T x' = u - x, y = gain x: the derivatives by u, x and T are known."""
    lag = Fmu(name)
    fmu = lag.instance()
    begin(fmu)
    put(fmu, lag.vr["u"], 1.0)
    fmu.doStep(0.0, 0.02)
    x = get(fmu, lag.vr["x"])[0]
    of = [lag.vr["der(x)"], lag.vr["y"]]
    by = {"u": (20.0, 0.0), "x": (-20.0, 1.0), "T": (-(1.0 - x) / 0.05**2, 0.0)}
    for known, true in by.items():
        found = (
            fmu.getDirectionalDerivative(of, [lag.vr[known]], [2.0])
            if name.endswith("2")
            else fmu.getDirectionalDerivative(unknowns=of, knowns=[lag.vr[known]], seed=[2.0])
        )
        for value, derivative in zip(found, true):
            close(value, 2.0 * derivative, 1e-9 * (1.0 + abs(derivative)))
    if name.endswith("3"):
        knowns = [lag.vr[known] for known in by]
        found = fmu.getAdjointDerivative(of, knowns, [1.0, 3.0], nSensitivity=len(knowns))
        for value, derivatives in zip(found, by.values()):
            close(value, derivatives[0] + 3.0 * derivatives[1], 1e-9 * (1.0 + abs(value)))
    fmu.freeInstance()
    lag.remove()


def guards_are_continuous_functions(name):
    """The guard of the ball is its height: never a sign alone, so that an importer can locate its zero."""
    ball = Fmu(name)
    fmu = ball.instance(kind=FMU3Model)
    begin(fmu)
    fmu.updateDiscreteStates()
    fmu.enterContinuousTimeMode()
    n = fmu.getNumberOfEventIndicators()
    x, z = fmu.getContinuousStates, None
    assert fmu.getNumberOfContinuousStates() == 2 and n == 1, n
    import ctypes

    state, guards = (ctypes.c_double * 2)(), (ctypes.c_double * 1)()
    x(state, 2)
    assert list(state) == [1.0, 0.0]
    seen = []
    for h in [0.9, 0.5, 0.25, 0.01, -0.01]:
        fmu.setContinuousStates((ctypes.c_double * 2)(h, -1.0), 2)
        fmu.getEventIndicators(guards, 1)
        seen.append(guards[0])
    signs = {math.copysign(1.0, z) for z in seen[:-1]}
    assert len(signs) == 1 and math.copysign(1.0, seen[-1]) not in signs, seen
    for z, h in zip(seen, [0.9, 0.5, 0.25, 0.01, -0.01]):
        close(abs(z), abs(h), 1e-15)
    fmu.freeInstance()
    ball.remove()


def the_wrong_token_makes_no_instance(name):
    lag = Fmu(name)
    lag.description.guid = lag.description.instantiationToken = "{other}"
    try:
        lag.instance()
    except Exception:
        lag.remove()
        return
    raise AssertionError("an instance of another model")


def an_event_of_a_co_simulation_is_returned_early(name):
    """With event mode a step ends at the event, and both its sides are recorded."""
    result = simulate_fmu(
        f"{folder}/{name}.fmu",
        fmi_type="CoSimulation",
        stop_time=0.6,
        output_interval=0.1,
        use_event_mode=True,
        early_return_allowed=True,
        output=["h", "v"],
    )
    t = math.sqrt(2.0 / 9.81)
    sides = [(row["h"], row["v"]) for row in result if abs(row["time"] - t) < 1e-6]
    assert len(sides) == 2, sides
    close(sides[0][1], -9.81 * t, 1e-5)
    close(sides[1][1], 0.8 * 9.81 * t, 1e-5)


def an_importer_looks_on_within_a_step(name):
    """It is called at the end of each step of the solver, reads values then, sets none, and may return early."""
    lag = Fmu(name)
    x, u = lag.vr["x"], lag.vr["u"]
    seen, asked = [], []

    def look(_, t, may_set, may_get, finished, early, wanted, wanted_s):
        assert may_get and finished and not may_set
        seen.append((t, get(fmu, x)[0]))
        try:
            put(fmu, u, 7.0)
        except Exception:
            asked.append(early)
        if early and t > 0.02:
            wanted[0], wanted_s[0] = True, t + 1e-4

    def run(**options):
        fmu = lag.instance(**options)
        begin(fmu)
        put(fmu, u, 1.0)
        return fmu

    plain = run()
    plain.doStep(0.0, 0.1)
    plain.doStep(0.1, 0.1)
    fmu = run(intermediateUpdate=look, requiredIntermediateVariables=[x])
    fmu.doStep(0.0, 0.1)
    times = [t for t, _ in seen]
    assert len(times) > 5 and times == sorted(set(times)) and times[-1] < 0.1, times
    for t, value in seen:
        close(value, 1.0 - math.exp(-t / 0.05), 1e-7)
    # The event at 34.7 ms ends a step of the solver.
    assert any(abs(t - 0.05 * math.log(2.0)) < 1e-6 for t in times), times
    assert asked == [False] * len(times), asked
    # Who looks on changes nothing.
    fmu.doStep(0.1, 0.1)
    close(get(fmu, x)[0], get(plain, x)[0], 0.0)
    fmu.freeInstance()
    plain.freeInstance()

    seen.clear()
    fmu = run(intermediateUpdate=look, requiredIntermediateVariables=[x], earlyReturnAllowed=True)
    event, _, early, t = fmu.doStep(0.0, 0.1)
    assert early and not event, (event, early)
    close(t, seen[-1][0] + 1e-4, 1e-12)
    close(get(fmu, x)[0], 1.0 - math.exp(-t / 0.05), 1e-7)
    put(fmu, u, 1.0)
    fmu.doStep(t, 1e-5)
    fmu.freeInstance()
    lag.remove()


def quantities_that_are_one_have_several_names(name):
    """Parts that are joined have one position: its names are aliases, and outputs have none."""
    moved = Fmu(name)
    names = {}
    for variable in moved.description.modelVariables:
        names.setdefault(variable.valueReference, []).append(variable)
    several = [own for own in names.values() if len(own) > 1]
    assert {"mass.s", "mass.a.s"} <= {v.name for v in names[moved.vr["mass.s"]]}, several
    assert all(v.causality == "local" for own in several for v in own), several
    moved.remove()


for fmi in ["3", "2"]:
    quantities_that_are_one_have_several_names(f"moved{fmi}")
    an_input_between_steps_acts_from_there(f"lag{fmi}")
    parameters_are_set_and_wrong_ones_refused(f"lag{fmi}")
    an_error_leaves_a_usable_instance(f"crushed{fmi}")
    instances_in_threads_do_not_disturb_each_other(f"lag{fmi}")
    a_saved_state_is_returned_to(f"lag{fmi}")
    directional_derivatives_are_those_of_the_equations(f"lag{fmi}")
    the_wrong_token_makes_no_instance(f"lag{fmi}")
    bounds_of_parameters_that_follow_are_kept(f"bounded{fmi}")
    no_step_goes_beyond_the_stop_time(f"lag{fmi}")
an_importer_looks_on_within_a_step("lag3")
guards_are_continuous_functions("ball3")
an_event_of_a_co_simulation_is_returned_early("ball3")
print("done")
