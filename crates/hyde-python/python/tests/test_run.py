"""The package as its users call it. Run from the root of the repository: `pytest crates/hyde-python`."""

import json
import shutil
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import hyde
from hyde import _command

ROOT = Path(__file__).resolve().parents[4]
FIRST = ROOT / "examples/first/first.hyde"
BENCH = ROOT / "examples/bench_axis/axis.hyde"


@pytest.fixture(scope="module")
def first() -> hyde.Model:
    return hyde.load(FIRST)


def test_columns_are_those_of_the_command(first: hyde.Model, tmp_path: Path) -> None:
    run = first.run()
    out = tmp_path / "out"
    subprocess.run([_command.path(), "run", str(FIRST), "--out", str(out), "--format", "json", "--quiet"], check=True)
    other = json.loads((out / "results.json").read_text())
    assert set(other) - {"t"} == set(run)
    assert np.array_equal(run.time, other["t"]["values"])
    for name in run:
        assert np.array_equal(run[name], other[name]["values"], equal_nan=True), name
        assert run.units[name] == other[name]["unit"]


def test_columns_share_memory_and_cannot_be_written(first: hyde.Model) -> None:
    run = first.run()
    assert np.shares_memory(run["table.s"], run["table.s"])
    with pytest.raises(ValueError):
        run["table.s"][0] = 1.0


def test_values_with_units_and_in_si_are_the_same(first: hyde.Model) -> None:
    runs = [first.run(set={"guide.F": value}) for value in (300.0, "300 [N]", "0.3 [kN]", (0.3, "kN"))]
    for run in runs:
        assert run.measures == runs[0].measures
    assert runs[0].measures["way"] != first.run().measures["way"]
    with pytest.raises(hyde.Error, match="kg"):
        first.run(set={"guide.F": "300 [kg]"})
    with pytest.raises(hyde.Error, match="no parameter"):
        first.run(set={"guide.G": 1.0})


def test_values_are_those_that_a_parameter_may_have(tmp_path: Path) -> None:
    model = tmp_path / "steps.hyde"
    model.write_text(
        """package steps;
model A
  parameter Integer n = 2;
  parameter Boolean on = true;
  parameter Real r(max = 10) = 1;
  Real x(start = 1, fixed = true);
  Real y = n + r + (if on then 1 else 0);
equation
  der(x) = 0;
end A;
experiment e of A
  measure Real last = max(y);
  solve ida(rtol = 1e-9) stop 1 [s];
end e;
"""
    )
    steps = hyde.load(model)
    assert steps.run(set={"n": 3, "on": 0}).measures["last"] == 4.0
    for values, why in (
        ({"n": 2.7}, "an Integer is a whole number"),
        ({"on": 5.0}, "`true` or `false`"),
        ({"r": 11.0}, "`max` is 10"),
        ({"r": float("nan")}, "finite"),
        ({"r": float("inf")}, "finite"),
        ({"x.start": 2.0}, "hyde.load"),
    ):
        with pytest.raises(hyde.Error, match=why):
            steps.run(set=values)
    with pytest.raises(hyde.Error, match="an Integer is a whole number"):
        hyde.load(model, set={"n": 2.7})


def test_structural_parameters_are_set_at_load(first: hyde.Model) -> None:
    assert first.parameters["screw.n"].structural
    with pytest.raises(hyde.Error, match="hyde.load"):
        first.run(set={"screw.n": 6})
    heavy = hyde.load(FIRST, set={"table.M": 320.0, "guide.F": "300 [N]"})
    assert float(heavy.parameters["table.M"]) == 320.0 and float(heavy.parameters["guide.F"]) == 300.0
    assert heavy.modes()["modes"] != first.modes()["modes"]
    coarse = hyde.load(FIRST, set={"screw.n": 6})
    assert len(coarse.run()) < len(first.run())


def test_gradients_are_derivatives(first: hyde.Model) -> None:
    name, step = "table.M", 1e-3
    run = first.run(gradient=[name], rtol=1e-9)
    mass = float(first.parameters[name])
    runs = [first.run(set={name: mass + sign * step}, rtol=1e-9) for sign in (-1, 1)]
    differences = (runs[1]["table.s"][-1] - runs[0]["table.s"][-1]) / (2 * step)
    assert run.gradient[name]["table.s"][-1] == pytest.approx(differences, rel=1e-3)


