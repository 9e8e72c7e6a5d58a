//! The figures that an experiment or a caller asks for, drawn from the results of a run.

use hyde_experiment::Run;
use hyde_program::{Constant, Curve, FigureKind, Program};
use hyde_report::{Figure, Line, circle_plot, time_panel, time_plot, to_png, to_svg, xy_plot};
use hyde_units::{drawn_in, shown};

/// The figures with their names, as written.
pub fn of_run(program: &Program, run: &Run) -> Vec<(String, Figure)> {
    let figures = program.experiment.figures.iter().enumerate();
    let drawn = figures.map(|(number, asked)| {
        let constant = |which| program.kernels.constant(which, &run.parameters);
        let shown = Shown {
            program,
            run,
            from: constant(Constant::ShownFrom(number)).unwrap_or(f64::NEG_INFINITY),
            to: constant(Constant::ShownTo(number)).unwrap_or(f64::INFINITY),
        };
        let figure = match &asked.kind {
            FigureKind::Panels(panels, None) => shown.over_time(&asked.title, panels),
            FigureKind::Panels(panels, Some(over)) => shown.over(&asked.title, panels, over),
            FigureKind::Circle([x, y]) => {
                let radius = constant(Constant::Radius(number)).unwrap_or(f64::NAN);
                circle_plot(&asked.title, &shown.values(x), &shown.values(y), radius)
            }
        };
        (asked.name.clone(), figure)
    });
    drawn.collect()
}

/// Curves over time, each panel in the unit of its first curve.
#[must_use]
pub fn over_time(title: &str, program: &Program, run: &Run, panels: &[Vec<Curve>]) -> Figure {
    let shown = Shown {
        program,
        run,
        from: f64::NEG_INFINITY,
        to: f64::INFINITY,
    };
    shown.over_time(title, panels)
}

/// The files of figures: each as `NAME.svg` and as `NAME.png`.
#[must_use]
pub fn files(figures: &[(String, Figure)]) -> Vec<(String, Vec<u8>)> {
    let both = |(name, figure): &(String, Figure)| {
        [
            (format!("{name}.svg"), to_svg(figure).into_bytes()),
            (format!("{name}.png"), to_png(figure, 2.0)),
        ]
    };
    figures.iter().flat_map(both).collect()
}

/// The rows of a run within the times that a figure shows.
struct Shown<'a> {
    program: &'a Program,
    run: &'a Run,
    from: f64,
    to: f64,
}

impl Shown<'_> {
    fn rows(&self) -> std::ops::Range<usize> {
        let time = &self.run.results.time;
        let first = time.partition_point(|t| *t < self.from);
        first..time.partition_point(|t| *t <= self.to).max(first)
    }

    fn values(&self, curve: &Curve) -> Vec<f64> {
        let column = self.run.results.column(curve.output).unwrap_or_default();
        column.get(self.rows()).unwrap_or_default().to_vec()
    }

    /// The values in the unit of another curve, of the same panel.
    fn values_as(&self, curve: &Curve, first: &Curve) -> Vec<f64> {
        let (_, unit) = drawn_in(&self.program.outputs[first.output].unit);
        let values = self.values(curve).into_iter();
        values.map(|si| unit.from_si(si)).collect()
    }

    fn unit(&self, curve: &Curve) -> String {
        let (unit, _) = drawn_in(&self.program.outputs[curve.output].unit);
        shown(&unit).to_owned()
    }

    /// The name of a panel's only curve, which stands on its axis, and its unit.
    fn label<'c>(&self, curves: &'c [Curve]) -> (&'c str, String) {
        let label = match curves {
            [only] => only.name.as_str(),
            _ => "",
        };
        let unit = curves.first().map(|curve| self.unit(curve));
        (label, unit.unwrap_or_default())
    }

    fn lines(&self, x: &[f64], curves: &[Curve]) -> Vec<Line> {
        let line = |curve: &Curve| {
            let label = if curves.len() == 1 { "" } else { &curve.name };
            Line::new(label, x.to_vec(), self.values_as(curve, &curves[0]))
        };
        curves.iter().map(line).collect()
    }

    fn over_time(&self, title: &str, panels: &[Vec<Curve>]) -> Figure {
        let time = &self.run.results.time[self.rows()];
        let panel = |curves: &Vec<Curve>| {
            let (label, unit) = self.label(curves);
            time_panel(label, &unit, self.lines(time, curves))
        };
        time_plot(title, panels.iter().map(panel).collect(), None)
    }

    fn over(&self, title: &str, panels: &[Vec<Curve>], over: &Curve) -> Figure {
        let x = self.values_as(over, over);
        let panel = |curves: &Vec<Curve>| {
            let (label, unit) = self.label(curves);
            let x_axis = (over.name.as_str(), self.unit(over));
            let figure = xy_plot(
                title,
                (x_axis.0, &x_axis.1),
                (label, &unit),
                self.lines(&x, curves),
            );
            figure.panels
        };
        let panels: Vec<_> = panels.iter().flat_map(panel).collect();
        Figure {
            shared_x: panels.len() > 1,
            width: 460.0,
            panel_height: if panels.len() > 1 { 150.0 } else { 290.0 },
            ..Figure::new(panels).with_title(title)
        }
    }
}
