//! What is said of a `diagnose` block.

use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn no_calibration((wanted, here): (&str, Span), known: &[String]) = error BadDiagnosis {
        "the file has no calibration `{wanted}`"; at here, "a diagnosis needs a calibrated model";
        match known {
            [] => { help "write `calibrate {wanted} of MODEL … end {wanted};` before it"; }
            known => { help "the file has `{}`", known.join("`, `"); }
        }
    }
    fn several_calibrations(other: Span) = error BadDiagnosis {
        "a diagnosis is of one calibration"; at other, "in this diagnosis";
        help "write a diagnosis for each calibration";
    }
    fn varies(diagnosis: Span) = error BadDiagnosis {
        "a diagnosis has no `vary`"; at diagnosis, "in this diagnosis";
        help "write `vary` in its calibration";
    }
    fn has_labels(label: Span) = error BadDiagnosis {
        "a diagnosis has no labels"; at label, "in this diagnosis";
        help "write `at` behind the records of its calibration";
    }
    fn max_effects_not_a_number(setting: Span) = error BadDiagnosis {
        "`max_effects` needs a number"; at setting, "in this diagnosis";
        help "write a number from 1 to 20: `max_effects 3;`";
    }
    fn seed_not_a_number(setting: Span) = error BadDiagnosis {
        "a seed is one whole number"; at setting, "in this diagnosis";
        help "write `seed 1;`";
    }
    fn no_such_setting(setting: &str, here: Span) = error BadDiagnosis {
        "a diagnosis has no `{setting}`"; at here, "in this diagnosis";
        help "it has `candidates`, `max_effects` and `seed`";
    }
    fn no_candidates(diagnosis: Span) = error BadDiagnosis {
        "the diagnosis has no `candidates`"; at diagnosis, "in this diagnosis";
        help "write `candidates Effects.*;`, followed by the packages of your own effects";
    }
    fn candidate_not_an_effect(setting: Span, candidate: Span) = error BadDiagnosis {
        "candidates must be effects"; at setting, "in this diagnosis"; at candidate, "names none";
        help "write `Effects.*` or the name of an effect";
    }
    fn package_without_effects((package, here): (&str, Span), with: &[&str]) = error BadDiagnosis {
        "no package `{package}` has effects"; at here, "not known";
        note "`hyde effects FILE` lists the effects that fit on the model";
        help "packages with effects are `{}`", with.join("`, `");
    }
    /// `near` was meant, or `packages` have effects.
    fn unknown_effect((effect, here): (&str, Span), near: Option<&str>, packages: &[&str]) = error BadDiagnosis {
        "no effect is called `{effect}`"; at here, "not known";
        note "`hyde effects FILE` lists the effects that fit on the model";
        match near {
            Some(near) => { help "did you mean `{near}`?"; }
            None => { help "packages with effects are `{}`", packages.join("`, `"); }
        }
    }
}
