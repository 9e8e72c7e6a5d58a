//! Every diagnostic of `calibrate` blocks, as data.

use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn gives_values(values: Span) = error BadStudy {
        "a calibration finds values itself"; at values, "in this study";
        help "give a range: `vary guide.F in 100 .. 400 [N];`";
    }
    fn varies_no_parameter(target: Span) = error BadStudy {
        "a calibration varies parameters"; at target, "in this study";
        help "write `vary uncertain;`, or name them: `vary guide.F, guide.b;`";
    }
    fn varies_all_of(part: &str, here: Span) = error BadStudy {
        "`vary` takes parameters by name, and `{part}.*` is not one"; at here, "in this study";
        help "name them, `vary {part}.k, {part}.d;` (`hyde params FILE` lists them), or write `vary uncertain;`: all that have a spread";
    }
    fn uncertain_per(label: &str, per: Span) = error BadStudy {
        "`uncertain` stands for many parameters"; at per, "in this study";
        help "name those that differ per {label}: `vary uncertain; vary saddle.M per {label};`";
    }
    fn varies_effects(study: Span) = error BadStudy {
        "a calibration puts no effects on the model"; at study, "in this study";
        help "calibrate a model that has them: `model B = A with E on site;`";
    }
    fn setting_with_labels(setting: &str, here: Span) = error BadStudy {
        "`{setting}` has no labels"; at here, "in this study";
        help "write `at` behind the records: `fit bench(\"full-*.csv\") at load = 200 [kg];`";
    }
    fn starts_not_a_number(setting: Span) = error BadStudy {
        "how many starts?"; at setting, "in this study";
        help "write a number from 1 to 100: `starts 4;`";
    }
    fn no_such_setting(setting: &str, here: Span) = error BadStudy {
        "a calibration has no `{setting}`"; at here, "in this study";
        help "it has `fit`, `holdout`, `vary` and `starts`";
    }
    fn no_fit(study: Span) = error BadStudy {
        "nothing says which records to calibrate on"; at study, "in this study";
        help "write `fit bench(\"fit-*.csv\");`";
    }
    fn no_vary(study: Span) = error BadStudy {
        "nothing says what may be varied"; at study, "in this study";
        help "write `vary uncertain;`, or name parameters: `vary guide.F, guide.b;`";
    }
    fn label_twice(label: &str, again: Span) = error BadStudy {
        "the label `{label}` has two values"; at again, "in this study";
        help "write a `fit` for each value";
    }
    fn label_not_comparable(label: &str, (shown, here): (&str, Span), (other, there): (&str, Span)) = error BadStudy {
        "the label `{label}` is `{shown}` here and `{other}` elsewhere, which cannot be compared";
        at here, "in this study"; at there, "the other value";
        help "write all values of a label with units of one kind, or all as texts";
    }
    /// `known` are labels that can stand in its place.
    fn no_such_label(label: &str, per: Span, known: &[String]) = error BadStudy {
        "no records have a label `{label}`"; at per, "in this study";
        help "write it behind the records, `fit bench(\"full-*.csv\") at {label} = 200 [kg];`; this calibration has {}",
            known.join(", ");
    }
    fn label_of_every_record(label: &str, here: Span) = error BadStudy {
        "every record has its own value of `{label}`"; at here, "in this study";
        help "leave the label out, `vary saddle.M per record;` needs none, or give it another name";
    }
    fn value_of_label(label: &str, value: Span) = error BadStudy {
        "the value of the label `{label}` is not a number or a text"; at value, "in this study";
        help "write `at load = 200 [kg]` or `at load = \"full\"`";
    }
    fn not_a_source(setting: &str, here: Span) = error BadStudy {
        "`{setting}` takes an experiment with the files of its records"; at here, "in this study";
        help "write `{setting} bench(\"fit-*.csv\");`: patterns are below `--data DIR`";
    }
    fn bounds_not_ascending(range: Span) = error BadStudy {
        "the bounds of a parameter are two numbers, the smaller first"; at range, "in this study";
        help "write `vary guide.F in 100 .. 400 [N];`";
    }
}
