//! Instantiates a model: a tree of instances, each with its parameters, variables and parts.
//!
//! `M m(R = 2)` with `model M extends B(R = 1); parameter Resistance R = 3; end M;` makes the instance `m` with the
//! parameter `m.R`, whose binding is the outermost of: the modification in the enclosing model (evaluated there), the
//! modification of the `extends` clause, the declaration. Nothing is evaluated here but what decides the structure:
//! dimensions of arrays and numbers of cells ([`crate::structural`]).

use crate::dimension::Dim;
use crate::instance::{
    Binding, Domain, DomainId, Field, Instance, InstanceId, Lowering, Member, ParameterNotes,
    VariableNotes,
};
use crate::model::{Model, listed};
use crate::names::{FileIndex, TypeName, nearest};
use hyde_diag::{Code, Diagnostic, InstancePath, Span};
use hyde_ir::{ClockId, Parameter, Quantity, Variable, VariableKind, flat};
use hyde_syntax::ast::{
    self, Change, Class, ClassBody, ClassKind, Declaration, Declarator, Element, EquationKind,
    Expr, ExprKind, Prefix, Reference,
};
use hyde_units::NamedUnit;

/// A modification of something below an instance, with the scope its value stands in.
#[derive(Clone)]
pub(crate) struct Modifier<'a> {
    target: Vec<&'a str>,
    change: &'a Change,
    scope: InstanceId,
    /// Given by the experiment, so that it can read the records' columns.
    records: bool,
    element: Option<usize>,
    /// Index into the model's list of modifications, to tell which were used.
    number: usize,
}

/// Elements of a class and its bases, each with the modifications of the `extends` clauses on the way.
struct Collected<'a> {
    element: &'a Element,
    file: FileIndex,
    modifiers: Vec<Modifier<'a>>,
}

/// Where an instance stands.
struct Place {
    path: InstancePath,
    parent: Option<InstanceId>,
    clock: Option<ClockId>,
    span: Span,
}

/// How far a walk over a class and its bases has come: the modifications that the `extends` clauses on the way made.
#[derive(Clone)]
struct Walk<'a> {
    id: InstanceId,
    file: FileIndex,
    modifiers: Vec<Modifier<'a>>,
    depth: usize,
}

