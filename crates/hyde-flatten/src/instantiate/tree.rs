//! [`InstanceTree`]: the instances of a model. This folder alone adds to it; every pass behind it can only read.

use crate::instance::{Instance, InstanceId, Member};
use crate::names::FileIndex;
use hyde_diag::{InstancePath, Origin, Span};
use hyde_syntax::ast::{ClassKind, Element};
use std::collections::BTreeMap;
use std::ops::{Index, Range};

/// The instances of a model by number, each behind the instance around it; the first one is the model itself.
#[derive(Default)]
pub(crate) struct InstanceTree<'a> {
    instances: Vec<Instance<'a>>,
}

impl<'a> InstanceTree<'a> {
    /// Adds an instance.
    pub(super) fn push(&mut self, instance: Instance<'a>) -> InstanceId {
        self.instances.push(instance);
        self.instances.len() - 1
    }

    /// What is written in an instance, each element with its file.
    pub(super) fn set_elements(&mut self, id: InstanceId, all: Vec<(FileIndex, &'a Element)>) {
        self.instances[id].elements = all;
    }

    /// Gives a member of an instance its name, and returns what had it before.
    pub(super) fn name(&mut self, id: InstanceId, name: &'a str, member: Member) -> Option<Member> {
        self.instances[id].members.insert(name, member)
    }

    /// How many instances there are.
    pub(crate) fn len(&self) -> usize {
        self.instances.len()
    }

    /// The number of each instance.
    pub(crate) fn ids(&self) -> Range<InstanceId> {
        0..self.instances.len()
    }

    /// The path of each instance, and where it is declared.
    pub(crate) fn declared(&self) -> BTreeMap<InstancePath, Span> {
        let all = self.instances.iter();
        all.map(|own| (own.path.clone(), own.span)).collect()
    }

    /// The path of an instance.
    pub(crate) fn path(&self, id: InstanceId) -> InstancePath {
        self.instances[id].path.clone()
    }

    /// The origin of what is written at a place, in the scope of an instance.
    pub(crate) fn origin(&self, id: InstanceId, span: Span) -> Origin {
        Origin::source(span, &self.instances[id].path)
    }

    /// An instance and those around it, from the inside to the model.
    pub(crate) fn around(&self, id: InstanceId) -> impl Iterator<Item = InstanceId> + '_ {
        std::iter::successors(Some(id), |&id| self.instances[id].parent)
    }

    /// Whether an instance is an effect or a part of one.
    pub(crate) fn is_of_effect(&self, id: InstanceId) -> bool {
        let mut around = self.around(id);
        around.any(|id| self.instances[id].class.kind == ClassKind::Effect)
    }
}

impl<'a> Index<InstanceId> for InstanceTree<'a> {
    type Output = Instance<'a>;

    fn index(&self, id: InstanceId) -> &Instance<'a> {
        &self.instances[id]
    }
}
