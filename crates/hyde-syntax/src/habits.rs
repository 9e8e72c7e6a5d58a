//! Words and signs of Modelica and its kin that Hyde does not have, each with what stands in its place.
//!
//! Most of them are names like others where they are not taken for words, so they are looked for only where a statement
//! is broken.

use crate::other_names;
use crate::recover::Scanner;

/// A word or sign, and what to write instead.
pub(crate) struct Habit {
    pub(crate) word: &'static str,
    /// How the word stands where it is no name.
    place: Place,
    pub(crate) message: &'static str,
    pub(crate) help: &'static str,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// In front of a word or alone at the beginning of a statement: what follows can be read without it.
    Prefix,
    /// At the beginning of a statement, or behind `initial`: what follows makes no sense without it.
    First,
    /// In front of a parenthesis.
    Call,
    /// In the middle of a statement, in front of a word.
    Inside,
}

/// A habit found in a text: from where to where.
pub(crate) struct Found {
    pub(crate) begin: usize,
    pub(crate) end: usize,
    pub(crate) habit: &'static Habit,
}

/// The first habit in the statement that begins at `start` and is not understood at `fault`.
pub(crate) fn find(text: &str, start: usize, fault: usize) -> Option<Found> {
    let tokens: Vec<(usize, &str)> = up_to(text, start, fault);
    let understood = tokens.iter().filter(|(at, _)| *at <= fault).count();
    if let [(_, "import"), _, (begin, "="), ..] = tokens[..] {
        let end = begin + 1;
        let habit = &ALIAS;
        return Some(Found { begin, end, habit });
    }
    if let Some(end) = comment(text, &tokens, fault) {
        let begin = tokens.first()?.0;
        let habit = &COMMENT;
        return Some(Found { begin, end, habit });
    }
    let token = |number: usize| tokens.get(number).map_or("", |(_, token)| *token);
    for (number, &(begin, word)) in tokens.iter().enumerate().take(understood + 1) {
        let before = number.checked_sub(1).map_or("", token);
        let named =
            |habit: &&Habit| habit.word == word && habit.fits(number, before, token(number + 1));
        if let Some(habit) = WORDS.iter().find(named) {
            let end = begin + word.len();
            return Some(Found { begin, end, habit });
        }
    }
    sign(text, &tokens[..understood])
}

/// The end of the line, if a statement begins with the sign of a comment of Python, Matlab or Ada.
pub(crate) fn behind_comment(text: &str, start: usize) -> Option<usize> {
    let rest = &text[start..];
    let comment = ["#", "%", "--"].iter().any(|sign| rest.starts_with(sign));
    comment.then(|| rest.find('\n').map_or(text.len(), |end| start + end))
}

/// Behind the sign with which a comment of Matlab or Ada begins, in the place of a statement.
fn comment(text: &str, tokens: &[(usize, &str)], fault: usize) -> Option<usize> {
    let &(begin, _) = tokens.first()?;
    let rest = &text[begin..];
    if rest.starts_with('%') && begin == fault {
        return Some(begin + 1);
    }
    rest.starts_with("--").then_some(begin + 2)
}

/// The tokens from `start` to `fault`, and two more.
fn up_to(text: &str, start: usize, fault: usize) -> Vec<(usize, &str)> {
    let mut tokens = Vec::new();
    let mut behind = 0;
    for token in Scanner::new(text, start) {
        tokens.push(token);
        behind += usize::from(token.0 > fault);
        if behind == 2 {
            break;
        }
    }
    tokens
}

/// Where a statement goes on that begins with a word that it can be read without.
pub(crate) fn behind_prefix(text: &str, start: usize) -> Option<usize> {
    let mut tokens = Scanner::new(text, start);
    let (begin, first) = tokens.next()?;
    let next = tokens.next().map_or("", |(_, token)| token);
    let named = |habit: &&Habit| {
        habit.word == first && habit.place == Place::Prefix && habit.fits(0, "", next)
    };
    WORDS.iter().find(named).map(|_| begin + first.len())
}

