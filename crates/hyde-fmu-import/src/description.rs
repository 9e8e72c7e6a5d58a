//! [`Description`]: what an FMU says of itself, `modelDescription.xml` of FMI 2.0 and 3.0 as one.

use crate::description_units::{Units, units};
use crate::{PLATFORM, Unusable};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;

/// The version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

/// How an FMU is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// It integrates itself.
    CoSimulation,
    /// It gives derivatives, and is integrated here.
    ModelExchange,
}

/// What kind of numbers a variable has, and with which functions they are set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// `Real`, `Float64`.
    Float64,
    /// `Float32`.
    Float32,
    /// `Integer`, `Int32`.
    Int32,
    /// `Int8`.
    Int8,
    /// `UInt8`.
    UInt8,
    /// `Int16`.
    Int16,
    /// `UInt16`.
    UInt16,
    /// `UInt32`.
    UInt32,
    /// `Int64`; of FMI 3.0 also `Enumeration`.
    Int64,
    /// `UInt64`.
    UInt64,
    /// `Boolean`.
    Boolean,
}

impl Numbers {
    fn of(element: &str, version: Version) -> Option<Self> {
        Some(match element {
            "Real" | "Float64" => Self::Float64,
            "Float32" => Self::Float32,
            "Integer" | "Int32" => Self::Int32,
            "Enumeration" if version == Version::Two => Self::Int32,
            "Enumeration" | "Int64" => Self::Int64,
            "Int8" => Self::Int8,
            "UInt8" => Self::UInt8,
            "Int16" => Self::Int16,
            "UInt16" => Self::UInt16,
            "UInt32" => Self::UInt32,
            "UInt64" => Self::UInt64,
            "Boolean" => Self::Boolean,
            _ => return None,
        })
    }

    /// What they are to a model.
    #[must_use]
    pub fn kind(self) -> NumberKind {
        match self {
            Self::Float64 | Self::Float32 => NumberKind::Real,
            Self::Boolean => NumberKind::Truth,
            Self::Int32
            | Self::Int8
            | Self::UInt8
            | Self::Int16
            | Self::UInt16
            | Self::UInt32
            | Self::Int64
            | Self::UInt64 => NumberKind::Whole,
        }
    }
}

/// What numbers are to a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberKind {
    /// `Real`.
    Real,
    /// `Integer`.
    Whole,
    /// `Boolean`.
    Truth,
}

/// What a variable is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Set before the run.
    Parameter,
    /// Set at every step.
    Input,
    /// Read after every step.
    Output,
}

/// How a real number of the FMU becomes one of the model: `factor*x + offset` in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct InSi {
    /// Unit of the model in which it is shown, as Hyde writes it; `1` of a number.
    pub unit: String,
    /// The factor.
    pub factor: f64,
    /// The offset.
    pub offset: f64,
}

/// A variable that a model can use.
#[derive(Clone, Debug)]
pub struct FmuVariable {
    /// Its name.
    pub name: String,
    /// The number by which functions know it.
    pub reference: u32,
    /// What it is for.
    pub role: Role,
    /// What kind of numbers it has.
    pub numbers: Numbers,
    /// Number of elements, of an array.
    pub len: Option<usize>,
    /// Its values before the run, as the FMU has them; none where it does not say.
    pub start: Vec<f64>,
    /// Its conversion.
    pub in_si: InSi,
    /// What it is.
    pub doc: String,
}

/// What an FMU says of itself.
#[derive(Clone, Debug)]
pub struct Description {
    /// Which version of the standard.
    pub version: Version,
    /// The name of its model.
    pub model_name: String,
    /// The tool that exported it, if it says so.
    pub tool: Option<String>,
    /// The name of the library without its ending.
    pub identifier: String,
    /// The token that the library is to see.
    pub token: String,
    /// Whether a process can have one instance only.
    pub once_per_process: bool,
    /// The communication step in s that it proposes.
    pub step: Option<f64>,
    /// How it is used: by co-simulation if it has it.
    pub used: Use,
    /// The relative tolerance that it proposes.
    pub tolerance: Option<f64>,
    /// The numbers of states and event indicators, of FMI 2.0.
    pub(crate) counts: (usize, usize),
    /// Its variables in their order.
    pub variables: Vec<FmuVariable>,
    /// What it has that a model cannot use, and units that were read in a way worth saying.
    pub notes: Vec<String>,
}