def test_errors_carry_their_diagnostics(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.hyde"
    wrong.write_text("package wrong;\nimport SI.*;\nmodel A\n  Length x = 1 [kg];\nend A;\n")
    with pytest.raises(hyde.ModelError) as raised:
        hyde.load(wrong)
    [diagnostic] = [own for own in raised.value.diagnostics if own["severity"] == "error"]
    assert diagnostic["code"].startswith("E")
    assert diagnostic["labels"][0]["line"] == 4
    assert "x = 1 [kg]" in str(raised.value)
    with pytest.raises(hyde.Error):
        hyde.load(tmp_path / "none.hyde")


def test_records_are_arrays_or_files(tmp_path: Path) -> None:
    model = tmp_path / "slide.hyde"
    model.write_text(
        """package slide;
import SI.*;
import Translational.*;
model Slide
  input Force F;
  Drive motor(F = F);
  Mass saddle(M = 10 [kg]);
equation
  connect(motor.a, saddle.a);
end Slide;
experiment trial(record log) of Slide
  stimulus F = log.F;
  measured log.s = saddle.s;
  solve ida(rtol = 1e-9) stop log.end;
end trial;
"""
    )
    t = np.linspace(0, 1, 101)
    # s = t^2/2 for 10 N on 10 kg, given in mm.
    record = {"t [s]": t, "F [N]": np.full_like(t, 10.0), "s [mm]": 500 * t**2}
    run = hyde.load(model, records={"log": record}).run()
    assert run.channels["s"].rms < 1e-8
    pandas = pytest.importorskip("pandas")
    run = hyde.load(model, records={"log": pandas.DataFrame(record)}).run()
    assert run.channels["s"].rms < 1e-8
    frame = run.to_pandas()
    assert frame.attrs["units"]["saddle.s"] == "m"
    assert frame["saddle.s"].iloc[-1] == pytest.approx(0.5)


def test_machine_code_of_others_is_told(tmp_path: Path) -> None:
    fmu = tmp_path / "axis.fmu"
    line = [_command.path(), "export", "fmu", str(FIRST), "push", "--quiet", "--reference", "none", "--out", str(fmu)]
    exported = subprocess.run(line, capture_output=True, text=True)
    if "libhyde_fmu" in exported.stderr:
        pytest.skip("the library of FMUs is not built")
    assert exported.returncode == 0, exported.stderr
    model = tmp_path / "apart.hyde"
    model.write_text(
        """package apart;
import SI.*;
model Apart = fmu("axis.fmu", step = 1 [ms]);
model Beside
  Apart axis;
  Real nothing = 0;
end Beside;
experiment push of Beside
  stop 0.1 [s];
end push;
"""
    )
    with pytest.warns(UserWarning, match="machine code of `axis.fmu` in this process"):
        beside = hyde.load(model)
    assert any("runs machine code of `axis.fmu`" in text for text in beside.assumptions)
    assert beside.run().time[-1] == pytest.approx(0.1)


def test_other_threads_go_on_during_a_run() -> None:
    bench = hyde.load(BENCH)
    longest, last, done = 0.0, time.perf_counter(), threading.Event()

    def beat() -> None:
        nonlocal longest, last
        while not done.is_set():
            now = time.perf_counter()
            longest, last = max(longest, now - last), now
            time.sleep(1e-3)

    thread = threading.Thread(target=beat)
    thread.start()
    begin = time.perf_counter()
    bench.run()
    took = time.perf_counter() - begin
    done.set()
    thread.join()
    assert longest < 0.5 * took


def test_a_run_can_be_interrupted() -> None:
    import _thread

    bench = hyde.load(BENCH)
    threading.Timer(0.1, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(1000):
            bench.run(rtol=1e-9)


def test_sweeps_give_each_run_or_its_error(first: hyde.Model) -> None:
    masses = [200.0, 300.0, 400.0]
    runs = first.sweep([{"table.M": mass} for mass in masses] + [{"table.X": 1.0}])
    ways = [run.measures["way"] for run in runs[:3] if isinstance(run, hyde.Run)]
    assert ways == sorted(ways, reverse=True) and len(ways) == 3
    assert isinstance(runs[3], hyde.Error)
    [kept] = first.sweep([{"table.M": 300.0}], keep=["table.s"])
    assert isinstance(kept, hyde.Run) and list(kept) == ["table.s"]
    assert np.array_equal(kept["table.s"], first.run()["table.s"])


def test_bounds_hold_for_values_set_later(first: hyde.Model) -> None:
    with pytest.raises(hyde.Error, match="table.M"):
        first.run(set={"table.M": -1.0})
    with pytest.raises(hyde.Error, match="no variable"):
        first.run(keep=["table.x"])
    with pytest.raises(hyde.Error, match="`stop`"):
        first.run(stop="1 [s]")  # type: ignore[arg-type]


def test_studies_give_what_the_command_prints(first: hyde.Model) -> None:
    modes = first.modes()
    assert modes["ok"]
    assert len(hyde.look(ROOT / "examples/new_axis/strokes.csv")[0]["channels"]) == 4
    with pytest.raises(hyde.Error, match="strokes.csv"):
        hyde.look(ROOT / "examples/bench_axis/strokes.csv")
    with pytest.raises(hyde.Error):
        first.fit()


def test_records_are_looked_for_in_the_folder_that_is_given(tmp_path: Path) -> None:
    [model, *records] = [tmp_path / "model", tmp_path / "other"]
    model.mkdir()
    [folder] = records
    folder.mkdir()
    text = BENCH.read_text()
    (model / "axis.hyde").write_text(text)
    with pytest.raises(hyde.ModelError, match="strokes.csv"):
        hyde.load(model / "axis.hyde")
    shutil.copy(BENCH.parent / "strokes.csv", folder)
    axis = hyde.load(model / "axis.hyde", data=folder)
    assert axis.run(stop=0.1).channels["x"].rms == hyde.load(BENCH).run(stop=0.1).channels["x"].rms
    # The folder of a calibration is another; the command says which it looked in.
    with pytest.raises(hyde.ModelError, match="fit-.*other"):
        axis.fit()
    with pytest.raises(hyde.ModelError, match="fit-.*cut"):
        axis.fit(data=BENCH.parent / "cut" / "none")


def test_studies_have_their_page_and_values_that_are_set(first: hyde.Model, tmp_path: Path) -> None:
    modes = first.modes("--below", "1 [kHz]")
    assert "<html" in modes.page.html and "srcdoc" in modes._repr_html_()
    heavy = first.modes("--below", "1 [kHz]", "--out", str(tmp_path), set={"table.M": 600})
    assert heavy["modes"][0]["frequency_hz"] < modes["modes"][0]["frequency_hz"]
    assert heavy.page.html == (tmp_path / "modes.html").read_text()
    modes.page.save(tmp_path / "kept.html")
    assert (tmp_path / "kept.html").read_text() == modes.page.html


def test_a_run_is_drawn(first: hyde.Model, tmp_path: Path) -> None:
    run = first.run()
    shown = run._repr_html_()
    assert "way" in shown and "<svg" in shown
    assert "<html" in run.page.html and "table.s" in run.page.html
    plot = run.plot("table.s", "table.v", title="both")
    [svg] = plot.svgs
    assert "both" in svg
    plot.save(tmp_path / "plot.svg")
    assert (tmp_path / "plot.svg").read_text() == svg
    with pytest.raises(hyde.Error, match="plot.svg"):
        plot.save(tmp_path / "plot.pdf")
    with pytest.raises(hyde.Error, match="page.html"):
        run.page.save(tmp_path / "page.pdf")
    assert not list(tmp_path.glob("*.pdf"))
    with pytest.raises(hyde.Error, match="panel of its own"):
        run.plot("table.s,table.v")
    with pytest.raises(hyde.Error, match="no column `table.x`"):
        run.plot("table.x")
    kept = first.run(keep="table.s")
    assert list(kept) == ["table.s"] and len(kept.plot().svgs) == 1
    with pytest.raises(hyde.Error, match="table.v"):
        kept.plot("table.v")


def test_names_that_are_not_there_are_told_with_those_like_them(first: hyde.Model) -> None:
    with pytest.raises(KeyError, match="did you mean `table.M`"):
        first.parameters["table.m"]
    run = first.run(gradient="table.M")
    assert list(run.gradient) == ["table.M"]
    with pytest.raises(KeyError, match="no column `tabel.s`; did you mean `table.s`"):
        run["tabel.s"]
    with pytest.raises(hyde.Error, match="did you mean `table.M`"):
        first.run({"tabl.M": 1.0})


def test_sweeps_tell_how_far_they_are_and_end_when_interrupted(first: hyde.Model) -> None:
    told: list[tuple[int, int]] = []
    first.sweep(({"table.M": mass} for mass in (200.0, 300.0)), progress=lambda done, of: told.append((done, of)))
    assert told == [(1, 2), (2, 2)]

    def stop(done: int, of: int) -> None:
        raise KeyboardInterrupt

    begin = time.perf_counter()
    first.run()
    once = time.perf_counter() - begin
    with pytest.raises(KeyboardInterrupt):
        first.sweep([{"table.M": 300.0}] * 1000, progress=stop)
    assert time.perf_counter() - begin < 200 * once


def test_tables_have_units(first: hyde.Model) -> None:
    run = first.run()
    arrow = pytest.importorskip("pyarrow")
    table = run.to_arrow()
    assert table.schema.field("table.s").metadata == {b"unit": b"m"}
    assert table["table.s"].to_numpy()[-1] == run["table.s"][-1]
    assert arrow.types.is_float64(table.schema.field("t").type)
    polars = pytest.importorskip("polars")
    frame = run.to_polars()
    assert isinstance(frame, polars.DataFrame)
    assert frame["table.s [m]"][-1] == run["table.s"][-1]
