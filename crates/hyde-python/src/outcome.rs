//! [`Outcome`]: what a run leaves, as NumPy arrays, and again as a run, for whoever draws it.

use hyde_experiment::Run;
use hyde_program::Program;
use hyde_signal::Series;
use numpy::{PyArray1, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What a run leaves. All values are SI.
#[pyclass(frozen, module = "hyde._hyde")]
pub(crate) struct Outcome {
    /// The times of the rows; an instant with an event has two.
    #[pyo3(get)]
    time: Py<PyArray1<f64>>,
    /// Columns by name.
    #[pyo3(get)]
    columns: Py<PyDict>,
    /// The SI unit of each column.
    #[pyo3(get)]
    units: Py<PyDict>,
    /// Derivatives: by the name of the parameter, then of the column.
    #[pyo3(get)]
    gradient: Py<PyDict>,
    /// Measures and expectations: name, value, whether it is an expectation, whether it holds.
    #[pyo3(get)]
    measures: Vec<(String, f64, bool, bool)>,
    /// Time in s, and cause.
    #[pyo3(get)]
    events: Vec<(f64, String)>,
    /// Measured channels: name, SI unit, root mean square of the difference, noise.
    #[pyo3(get)]
    channels: Vec<(String, String, f64, Option<f64>)>,
    /// Times, what was measured, what the model has: for each channel.
    #[pyo3(get)]
    compared: Py<PyDict>,
    /// Steps, events, ticks.
    #[pyo3(get)]
    counts: (u64, u64, u64),
    /// The run, with nothing in its time, its columns and its channels: that is in the arrays.
    rest: Run,
    /// The arrays of the columns, in the order of the results.
    arrays: Vec<Py<PyArray1<f64>>>,
}

impl Outcome {
    /// Takes the columns of a run: each becomes the memory of its array.
    pub(crate) fn of(py: Python<'_>, program: &Program, mut run: Run) -> PyResult<Self> {
        let results = &mut run.results;
        let (columns, units) = (PyDict::new(py), PyDict::new(py));
        let columns_of_rows = std::mem::take(&mut results.columns).into_iter();
        let arrays = columns_of_rows.map(|series| array(py, series.values().into_owned()));
        let arrays: Vec<_> = arrays.collect::<PyResult<_>>()?;
        for (&number, &place) in results.outputs.iter().zip(&results.places) {
            let output = &program.outputs[number];
            if !output.auxiliary {
                columns.set_item(&output.name, &arrays[place])?;
                units.set_item(&output.name, output.dimension.usual_unit())?;
            }
        }
        let gradient = PyDict::new(py);
        if let Some(found) = results.gradient.take() {
            for (place, of_parameter) in found.parameters.iter().zip(found.columns) {
                let Some((_, name)) = program.parameter_at(*place) else {
                    continue;
                };
                let own = PyDict::new(py);
                for (&number, values) in results.outputs.iter().zip(of_parameter) {
                    let output = &program.outputs[number];
                    if !output.auxiliary {
                        own.set_item(&output.name, array(py, values)?)?;
                    }
                }
                gradient.set_item(name, own)?;
            }
        }
        let time = array(py, std::mem::take(&mut results.time))?.unbind();
        let events = results.events.iter();
        let events = events.map(|event| (event.t, event.cause.clone())).collect();
        let statistics = &results.statistics;
        let counts = (statistics.steps, statistics.events, statistics.ticks);
        let measures = run.measures.iter();
        let measures =
            measures.map(|own| (own.name.clone(), own.value, own.expectation, own.holds));
        let measures = measures.collect();
        let compared = PyDict::new(py);
        let mut channels = Vec::new();
        for channel in &mut run.channels {
            let unit = channel.unit.unit().dimension.usual_unit();
            let arrays = (
                array(py, std::mem::take(&mut channel.time))?,
                array(py, std::mem::take(&mut channel.measured))?,
                array(py, std::mem::take(&mut channel.simulated))?,
            );
            compared.set_item(&channel.name, arrays)?;
            channels.push((channel.name.clone(), unit, channel.rms, channel.noise));
        }
        Ok(Self {
            time,
            columns: columns.unbind(),
            units: units.unbind(),
            gradient: gradient.unbind(),
            measures,
            events,
            channels,
            compared: compared.unbind(),
            counts,
            arrays: arrays.into_iter().map(Bound::unbind).collect(),
            rest: run,
        })
    }

    /// The run as it was, with copies of the arrays.
    pub(crate) fn run(&self, py: Python<'_>) -> PyResult<Run> {
        let mut run = self.rest.clone();
        run.results.time = self.time.bind(py).to_vec()?;
        let series = |array: &Py<PyArray1<f64>>| -> PyResult<Series> {
            Ok(array.bind(py).to_vec()?.into_iter().collect())
        };
        run.results.columns = self.arrays.iter().map(series).collect::<PyResult<_>>()?;
        for channel in &mut run.channels {
            let arrays = self.compared.bind(py).get_item(&channel.name)?;
            let Some(arrays) = arrays else { continue };
            (channel.time, channel.measured, channel.simulated) = arrays.extract()?;
        }
        Ok(run)
    }

    /// Whether only some columns were kept.
    pub(crate) fn is_part(&self, program: &Program) -> bool {
        self.rest.results.outputs.len() < program.outputs.len()
    }

    /// The numbers of the outputs that were kept and are shown.
    pub(crate) fn kept(&self, program: &Program) -> Vec<usize> {
        let kept = self.rest.results.outputs.iter().copied();
        kept.filter(|&number| !program.outputs[number].auxiliary)
            .collect()
    }
}

/// A vector as an array that nobody writes to: a column may be looked at by several.
fn array(py: Python<'_>, values: Vec<f64>) -> PyResult<Bound<'_, PyArray1<f64>>> {
    let array = PyArray1::from_vec(py, values);
    array.readwrite().make_nonwriteable();
    Ok(array)
}
