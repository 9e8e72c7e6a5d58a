//! Offers: every effect on everything it fits on, as far as its parameters. [`crate::candidates`] makes the list of them.

use super::effect::{fits_on, instance_of_effect, is_parameter};
use super::{Walk, collect, members};
use crate::instance::InstanceId;
use crate::model::Model;
use hyde_syntax::ast::Element;

/// An effect that fits on a host: there are its parameters alone.
pub(crate) struct Offer<'a> {
    pub(crate) host: InstanceId,
    pub(crate) effect: InstanceId,
    /// The package of its file; none for the user's own.
    pub(crate) package: Option<String>,
    /// What its instance would be called below its host.
    pub(crate) name: String,
    /// Everything that is written in it.
    pub(crate) elements: Vec<&'a Element>,
}

/// Makes the parameters of every effect that fits on an instance, and nothing else of it: for
/// [`crate::candidates`].
pub(super) fn offer(model: &mut Model<'_, '_>, host: InstanceId) {
    if !model.making.offering || model.tree.is_of_effect(host) {
        return;
    }
    for (file, package, class) in model.names.effects() {
        if !fits_on(model.names, &model.tree[host], (file, class)) {
            continue;
        }
        let first = class.name.text.as_str();
        let taken = |name: &str| model.tree[host].members.contains_key(name);
        let mut numbered = (2..).map(|number| format!("{first}{number}"));
        let name = match taken(first) {
            true => numbered.find(|name| !taken(name)).unwrap_or_default(),
            false => first.to_owned(),
        };
        let id = instance_of_effect(model, host, (file, class), &name, class.name.span);
        let mut collected = Vec::new();
        let walk = Walk {
            id,
            file,
            modifiers: Vec::new(),
            chain: Vec::new(),
        };
        collect(model, walk, class, &mut collected);
        let elements = collected.iter().map(|item| item.element).collect();
        let (parameters, _): (Vec<_>, Vec<_>) = collected.into_iter().partition(is_parameter);
        members(model, id, &parameters);
        model.tree.set_elements(id, Vec::new());
        model.making.offers.push(Offer {
            host,
            effect: id,
            package,
            name,
            elements,
        });
    }
}
