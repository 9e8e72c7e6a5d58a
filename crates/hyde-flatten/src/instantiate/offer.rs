//! Offers: every effect on everything it fits on, as far as its parameters. [`crate::candidates`] makes the list of them.

use super::Walk;
use super::effect::is_parameter;
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

impl Model<'_, '_> {
    /// Makes the parameters of every effect that fits on an instance, and nothing else of it: for
    /// [`crate::candidates`].
    pub(super) fn offer(&mut self, host: InstanceId) {
        if !self.offering || self.is_of_effect(host) {
            return;
        }
        for (file, package, class) in self.names.effects() {
            if !self.fits_on(host, file, class) {
                continue;
            }
            let first = class.name.text.as_str();
            let taken = |name: &str| self.instances[host].members.contains_key(name);
            let mut numbered = (2..).map(|number| format!("{first}{number}"));
            let name = match taken(first) {
                true => numbered.find(|name| !taken(name)).unwrap_or_default(),
                false => first.to_owned(),
            };
            let id = self.instance_of_effect(host, (file, class), &name, class.name.span);
            let mut collected = Vec::new();
            let walk = Walk {
                id,
                file,
                modifiers: Vec::new(),
                chain: Vec::new(),
            };
            self.collect(walk, class, &mut collected);
            let elements = collected.iter().map(|item| item.element).collect();
            let (parameters, _): (Vec<_>, Vec<_>) = collected.into_iter().partition(is_parameter);
            self.members(id, &parameters);
            self.instances[id].elements = Vec::new();
            self.offers.push(Offer {
                host,
                effect: id,
                package,
                name,
                elements,
            });
        }
    }
}
