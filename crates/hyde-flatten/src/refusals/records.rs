//! What is said of records: their columns, what is measured, replayed, and compared as a response.

use crate::words::{listed, nearest};
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::Reference;
use hyde_syntax::member;
use hyde_units::NamedUnit;

diagnostics! {
    fn not_a_column(reference: &Reference, here: Span) = error NoColumn {
        "`{}` is not a column of a record", reference.dotted();
        at here, "the left side of `=` must be the measured column";
        help "write `measured file.x = saddle.s;`";
    }
    fn unknown_preparation(here: Span) = error BadArguments {
        "a record is prepared with `lowpass(x, f)`, `slope(x)`, or a factor"; at here, "not one of these";
    }
    fn measures_no_column(here: Span) = error NoColumn {
        "the measured quantity must be a column of a record"; at here, "no column";
        help "write `measured file.x = saddle.s;`";
    }
    fn which_column(record: &str, here: Span) = error NoColumn {
        "which column of the record?"; at here, "names a record";
        help "write `{record}.column`";
    }
    fn unusable_column(record: &str, here: Span, (why, repair): (&str, &str)) = error BadRecord {
        "the record `{record}`: {why}"; at here, "read here";
        help "{repair}";
    }
    fn no_column((record, column): (&str, &str), here: Span, known: &[&str]) = error NoColumn {
        "the record `{record}` has no column `{column}`"; at here, "not in its header";
        match (nearest(column, known.iter().copied())) {
            Some(near) => {
                note "its columns are {}", listed(known);
                help "did you mean `{record}.{}`?{}", member(near), match member(near) == near {
                    true => "",
                    false => " A name that is not a word is written in quotes",
                };
            }
            None if known.is_empty() => { help "the record was not given: `--record NAME=PATH`"; }
            None => { help "its columns are {}", as_written(known); }
        }
    }
    fn no_part_of_column(part: &str, here: Span) = error NoColumn {
        "a column has no `{part}`"; at here, "unknown";
        help "write `.next` for the value of the next sample, `.first` for the first, `.mean` for the mean";
    }
    /// A column without a unit that is read in `taken`; `unit` is at the end of its name.
    fn unit_in_name(
        (record, column): (&str, &str), read: Span, (taken, unit): (&NamedUnit, &NamedUnit),
    ) = error BadRecord {
        "`{record}.{}` has no unit: is it in {taken}, or in {unit} as its name says?", member(column);
        at read, "read in {taken} here";
        help "say the unit: `record {record}(column = {column:?} in [{unit}])`, or `in [{taken}]`";
    }
    fn nothing_to_replay(target: &Reference) = error CannotReplay {
        "`{}` has no equation of its own", target.dotted(); at target.span, "cannot be replayed";
        note "a replayed column replaces the one equation that determines its variable";
        help "replay an input, an output, or a variable declared with a value: `site Force force = …;`";
    }
    fn replays_array(target: &Reference) = error CannotReplay {
        "`{}` is an array", target.dotted(); at target.span, "a column replaces a single variable";
        help "replay a variable of its own: `Force F1 = …;`, which the element is made of";
    }
    fn response_takes_two(call: Span) = error BadArguments {
        "`response` takes an input of the model and a variable that responds to it"; at call, "not two arguments";
        help "write `response(i, motor.phi)`";
    }
    fn not_a_response(here: Span) = error BadResponse {
        "this is not a measured response"; at here, "cannot be compared with a frequency response";
        help "write `response(file.u, file.y)` with columns over time, or `complex(frf.re, frf.im)` or `polar(frf.gain, frf.phase)` with columns over frequency";
    }
    fn two_records(here: Span, first: &str, second: &str) = error BadResponse {
        "a response is measured in one record"; at here, "columns of `{first}` and of `{second}`";
    }
    fn filtered_response(column: Span) = error BadResponse {
        "a column of a measured response may only be multiplied by a factor"; at column, "filtered";
    }
    fn over_frequency(column: &str, read: Span) = error BadRecord {
        "`{column}` is over frequency, not over time"; at read, "read over time";
        help "only a measured response has such a record: `measured complex(frf.re, frf.im) = response(u, y);`";
    }
}

/// The names of columns as a model writes them.
fn as_written(columns: &[&str]) -> String {
    let written: Vec<_> = columns.iter().map(|name| member(name)).collect();
    let written: Vec<&str> = written.iter().map(|name| &**name).collect();
    let quoted = match written == columns {
        true => "",
        false => "; a name that is not a word is written in quotes",
    };
    format!("{}{quoted}", listed(&written))
}
