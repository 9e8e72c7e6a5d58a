//! The host of an effect: of which type it must be, and the effect inside it.

use crate::instance::{Instance, InstanceId};
use crate::model::Model;
use crate::names::{FileIndex, Names};
use hyde_diag::Span;
use hyde_syntax::ast::{Class, ClassBody, Reference};

/// The type an effect is for.
pub(crate) fn host_of(class: &Class) -> Option<&Reference> {
    match &class.body {
        ClassBody::Long { host, .. } => host.as_ref(),
        ClassBody::Short { .. } => None,
    }
}

/// Whether an instance is of the type that an effect is for, or of one that extends it.
pub(super) fn fits_on<'a>(
    names: Names<'a>,
    host: &Instance<'a>,
    (file, effect): (FileIndex, &'a Class),
) -> bool {
    let wanted = host_of(effect).and_then(|host| names.class(file, host));
    wanted.is_some_and(|(_, wanted)| names.is_a((host.file, host.class), wanted))
}

/// A site as written, subscripts included: `joint[2].flange`.
pub(crate) fn written(site: &Reference) -> String {
    hyde_syntax::format_reference(site)
}

/// An effect inside its host, without members yet.
pub(super) fn instance_of_effect<'a>(
    model: &mut Model<'a, '_>,
    host: InstanceId,
    (file, class): (FileIndex, &'a Class),
    name: &str,
    span: Span,
) -> InstanceId {
    model.tree.push(Instance {
        path: model.tree.path(host).child(name),
        file,
        class,
        parent: Some(host),
        outer: Some(host),
        clock: model.clock_of(host),
        members: std::collections::BTreeMap::new(),
        elements: Vec::new(),
        span,
    })
}