impl Habit {
    fn fits(&self, number: usize, before: &str, next: &str) -> bool {
        let word = |token: &str| token.starts_with(|c: char| c.is_alphabetic() || c == '_');
        let free = before != "." && next != "." && next != "=";
        free && match self.place {
            Place::Prefix => word(next) && (before.is_empty() || word(before)),
            Place::First => {
                let goes_on = word(next) || next == ";" || next.starts_with('"');
                (number == 0 && goes_on) || before == "initial"
            }
            Place::Call => next == "(",
            Place::Inside => word(next),
        }
    }
}

/// A sign of another language where the statement is not understood.
fn sign(text: &str, tokens: &[(usize, &str)]) -> Option<Found> {
    let &(fault, last) = tokens.last()?;
    let found = |begin: usize, habit: &'static Habit| {
        let end = begin + habit.word.len();
        Some(Found { begin, end, habit })
    };
    for habit in &SIGNS {
        // A sign of two characters may be understood up to its second one, and `n++` as a sum up to its end.
        let counts = matches!(habit.word, "++" | "--");
        for back in 0..habit.word.len() + usize::from(counts && last == ";") {
            if let Some(begin) = fault.checked_sub(back)
                && text
                    .get(begin..)
                    .is_some_and(|rest| rest.starts_with(habit.word))
            {
                return found(begin, habit);
            }
        }
    }
    // `x == 1;` is an expression up to its end.
    let compares = |(at, _): &&(usize, &str)| text[*at..].starts_with("==");
    if last == ";" {
        let (begin, _) = *tokens.iter().find(compares)?;
        return found(begin, &COMPARED);
    }
    None
}

const fn word(
    word: &'static str,
    place: Place,
    message: &'static str,
    help: &'static str,
) -> Habit {
    Habit {
        word,
        place,
        message,
        help,
    }
}

const ASSIGNMENTS: &str = "write each assignment as an equation, `y = 2*x;`, and a choice as `y = if x > 0 then x else 0;`; for variables that change at events write `when x > 1 then … end when;` or a `clocked` part";
const LOOP: &str = "Hyde has no loops that run: equations over a range are `for i in 1:n loop … end for;`, sums are `sum(x)`";
const HANDED_DOWN: &str = "hand it to the parts that need it: `Part part(g = g);` with `parameter Real g;` in the part, or connect it";
const OPEN_TO_ALL: &str =
    "leave the word out: every variable can be seen; `final` keeps a parameter from being changed";
const NEW_VALUE: &str = "write the new value of a variable at an event: `n = pre(n) + 1;`";
const ELEMENTS: &str =
    "write the operator without the point: arrays are multiplied element by element";
/// How a package is imported.
pub(crate) const IMPORT: &str = "a package is imported by `import SI.*;`";
/// How a value is chosen.
pub(crate) const CHOICE: &str = "a choice between values is written `if a > b then x else y`";
const MODEL: &str =
    "write `model`; what is connected is a `connector`, what is computed a `function`";

