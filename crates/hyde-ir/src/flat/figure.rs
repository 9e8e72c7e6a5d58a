//! [`Figure`]: what an experiment wants to see of a run.

use crate::Quantity;
use crate::id::ExprId;

/// Something that a figure shows over time.
#[derive(Clone, Debug)]
pub struct Curve {
    /// As it is written.
    pub name: String,
    /// What is shown.
    pub value: ExprId,
    /// In what it is shown.
    pub quantity: Quantity,
}

/// What kind of figure.
#[derive(Clone, Debug)]
pub enum FigureKind {
    /// Panels one above the other, over time or over a curve.
    Panels(Vec<Vec<Curve>>, Option<Curve>),
    /// A contour about the origin, its deviation from a circle magnified: x and y, and the radius in m, of parameters alone.
    Circle([Curve; 2], ExprId),
}

/// `figure name = a, {b, c} over x in t1 .. t2 "title"`.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Its name.
    pub name: String,
    /// Its title.
    pub title: String,
    /// What it shows.
    pub kind: FigureKind,
    /// The times shown in s, of parameters alone.
    pub within: Option<(ExprId, ExprId)>,
}

impl Figure {
    /// Its curves in the order in which they are outputs.
    pub fn curves(&self) -> impl Iterator<Item = &Curve> {
        let (panels, over, circle) = match &self.kind {
            FigureKind::Panels(panels, over) => (&panels[..], over.as_ref(), &[][..]),
            FigureKind::Circle(curves, _) => (&[][..], None, &curves[..]),
        };
        panels.iter().flatten().chain(over).chain(circle)
    }

    /// The same to be changed.
    pub fn curves_mut(&mut self) -> impl Iterator<Item = &mut Curve> {
        let (panels, over, circle) = match &mut self.kind {
            FigureKind::Panels(panels, over) => (&mut panels[..], over.as_mut(), &mut [][..]),
            FigureKind::Circle(curves, _) => (&mut [][..], None, &mut curves[..]),
        };
        panels.iter_mut().flatten().chain(over).chain(circle)
    }
}
