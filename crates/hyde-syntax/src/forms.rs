//! How statements that begin with a word of the language are written: what a message shows where one of them is broken and
//! nothing more is known.

/// Where a statement stands. The tests parse every example there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    File,
    Class,
    Equation,
    Effect,
    Mode,
    Experiment,
    Study,
}

struct Form {
    word: &'static str,
    #[cfg_attr(not(test), expect(dead_code, reason = "read by the tests"))]
    place: Place,
    /// A sentence with one or two examples in back quotes.
    help: &'static str,
}

/// How a statement is written that begins with the word that a text begins with, if it is one of these.
pub(crate) fn of(statement: &str) -> Option<&'static str> {
    let word = |c: char| !(c.is_alphanumeric() || c == '_');
    let first = statement.split(word).next()?;
    let form = FORMS.iter().find(|form| form.word == first)?;
    Some(form.help)
}

const fn form(word: &'static str, place: Place, help: &'static str) -> Form {
    Form { word, place, help }
}

static FORMS: [Form; 36] = [
    form(
        "import",
        Place::File,
        "a package is imported by `import SI.*;`",
    ),
    form(
        "type",
        Place::File,
        "a type is written `type Gain = Real [A.s/m] \"what it is\";`",
    ),
    form(
        "model",
        Place::File,
        "a model is written `model Axis … end Axis;`",
    ),
    form(
        "connector",
        Place::File,
        "a connector is written `connector Tip … end Tip;`",
    ),
    form(
        "effect",
        Place::File,
        "an effect is written `effect Tilt on Rail … end Tilt;`",
    ),
    form(
        "function",
        Place::File,
        "a function is written `function twice input Real x; output Real y = 2*x; end twice;`",
    ),
    form(
        "experiment",
        Place::File,
        "an experiment is written `experiment step of Axis … end step;`, one on a record `experiment bench(record log = \"scope.csv\") of Axis … end bench;`",
    ),
    form(
        "calibrate",
        Place::File,
        "a calibration is written `calibrate fitted of Axis … end fitted;`",
    ),
    form(
        "diagnose",
        Place::File,
        "a diagnosis is written `diagnose found of calibrate fitted … end found;`",
    ),
    form(
        "sweep",
        Place::File,
        "a sweep is written `sweep gaps of step … end gaps;`, of an experiment",
    ),
    form(
        "extends",
        Place::Class,
        "a model is extended by `extends Slide(m = 20 [kg]);`",
    ),
    form(
        "parameter",
        Place::Class,
        "a parameter is written `parameter Mass m = 310 [kg] ~ ±8% \"the table\";`",
    ),
    form(
        "input",
        Place::Class,
        "an input is written `input Force F;`",
    ),
    form(
        "domain",
        Place::Class,
        "a domain is written `domain rod(x in 0 .. len);`",
    ),
    form(
        "discretize",
        Place::Class,
        "a field is discretized by `discretize rod by fem(n = 50);`",
    ),
    form(
        "modes",
        Place::Class,
        "modes are written `modes initial stuck { mode stuck { v = 0; exit F > Fs -> slip; } mode slip { F = Fc; exit v < 0 -> stuck; } }`",
    ),
    form(
        "mode",
        Place::Mode,
        "a mode is written `mode slip(Real s) { F = s*Fc; exit s*v < 0 -> stuck; }`",
    ),
    form(
        "exit",
        Place::Mode,
        "an exit is written `mode stuck { v = 0; exit F > Fs -> slip; }`",
    ),
    form(
        "clocked",
        Place::Class,
        "a clocked part is written `clocked cnc(1 [ms]) … end cnc;`",
    ),
    form(
        "connect",
        Place::Equation,
        "a connection is written `connect(motor.b, screw.a);`",
    ),
    form(
        "for",
        Place::Equation,
        "equations over a range are written `for i in 1:n loop x[i] = 0; end for;`",
    ),
    form(
        "if",
        Place::Equation,
        "a choice between equations is written `if a > b then y = x; else y = 0; end if;`, one between values `y = if a > b then x else 0;`",
    ),
    form(
        "when",
        Place::Equation,
        "what happens at an event is written `when x > 1 [m] then reinit(v, 0); end when;`",
    ),
    form(
        "assert",
        Place::Equation,
        "a condition is written `assert(x < 1 [m], \"beyond the end\");`",
    ),
    form(
        "wrap",
        Place::Effect,
        "a quantity is changed by `wrap F by F*(1 + part);`",
    ),
    form(
        "measure",
        Place::Experiment,
        "a measure is written `measure Length top = max(x);`",
    ),
    form(
        "stimulus",
        Place::Experiment,
        "an input is driven by `stimulus F = 10 [N]*sin(50 [rad/s]*time);` or by a record, `stimulus F = log.force;`",
    ),
    form(
        "measured",
        Place::Experiment,
        "what a record shows is written `measured log.x = x ~ 1 [um];`: its column, what the model says, and the noise",
    ),
    form(
        "replay",
        Place::Experiment,
        "a signal is taken from a record by `replay cnc.F = log.force;`",
    ),
    form(
        "expect",
        Place::Experiment,
        "what must hold is written `expect max(x) < 25 [mm];`",
    ),
    form(
        "figure",
        Place::Experiment,
        "a figure is written `figure motion = x, v \"there and back\";`",
    ),
    form(
        "solve",
        Place::Experiment,
        "a run is written `solve auto(rtol = 1e-6) stop 2 [s] every 1 [ms];`",
    ),
    form(
        "bode",
        Place::Experiment,
        "a response is written `bode from F to v over 1 [Hz] .. 80 [Hz];`",
    ),
    form(
        "vary",
        Place::Study,
        "a range is written `vary k in 700 .. 900 [N/m];`, single values `vary k = {700, 900} [N/m];`",
    ),
    form(
        "fit",
        Place::Study,
        "records are given by `fit bench(\"first.csv\", \"second.csv\");`",
    ),
    form(
        "grid",
        Place::Study,
        "the points of ranges are given by `grid 10;`",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use hyde_diag::{Diagnostics, Sources};

    fn put(place: Place, code: &str) -> String {
        match place {
            Place::File => code.to_owned(),
            Place::Class => format!("model M {code} end M;"),
            Place::Equation => format!("model M equation {code} end M;"),
            Place::Effect => format!("effect E on M {code} end E;"),
            Place::Mode => format!("model M modes initial stuck {{ {code} }} end M;"),
            Place::Experiment => format!("experiment e of M {code} end e;"),
            Place::Study => format!("sweep s of e {code} end s;"),
        }
    }

    #[test]
    fn every_example_is_understood() {
        for form in &FORMS {
            let codes = form.help.split('`').skip(1).step_by(2);
            let mut own = 0;
            for code in codes {
                own += usize::from(code.contains(form.word));
                let text = put(form.place, &code.replace('…', ""));
                let mut sources = Sources::new();
                let file = sources.add("form.hyde", format!("package forms;\n{text}\n"));
                let mut diagnostics = Diagnostics::new();
                crate::parse(&sources, file, &mut diagnostics);
                assert!(!diagnostics.has_errors(), "{code}: {diagnostics:?}");
            }
            assert!(own > 0, "{}", form.word);
        }
    }
}