static WORDS: [Habit; 33] = [
    word(
        "algorithm",
        Place::First,
        "Hyde has no `algorithm` sections, only equations",
        ASSIGNMENTS,
    ),
    word(
        "protected",
        Place::Prefix,
        "Hyde has no `protected` parts",
        OPEN_TO_ALL,
    ),
    word(
        "public",
        Place::Prefix,
        "Hyde has no `public` parts",
        OPEN_TO_ALL,
    ),
    word(
        "inner",
        Place::Prefix,
        "Hyde has no `inner` and `outer`",
        HANDED_DOWN,
    ),
    word(
        "outer",
        Place::Prefix,
        "Hyde has no `inner` and `outer`",
        HANDED_DOWN,
    ),
    word(
        "stream",
        Place::Prefix,
        "Hyde has no `stream` variables",
        "a connector has potentials and flows: `flow Force f;`",
    ),
    word(
        "discrete",
        Place::Prefix,
        "Hyde has no word `discrete`",
        "leave it out: a variable that `when` sets is discrete",
    ),
    word(
        "partial",
        Place::Prefix,
        "Hyde has no word `partial` for models",
        "leave it out: a model may leave equations open for those that extend it",
    ),
    word(
        "encapsulated",
        Place::Prefix,
        "Hyde has no word `encapsulated`",
        "leave it out: a file sees its own package and what it imports",
    ),
    word(
        "expandable",
        Place::Prefix,
        "Hyde has no `expandable` connectors",
        "declare what the connector has: `connector Bus … end Bus;`",
    ),
    word(
        "pure",
        Place::Prefix,
        "Hyde has no word `pure`",
        "leave it out: every function is pure",
    ),
    word(
        "impure",
        Place::Prefix,
        "Hyde has no `impure` functions",
        "leave the word out: every function is pure",
    ),
    word(
        "annotation",
        Place::Call,
        "Hyde has no `annotation`",
        "leave it out: documentation is a text behind the name, `model Axis \"the X axis\"`",
    ),
    word(
        "enumeration",
        Place::Call,
        "Hyde has no `enumeration`",
        "write the states of a part as modes, `modes initial open { mode open { … } mode shut { … } }`, and a choice as an Integer parameter",
    ),
    word(
        "within",
        Place::First,
        "Hyde has no `within`",
        "the first line says to which package a file belongs: `package Drives.Mine;`",
    ),
    word("block", Place::First, "Hyde has no `block`", MODEL),
    word("class", Place::First, "Hyde has no `class`", MODEL),
    word("def", Place::First, "Hyde has no `def`", MODEL),
    word("using", Place::First, "Hyde has no `using`", IMPORT),
    word("include", Place::First, "Hyde has no `include`", IMPORT),
    word(
        "record",
        Place::First,
        "Hyde has no `record` of its own",
        "write a `model` with parameters, or a parameter each; measured data is declared behind the name of an experiment: `experiment bench(record log = \"scope.csv\") of Axis`",
    ),
    word(
        "operator",
        Place::First,
        "Hyde has no `operator` of its own",
        MODEL,
    ),
    word(
        "external",
        Place::First,
        "Hyde has no `external` functions",
        "write the function as an expression, or its points as a `table`",
    ),
    word(
        "constrainedby",
        Place::Inside,
        "Hyde has no `constrainedby`",
        "leave it out: what takes the place of a `replaceable` part has its connectors and parameters",
    ),
    word(
        "initial",
        Place::Call,
        "Hyde has no `initial()`: conditions at the start are equations",
        "write `initial equation` and the equations below it",
    ),
    word("while", Place::First, "Hyde has no `while`", LOOP),
    word("break", Place::First, "Hyde has no `break`", LOOP),
    word(
        "return",
        Place::First,
        "Hyde has no `return`",
        "the output of a function has its value where it is declared: `output Real y = 2*x;`",
    ),
    word(
        "elsif",
        Place::Inside,
        "`elsif` is written otherwise",
        "write `elseif`",
    ),
    word(
        "elif",
        Place::Inside,
        "`elif` is written otherwise",
        "write `elseif`",
    ),
    word(
        "endif",
        Place::First,
        "`endif` is written otherwise",
        "write `end if;`",
    ),
    word(
        "endfor",
        Place::First,
        "`endfor` is written otherwise",
        "write `end for;`",
    ),
    word(
        "endwhen",
        Place::First,
        "`endwhen` is written otherwise",
        "write `end when;`",
    ),
];

