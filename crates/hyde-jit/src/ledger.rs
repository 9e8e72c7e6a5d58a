//! The table of the energy ledger: which outputs its accounts and ports are.

use hyde_ir::flat;
use hyde_program::{Account, Ledger, Port};

/// Entries of the ledger among the outputs of a DAE: one a piece of an account, two a port.
pub(crate) fn outputs(ledger: &flat::Ledger) -> usize {
    let pieces: usize = ledger.accounts.iter().map(|a| a.pieces.len()).sum();
    pieces + 2 * ledger.ports.len()
}

/// Columns of those entries.
pub(crate) fn columns(ledger: &flat::Ledger) -> usize {
    let accounts: usize = ledger.accounts.iter().map(size).sum();
    accounts + 2 * ledger.ports.len()
}

/// The table, its first column given.
pub(crate) fn ledger(ledger: &flat::Ledger, first: usize) -> Ledger {
    let mut next = first;
    let mut take = |columns: usize| {
        next += columns;
        next - columns..next
    };
    let accounts = ledger.accounts.iter().map(|account| Account {
        component: account.component.to_string(),
        name: account.name.clone(),
        kind: account.kind,
        outputs: take(size(account)),
    });
    let accounts = accounts.collect();
    let ports = ledger.ports.iter().map(|port| {
        let flow = take(2).start;
        Port {
            component: port.component.to_string(),
            kind: port.kind,
            flow,
            potential: flow + 1,
        }
    });
    Ledger {
        accounts,
        ports: ports.collect(),
    }
}

fn size(account: &flat::Account) -> usize {
    account.pieces.iter().map(|(range, _)| range.len()).sum()
}
