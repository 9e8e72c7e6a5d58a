//! The tools: what each does and takes, and the command line that it stands for.

use serde_json::{Map, Value, json};

/// A tool that runs a command.
pub(crate) struct Tool {
    /// Its name, and the command.
    pub(crate) name: &'static str,
    about: &'static str,
    arguments: &'static [Argument],
}

/// An argument of a tool.
struct Argument {
    name: &'static str,
    about: &'static str,
    kind: Kind,
    needed: bool,
}

/// How an argument is given, and where it stands in the command line.
#[derive(Clone, Copy)]
enum Kind {
    /// A text in its place.
    Place,
    /// Texts, each in its place.
    Places,
    /// A text behind an option.
    Option(&'static str),
    /// Texts, each behind an option.
    Options(&'static str),
    /// An option that is there or not.
    Flag(&'static str),
}

const FILE: Argument = Argument {
    name: "file",
    about: "path of the model file, NAME.hyde",
    kind: Kind::Place,
    needed: true,
};
const EXPERIMENT: Argument = Argument {
    name: "experiment",
    about: "name of the experiment; optional if the file has only one",
    kind: Kind::Place,
    needed: false,
};
const SET: Argument = Argument {
    name: "set",
    about: "parameters to set, each `saddle.M=320 [kg]`",
    kind: Kind::Options("--set"),
    needed: false,
};
const RECORD: Argument = Argument {
    name: "record",
    about: "files of records, each `NAME=PATH`",
    kind: Kind::Options("--record"),
    needed: false,
};
const AT: Argument = Argument {
    name: "at",
    about: "operating point: `0.3 [s]`, `start` or `steady`",
    kind: Kind::Option("--at"),
    needed: false,
};
const IN: Argument = Argument {
    name: "in",
    about: "modes of components, each `guide=slip`",
    kind: Kind::Options("--in"),
    needed: false,
};
const OUT: Argument = Argument {
    name: "out",
    about: "folder for results, figures and pages [default: a temporary folder]",
    kind: Kind::Option("--out"),
    needed: false,
};
const SANDBOX: Argument = Argument {
    name: "sandbox",
    about: "run each FMU of the model in a process of its own",
    kind: Kind::Flag("--sandbox"),
    needed: false,
};

/// Every tool but that of the library.
pub(crate) const TOOLS: &[Tool] = &[
    Tool {
        name: "check",
        about: "Compile every experiment of a model file and report all errors with their places and corrections. Runs nothing.",
        arguments: &[FILE, EXPERIMENT, SET],
    },
    Tool {
        name: "run",
        about: "Solve an experiment. Gives measures, expectations, errors of measured channels and the paths of results, events and the report; no samples.",
        arguments: &[FILE, EXPERIMENT, SET, RECORD, SANDBOX, OUT],
    },
    Tool {
        name: "modes",
        about: "Natural frequencies, damping ratios and stability of the linearised model at an operating point, with where the energy of each mode is.",
        arguments: &[
            FILE,
            EXPERIMENT,
            SET,
            AT,
            IN,
            Argument {
                name: "open",
                about: "only the plant; outputs of clocked controllers stay constant",
                kind: Kind::Flag("--open"),
                needed: false,
            },
        ],
    },
    Tool {
        name: "bode",
        about: "Frequency responses and stability margins that an experiment asks for, of the linearised model. The responses go to a file.",
        arguments: &[
            FILE,
            EXPERIMENT,
            SET,
            AT,
            IN,
            Argument {
                name: "cut",
                about: "signals at which to open a loop for its margins, each `cnc.control.i_ref`",
                kind: Kind::Options("--cut"),
                needed: false,
            },
            Argument {
                name: "margins",
                about: "only the stability margins",
                kind: Kind::Flag("--margins"),
                needed: false,
            },
        ],
    },
    Tool {
        name: "fit",
        about: "Calibrate a model on its records: parameters with confidence intervals, residuals of each channel. May take minutes.",
        arguments: &[
            FILE,
            Argument {
                name: "calibration",
                about: "name of the calibration; optional if the file has only one",
                kind: Kind::Place,
                needed: false,
            },
            OUT,
        ],
    },
    Tool {
        name: "diagnose",
        about: "Find the effects that a calibrated model omits, or that none can be detected. May take minutes.",
        arguments: &[
            FILE,
            Argument {
                name: "diagnosis",
                about: "name of the diagnosis; optional if the file has only one",
                kind: Kind::Place,
                needed: false,
            },
            OUT,
        ],
    },
    Tool {
        name: "look",
        about: "What is in trace files (CSV of scopes and drives, Parquet, XML, workbooks): layout, channels, rates, gaps, noise, delays, and the line for a model file.",
        arguments: &[
            Argument {
                name: "files",
                about: "paths of traces",
                kind: Kind::Places,
                needed: true,
            },
            OUT,
        ],
    },
    Tool {
        name: "explain",
        about: "Explain a diagnostic code such as E0503, with a wrong and a right example.",
        arguments: &[Argument {
            name: "code",
            about: "the code; without it all codes are listed",
            kind: Kind::Place,
            needed: false,
        }],
    },
];

impl Tool {
    /// Its description for `tools/list`.
    pub(crate) fn listed(&self) -> Value {
        let mut properties = Map::new();
        for own in self.arguments {
            let schema = match own.kind {
                Kind::Place | Kind::Option(_) => json!({ "type": "string" }),
                Kind::Places | Kind::Options(_) => {
                    json!({ "type": "array", "items": { "type": "string" } })
                }
                Kind::Flag(_) => json!({ "type": "boolean" }),
            };
            let mut schema = schema;
            schema["description"] = json!(own.about);
            properties.insert(own.name.to_owned(), schema);
        }
        let needed = self.arguments.iter().filter(|own| own.needed);
        let needed: Vec<&str> = needed.map(|own| own.name).collect();
        json!({
            "name": self.name,
            "description": self.about,
            "inputSchema": {
                "type": "object", "properties": properties, "required": needed, "additionalProperties": false,
            },
            "annotations": { "readOnlyHint": !self.takes("out"), "openWorldHint": false },
        })
    }

    /// Whether it takes an argument.
    pub(crate) fn takes(&self, name: &str) -> bool {
        self.arguments.iter().any(|own| own.name == name)
    }

    /// The command line of a call.
    ///
    /// # Errors
    /// What is wrong with the arguments.
    pub(crate) fn command(&self, given: &Map<String, Value>) -> Result<Vec<String>, String> {
        if let Some(other) = given.keys().find(|key| !self.takes(key)) {
            let known: Vec<&str> = self.arguments.iter().map(|own| own.name).collect();
            return Err(format!(
                "`{}` has no argument `{other}`; it has `{}`",
                self.name,
                known.join("`, `")
            ));
        }
        let mut options = Vec::new();
        let mut places = Vec::new();
        for own in self.arguments {
            let Some(value) = given.get(own.name).filter(|value| !value.is_null()) else {
                if own.needed {
                    return Err(format!("`{}` needs the argument `{}`", self.name, own.name));
                }
                continue;
            };
            let wrong =
                |what: &str| format!("the argument `{}` of `{}` is {what}", own.name, self.name);
            let text = || {
                let text = value.as_str().ok_or_else(|| wrong("a text"))?;
                Ok::<String, String>(text.to_owned())
            };
            let texts = || {
                let list = value.as_array().ok_or_else(|| wrong("a list of texts"))?;
                let each = list.iter().map(|item| {
                    let text = item.as_str().ok_or_else(|| wrong("a list of texts"))?;
                    Ok::<String, String>(text.to_owned())
                });
                each.collect::<Result<Vec<String>, String>>()
            };
            match own.kind {
                Kind::Place => places.push(text()?),
                Kind::Places => places.extend(texts()?),
                Kind::Option(option) => options.push(format!("{option}={}", text()?)),
                Kind::Options(option) => {
                    let each = texts()?.into_iter();
                    options.extend(each.map(|text| format!("{option}={text}")));
                }
                Kind::Flag(option) => {
                    if value.as_bool().ok_or_else(|| wrong("true or false"))? {
                        options.push(option.to_owned());
                    }
                }
            }
        }
        let mut line = vec![self.name.to_owned()];
        line.extend(options);
        if self.name == "bode" {
            line.push("--linear".to_owned());
        }
        if self.name != "explain" {
            line.push("--json".to_owned());
        }
        // Nothing behind is an option, whatever it begins with.
        line.push("--".to_owned());
        line.extend(places);
        Ok(line)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]
mod tests {
    use super::*;

    #[test]
    fn a_call_is_a_command_line() {
        let run = TOOLS.iter().find(|tool| tool.name == "run").unwrap();
        let given = json!({ "file": "-a.hyde", "experiment": "push", "set": ["M=3 [kg]"], "sandbox": true, "out": "o" });
        let line = run.command(given.as_object().unwrap()).unwrap();
        let expected = [
            "run",
            "--set=M=3 [kg]",
            "--sandbox",
            "--out=o",
            "--json",
            "--",
            "-a.hyde",
            "push",
        ];
        assert_eq!(line, expected);
        let unknown = json!({ "file": "a.hyde", "stop": 1 });
        let said = run.command(unknown.as_object().unwrap()).unwrap_err();
        assert!(said.contains("no argument `stop`"), "{said}");
        let said = run.command(&Map::new()).unwrap_err();
        assert!(said.contains("needs the argument `file`"), "{said}");
        let wrong = json!({ "file": "a.hyde", "set": "M=3" });
        let said = run.command(wrong.as_object().unwrap()).unwrap_err();
        assert!(said.contains("a list of texts"), "{said}");
    }
}
