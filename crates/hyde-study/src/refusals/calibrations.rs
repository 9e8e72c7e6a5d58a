//! What is said of calibrations, of the records designed for them, and of what cannot be observed.

use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn several_values(calibration: &str, per: Span) = error BadStudy {
        "the calibration `{calibration}` has a parameter with several values, and this study takes one for all records";
        at per, "a value each";
        help "write a second calibration without `per`, of the records that share all values, and name it";
    }
    fn several_experiments(calibration: &str, here: Span, count: usize) = error BadStudy {
        "the calibration `{calibration}` is of {count} experiments, and this study takes one";
        at here, "this calibration";
        help "write a second calibration whose records are of one experiment, and name it";
    }
    fn no_experiment(experiment: &str, here: Span) = error BadStudy {
        "the file has no experiment `{experiment}`"; at here, "asked for here";
        help "name an experiment of the file, `fit bench(\"fit-*.csv\");`";
    }
    fn experiment_of_another_model(
        (experiment, here): (&str, Span), model: &str, calibration: &str, models: &[String], of_experiment: bool,
    ) = error BadStudy {
        "`{experiment}` is an experiment of `{model}`, the calibration is of `{}`", models.join("`, `");
        at here, "asked for here";
        match (of_experiment) {
            true => { help "a calibration is of a model: `calibrate {calibration} of {model}`"; }
            false => { help "name all models that share parameters: `calibrate {calibration} of {}, {model}`", models.join(", "); }
        }
    }
    fn model_twice(model: &str, study: Span) = error BadStudy {
        "the model `{model}` is named twice"; at study, "in this study";
        help "name each model once, and records of an experiment of each: `fit bench(\"fit-*.csv\");`";
    }
    fn model_without_record(model: &str, study: Span) = error BadStudy {
        "no record of the calibration is of the model `{model}`"; at study, "in this study";
        help "name each model once, and records of an experiment of each: `fit bench(\"fit-*.csv\");`";
    }
    fn pattern_of_no_record(experiment: &str, records: &str, pattern: Span) = error BadStudy {
        "`{experiment}` has {records}"; at pattern, "no record is assigned to this pattern";
        help "name the record of the pattern: `fit bench(file = \"fit-*.csv\");`";
    }
    fn record_twice((record, experiment): (&str, &str), first: Span, again: Span, word: &str) = error BadStudy {
        "the record `{record}` of `{experiment}` is named twice, and would count twice";
        at again, "again here"; at first, "first here";
        help "name each record in one `{word}` only";
    }
    fn fitted_and_held_out((record, experiment): (&str, &str), fitted: Span, held: Span) = error BadStudy {
        "the record `{record}` of `{experiment}` is fitted, and held out as well";
        at held, "held out here"; at fitted, "fitted here";
        help "only records that the fit does not read test the model: name it in one of the two, or narrow the pattern of the other";
    }
    fn no_label((parameter, label): (&str, &str), (record, here): (&str, Span), per: Span) = error BadStudy {
        "`{parameter}` has a value for each `{label}`, and `{record}` has no `{label}`";
        at here, "the value of `{label}` of these records is missing"; at per, "a value each";
        help "write it behind the records: `fit bench(\"full-*.csv\") at {label} = 200 [kg];`; without a label there are `per record` and `per experiment`";
    }
    /// `only` is the value that all records have.
    fn same_label((parameter, label): (&str, &str), per: Span, only: Option<&str>) = error BadStudy {
        "`{parameter}` has a value for each `{label}`, and all records have the same{}",
            only.map_or_else(String::new, |only| format!(", `{only}`"));
        at per, "one value only";
        help "leave `per {label}` out, or name records with another value of it";
    }
    fn each_record_held_out(parameter: &str, (record, here): (&str, Span), per: Span) = error BadStudy {
        "`{parameter}` has a value for each record, and `{record}` is held out";
        at here, "held out here"; at per, "a value each";
        help "name the condition that fitted and held-out records share: `fit bench(\"a-*.csv\") at load = 200 [kg]; holdout bench(\"b-*.csv\") at load = 200 [kg]; vary {parameter} per load;`";
    }
    fn label_not_fitted((parameter, label): (&str, &str), value: &str, here: Span, per: Span) = error BadStudy {
        "`{parameter}` has a value for each `{label}`, and no fitted record has `{value}`";
        at here, "held out here"; at per, "a value each";
        help "hold out records with a value of `{label}` that is fitted";
    }
    fn no_label_held_out((parameter, label): (&str, &str), (record, here): (&str, Span), per: Span) = error BadStudy {
        "`{parameter}` has a value for each `{label}`, and `{record}` has no `{label}`";
        at here, "held out here"; at per, "a value each";
        help "write it behind the records: `holdout bench(\"c-*.csv\") at {label} = 200 [kg];`";
    }
    /// Each model has the parameter in a unit.
    fn units_differ(
        parameter: &str, (unit, model): (&str, &str), (other, second): (&str, &str), records: Option<Span>,
    ) = error CannotVary {
        "`{parameter}` is in {unit} in `{model}` and in {other} in `{second}`";
        if let Some(records) = records { at records, "records of both models"; }
        help "parameters with one name are one parameter: rename one of them";
    }
    fn nothing_uncertain(here: Span) = error CannotVary {
        "no parameter of the model is uncertain"; at here, "asked for here";
        help "declare the uncertainty of a parameter: `parameter Mass M = 310 [kg] ~ ±8%;`";
    }
    fn cannot_vary(parameter: &str, here: Span, why: &str) = error CannotVary {
        "`{parameter}` cannot be varied"; at here, "{why}";
        help "`hyde params FILE` lists the parameters";
    }
    fn varies_by_steps((parameter, kind): (&str, &str), here: Span) = error CannotVary {
        "`{parameter}` cannot be varied: it is {kind}"; at here, "a fit moves a parameter by small steps";
        help "leave it out here, and calibrate once for each of its values: `hyde fit FILE --set {parameter}=…`";
    }
    fn uncertain_step((parameter, kind): (&str, &str), here: Span, declared: Span) = error CannotVary {
        "`{parameter}` is uncertain and cannot be varied: it is {kind}";
        at here, "a fit moves a parameter by small steps"; at declared, "has a spread";
        help "remove its `~`, and calibrate once for each of its values: `hyde fit FILE --set {parameter}=…`";
    }
    fn negative_noise(channel: &str, noise: &str, here: Span) = error CannotObserve {
        "the noise of the channel `{channel}` is {noise}: a standard deviation is not negative"; at here, "measured here";
        help "write it without the sign";
    }
    fn nothing_to_design(experiment: &str, study: Span) = error BadStudy {
        "no stimulus of `{experiment}` reads a column that is not measured"; at study, "requested by this study";
        help "a record is designed for a column that drives the model: `stimulus r = file.r;`";
    }
    fn no_channel(record: &str, column: &str, study: Span) = error CannotObserve {
        "no channel determines the column `{record}.{column}`"; at study, "requested by this study";
        help "every recorded column needs its `measured` or `replay`, and no `slope` alone";
    }
    fn cannot_simulate(why: &str, study: Span) = error CannotObserve {
        "records of this axis cannot be simulated: {why}"; at study, "asked for by this study";
        help "run its experiment first: `hyde run FILE`; every recorded column needs its `measured` or `replay`";
    }
    fn record_not_observed(record: &str, (why, repair): (&str, &str), study: Span) = error CannotObserve {
        "`{record}` cannot be observed: {why}"; at study, "asked for by this study";
        help "{repair}";
    }
    fn model_not_observed((why, repair): (&str, &str), study: Span) = error CannotObserve {
        "the model cannot be observed: {why}"; at study, "asked for by this study";
        help "{repair}";
    }
    /// `still` says that an observer does not move.
    fn nothing_learned(
        calibration: &str, here: Span, parameters: &[String], causes: &[String], still: bool,
    ) = error NothingLearned {
        "the calibration `{calibration}` cannot determine any parameter: no innovation depends on {}", parameters.join(", ");
        at here, "asked for here";
        for cause in causes { note "{cause}"; }
        match still {
            true => {
                help "drive the model with the recorded input that moved the axis, `stimulus F = file.force;`, and declare a channel that moves as `measured`";
            }
            false => { help "record a motion that these parameters influence, or `vary` others"; }
        }
    }
}