impl<'a> Model<'a, '_> {
    /// Instantiates the model asked for; `None` if there is none of that name.
    pub(crate) fn instantiate_root(&mut self) -> Option<InstanceId> {
        let name = self.input.model;
        let Some(class) = self.names.own_class(name) else {
            let file = self.input.files.first()?.0;
            let diagnostic = Diagnostic::error(
                Code::NoExperiment,
                format!("the file has no model `{name}`"),
            );
            let models: Vec<&str> = self.names.own_models().collect();
            let written = self
                .input
                .experiment
                .and_then(|experiment| self.names.own_experiment(experiment))
                .filter(|experiment| experiment.model.dotted() == name);
            let diagnostic = match written {
                Some(experiment) => diagnostic.label(experiment.model.span, "not in this file"),
                None => diagnostic.label(Span::new(file, 0, 0), "searched in this file"),
            };
            self.report(match nearest(name, models.iter().copied()) {
                Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
                None if models.is_empty() => diagnostic.help("it has none"),
                None => diagnostic.help(format!("it has {}", listed(&models))),
            });
            return None;
        };
        self.flat.name = class.name.text.clone();
        let mut modifiers = Vec::new();
        if let Some(experiment) = self
            .input
            .experiment
            .and_then(|name| self.names.own_experiment(name))
        {
            self.flat.experiment.records = experiment
                .records
                .iter()
                .map(|record| record.name.text.clone())
                .collect();
            self.modifiers_of(&experiment.changes, 0, &mut modifiers);
            modifiers
                .iter_mut()
                .for_each(|modifier| modifier.records = true);
        }
        let place = Place {
            path: InstancePath::root(),
            parent: None,
            clock: None,
            span: class.name.span,
        };
        let root = self.instantiate(0, class, modifiers, place);
        self.report_unused_modifications();
        Some(root)
    }

    fn instantiate(
        &mut self,
        file: FileIndex,
        class: &'a Class,
        modifiers: Vec<Modifier<'a>>,
        place: Place,
    ) -> InstanceId {
        let Place {
            path,
            parent,
            clock,
            span,
        } = place;
        let id = self.instances.len();
        self.instances.push(Instance {
            path,
            file,
            class,
            parent,
            outer: None,
            clock,
            members: std::collections::BTreeMap::new(),
            elements: Vec::new(),
            span,
        });
        if self.depth(id) > 40 {
            self.report(
                Diagnostic::error(
                    Code::Cycle,
                    format!("`{}` contains itself", class.name.text),
                )
                .label(class.name.span, "instantiated inside itself without end")
                .help("a model cannot be a component of itself"),
            );
            return id;
        }
        let last_words = modifiers
            .iter()
            .filter(|modifier| modifier.target.len() == 1);
        self.modified
            .extend(last_words.map(|modifier| (modifier.number, id)));
        let mut collected = Vec::new();
        let walk = Walk {
            id,
            file,
            modifiers,
            depth: 0,
        };
        self.collect(walk, class, &mut collected);
        self.members(id, &collected);
        id
    }

    /// Makes the members of an instance from its collected elements: parameters first, for dimensions may use them.
    fn members(&mut self, id: InstanceId, collected: &[Collected<'a>]) {
        let discrete: Vec<&'a str> = collected
            .iter()
            .flat_map(|item| assigned_in_when(item.element))
            .collect();
        let is_parameter = |element: &Element| {
            matches!(element, Element::Declaration(d) if d.prefixes.iter().any(|p| {
                matches!(p, Prefix::Parameter | Prefix::Constant | Prefix::Size | Prefix::Shape)
            }))
        };
        for item in collected.iter().filter(|item| is_parameter(item.element)) {
            if let Element::Declaration(declaration) = item.element {
                self.declare_parameters(id, item, declaration);
            }
        }
        for item in collected {
            if let Element::Domain(domain) = item.element {
                let method = collected.iter().find_map(|other| {
                    if let Element::Discretize(method) = other.element
                        && method.domain.text == domain.name.text
                    {
                        Some(method)
                    } else {
                        None
                    }
                });
                self.declare_domain(id, domain, method);
            }
        }
        for item in collected.iter().filter(|item| !is_parameter(item.element)) {
            match item.element {
                Element::Declaration(declaration) => {
                    self.declare(id, item, declaration, &discrete, collected)
                }
                Element::Clocked(clocked) => self.clocked(id, item, clocked),
                Element::Discretize(method) => {
                    self.domain_named(id, &method.domain);
                }
                Element::Extends(..)
                | Element::Domain(_)
                | Element::Modes(_)
                | Element::Equation(_)
                | Element::InitialEquation(_)
                | Element::Wrap(..)
                | Element::Add(_)
                | Element::Replace(..)
                | Element::Signature(_)
                | Element::Confounds(_)
                | Element::Measure(_) => {}
            }
        }
        self.instances[id].elements = collected
            .iter()
            .map(|item| (item.file, item.element))
            .collect();
    }

    /// The elements of a class, those of its bases first.
    fn collect(&mut self, walk: Walk<'a>, class: &'a Class, out: &mut Vec<Collected<'a>>) {
        if walk.depth > 40 {
            self.report(
                Diagnostic::error(Code::Cycle, format!("`{}` extends itself", class.name.text))
                    .label(class.name.span, "declared here"),
            );
            return;
        }
        match &class.body {
            ClassBody::Short {
                base,
                changes,
                effects,
            } => {
                if let Some(used) = effects.first() {
                    self.not_yet("adding effects to a model", used.effect.span);
                }
                self.collect_base(walk, base, changes, out);
            }
            ClassBody::Long { elements, .. } => {
                for element in elements {
                    if let Element::Extends(base, changes) = element {
                        self.collect_base(walk.clone(), base, changes, out);
                    } else {
                        out.push(Collected {
                            element,
                            file: walk.file,
                            modifiers: walk.modifiers.clone(),
                        });
                    }
                }
            }
        }
    }

    fn collect_base(
        &mut self,
        mut walk: Walk<'a>,
        base: &'a Reference,
        changes: &'a [Change],
        out: &mut Vec<Collected<'a>>,
    ) {
        self.modifiers_of(changes, walk.id, &mut walk.modifiers);
        match self.names.class(walk.file, base) {
            Some((file, class)) => {
                walk.file = file;
                walk.depth += 1;
                self.collect(walk, class, out);
            }
            None => {
                let diagnostic = self.names.unknown(walk.file, base);
                self.report(diagnostic);
            }
        }
    }

    /// Declares variables or components.
    fn declare(
        &mut self,
        id: InstanceId,
        item: &Collected<'a>,
        declaration: &'a Declaration,
        discrete: &[&'a str],
        collected: &[Collected<'a>],
    ) {
        let class = self.names.class(item.file, &declaration.type_name);
        let quantity = self.names.quantity(item.file, &declaration.type_name);
        for declarator in &declaration.declarators {
            if !self.free_name(id, declarator) {
                continue;
            }
            let as_component = match (&class, &quantity) {
                (Some(_), None) => true,
                (None, Some(_)) => false,
                (Some(_), Some(_)) => means_component(declaration, declarator, collected),
                (None, None) => {
                    let diagnostic = self.names.unknown(item.file, &declaration.type_name);
                    self.report(diagnostic);
                    let names = declaration.declarators.iter();
                    self.undeclared
                        .extend(names.map(|declarator| declarator.name.text.as_str()));
                    return;
                }
            };
            match (as_component, class, quantity) {
                (true, Some((file, class)), _) => {
                    self.declare_component(id, item, declaration, declarator, file, class)
                }
                (_, _, Some(quantity)) => {
                    self.declare_variable(id, item, declaration, declarator, quantity, discrete)
                }
                _ => {}
            }
        }
    }

    fn declare_component(
        &mut self,
        id: InstanceId,
        item: &Collected<'a>,
        declaration: &'a Declaration,
        declarator: &'a Declarator,
        file: FileIndex,
        class: &'a Class,
    ) {
        if class.kind == ClassKind::Effect {
            self.report(
                Diagnostic::error(
                    Code::WrongType,
                    format!("`{}` is an effect, not a component", class.name.text),
                )
                .label(
                    declaration.type_name.span,
                    "an effect is switched on at a site",
                )
                .help(format!(
                    "write `model New = Old with {} on site;`",
                    class.name.text
                )),
            );
            return;
        }
        if let Some(binding) = &declarator.binding {
            self.report(
                Diagnostic::error(
                    Code::WrongType,
                    format!(
                        "the component `{}` cannot equal an expression",
                        declarator.name.text
                    ),
                )
                .label(binding.span, "a value for a component")
                .help("modify its parameters: `Mass m(M = 3 [kg]);`"),
            );
        }
        let count = self.length(id, &declaration.dims, &declarator.dims);
        let name = declarator.name.text.as_str();
        let mut inner = self.modifiers_for(name, &item.modifiers);
        self.modifiers_of(&declarator.changes, id, &mut inner);
        let Some((file, class)) = self.redeclared(declaration, declarator, &inner, (file, class))
        else {
            self.undeclared.insert(name);
            return;
        };
        let (path, clock) = (self.path(id), self.instances[id].clock);
        let place = |path: InstancePath| Place {
            path,
            parent: Some(id),
            clock,
            span: declarator.name.span,
        };
        match count {
            None => {
                let part = self.instantiate(file, class, inner, place(path.child(name)));
                self.instances[id]
                    .members
                    .insert(name, Member::Instance(part));
            }
            Some(count) => {
                let mut parts = Vec::new();
                for index in 0..count {
                    let mut own = inner.clone();
                    for modifier in &mut own {
                        if !modifier.change.each && modifier.element.is_none() {
                            modifier.element = Some(index);
                        }
                    }
                    let child = path.child(&format!("{name}[{}]", index + 1));
                    parts.push(self.instantiate(file, class, own, place(child)));
                }
                self.instances[id]
                    .members
                    .insert(name, Member::Instances(parts));
            }
        }
    }

    /// The class of a component: that of the outermost redeclaration, if there is one.
    fn redeclared(
        &mut self,
        declaration: &Declaration,
        declarator: &Declarator,
        modifiers: &[Modifier<'a>],
        declared: (FileIndex, &'a Class),
    ) -> Option<(FileIndex, &'a Class)> {
        let redeclaration = modifiers.iter().find_map(|modifier| {
            let new = modifier.change.redeclare.as_ref()?;
            modifier.target.is_empty().then_some((modifier, new))
        });
        let Some((modifier, new)) = redeclaration else {
            return Some(declared);
        };
        if !declaration.prefixes.contains(&Prefix::Replaceable) {
            let name = &declarator.name.text;
            self.report(
                Diagnostic::error(Code::FinalModified, format!("`{name}` is not replaceable"))
                    .label(modifier.change.target.span, "cannot be redeclared")
                    .label(declarator.name.span, "declared here, for good")
                    .help(format!(
                        "declare it `replaceable {} {name}`",
                        declared.1.name.text
                    )),
            );
            return None;
        }
        let file = self.names.file_of(new.span)?;
        let class = self.names.class(file, new);
        if class.is_none() {
            let diagnostic = self.names.unknown(file, new);
            self.report(diagnostic);
        }
        class
    }

    fn declare_variable(
        &mut self,
        id: InstanceId,
        item: &Collected<'a>,
        declaration: &'a Declaration,
        declarator: &'a Declarator,
        kind: TypeName<'a>,
        discrete: &[&'a str],
    ) {
        let name = declarator.name.text.as_str();
        let has = |prefix| declaration.prefixes.contains(&prefix);
        let modifiers = self.modifiers_for(name, &item.modifiers);
        let binding = self.binding(id, declarator, &modifiers);
        let attribute =
            |model: &mut Self, word: &str| model.attribute(id, declarator, &modifiers, word);
        let start = attribute(self, "start");
        let fixed = attribute(self, "fixed");
        self.check_attributes(declarator, &modifiers);
        let fixed = fixed.is_some_and(|fixed| matches!(fixed.expr.kind, ExprKind::Boolean(true)));
        let (dim, quantity) = self.quantity(kind, binding.map(|binding| binding.expr));
        let clock = self.instances[id].clock;
        let variable_kind = match clock {
            Some(clock) => VariableKind::Clocked(clock),
            None if discrete.contains(&name) => VariableKind::Discrete,
            None => VariableKind::Continuous,
        };
        let field = if has(Prefix::Field) {
            let field = self.field(id, declarator);
            if field.is_none() {
                self.undeclared.insert(name);
                return;
            }
            field
        } else {
            None
        };
        let (len, first) = match field {
            Some(field) => {
                let cells = self.domains[field.domain].cells;
                (
                    Some(if field.flux { cells } else { cells + 1 }),
                    i32::from(field.flux),
                )
            }
            None => (self.length(id, &declaration.dims, &declarator.dims), 1),
        };
        let origin = self.origin(id, declarator.name.span);
        let flow = has(Prefix::Flow);
        if flow && self.instances[id].class.kind != ClassKind::Connector {
            self.report(
                Diagnostic::error(
                    Code::BadConnection,
                    format!("`flow` on `{name}`, which is in no connector"),
                )
                .label(declaration.span, "only the variables of a connector flow"),
            );
        }
        self.variables.push(VariableNotes {
            instance: id,
            dim,
            binding,
            start,
            field,
        });
        let var = self.flat.variables.push(Variable {
            name: self.instances[id].path.member(name),
            len,
            first,
            kind: variable_kind,
            quantity,
            start: Vec::new(),
            fixed,
            flow,
            boolean: matches!(kind, TypeName::Boolean),
            input: has(Prefix::Input),
            trace: None,
            origin,
        });
        self.instances[id]
            .members
            .insert(name, Member::Variable(var));
    }

    fn declare_parameters(
        &mut self,
        id: InstanceId,
        item: &Collected<'a>,
        declaration: &'a Declaration,
    ) {
        let Some(kind) = self.names.quantity(item.file, &declaration.type_name) else {
            let diagnostic = match self.names.class(item.file, &declaration.type_name) {
                Some(_) => Diagnostic::error(Code::WrongType, "a model cannot be a parameter")
                    .label(declaration.type_name.span, "this is a model")
                    .help("declare it without `parameter`; exchange it by `replaceable`"),
                None => self.names.unknown(item.file, &declaration.type_name),
            };
            self.report(diagnostic);
            let names = declaration.declarators.iter();
            self.undeclared
                .extend(names.map(|declarator| declarator.name.text.as_str()));
            return;
        };
        let has = |prefix| declaration.prefixes.contains(&prefix);
        for declarator in &declaration.declarators {
            if !self.free_name(id, declarator) {
                continue;
            }
            let name = declarator.name.text.as_str();
            let modifiers = self.modifiers_for(name, &item.modifiers);
            let outermost = modifiers.iter().find(|modifier| modifier.target.is_empty());
            if let (true, Some(modifier)) = (has(Prefix::Final) || has(Prefix::Constant), outermost)
            {
                self.report(
                    Diagnostic::error(Code::FinalModified, format!("`{name}` is final"))
                        .label(modifier.change.target.span, "cannot be modified")
                        .label(declarator.name.span, "declared final here")
                        .help(format!(
                            "leave `{name}` out: modify the parameters that its value is made of"
                        )),
                );
            }
            let declared = declarator
                .prior
                .as_ref()
                .or_else(|| outermost.and_then(|m| m.change.prior.as_ref()));
            let prior = outermost.and_then(|m| m.change.prior.as_ref()).or(declared);
            let prior = prior.and_then(|prior| self.prior(prior));
            let source = outermost
                .and_then(|m| m.change.source.clone())
                .or_else(|| declarator.source.clone());
            let binding = self.binding(id, declarator, &modifiers);
            self.check_attributes(declarator, &modifiers);
            let (dim, quantity) = self.quantity(kind, binding.map(|binding| binding.expr));
            let len = self.length(id, &declaration.dims, &declarator.dims);
            let span = binding.map_or(declarator.name.span, |binding| binding.span);
            let path = self.path(id);
            let is_final = has(Prefix::Final)
                || has(Prefix::Constant)
                || outermost.is_some_and(|m| m.change.is_final);
            self.parameters.push(ParameterNotes {
                dim,
                binding,
                state: Lowering::Waiting,
                boolean: matches!(kind, TypeName::Boolean),
            });
            let param = self.flat.parameters.push(Parameter {
                name: path.member(name),
                len,
                value: Vec::new(),
                quantity,
                structural: false,
                is_final,
                derived: false,
                prior,
                source,
                origin: self.origin(id, span),
            });
            self.instances[id]
                .members
                .insert(name, Member::Parameter(param));
        }
    }

    fn declare_domain(
        &mut self,
        id: InstanceId,
        domain: &'a ast::Domain,
        method: Option<&'a ast::Discretize>,
    ) {
        let name = domain.name.text.as_str();
        let span = domain.name.span;
        let Some(method) = method else {
            self.report(
                Diagnostic::error(
                    Code::FieldUse,
                    format!("the domain `{name}` is not discretised"),
                )
                .label(span, "how many cells?")
                .help(format!("write `discretize {name} by fem(n = 24);`")),
            );
            self.undeclared.insert(name);
            return;
        };
        let averaged = match method.method.text.as_str() {
            "fem" => true,
            "fv" => false,
            other => {
                self.report(
                    Diagnostic::error(
                        Code::NotYet,
                        format!("no discretisation is called `{other}` in this version"),
                    )
                    .label(method.method.span, "not known")
                    .help("write `fem(n = …)` or `fv(n = …)`"),
                );
                self.undeclared.insert(name);
                return;
            }
        };
        let cells = method
            .arguments
            .iter()
            .find(|a| a.name.as_ref().is_some_and(|name| name.text == "n"));
        let Some(cells) = cells else {
            self.report(
                Diagnostic::error(Code::BadArguments, format!("how many cells has `{name}`?"))
                    .label(method.method.span, "no `n` given")
                    .help(format!("write `{}(n = 24)`", method.method.text)),
            );
            self.undeclared.insert(name);
            return;
        };
        let Some(count) = self.structural_integer(id, &cells.value) else {
            self.undeclared.insert(name);
            return;
        };
        let Some(cells) = usize::try_from(count)
            .ok()
            .filter(|&n| (2..=10_000_000).contains(&n))
        else {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!("`{name}` cannot have {count} cells"),
                )
                .label(cells.value.span, "at least 2"),
            );
            self.undeclared.insert(name);
            return;
        };
        let domain = Domain {
            instance: id,
            name,
            coordinate: &domain.coordinate.text,
            from: &domain.range.from,
            to: &domain.range.to,
            cells,
            averaged,
            span,
            mesh: None,
        };
        self.domains.push(domain);
        self.instances[id]
            .members
            .insert(name, Member::Domain(self.domains.len() - 1));
    }

    /// The domain of a field and whether its values lie between the nodes: those of a flux, whose binding has `pder`.
    fn field(&mut self, id: InstanceId, declarator: &'a Declarator) -> Option<Field> {
        let name = &declarator.name;
        let Some(domain) = &declarator.domain else {
            self.report(
                Diagnostic::error(
                    Code::FieldUse,
                    format!("on which domain is the field `{}`?", name.text),
                )
                .label(name.span, "a field needs a domain")
                .help(format!("write `field … {} on bar;`", name.text)),
            );
            return None;
        };
        let domain = self.domain_named(id, domain)?;
        let flux = declarator
            .binding
            .as_ref()
            .is_some_and(|binding| binding.calls("pder"));
        Some(Field {
            domain,
            flux,
            traces: None,
        })
    }

    /// The domain of that name in an instance; reported once if there is none.
    pub(crate) fn domain_named(&mut self, id: InstanceId, name: &'a ast::Name) -> Option<DomainId> {
        if let Some(Member::Domain(domain)) = self.instances[id].members.get(name.text.as_str()) {
            return Some(*domain);
        }
        if self.undeclared.insert(&name.text) {
            self.report(
                Diagnostic::error(
                    Code::UnknownName,
                    format!("no domain is called `{}` here", name.text),
                )
                .label(name.span, "not known")
                .help("declare it: `domain bar(x in 0 .. len);`"),
            );
        }
        None
    }

    fn clocked(&mut self, id: InstanceId, item: &Collected<'a>, clocked: &'a ast::Clocked) {
        let name = clocked.name.text.as_str();
        if self.instances[id].clock.is_some() {
            self.report(
                Diagnostic::error(Code::ClockBorder, "a clocked part inside a clocked part")
                    .label(clocked.name.span, "move it beside the other"),
            );
            return;
        }
        let origin = self.origin(id, clocked.name.span);
        let nothing = self.flat.exprs.constant(0.0);
        let path = self.path(id).child(name);
        let clock = self.flat.clocks.push(flat::Clock {
            name: path.as_str().to_owned(),
            period: nothing,
            delay: nothing,
            phase: nothing,
            origin,
        });
        let part = self.instances.len();
        self.instances.push(Instance {
            path,
            file: item.file,
            class: self.instances[id].class,
            parent: Some(id),
            outer: Some(id),
            clock: Some(clock),
            members: std::collections::BTreeMap::new(),
            elements: Vec::new(),
            span: clocked.name.span,
        });
        self.instances[id]
            .members
            .insert(name, Member::Instance(part));
        let modifiers = self.modifiers_for(name, &item.modifiers);
        let collected: Vec<Collected<'a>> = clocked
            .elements
            .iter()
            .map(|element| Collected {
                element,
                file: item.file,
                modifiers: modifiers.clone(),
            })
            .collect();
        self.members(part, &collected);
    }

    /// The dimension and printed unit of a declared type; `Real` takes those of a literal it is bound to.
    fn quantity(&mut self, kind: TypeName<'a>, binding: Option<&'a Expr>) -> (Dim, Quantity) {
        let written = binding
            .and_then(literal_unit)
            .and_then(|unit| NamedUnit::parse(&unit.text).ok());
        let (dim, unit) = match kind {
            TypeName::Integer | TypeName::Boolean => return (Dim::NUMBER, Quantity::number()),
            TypeName::Real => match &written {
                Some(unit) => (Dim::known(unit.unit().dimension), None),
                None => (Dim::unknown(self.dimensions.fresh()), None),
            },
            TypeName::Quantity(file_of_type, item) => {
                let unit = self.type_unit(file_of_type, item, 0);
                let dim = unit
                    .as_ref()
                    .map_or(Dim::NUMBER, |unit| Dim::known(unit.unit().dimension));
                (dim, unit)
            }
        };
        let same = |unit: &NamedUnit| dim.as_known() == Some(unit.unit().dimension);
        let quantity = match (written.filter(same), unit) {
            (Some(unit), _) | (None, Some(unit)) => Quantity {
                dimension: unit.unit().dimension,
                unit,
            },
            (None, None) => Quantity::number(),
        };
        (dim, quantity)
    }

    fn type_unit(
        &mut self,
        file: FileIndex,
        item: &'a ast::TypeItem,
        depth: usize,
    ) -> Option<NamedUnit> {
        if let Some(unit) = &item.unit {
            return match NamedUnit::parse(&unit.text) {
                Ok(unit) => Some(unit),
                Err(error) => {
                    self.bad_unit(unit, &error);
                    None
                }
            };
        }
        if depth > 20 {
            return None;
        }
        match self.names.quantity(file, &item.base) {
            Some(TypeName::Quantity(file, base)) => self.type_unit(file, base, depth + 1),
            Some(TypeName::Real | TypeName::Integer | TypeName::Boolean) => None,
            None => {
                let diagnostic = self.names.unknown(file, &item.base);
                self.report(diagnostic);
                None
            }
        }
    }

    fn prior(&mut self, prior: &'a ast::Prior) -> Option<hyde_ir::Prior> {
        if prior.percent {
            return Some(hyde_ir::Prior::Relative(prior.value / 100.0));
        }
        let scale = match &prior.unit {
            None => 1.0,
            Some(unit) => match NamedUnit::parse(&unit.text) {
                Ok(unit) => unit.unit().difference_to_si(1.0),
                Err(error) => {
                    self.bad_unit(unit, &error);
                    return None;
                }
            },
        };
        Some(hyde_ir::Prior::Absolute(prior.value * scale))
    }

    /// The value of a name: the outermost modification, else the declaration.
    fn binding(
        &mut self,
        id: InstanceId,
        declarator: &'a Declarator,
        modifiers: &[Modifier<'a>],
    ) -> Option<Binding<'a>> {
        let modified = modifiers
            .iter()
            .find(|modifier| modifier.target.is_empty() && modifier.change.value.is_some());
        match modified {
            Some(modifier) => {
                let expr = modifier.change.value.as_ref()?;
                Some(Binding {
                    expr,
                    scope: modifier.scope,
                    records: modifier.records,
                    element: modifier.element,
                    span: modifier.change.target.span,
                })
            }
            None => {
                let expr = declarator.binding.as_ref()?;
                Some(Binding {
                    expr,
                    scope: id,
                    records: false,
                    element: None,
                    span: declarator.name.span,
                })
            }
        }
    }

    /// `start` or `fixed` of a variable: the outermost modification, else the declaration.
    fn attribute(
        &mut self,
        id: InstanceId,
        declarator: &'a Declarator,
        modifiers: &[Modifier<'a>],
        word: &str,
    ) -> Option<Binding<'a>> {
        let modified = modifiers
            .iter()
            .find(|modifier| modifier.target == [word] && modifier.change.value.is_some());
        if let Some(modifier) = modified {
            self.modifications[modifier.number].2 = true;
            let expr = modifier.change.value.as_ref()?;
            return Some(Binding {
                expr,
                scope: modifier.scope,
                records: modifier.records,
                element: modifier.element,
                span: expr.span,
            });
        }
        let change = declarator
            .changes
            .iter()
            .find(|change| change.target.as_word() == Some(word))?;
        let expr = change.value.as_ref()?;
        Some(Binding {
            expr,
            scope: id,
            records: false,
            element: None,
            span: expr.span,
        })
    }

    fn check_attributes(&mut self, declarator: &'a Declarator, modifiers: &[Modifier<'a>]) {
        for modifier in modifiers {
            if modifier.target.is_empty()
                || matches!(modifier.target.as_slice(), ["start" | "fixed"])
            {
                self.modifications[modifier.number].2 = true;
            }
        }
        for change in &declarator.changes {
            if !matches!(change.target.as_word(), Some("start" | "fixed")) {
                self.report(
                    Diagnostic::error(
                        Code::UnknownModification,
                        format!("a variable has no attribute `{}`", change.target.dotted()),
                    )
                    .label(change.target.span, "changes nothing")
                    .help("attributes are `start` and `fixed`"),
                );
            }
        }
    }

    /// The modifications of `name`, with it taken off their targets.
    fn modifiers_for(&mut self, name: &str, modifiers: &[Modifier<'a>]) -> Vec<Modifier<'a>> {
        let mut found = Vec::new();
        for modifier in modifiers
            .iter()
            .filter(|modifier| modifier.target.first() == Some(&name))
        {
            let mut inner = modifier.clone();
            inner.target.remove(0);
            if inner.target.is_empty() {
                self.modifications[inner.number].2 = true;
            }
            found.push(inner);
        }
        found
    }

    /// Nested changes as a list of single ones.
    fn modifiers_of(
        &mut self,
        changes: &'a [Change],
        scope: InstanceId,
        out: &mut Vec<Modifier<'a>>,
    ) {
        self.modifiers_below(changes, scope, &[], out);
    }

    fn modifiers_below(
        &mut self,
        changes: &'a [Change],
        scope: InstanceId,
        above: &[&'a str],
        out: &mut Vec<Modifier<'a>>,
    ) {
        for change in changes {
            let mut target = above.to_vec();
            target.extend(
                change
                    .target
                    .parts
                    .iter()
                    .map(|part| part.name.text.as_str()),
            );
            self.modifiers_below(&change.changes, scope, &target, out);
            if change.redeclare.is_some()
                || change.value.is_some()
                || change.prior.is_some()
                || change.source.is_some()
            {
                let number = self.modifications.len();
                self.modifications
                    .push((change.target.span, target.join("."), false));
                out.push(Modifier {
                    target,
                    change,
                    scope,
                    records: false,
                    element: None,
                    number,
                });
            }
        }
    }

    fn report_unused_modifications(&mut self) {
        let unused: Vec<(usize, Span, String)> = (0..)
            .zip(&self.modifications)
            .filter(|(_, (.., used))| !used)
            .map(|(number, (span, name, _))| (number, *span, name.clone()))
            .collect();
        for (number, span, name) in unused {
            let last = name.rsplit('.').next().unwrap_or(&name);
            if name.split('.').any(|word| self.undeclared.contains(word)) {
                continue;
            }
            let diagnostic = Diagnostic::error(
                Code::UnknownModification,
                format!("there is no `{name}` to modify"),
            );
            let Some(instance) = self.modified.get(&number).map(|&id| &self.instances[id]) else {
                self.report(diagnostic.label(span, "changes nothing"));
                continue;
            };
            let known: Vec<&str> = instance.members.keys().copied().collect();
            let diagnostic = diagnostic.label(
                span,
                format!("`{}` has nothing of that name", instance.class.name.text),
            );
            let near = nearest(last, known.iter().copied()).filter(|near| *near != last);
            self.report(match near {
                Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
                None => diagnostic.help(format!("it has {}", listed(&known))),
            });
        }
    }

    fn free_name(&mut self, id: InstanceId, declarator: &'a Declarator) -> bool {
        let name = declarator.name.text.as_str();
        let Some(member) = self.instances[id].members.get(name) else {
            return true;
        };
        let first = match member {
            Member::Variable(var) => Some(self.flat.variables[*var].origin.span),
            Member::Parameter(param) => Some(self.flat.parameters[*param].origin.span),
            Member::Instance(part) => Some(self.instances[*part].span),
            Member::Instances(parts) => parts.first().map(|part| self.instances[*part].span),
            Member::Domain(domain) => Some(self.domains[*domain].span),
        };
        let diagnostic = Diagnostic::error(Code::Duplicate, format!("`{name}` is declared twice"))
            .label(declarator.name.span, "declared again here");
        let diagnostic = match first {
            Some(first) => diagnostic.label(first, "declared first here"),
            None => diagnostic,
        };
        self.report(diagnostic.help("rename one of the two, or take it out"));
        false
    }

    /// The length that dimensions after the type or the name give.
    fn length(
        &mut self,
        id: InstanceId,
        of_type: &'a [Expr],
        of_name: &'a [Expr],
    ) -> Option<usize> {
        let dims: Vec<&'a Expr> = of_name.iter().chain(of_type).collect();
        match dims.as_slice() {
            [] => None,
            [dim] => {
                let Some(length) = self.structural_integer(id, dim) else {
                    return Some(0); // Reported; no element is looked for in it.
                };
                if !(0..=100_000_000).contains(&length) {
                    self.report(
                        Diagnostic::error(
                            Code::BadShape,
                            format!("an array cannot have {length} elements"),
                        )
                        .label(dim.span, "the number of elements"),
                    );
                    return Some(0);
                }
                usize::try_from(length).ok()
            }
            [_, second, ..] => {
                self.report(
                    Diagnostic::error(Code::NotYet, "arrays have one dimension in this version")
                        .label(second.span, "a second dimension"),
                );
                None
            }
        }
    }

    fn depth(&self, id: InstanceId) -> usize {
        std::iter::successors(Some(id), |&id| self.instances[id].parent).count()
    }

    /// Refuses what is parsed but not compiled in this version.
    pub(crate) fn not_yet(&mut self, what: &str, span: Span) {
        self.report(
            Diagnostic::error(
                Code::NotYet,
                format!("{what} is parsed but not compiled in this version"),
            )
            .label(span, "not compiled yet"),
        );
    }
}

/// Whether a name declared with a word that is both a type and a model means a component: it is used with a dot or
/// modified as one.
fn means_component(
    declaration: &Declaration,
    declarator: &Declarator,
    collected: &[Collected<'_>],
) -> bool {
    let quantity = [
        Prefix::Input,
        Prefix::Output,
        Prefix::Flow,
        Prefix::Site,
        Prefix::Field,
    ];
    if declarator.binding.is_some()
        || declaration
            .prefixes
            .iter()
            .any(|prefix| quantity.contains(prefix))
    {
        return false;
    }
    if !declarator.changes.is_empty() {
        return declarator
            .changes
            .iter()
            .any(|change| !matches!(change.target.as_word(), Some("start" | "fixed")));
    }
    collected
        .iter()
        .any(|item| element_uses_member(item.element, &declarator.name.text))
}

fn element_uses_member(element: &Element, name: &str) -> bool {
    let expr = |e: &Expr| uses_member(e, name);
    match element {
        Element::Equation(equation) | Element::InitialEquation(equation) => {
            equation_uses_member(equation, name)
        }
        Element::Declaration(declaration) => declaration.declarators.iter().any(|declarator| {
            declarator.binding.as_ref().is_some_and(expr)
                || declarator
                    .changes
                    .iter()
                    .any(|change| change.value.as_ref().is_some_and(expr))
        }),
        Element::Clocked(clocked) => clocked
            .elements
            .iter()
            .any(|inner| element_uses_member(inner, name)),
        Element::Modes(modes) => modes.modes.iter().any(|mode| {
            mode.equations
                .iter()
                .any(|equation| equation_uses_member(equation, name))
                || mode.exits.iter().any(|exit| expr(&exit.guard))
        }),
        Element::Extends(..)
        | Element::Domain(_)
        | Element::Discretize(_)
        | Element::Wrap(..)
        | Element::Add(_)
        | Element::Replace(..)
        | Element::Signature(_)
        | Element::Confounds(_)
        | Element::Measure(_) => false,
    }
}

fn equation_uses_member(equation: &ast::Equation, name: &str) -> bool {
    let inside =
        |list: &[ast::Equation]| list.iter().any(|inner| equation_uses_member(inner, name));
    match &equation.kind {
        EquationKind::Connect(sides) => sides.iter().any(|side| starts_with_member(side, name)),
        EquationKind::Equality { lhs, rhs, .. } => uses_member(lhs, name) || uses_member(rhs, name),
        EquationKind::For { equations, .. } => inside(equations),
        EquationKind::If {
            branches,
            otherwise,
        } => branches.iter().any(|(_, list)| inside(list)) || inside(otherwise),
        EquationKind::When(branches) => branches.iter().any(|(_, list)| inside(list)),
        EquationKind::Assert(condition, _) => uses_member(condition, name),
        EquationKind::Reinit(state, value) => {
            starts_with_member(state, name) || uses_member(value, name)
        }
    }
}

fn uses_member(expr: &Expr, name: &str) -> bool {
    expr.any(&|expr| {
        matches!(&expr.kind, ExprKind::Reference(path) | ExprKind::Call(path, _) if starts_with_member(path, name))
    })
}

fn starts_with_member(reference: &Reference, name: &str) -> bool {
    reference.parts.len() > 1 && reference.parts[0].name.text == name
}

/// The names that the `when` clauses of an element assign.
fn assigned_in_when(element: &Element) -> Vec<&str> {
    let Element::Equation(equation) = element else {
        return Vec::new();
    };
    let EquationKind::When(branches) = &equation.kind else {
        return Vec::new();
    };
    let equations = branches.iter().flat_map(|(_, list)| list);
    let assigned = equations.filter_map(|equation| {
        if let EquationKind::Equality { lhs, .. } = &equation.kind
            && let ExprKind::Reference(name) = &lhs.kind
        {
            name.as_word()
        } else {
            None
        }
    });
    assigned.collect()
}

/// The unit of a literal, possibly negative.
fn literal_unit(expr: &Expr) -> Option<&ast::UnitText> {
    match &expr.kind {
        ExprKind::Number(_, unit) => unit.as_ref(),
        ExprKind::Unary(_, inner) => literal_unit(inner),
        ExprKind::Array(items, unit) => unit
            .as_ref()
            .or_else(|| items.first().and_then(literal_unit)),
        ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..) => None,
    }
}
