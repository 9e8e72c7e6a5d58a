//! The energy ledger of a run: where every joule came from and where it went, component by component.
//!
//! ```text
//! received + supplied = stored + at events + dissipated + remainder
//! ```
//!
//! *Received* is what came through the connectors, less what went on to parts inside. The rest a component says of itself
//! (`stored`, `dissipated`, `supplied`). One that says nothing is an ideal source, drain or passage: what it received
//! negative it supplied. The *remainder* is what the solver lost or found.

use hyde_program::{AccountKind, Ledger};
use hyde_sim::Energies;

/// A component's line of the ledger, in J.
#[derive(Clone, Debug, PartialEq)]
pub struct LedgerEntry {
    /// The component; empty for the model itself.
    pub component: String,
    /// Through its connectors, less what went to its parts.
    pub received: f64,
    /// From outside the model.
    pub supplied: f64,
    /// Growth of what it stores, between events.
    pub stored: f64,
    /// What its store jumped by at events: negative in an impact.
    pub at_events: f64,
    /// Turned into heat.
    pub dissipated: f64,
    /// What is missing in the balance.
    pub remainder: f64,
}

/// The ledger of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyLedger {
    /// The components that took part, in the order of the model.
    pub entries: Vec<LedgerEntry>,
    /// The energy that passed, in J: through connectors, lost or gained at events, and supplied from outside.
    pub passed: f64,
}

impl EnergyLedger {
    /// The ledger from the sums of a run.
    #[must_use]
    pub fn new(ledger: &Ledger, sums: &Energies) -> Self {
        let mut components: Vec<&str> = Vec::new();
        let named = ledger.ports.iter().map(|port| port.component.as_str());
        for name in named.chain(ledger.accounts.iter().map(|a| a.component.as_str())) {
            if !components.contains(&name) {
                components.push(name);
            }
        }
        let with_ports: Vec<&str> = components
            .iter()
            .copied()
            .filter(|name| ledger.ports.iter().any(|port| port.component == *name))
            .collect();
        let signalled = Signalled::of(ledger, &with_ports);
        let home = |component: &str| signalled.home(component, &with_ports);
        let mut entries: Vec<LedgerEntry> = Vec::new();
        for component in components.iter().map(|name| home(name)) {
            if !entries.iter().any(|entry| entry.component == component) {
                entries.push(LedgerEntry::of(component));
            }
        }
        let find = |entries: &mut Vec<LedgerEntry>, component: &str| {
            entries
                .iter()
                .position(|entry| entry.component == component)
        };
        for (port, energy) in ledger.ports.iter().zip(&sums.received) {
            if let Some(at) = find(&mut entries, &home(&port.component)) {
                entries[at].received += energy;
            }
            let outer = port.component.rsplit_once('.').map(|(outer, _)| outer);
            let around = outer.and_then(|outer| nearest(&with_ports, outer));
            if let Some(at) = around.and_then(|around| find(&mut entries, &around)) {
                entries[at].received -= energy;
            }
        }
        let mut says = vec![false; entries.len()];
        let numbers = sums.accounts.iter().zip(&sums.jumps);
        for (account, (energy, jump)) in ledger.accounts.iter().zip(numbers) {
            let Some(at) = find(&mut entries, &home(&account.component)) else {
                continue;
            };
            says[at] = true;
            match account.kind {
                AccountKind::Stored => {
                    entries[at].stored += energy;
                    entries[at].at_events += jump;
                }
                AccountKind::Dissipated => entries[at].dissipated += energy,
                AccountKind::Supplied => entries[at].supplied += energy,
            }
        }
        for (entry, says) in entries.iter_mut().zip(says) {
            if !says {
                entry.supplied = -entry.received;
            }
            if signalled.balanced.contains(&entry.component) {
                entry.supplied = entry.stored + entry.dissipated - entry.received;
            }
            // What jumped at an event came at once: no port could measure it.
            entry.remainder = entry.received + entry.supplied - entry.stored - entry.dissipated;
        }
        let supplied: f64 = entries.iter().map(|entry| entry.supplied.abs()).sum();
        Self {
            entries,
            passed: sums.passed.max(supplied),
        }
    }

    /// What is missing in all balances together, without regard to sign, over the energy that passed.
    #[must_use]
    pub fn closure(&self) -> f64 {
        let missing: f64 = self.entries.iter().map(|e| e.remainder.abs()).sum();
        if self.passed > 0.0 {
            missing / self.passed
        } else {
            0.0
        }
    }

    /// The sums of all components.
    #[must_use]
    pub fn total(&self) -> LedgerEntry {
        let mut total = LedgerEntry::of(String::new());
        for entry in &self.entries {
            total.received += entry.received;
            total.supplied += entry.supplied;
            total.stored += entry.stored;
            total.at_events += entry.at_events;
            total.dissipated += entry.dissipated;
            total.remainder += entry.remainder;
        }
        total
    }
}

impl LedgerEntry {
    fn of(component: String) -> Self {
        Self {
            component,
            received: 0.0,
            supplied: 0.0,
            stored: 0.0,
            at_events: 0.0,
            dissipated: 0.0,
            remainder: 0.0,
        }
    }
}

/// Sources that may exert the force of a part without connectors, as two drives do for the contact between them. What such a
/// part stores comes through the sources: their energies balance only together.
struct Signalled {
    /// The sources, each with the component around that has connectors; the model itself is empty.
    sources: Vec<(String, String)>,
    /// The components whose own equations or sources exchange what no connector measures.
    balanced: Vec<String>,
}

impl Signalled {
    fn of(ledger: &Ledger, with_ports: &[&str]) -> Self {
        let around = |component: &str| {
            let outer = component.rsplit_once('.').map(|(outer, _)| outer);
            let found = outer.and_then(|outer| nearest(with_ports, outer));
            found.unwrap_or_default()
        };
        let accounts = || ledger.accounts.iter().map(|account| &account.component[..]);
        let is_part = |component: &&str| !component.is_empty() && !with_ports.contains(component);
        let scopes: Vec<String> = accounts().filter(is_part).map(around).collect();
        let says = |component: &str| {
            accounts().any(|known| nearest(with_ports, known).as_deref() == Some(component))
        };
        let silent = with_ports.iter().filter(|component| !says(component));
        let sources: Vec<(String, String)> = silent
            .map(|component| ((*component).to_owned(), around(component)))
            .filter(|(_, scope)| scopes.contains(scope))
            .collect();
        let mut balanced: Vec<String> = sources.iter().map(|(_, scope)| scope.clone()).collect();
        // A model without accounts of its own that drives a part by its equations.
        if scopes.iter().any(String::is_empty) && !accounts().any(str::is_empty) {
            balanced.push(String::new());
        }
        Self { sources, balanced }
    }

    /// Where a component has its line: a part without connectors, and a source that may act for such a part, with the
    /// component around that has connectors.
    fn home(&self, component: &str, with_ports: &[&str]) -> String {
        let source = self.sources.iter().find(|(known, _)| known == component);
        match source {
            Some((_, scope)) => scope.clone(),
            None => nearest(with_ports, component).unwrap_or_default(),
        }
    }
}

/// The component itself or the nearest around it that is in the list.
fn nearest(list: &[&str], component: &str) -> Option<String> {
    let mut name = component;
    loop {
        if list.contains(&name) {
            return Some(name.to_owned());
        }
        name = name.rsplit_once('.')?.0;
    }
}
