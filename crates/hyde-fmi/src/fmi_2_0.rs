//! modelDescription.xml of FMI 2.0.

use crate::description::{Described, bound, start, type_name};
use crate::interface::{Causality, Source, Variable};
use crate::xml::{Xml, number, some};
use hyde_units::Kind;

impl Described<'_> {
    /// The description in the form of FMI 2.0. A variable's index, from 1, is its number plus 1, but for guards, which have none.
    /// An alias has the value reference of the variable that it is another name of.
    #[must_use]
    pub fn fmi2(&self) -> String {
        let mut xml = Xml::new();
        let interface = self.interface;
        xml.open(
            "fmiModelDescription",
            &[
                ("fmiVersion", some("2.0")),
                ("modelName", some(&self.name)),
                ("guid", some(&self.token)),
                ("description", self.description.clone()),
                (
                    "generationTool",
                    some(format!("Hyde {}", env!("CARGO_PKG_VERSION"))),
                ),
                ("variableNamingConvention", some("structured")),
                ("numberOfEventIndicators", some(interface.guards.len())),
            ],
        );
        if interface.no_model_exchange.is_none() {
            xml.leaf(
                "ModelExchange",
                &[
                    ("modelIdentifier", some(&self.identifier)),
                    ("canGetAndSetFMUstate", some(true)),
                    ("canSerializeFMUstate", some(true)),
                    ("providesDirectionalDerivative", some(true)),
                ],
            );
        }
        xml.leaf(
            "CoSimulation",
            &[
                ("modelIdentifier", some(&self.identifier)),
                ("canHandleVariableCommunicationStepSize", some(true)),
                ("canGetAndSetFMUstate", some(true)),
                ("canSerializeFMUstate", some(true)),
                ("providesDirectionalDerivative", some(true)),
            ],
        );
        self.write_units(&mut xml);
        let types = self.types();
        if !types.is_empty() {
            xml.open("TypeDefinitions", &[]);
            for (name, unit) in &types {
                xml.open("SimpleType", &[("name", some(name))]);
                xml.leaf(
                    "Real",
                    &[
                        ("unit", some(unit.si().text())),
                        (
                            "displayUnit",
                            (!unit.unit().is_si()).then(|| unit.text().to_owned()),
                        ),
                    ],
                );
                xml.close();
            }
            xml.close();
        }
        self.write_categories(&mut xml);
        self.write_experiment(&mut xml);
        xml.open("ModelVariables", &[]);
        for (number, variable) in interface.variables.iter().enumerate() {
            if !matches!(variable.source, Source::Guard(_)) {
                self.write_variable2(&mut xml, number, variable);
            }
        }
        xml.close();
        xml.open("ModelStructure", &[]);
        let mut list = |element: &'static str, numbers: Vec<usize>| {
            if numbers.is_empty() {
                return;
            }
            xml.open(element, &[]);
            for reference in numbers {
                xml.leaf("Unknown", &[("index", some(reference + 1))]);
            }
            xml.close();
        };
        list("Outputs", interface.with(Causality::Output).collect());
        list("Derivatives", interface.derivatives.clone());
        list("InitialUnknowns", interface.initial_unknowns());
        xml.close();
        xml.finish()
    }

    fn write_variable2(&self, xml: &mut Xml, own: usize, variable: &Variable) {
        xml.open(
            "ScalarVariable",
            &[
                ("name", some(&variable.name)),
                ("valueReference", some(variable.alias_of.unwrap_or(own))),
                ("description", variable.description.clone()),
                ("causality", some(variable.causality.word())),
                ("variability", some(variable.variability.word())),
            ],
        );
        let state = self.interface.states.iter().any(|(of, _)| *of == own);
        let (min, max) = variable.bounds;
        let range = [
            ("min", bound(variable, min)),
            ("max", bound(variable, max)),
            ("start", start(variable)),
        ];
        match variable.kind {
            Kind::Real => {
                let declared = variable.unit.as_ref().map(type_name);
                let mut attributes = vec![("declaredType", declared)];
                attributes.extend(range);
                attributes.push(("nominal", state.then(|| number(self.nominal()))));
                let of = variable.derivative_of.map(|of| (of + 1).to_string());
                attributes.push(("derivative", of));
                xml.leaf("Real", &attributes);
            }
            Kind::Integer => xml.leaf("Integer", &range),
            Kind::Boolean => xml.leaf("Boolean", &range[2..]),
        }
        xml.close();
    }
}
