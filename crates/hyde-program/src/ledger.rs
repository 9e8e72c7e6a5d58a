//! What the energy ledger adds up during a run.

use hyde_ir::flat::{AccountKind, PortKind};
use std::ops::Range;

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
