//! What is said of the files of records, tables and FMUs.

use crate::near::nearest;
use hyde_diag::{Origin, Span, diagnostics};
use hyde_syntax::ast::{Name, RecordItem};

const INSIDE: &str = "only files below the model's folder or `--data` are read";
const RELATIVE: &str = "the path is relative to the folder of the manifest, or, without a manifest, to that of the model";

diagnostics! {
    fn no_such_file((pattern, here): (&str, Span), folder: &str, in_data: bool) = error NoFiles {
        "no file is called `{pattern}` in `{folder}`"; at here, "asked for here";
        match in_data {
            false => { help "name the folder of the records: `--data DIR`"; }
            true => { help "put such files there, or write another pattern"; }
        }
    }
    fn link_out_of_folder(path: &str, here: Span) = error NoRecord {
        "`{path}` is a link to a file outside its folder"; at here, "{INSIDE}";
        help "move the file into the folder, or name its folder: `--data DIR`";
    }
    fn numbers_of_files(first: &str, other: usize, here: Span) = error NoFiles {
        "{first} for one record and {other} for another"; at here, "asked for here";
        help "give every record the same number of files, or one file";
    }
    fn no_record_of_experiment(experiment: &str, record: &str, study: Span) = error BadStudy {
        "`{experiment}` has no record `{record}`"; at study, "in this study";
    }
    fn unreadable_record(why: &str, study: Span) = error BadRecord {
        "{why}"; at study, "in this study";
    }
    fn no_files(why: &str, study: Span) = error NoFiles {
        "{why}"; at study, "in this study";
    }
    fn no_record(why: &str) = error NoRecord {
        "{why}";
    }
    fn cannot_join(record: &RecordItem, file: &str, why: &str, repair: &str) = error BadRecord {
        "`{file}`: {why}"; at record.default.as_ref().unwrap_or(&record.name).span, "the record is declared here";
        help "{repair}";
    }
    fn bad_settings(file: &str, why: &str, record: Span) = error BadRecord {
        "`{file}`: {why}"; at record, "the record is declared here";
        help "write what would stand in the experiment: `(time = \"Time\" in [ms]) every 1 [ms]`";
    }
    fn leaves_folder(record: &str, (path, here): (&str, Span)) = error NoRecord {
        "`{path}` leaves the model's folder"; at here, "{INSIDE}";
        help "give it on the command line: `--record '{record}={path}'`";
    }
    fn links_out(record: &str, (path, here): (&str, Span)) = error NoRecord {
        "`{path}` is a link to a file outside its folder"; at here, "{INSIDE}";
        help "move the file into the folder, or give it on the command line: `--record {record}=PATH`";
    }
    fn missing_record(record: &Name, why: &str) = error NoRecord {
        "the record `{}` is missing: {why}", record.text; at record.span, "declared here";
        help "give its file: `--record {}=PATH`, or the folder it is below: `--data DIR`", record.text;
    }
    fn missing_record_unused(record: &Name, why: &str) = warning NoRecord {
        "the record `{}` is missing: {why}; only the model is checked, without its experiment", record.text;
        at record.span, "declared here";
        help "give its file: `--record {}=PATH`, or the folder it is below: `--data DIR`", record.text;
    }
    fn no_table(why: &str, here: Span) = error NotDeclared {
        "a table has no file: {why}"; at here, "named here";
        help "{RELATIVE}";
    }
    fn unreadable_table(path: &str, (why, repair): (&str, &str), here: Span) = error BadRecord {
        "`{path}`: {why}"; at here, "read for this table";
        help "{repair}";
    }
    fn no_fmu(why: &str, here: Span) = error NotDeclared {
        "an FMU has no file: {why}"; at here, "named here";
        help "{RELATIVE}";
    }
    fn unusable_fmu(why: &str, here: Span, repair: &str) = error BadFmu {
        "{why}"; at here, "named here";
        help "{repair}";
    }
    /// `other` says that it is an input or an output.
    fn no_parameter_of_fmu(
        file: &str, (word, here): (&str, Span), other: bool, parameters: &[&str],
    ) = error UnknownModification {
        "the FMU `{file}` has no parameter `{word}`"; at here, "changes nothing";
        match (nearest(word, parameters.iter().copied())) {
            _ if other => {
                help "`{word}` is an input or an output: write an equation for it where the component is declared";
            }
            Some(near) => { help "did you mean `{near}`?"; }
            None if parameters.is_empty() => { help "it has no parameters but `step`"; }
            None => {
                help "it has `step`, `{}`{}", parameters[..parameters.len().min(8)].join("`, `"),
                    match parameters.len() > 8 { true => ", …", false => "" };
            }
        }
    }
    fn no_step(file: &str, here: Span) = error NoValue {
        "the FMU `{file}` proposes no communication step"; at here, "how often is it called?";
        help "write `fmu(\"{file}\", step = 1 [ms])`";
    }
    fn fmu_failed((file, component): (&str, &str), when: &str, what: &str, log: &[String], places: &[Origin]) = error FmuFailed {
        "the FMU `{file}`{} failed {when}: {what}", match component {
            "" => String::new(),
            component => format!(" of `{component}`"),
        };
        for origin in places { at origin.span, "this component"; }
        match log {
            [] if !what.starts_with("`fmi") => {}
            [] => { note "it logged no warning or error"; }
            log => { for line in log { note "it logged {line}"; } }
        }
        help "check its parameters, its inputs just before (`hyde run … --out`), and the communication step `step`";
    }
}