impl Description {
    pub(crate) fn parse(file: &str, text: &str) -> Result<Self, Unusable> {
        let invalid = |why: String| {
            Unusable::new(
                format!("the model description of `{file}` cannot be read: {why}"),
                "check the FMU with `fmpy validate`, or export it again",
            )
        };
        let document = Document::parse(text).map_err(|error| invalid(error.to_string()))?;
        let root = document.root_element();
        let said = root.attribute("fmiVersion").unwrap_or_default();
        let version = match said {
            "2.0" => Version::Two,
            other if other.starts_with("3.") => Version::Three,
            other => {
                return Err(Unusable::new(
                    format!("`{file}` is an FMU of FMI {other}"),
                    "export it for FMI 2.0 or 3.0",
                ));
            }
        };
        let simulated = child(root, "CoSimulation").map(|own| (own, Use::CoSimulation));
        let exchanged = child(root, "ModelExchange").map(|own| (own, Use::ModelExchange));
        let Some((simulated, used)) = simulated.or(exchanged) else {
            return Err(Unusable::new(
                format!("`{file}` has neither co-simulation nor model exchange"),
                "export it for co-simulation",
            ));
        };
        let identifier = simulated
            .attribute("modelIdentifier")
            .ok_or_else(|| invalid("`CoSimulation` has no `modelIdentifier`".to_owned()))?;
        let token = match version {
            Version::Two => "guid",
            Version::Three => "instantiationToken",
        };
        let experiment = child(root, "DefaultExperiment");
        let step = experiment.and_then(|own| own.attribute("stepSize"));
        let step = step.or_else(|| simulated.attribute("fixedInternalStepSize"));
        let mut found = Self {
            version,
            model_name: root.attribute("modelName").unwrap_or(identifier).to_owned(),
            tool: root.attribute("generationTool").map(str::to_owned),
            identifier: identifier.to_owned(),
            token: root.attribute(token).unwrap_or_default().to_owned(),
            once_per_process: simulated
                .attribute("canBeInstantiatedOnlyOncePerProcess")
                .is_some_and(is_true),
            step: step
                .and_then(|step| step.trim().parse().ok())
                .filter(|step: &f64| *step > 0.0 && step.is_finite()),
            used,
            tolerance: experiment
                .and_then(|own| own.attribute("tolerance"))
                .and_then(|own| own.trim().parse().ok())
                .filter(|own: &f64| *own > 0.0 && own.is_finite()),
            counts: counts(root),
            variables: Vec::new(),
            notes: Vec::new(),
        };
        if used == Use::ModelExchange {
            found.notes.push(
                "it has no co-simulation: Hyde integrates its equations within each communication step".to_owned(),
            );
        }
        found.read_variables(root);
        Ok(found)
    }

    fn read_variables(&mut self, root: Node<'_, '_>) {
        let units = units(root);
        let types: BTreeMap<&str, Node<'_, '_>> = child(root, "TypeDefinitions")
            .into_iter()
            .flat_map(|all| all.children())
            .filter_map(|own| Some((own.attribute("name")?, own)))
            .collect();
        let Some(all) = child(root, "ModelVariables") else {
            return;
        };
        // They keep their start values, and so do the sizes of arrays.
        let structural: BTreeMap<&str, usize> = all
            .children()
            .filter(|own| own.attribute("causality") == Some("structuralParameter"))
            .filter_map(|own| {
                let size = own.attribute("start")?.trim().parse().ok()?;
                Some((own.attribute("valueReference")?, size))
            })
            .collect();
        let mut unusable: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for own in all.children().filter(Node::is_element) {
            // FMI 2.0 has the type in an element of its own.
            let typed = match self.version {
                Version::Two => own.children().find(Node::is_element),
                Version::Three => Some(own),
            };
            let (Some(name), Some(typed)) = (own.attribute("name"), typed) else {
                continue;
            };
            let role = match own.attribute("causality") {
                Some("parameter") => Role::Parameter,
                Some("input") => Role::Input,
                Some("output") => Role::Output,
                Some("structuralParameter") => {
                    let list = unusable.entry("structural parameters keep their values");
                    list.or_default().push(name.to_owned());
                    continue;
                }
                Some(_) | None => continue,
            };
            let element = typed.tag_name().name();
            let Some(numbers) = Numbers::of(element, self.version) else {
                let why = match element {
                    "String" => "texts keep their values",
                    "Binary" => "binary values are not used",
                    _ => "clocks are not used",
                };
                unusable.entry(why).or_default().push(name.to_owned());
                continue;
            };
            let Ok(len) = length(own, &structural) else {
                let list = unusable.entry("arrays without a size are not used");
                list.or_default().push(name.to_owned());
                continue;
            };
            let reference = own.attribute("valueReference").map(str::parse);
            let Some(Ok(reference)) = reference else {
                continue;
            };
            let declared = typed
                .attribute("declaredType")
                .and_then(|own| types.get(own));
            let unit = typed.attribute("unit").or_else(|| {
                let declared = declared?;
                let inner = declared.children().find(|own| own.has_attribute("unit"));
                let inner = inner.and_then(|own| own.attribute("unit"));
                declared.attribute("unit").or(inner)
            });
            let relative = typed.attribute("relativeQuantity").is_some_and(is_true);
            let in_si = self.in_si(name, unit, relative, &units);
            self.variables.push(FmuVariable {
                name: name.to_owned(),
                reference,
                role,
                numbers,
                len,
                start: starts(typed.attribute("start").unwrap_or_default()),
                in_si,
                doc: own.attribute("description").unwrap_or_default().to_owned(),
            });
        }
        for (why, names) in unusable {
            let shown: Vec<&str> = names.iter().take(4).map(String::as_str).collect();
            let more = if names.len() > 4 { ", …" } else { "" };
            self.notes
                .push(format!("{why}: `{}`{more}", shown.join("`, `")));
        }
    }

