//! modelDescription.xml of FMI 3.0.

use crate::description::{Described, bound, start, type_name};
use crate::interface::{Causality, Interface, Variable};
use crate::xml::{Xml, number, some};
use hyde_units::Kind;

impl Described<'_> {
    /// The description in the form of FMI 3.0.
    #[must_use]
    pub fn fmi3(&self) -> String {
        let mut xml = Xml::new();
        xml.open(
            "fmiModelDescription",
            &[
                ("fmiVersion", some("3.0")),
                ("modelName", some(&self.name)),
                ("instantiationToken", some(&self.token)),
                ("description", self.description.clone()),
                ("version", None),
                (
                    "generationTool",
                    some(format!("Hyde {}", env!("CARGO_PKG_VERSION"))),
                ),
                ("variableNamingConvention", some("structured")),
            ],
        );
        if self.interface.no_model_exchange.is_none() {
            xml.leaf(
                "ModelExchange",
                &[
                    ("modelIdentifier", some(&self.identifier)),
                    ("canGetAndSetFMUState", some(true)),
                    ("canSerializeFMUState", some(true)),
                    ("providesDirectionalDerivatives", some(true)),
                    ("providesAdjointDerivatives", some(true)),
                    ("needsCompletedIntegratorStep", some(true)),
                ],
            );
        }
        xml.leaf(
            "CoSimulation",
            &[
                ("modelIdentifier", some(&self.identifier)),
                ("canGetAndSetFMUState", some(true)),
                ("canSerializeFMUState", some(true)),
                ("providesDirectionalDerivatives", some(true)),
                ("providesAdjointDerivatives", some(true)),
                ("canHandleVariableCommunicationStepSize", some(true)),
                ("providesIntermediateUpdate", some(true)),
                ("mightReturnEarlyFromDoStep", some(true)),
                ("canReturnEarlyAfterIntermediateUpdate", some(true)),
                ("hasEventMode", some(true)),
            ],
        );
        self.write_units(&mut xml);
        let types = self.types();
        if !types.is_empty() {
            xml.open("TypeDefinitions", &[]);
            for (name, unit) in &types {
                xml.leaf(
                    "Float64Type",
                    &[
                        ("name", some(name)),
                        ("unit", some(unit.si().text())),
                        (
                            "displayUnit",
                            (!unit.unit().is_si()).then(|| unit.text().to_owned()),
                        ),
                    ],
                );
            }
            xml.close();
        }
        self.write_categories(&mut xml);
        self.write_experiment(&mut xml);
        xml.open("ModelVariables", &[]);
        let aliases = self.interface.aliases();
        let variables = self.interface.variables.iter().enumerate();
        for (reference, variable) in variables.filter(|(_, own)| own.alias_of.is_none()) {
            let others = aliases.get(&reference).map_or(&[][..], Vec::as_slice);
            self.write_variable3(&mut xml, reference, variable, others);
        }
        xml.close();
        write_structure(&mut xml, self.interface);
        xml.finish()
    }

    fn write_variable3(
        &self,
        xml: &mut Xml,
        reference: usize,
        variable: &Variable,
        aliases: &[&Variable],
    ) {
        let element = match variable.kind {
            Kind::Real => "Float64",
            Kind::Integer => "Int32",
            Kind::Boolean => "Boolean",
        };
        let real = variable.kind == Kind::Real;
        let declared = variable.unit.as_ref().filter(|_| real).map(type_name);
        let state = self.interface.states.iter().any(|(of, _)| *of == reference);
        let (min, max) = variable.bounds;
        xml.open(
            element,
            &[
                ("name", some(&variable.name)),
                ("valueReference", some(reference)),
                ("description", variable.description.clone()),
                ("causality", some(variable.causality.word())),
                ("variability", some(variable.variability.word())),
                ("declaredType", declared),
                ("min", bound(variable, min)),
                ("max", bound(variable, max)),
                ("nominal", state.then(|| number(self.nominal()))),
                (
                    "derivative",
                    variable.derivative_of.map(|of| of.to_string()),
                ),
                ("start", start(variable)),
            ],
        );
        for alias in aliases {
            let shown = alias.unit.as_ref().filter(|unit| !unit.unit().is_si());
            let shown = shown.filter(|_| real).map(|unit| unit.text().to_owned());
            xml.leaf(
                "Alias",
                &[
                    ("name", some(&alias.name)),
                    ("description", alias.description.clone()),
                    ("displayUnit", shown),
                ],
            );
        }
        xml.close();
    }
}

fn write_structure(xml: &mut Xml, interface: &Interface) {
    xml.open("ModelStructure", &[]);
    let mut list = |element: &'static str, numbers: &mut dyn Iterator<Item = usize>| {
        for reference in numbers {
            xml.leaf(element, &[("valueReference", some(reference))]);
        }
    };
    list("Output", &mut interface.with(Causality::Output));
    list(
        "ContinuousStateDerivative",
        &mut interface.derivatives.iter().copied(),
    );
    list(
        "InitialUnknown",
        &mut interface.initial_unknowns().into_iter(),
    );
    list(
        "EventIndicator",
        &mut interface.guards.iter().map(|(number, _)| *number),
    );
    xml.close();
}
