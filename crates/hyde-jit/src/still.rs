//! [`Still`]: derivatives by what is constant between events, parameters and memory, made when a gradient asks for them.

use crate::compiled::{Backend, Code, entries};
use crate::interpret::{Frame, Interpreter};
use crate::routine::{self, Routine};
use hyde_ir::dae::{Dae, Function, Partial};
use hyde_ir::{ClockId, ExprId, Id as _, Index, Range};
use hyde_program::{PartialEntry, Point, TickWrt, Workspace, Wrt};
use std::collections::BTreeMap;

/// Derivatives by parameters and memory.
pub(crate) struct Still {
    functions: BTreeMap<Function, Derivatives>,
    ticks: Vec<Tick>,
    parameters: Parametric,
    start: Parametric,
    /// Of the instants of clocks and relations.
    instants: BTreeMap<ExprId, Parametric>,
}

struct Derivatives {
    entries: Vec<PartialEntry>,
    code: Code,
}

struct Tick {
    places: Vec<(usize, TickWrt)>,
    code: Code,
}

/// Derivatives that are made of parameters alone.
struct Parametric {
    entries: Vec<PartialEntry>,
    code: Interpreter,
}

impl Still {
    pub(crate) fn new(dae: &Dae, backend: Backend) -> Self {
        let mut dae = dae.clone();
        let mut functions = BTreeMap::new();
        for function in Function::ALL {
            let list = hyde_analysis::still_partials(&mut dae, function);
            let name = format!("{}_still_partials", routine::name(function));
            let derivatives = Derivatives {
                entries: entries(&list),
                code: Code::new(&dae, &Routine::partials(&dae, name, &list), backend),
            };
            functions.insert(function, derivatives);
        }
        let clocks: Vec<ClockId> = dae.ticks.ids().collect();
        let ticks = clocks
            .into_iter()
            .map(|clock| Tick::new(&mut dae, clock, backend))
            .collect();
        let list = hyde_analysis::parameter_slopes(&mut dae);
        let parameters = Parametric::new(&dae, &list);
        let list = hyde_analysis::start_slopes(&mut dae);
        let start = Parametric::new(&dae, &list);
        let of_clocks = dae.ticks.iter();
        let of_clocks = of_clocks.flat_map(|tick| [tick.period, tick.delay, tick.phase]);
        let of_relations = dae.relations.iter();
        let of_relations = of_relations.filter_map(|relation| relation.time_event);
        let instants: Vec<ExprId> = of_clocks.chain(of_relations).collect();
        let instants = instants
            .into_iter()
            .map(|value| {
                let list = hyde_analysis::number_slopes(&mut dae, value);
                (value, Parametric::new(&dae, &list))
            })
            .collect();
        Self {
            functions,
            ticks,
            parameters,
            start,
            instants,
        }
    }

    pub(crate) fn entries(&self, function: Function) -> &[PartialEntry] {
        &self.functions[&function].entries
    }

    pub(crate) fn partials(
        &self,
        function: Function,
        at: Point<'_>,
        workspace: &mut Workspace,
        out: &mut [f64],
    ) {
        let derivatives = &self.functions[&function];
        assert!(
            out.len() >= derivatives.entries.len(),
            "room for every value"
        );
        derivatives.code.run(at, workspace, out);
    }

    pub(crate) fn tick_partials(
        &self,
        clock: usize,
        at: Point<'_>,
        workspace: &mut Workspace,
    ) -> Vec<(usize, TickWrt, f64)> {
        let tick = &self.ticks[clock];
        let mut values = vec![0.0; tick.places.len()];
        tick.code.run(at, workspace, &mut values);
        let pairs = tick.places.iter().zip(values);
        pairs
            .map(|(&(row, wrt), value)| (row, wrt, value))
            .collect()
    }

    /// The derivative of the whole parameter vector by each chosen number of it. Those chosen are independent of each
    /// other; what uses them follows, in the order of computation.
    pub(crate) fn parameter_directions(&self, chosen: &[usize], p: &[f64]) -> Vec<Vec<f64>> {
        let slopes = self.parameters.values(p);
        let follow = |&place: &usize| {
            let mut direction = vec![0.0; p.len()];
            direction[place] = 1.0;
            for &(row, column, slope) in &slopes {
                if !chosen.contains(&row) {
                    direction[row] += slope * direction[column];
                }
            }
            direction
        };
        chosen.iter().map(follow).collect()
    }

    pub(crate) fn start_partials(&self, p: &[f64]) -> Vec<(usize, usize, f64)> {
        self.start.values(p)
    }

    /// The derivatives of an instant of a clock or a relation by parameters.
    pub(crate) fn instant_partials(&self, value: ExprId, p: &[f64]) -> Vec<(usize, f64)> {
        let values = self.instants.get(&value).map(|slopes| slopes.values(p));
        values
            .into_iter()
            .flatten()
            .map(|(_, column, slope)| (column, slope))
            .collect()
    }
}

impl Tick {
    fn new(dae: &mut Dae, clock: ClockId, backend: Backend) -> Self {
        let list = hyde_analysis::tick_partials(dae, clock);
        let partial = |(row, &(_, _, value)): (i32, &(usize, _, ExprId))| Partial {
            range: Range::SCALAR,
            row: Index::fixed(row),
            wrt: hyde_ir::dae::Wrt::Time,
            value,
        };
        let values: Vec<Partial> = (0..).zip(&list).map(partial).collect();
        let name = format!("tick_{}_partials", clock.index());
        let places = list.into_iter().map(|(row, wrt, _)| (row, in_program(wrt)));
        Self {
            places: places.collect(),
            code: Code::new(dae, &Routine::partials(dae, name, &values), backend),
        }
    }
}

impl Parametric {
    fn new(dae: &Dae, list: &[Partial]) -> Self {
        Self {
            entries: entries(list),
            code: Interpreter::new(dae, &Routine::partials(dae, "slopes".to_owned(), list)),
        }
    }

    /// Row, parameter, derivative.
    fn values(&self, p: &[f64]) -> Vec<(usize, usize, f64)> {
        let mut values = vec![0.0; self.entries.len()];
        self.code.run(&mut Frame::of_parameters(p, &mut values));
        let pairs = self.entries.iter().zip(values);
        let by_parameter = |(entry, value): (&PartialEntry, f64)| match entry.wrt {
            Wrt::Parameter(column) => Some((entry.row, column, value)),
            Wrt::Memory(_) | Wrt::Unknown(_) | Wrt::Derivative(_) | Wrt::Delayed(_) | Wrt::Time => {
                None
            }
        };
        pairs.filter_map(by_parameter).collect()
    }
}

fn in_program(wrt: hyde_analysis::TickWrt) -> TickWrt {
    use hyde_analysis::TickWrt as InDae;
    match wrt {
        InDae::Memory(position) => TickWrt::Memory(position),
        InDae::Unknown(position) => TickWrt::Unknown(position),
        InDae::Derivative(position) => TickWrt::Derivative(position),
        InDae::Delayed(number) => TickWrt::Delayed(number),
        InDae::Parameter(position) => TickWrt::Parameter(position),
    }
}
