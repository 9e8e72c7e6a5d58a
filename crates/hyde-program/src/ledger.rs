//! What the energy ledger adds up during a run.

use std::ops::Range;

/// What an account says of its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccountKind {
    /// An energy that it has, in J.
    Stored,
    /// A power that it turns into heat, in W.
    Dissipated,
    /// A power that it has from outside the model, in W.
    Supplied,
}

/// What a component says of its energy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Account {
    /// The component.
    pub component: String,
    /// The account's name there.
    pub name: String,
    /// What it says.
    pub kind: AccountKind,
    /// The outputs whose sum it is.
    pub outputs: Range<usize>,
}

/// How the variables of a connector make a power.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortKind {
    /// Flow times the derivative of the potential: force and position.
    Work,
    /// Flow times potential: current and voltage.
    Power,
    /// The flow itself: heat.
    Heat,
}

/// Where energy enters a component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// The component.
    pub component: String,
    /// How flow and potential make a power.
    pub kind: PortKind,
    /// The output that is the flow into the component.
    pub flow: usize,
    /// The output that is the potential.
    pub potential: usize,
}

/// Accounts and ports of a model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ledger {
    /// What components say of themselves.
    pub accounts: Vec<Account>,
    /// Where energy goes from one component to another.
    pub ports: Vec<Port>,
}
