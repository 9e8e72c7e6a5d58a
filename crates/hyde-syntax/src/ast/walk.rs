//! Every expression that stands in a file, whatever it is part of.

use super::{
    Argument, Change, Class, ClassBody, Declarator, Element, Equation, EquationKind, Experiment,
    ExperimentItem, Expr, File, Item, Range,
};

impl File {
    /// Shows `visit` the expressions of classes and experiments, those below others not: see [`Expr::children`].
    pub fn each_expression<'a>(&'a self, visit: &mut dyn FnMut(&'a Expr)) {
        for item in &self.items {
            match item {
                Item::Class(class) => of_class(class, visit),
                Item::Experiment(experiment) => of_experiment(experiment, visit),
                // Studies are kept as written until there is a command that runs them.
                Item::Type(_) | Item::Study(_) => {}
            }
        }
    }
}

fn of_class<'a>(class: &'a Class, visit: &mut dyn FnMut(&'a Expr)) {
    match &class.body {
        ClassBody::Long { elements, .. } => of_elements(elements, visit),
        ClassBody::Short {
            changes, effects, ..
        } => {
            of_changes(changes, visit);
            effects
                .iter()
                .for_each(|used| of_changes(&used.changes, visit));
        }
    }
}

fn of_elements<'a>(elements: &'a [Element], visit: &mut dyn FnMut(&'a Expr)) {
    for element in elements {
        match element {
            Element::Extends(_, changes) | Element::Replace(_, _, changes) => {
                of_changes(changes, visit)
            }
            Element::Declaration(declaration) => {
                declaration.dims.iter().for_each(&mut *visit);
                for declarator in &declaration.declarators {
                    of_declarator(declarator, visit);
                }
            }
            Element::Domain(domain) => of_range(&domain.range, visit),
            Element::Discretize(method) => of_arguments(&method.arguments, visit),
            Element::Modes(modes) => {
                of_arguments(&modes.arguments, visit);
                for mode in &modes.modes {
                    for list in [&mode.equations, &mode.enter, &mode.leave] {
                        of_equations(list, visit);
                    }
                    for exit in &mode.exits {
                        visit(&exit.guard);
                        of_arguments(&exit.arguments, visit);
                        of_equations(&exit.actions, visit);
                    }
                }
            }
            Element::Clocked(clocked) => {
                of_arguments(&clocked.arguments, visit);
                of_elements(&clocked.elements, visit);
            }
            Element::Equation(equation)
            | Element::InitialEquation(equation)
            | Element::Add(equation) => of_equations(std::slice::from_ref(equation), visit),
            Element::Wrap(_, value) => visit(value),
            Element::Signature(marks) => marks
                .iter()
                .for_each(|(_, arguments)| of_arguments(arguments, visit)),
            Element::Confounds(_) => {}
            Element::Measure(measure) | Element::Account(_, measure) => visit(&measure.value),
        }
    }
}

fn of_declarator<'a>(declarator: &'a Declarator, visit: &mut dyn FnMut(&'a Expr)) {
    declarator.dims.iter().for_each(&mut *visit);
    of_changes(&declarator.changes, visit);
    declarator.binding.iter().for_each(&mut *visit);
    declarator
        .within
        .iter()
        .for_each(|range| of_range(range, visit));
    of_arguments(&declarator.over, visit);
}

fn of_changes<'a>(changes: &'a [Change], visit: &mut dyn FnMut(&'a Expr)) {
    for change in changes {
        of_changes(&change.changes, visit);
        change.value.iter().for_each(&mut *visit);
    }
}

fn of_equations<'a>(equations: &'a [Equation], visit: &mut dyn FnMut(&'a Expr)) {
    for equation in equations {
        match &equation.kind {
            EquationKind::Equality { lhs, rhs, place } => {
                visit(lhs);
                visit(rhs);
                for (position, force) in place.iter().flat_map(|place| &place.loads) {
                    visit(position);
                    visit(force);
                }
            }
            EquationKind::Connect(_) => {}
            EquationKind::For {
                first,
                last,
                equations,
                ..
            } => {
                visit(first);
                visit(last);
                of_equations(equations, visit);
            }
            EquationKind::If {
                branches,
                otherwise,
            } => {
                of_branches(branches, visit);
                of_equations(otherwise, visit);
            }
            EquationKind::When(branches) => of_branches(branches, visit),
            EquationKind::Assert(condition, _) => visit(condition),
            EquationKind::Reinit(_, value) => visit(value),
        }
    }
}

fn of_branches<'a>(branches: &'a [(Expr, Vec<Equation>)], visit: &mut dyn FnMut(&'a Expr)) {
    for (condition, equations) in branches {
        visit(condition);
        of_equations(equations, visit);
    }
}

fn of_experiment<'a>(experiment: &'a Experiment, visit: &mut dyn FnMut(&'a Expr)) {
    of_changes(&experiment.changes, visit);
    for item in &experiment.items {
        match item {
            ExperimentItem::Stimulus(drives) | ExperimentItem::Replay(drives) => {
                for drive in drives {
                    visit(&drive.value);
                    drive.noise.iter().for_each(&mut *visit);
                }
            }
            ExperimentItem::Measured(channels) => {
                for channel in channels {
                    visit(&channel.signal);
                    visit(&channel.value);
                    channel.noise.iter().for_each(&mut *visit);
                }
            }
            ExperimentItem::Expect(value, _)
            | ExperimentItem::Start(value)
            | ExperimentItem::Stop(value)
            | ExperimentItem::Every(value)
            | ExperimentItem::Skip(value) => visit(value),
            ExperimentItem::Measure(measure) => visit(&measure.value),
            ExperimentItem::Solve(_, arguments) => of_arguments(arguments, visit),
            ExperimentItem::Bode(bode) => {
                bode.outputs.iter().for_each(&mut *visit);
                of_range(&bode.band, visit);
                if let Some((_, arguments)) = &bode.steps {
                    of_arguments(arguments, visit);
                }
                bode.at.iter().for_each(&mut *visit);
            }
            ExperimentItem::Margins(margins) => {
                let band = margins.band.iter();
                band.for_each(|band| of_range(band, visit));
                margins.at.iter().for_each(&mut *visit);
            }
            ExperimentItem::Figure(figure) => {
                figure
                    .panels
                    .iter()
                    .chain(&figure.over)
                    .for_each(&mut *visit);
                figure
                    .within
                    .iter()
                    .for_each(|range| of_range(range, visit));
            }
            ExperimentItem::Budget(ideals) => ideals
                .iter()
                .for_each(|ideal| of_changes(&ideal.changes, visit)),
        }
    }
}

fn of_arguments<'a>(arguments: &'a [Argument], visit: &mut dyn FnMut(&'a Expr)) {
    arguments.iter().for_each(|argument| visit(&argument.value));
}

fn of_range<'a>(range: &'a Range, visit: &mut dyn FnMut(&'a Expr)) {
    visit(&range.from);
    visit(&range.to);
}
