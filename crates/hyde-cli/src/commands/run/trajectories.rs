//! The results of a run as Dymola and OpenModelica write them: `dsres.mat`, version 1.1, transposed.
//!
//! `name` and `description` have a column each variable. `dataInfo` has one too: the matrix in which its values are, the
//! row there with its sign, 0 for linear interpolation, -1 for no values beyond the ends. `data_1` has a row each
//! parameter and two columns, begin and end of the run; `data_2` a row each variable and a column each sample; the time is
//! the first row of both. Two columns of one time are an event.

use super::folder::columns;
use hyde_program::Program;
use hyde_signal::Written;
use hyde_signal::mat::Level4;
use hyde_sim::Results;

pub(super) fn mat(program: &Program, results: &Results) -> Vec<u8> {
    let columns = columns(program, results);
    let (mut names, mut descriptions, mut places) = (Vec::new(), Vec::new(), Vec::new());
    let values: Vec<_> = columns.iter().map(Written::values).collect();
    let time = values.first().map_or(&[][..], AsRef::as_ref);
    let mut constants: Vec<Vec<f64>> = vec![vec![
        time.first().copied().unwrap_or(0.0),
        time.last().copied().unwrap_or(0.0),
    ]];
    for (number, column) in columns.iter().enumerate() {
        let is_time = number == 0;
        names.push(match is_time {
            true => "time".to_owned(),
            false => column.name.clone().into_owned(),
        });
        let unit = column.unit.as_ref().map(|unit| {
            let si = unit.unit().dimension.usual_unit();
            (si, unit.text().to_owned())
        });
        descriptions.push(match unit {
            Some((si, shown)) => described("", &si, &shown),
            None => String::new(),
        });
        let matrix = if is_time { 0 } else { 2 };
        places.extend([matrix, row(number), 0, -1]);
    }
    for parameter in &program.parameters {
        for place in parameter.place..parameter.place + parameter.len {
            let name = match program.parameter_at(place) {
                Some((_, name)) => name,
                None => continue,
            };
            // A free input is a parameter and a reported quantity.
            if names.contains(&name) {
                continue;
            }
            names.push(name);
            descriptions.push(described(
                parameter.source.as_deref().unwrap_or_default(),
                &parameter.dimension.usual_unit(),
                parameter.unit.text(),
            ));
            places.extend([1, row(constants.len()), 0, 0]);
            constants.push(vec![results.parameters[place]; 2]);
        }
    }
    let rows = columns.len();
    let samples = 0..time.len();
    let values = samples.flat_map(|k| values.iter().map(move |column| column[k]));
    let values: Vec<f64> = values.collect();
    let ends = [0, 1].into_iter();
    let ends: Vec<f64> = ends
        .flat_map(|end| constants.iter().map(move |both| both[end]))
        .collect();
    Level4::default()
        .texts_in_rows("Aclass", &["Atrajectory", "1.1", "", "binTrans"])
        .texts_in_columns("name", &names)
        .texts_in_columns("description", &descriptions)
        .whole("dataInfo", 4, &places)
        .numbers("data_1", constants.len(), &ends)
        .numbers("data_2", rows, &values)
        .into_bytes()
}

/// Rows count from 1.
fn row(number: usize) -> i32 {
    i32::try_from(number + 1).unwrap_or(i32::MAX)
}

/// `what it is [m|mm]`: the unit of the values, and that for people.
fn described(text: &str, si: &str, shown: &str) -> String {
    let unit = match (si == "1", si == shown || shown == "1") {
        (true, _) => String::new(),
        (false, true) => format!("[{si}]"),
        (false, false) => format!("[{si}|{shown}]"),
    };
    let text: String = text.chars().filter(char::is_ascii).collect();
    format!("{text} {unit}").trim().to_owned()
}
