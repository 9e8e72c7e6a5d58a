//! The mesh of a domain: cell length, places on it, and runs of nodes.

use crate::dimension::Dim;
use crate::instance::{DomainId, Scope, Setting};
use crate::model::Model;
use crate::refusals::fields as refused;
use hyde_ir::{ExprId, Index, Range};

impl<'a> Model<'a, '_> {
    /// Lower end, cell length, and dimension of a domain.
    pub(super) fn mesh(&mut self, domain: DomainId) -> (ExprId, ExprId, Dim) {
        if let Some(mesh) = &self.domains[domain].mesh {
            return mesh.clone();
        }
        let (instance, from, to, cells) = {
            let domain = &self.domains[domain];
            (domain.instance, domain.from, domain.to, domain.cells)
        };
        let scope = Scope::new(instance, Setting::Parameter);
        let (from, to) = (self.value(from, &scope), self.value(to, &scope));
        self.agree(&from, &to, "the ends of a domain are", instance);
        let arena = &mut self.flat.exprs;
        let length = arena.minus(to.id, from.id);
        if self
            .current_value(length)
            .is_some_and(|length| length <= 0.0)
        {
            let domain = &self.domains[domain];
            let diagnostic = refused::no_length(domain.name, domain.span);
            self.report(diagnostic);
        }
        let arena = &mut self.flat.exprs;
        let count = arena.constant(cells as f64);
        let h = arena.over(length, count);
        let mesh = (from.id, h, to.dim);
        self.domains[domain].mesh = Some(mesh.clone());
        mesh
    }

    pub(super) fn cells(&self, domain: DomainId) -> i32 {
        i32::try_from(self.domains[domain].cells).unwrap_or(i32::MAX)
    }

    /// An equation at a single node is a scalar one: its counter is a number.
    pub(super) fn fix_counter(&mut self, id: ExprId, range: Range) -> ExprId {
        if range.first != range.last {
            return id;
        }
        self.flat.exprs.at_counter(id, range.first)
    }
}

/// The nodes 0..n in pieces: each end, each node with a load, and the runs between them.
pub(super) fn pieces(n: i32, loaded: &[i32]) -> Vec<Range> {
    let mut single: Vec<i32> = loaded.to_vec();
    single.extend([0, n]);
    single.sort_unstable();
    single.dedup();
    let mut found = Vec::new();
    let mut next = 0;
    for node in single {
        if next < node {
            found.push(Range {
                first: next,
                last: node - 1,
            });
        }
        found.push(Range {
            first: node,
            last: node,
        });
        next = node + 1;
    }
    found
}

/// The index of a node over a range: its number where there is only one.
pub(super) fn counted_index(range: Range) -> Index {
    if range.first == range.last {
        Index::fixed(range.first)
    } else {
        Index::COUNTER
    }
}

pub(super) fn collapsed(range: Range) -> Range {
    if range.first == range.last {
        Range::SCALAR
    } else {
        range
    }
}

pub(super) fn shifted(index: Index, by: i32) -> Index {
    Index {
        offset: index.offset + by,
        ..index
    }
}
