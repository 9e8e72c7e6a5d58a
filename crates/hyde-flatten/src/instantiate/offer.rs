//! Offers: every effect on everything it fits on, as far as its parameters. [`crate::candidates`] makes the list of them.

use super::collect::{Collected, Walk, collect};
use super::host::{fits_on, instance_of_effect};
use super::making::Offer;
use super::parameter::parameters_of;
use crate::instance::InstanceId;
use crate::model::Model;

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
        let (parameters, _): (Vec<_>, Vec<_>) =
            collected.into_iter().partition(Collected::is_parameter);
        parameters_of(model, id, &parameters);
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