    fn in_si(&mut self, name: &str, unit: Option<&str>, relative: bool, units: &Units) -> InSi {
        let number = InSi {
            unit: "1".to_owned(),
            factor: 1.0,
            offset: 0.0,
        };
        let Some(unit) = unit.filter(|unit| !unit.is_empty()) else {
            return number;
        };
        match units.in_si(unit, relative) {
            Some((in_si, None)) => in_si,
            Some((in_si, Some(note))) => {
                if !self.notes.contains(&note) {
                    self.notes.push(note);
                }
                in_si
            }
            None => {
                self.notes.push(format!(
                    "the unit `{unit}` of `{name}` is not defined: its values are plain numbers"
                ));
                number
            }
        }
    }

    /// The library of this platform in the archive, if it has one.
    pub(crate) fn library<'a>(
        &self,
        file: &str,
        names: impl Iterator<Item = &'a str>,
    ) -> Result<String, Unusable> {
        let platform = match self.version {
            Version::Two => PLATFORM.1,
            Version::Three => PLATFORM.0,
        };
        let wanted = format!("binaries/{platform}/{}.so", self.identifier);
        let mut others: Vec<String> = Vec::new();
        let mut sources = false;
        for name in names {
            if name == wanted {
                return Ok(wanted);
            }
            sources |= name.starts_with("sources/");
            let mut parts = name.split('/');
            if parts.next() == Some("binaries")
                && let (Some(other), Some(_)) = (parts.next(), parts.next())
                && other != platform
                && !others.iter().any(|known| known == other)
            {
                others.push(other.to_owned());
            }
        }
        let has = match (others.is_empty(), sources) {
            (false, _) => format!("it has libraries for `{}` only", others.join("`, `")),
            (true, true) => "it has source code only".to_owned(),
            (true, false) => "it has none".to_owned(),
        };
        Err(Unusable::new(
            format!("`{file}` has no library `{wanted}`: {has}"),
            format!(
                "export it for Linux on x86-64 (`{platform}`), or compile its sources there with `fmpy compile`"
            ),
        ))
    }
}

/// The numbers of states and event indicators, as FMI 2.0 says them.
fn counts(root: Node<'_, '_>) -> (usize, usize) {
    let structure = child(root, "ModelStructure");
    let derivatives = structure.and_then(|own| child(own, "Derivatives"));
    let states = derivatives.map_or(0, |own| own.children().filter(Node::is_element).count());
    let indicators = root.attribute("numberOfEventIndicators");
    let indicators = indicators.and_then(|own| own.trim().parse().ok());
    (states, indicators.unwrap_or(0))
}

/// The number of elements of an array; none of a scalar.
fn length(own: Node<'_, '_>, structural: &BTreeMap<&str, usize>) -> Result<Option<usize>, ()> {
    let mut len = None;
    let dimensions = own.children().filter(|own| own.has_tag_name("Dimension"));
    for dimension in dimensions {
        let fixed = dimension.attribute("start");
        let fixed = fixed.and_then(|size| size.trim().parse::<usize>().ok());
        let other = dimension.attribute("valueReference");
        let other = other.and_then(|reference| structural.get(reference).copied());
        let size = fixed.or(other).ok_or(())?;
        len = Some(len.unwrap_or(1_usize).checked_mul(size).ok_or(())?);
    }
    Ok(len)
}

fn starts(text: &str) -> Vec<f64> {
    let number = |word: &str| match word {
        "true" => Some(1.0),
        "false" => Some(0.0),
        other => other.parse().ok().filter(|value: &f64| value.is_finite()),
    };
    let values: Option<Vec<f64>> = text.split_whitespace().map(number).collect();
    values.unwrap_or_default()
}

pub(crate) fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|own| own.has_tag_name(name))
}

fn is_true(text: &str) -> bool {
    matches!(text, "true" | "1")
}