static SIGNS: [Habit; 19] = [
    word(
        "±",
        Place::Inside,
        "an uncertainty stands behind `~`",
        "write `parameter Mass M = 310 [kg] ~ ±8%;`",
    ),
    word(
        "+/-",
        Place::Inside,
        "Hyde has no `+/-`",
        "an uncertainty is written `parameter Mass M = 310 [kg] ~ ±8%;`",
    ),
    word(
        ":=",
        Place::Inside,
        "Hyde has no `:=`",
        "equations and bindings are written with `=`: `y = 2*x;`",
    ),
    word(
        "**",
        Place::Inside,
        "Hyde has no `**`",
        "a power is written `x^2`",
    ),
    word(
        "!=",
        Place::Inside,
        "Hyde has no `!=`",
        "not equal is written `<>`",
    ),
    word(
        "~=",
        Place::Inside,
        "Hyde has no `~=`",
        "not equal is written `<>`",
    ),
    word("+=", Place::Inside, "Hyde has no `+=`", NEW_VALUE),
    word("-=", Place::Inside, "Hyde has no `-=`", NEW_VALUE),
    word("++", Place::Inside, "Hyde has no `++`", NEW_VALUE),
    word("--", Place::Inside, "Hyde has no `--`", NEW_VALUE),
    word(".*", Place::Inside, "Hyde has no `.*`", ELEMENTS),
    word("./", Place::Inside, "Hyde has no `./`", ELEMENTS),
    word(".^", Place::Inside, "Hyde has no `.^`", ELEMENTS),
    word("?", Place::Inside, "Hyde has no `?`", CHOICE),
    word(
        ":",
        Place::Inside,
        "a `:` does not belong here",
        "leave it out: a block ends with `end NAME;`, a variable is declared by `Length x;`, and gets its value with `=`",
    ),
    word("&&", Place::Inside, "Hyde has no `&&`", "write `and`"),
    word("||", Place::Inside, "Hyde has no `||`", "write `or`"),
    word(
        "#",
        Place::Inside,
        "`#` does not begin a comment",
        "a comment is written `// …` to the end of the line, or `/* … */`",
    ),
    word(
        "'",
        Place::Inside,
        "Hyde has no `'`",
        "the derivative of `x` by time is `der(x)`; a name has letters, digits and `_`, and no quotes: `x_ref`",
    ),
];

static COMMENT: Habit = word(
    "%",
    Place::Inside,
    "this does not begin a comment",
    "a comment is written `// …` to the end of the line, or `/* … */`",
);

static ALIAS: Habit = word(
    "=",
    Place::Inside,
    "an import cannot be renamed",
    "import a package whole, `import SI.*;`, and use its names as they are: `Mass m;`",
);

static COMPARED: Habit = word(
    "==",
    Place::Inside,
    "`==` compares: there is no equation here",
    "an equation is written with one `=`: `y = 2*x;`",
);

/// What stands in the place of an attribute of Modelica, which has this text as its value.
#[must_use]
pub fn instead_of_attribute(word: &str, text: &str) -> Option<String> {
    let help = match word {
        "unit" => {
            return Some(format!(
                "the unit stands behind the value, `= 1 [{text}]`, and the declared type has its dimension"
            ));
        }
        "displayUnit" => {
            return Some(format!(
                "results are shown in the unit of the type: declare one of your own, `type Shown = Real [{text}];`"
            ));
        }
        "quantity" => "the declared type says which quantity it is: `Torque tau;`",
        "nominal" => "leave it out: values are scaled by what they are during the run",
        "stateSelect" => "write `state = always`, `prefer`, `avoid` or `never`",
        _ => return None,
    };
    Some(help.to_owned())
}

/// What stands in the place of a type, package or function of Modelica, by its full name.
#[must_use]
pub fn instead_of(path: &str) -> Option<String> {
    if path == "String" {
        let help = "Hyde has no type `String`: a text is documentation, behind a name; a choice is an Integer parameter";
        return Some(help.to_owned());
    }
    if let Some(help) = other_names::instead_of_type(path) {
        return Some(help.to_owned());
    }
    let mut parts = path.split('.');
    if parts.next() != Some("Modelica") {
        return None;
    }
    let parts: Vec<&str> = parts.collect();
    let here = |part: &&str| match *part {
        "Units" | "SI" | "SIunits" => Some("SI"),
        "Rotational" => Some("Rotational"),
        "Translational" => Some("Translational"),
        "Planar" | "MultiBody" => Some("Planar"),
        "Electrical" => Some("Electrical"),
        "Thermal" => Some("Thermal"),
        "Blocks" => Some("Blocks"),
        "Clocked" => Some("Clocked"),
        _ => None,
    };
    let last = parts.last().copied().unwrap_or_default();
    Some(match parts.iter().find_map(here) {
        Some(package) if here(&last) == Some(package) || last.is_empty() => {
            format!("Hyde's library is not below `Modelica`: write `import {package}.*;`")
        }
        Some(package) => format!(
            "Hyde's library is not below `Modelica`: write `import {package}.*;` and the name alone, `{last}`"
        ),
        None => format!(
            "Hyde's library is not below `Modelica`: functions and constants have their name alone, `{last}`; `hyde doc --library` lists what there is"
        ),
    })
}
