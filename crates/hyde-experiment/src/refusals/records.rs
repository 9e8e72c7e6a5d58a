//! What is said of the files of records, and of what an experiment declares of them.

use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::{Name, RecordItem};

diagnostics! {
    fn unreadable(record: &RecordItem, file: &str, why: &str, repair: &str) = error BadRecord {
        "`{file}`: {why}"; at record.default.as_ref().unwrap_or(&record.name).span, "the record is declared here";
        help "{repair}";
    }
    fn setting_twice(record: &str, setting: &str, here: Span) = error BadRecord {
        "the record `{record}` has `{setting}` twice"; at here, "declared here";
        help "leave one of the two out";
    }
    fn unit_of_setting(setting: &str, here: Span) = error BadRecord {
        "`{setting}` has neither a unit nor a range"; at here, "declared here";
        help "units belong to columns: `column = \"x\" in [mm]`";
    }
    fn time_twice(column: Span, every: Span) = error BadRecord {
        "the time of the record is declared twice"; at column, "by a column"; at every, "by a period";
        help "leave one of the two out";
    }
    fn header_is_no_line(here: Span) = error BadRecord {
        "the header is not the number of a line"; at here, "declared here";
        help "write its line, counted from 1: `header = 5`";
    }
    fn not_a_run(here: Span) = error BadRecord {
        "the run is not the number of one"; at here, "declared here";
        help "write which run of the file is meant, counted from 1: `run = 2`";
    }
    fn not_a_separator(text: &str, here: Span) = error BadRecord {
        "`{text}` is not a separator"; at here, "declared here";
        help "write one sign, or a word for one: `separator = \";\"`, `\"tab\"`, `\"blank\"`";
    }
    fn not_a_decimal_sign(text: &str, here: Span) = error BadRecord {
        "`{text}` is not a decimal sign"; at here, "declared here";
        help "write `decimal = \".\"` or `decimal = \",\"`";
    }
    fn unknown_setting(setting: &Name) = error BadRecord {
        "a record has no setting `{}`", setting.text; at setting.span, "not known here";
        help "its settings are `time`, `column`, `columns`, `header`, `separator`, `decimal`, `encoding`, `sheet` and `run`: `time = \"Timestamp\" in [ms]`";
    }
    fn unknown_layout(layout: &Name, known: &[String]) = error BadRecord {
        "there is no layout `{}`", layout.text; at layout.span, "not known";
        help "its layouts are {}", known.join(", ");
    }
    fn bad_unit_of_time(why: &str, unit: Span) = error BadUnit {
        "{why}"; at unit, "the unit of the time";
        help "write a unit of time: `s`, `ms`, `us`";
    }
    fn bad_unit_of_column(why: &str, unit: Span) = error BadUnit {
        "{why}"; at unit, "the unit of the column";
        help "write a unit as in a model, `[mm/s]`";
    }
    fn wraps_after_nothing(here: Span) = error BadRecord {
        "a column wraps after a number above 0"; at here, "declared here";
        help "write the number of its values: `wraps 65536` for 16 bits";
    }
    fn bad_period(here: Span) = error BadRecord {
        "the sampling period is not a positive time"; at here, "a number with a unit of time is expected";
        help "write `every 1 [ms]`";
    }
}
