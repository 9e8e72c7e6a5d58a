//! Notes the effects that are to be put on instances, from the text of the model and from outside it.

use super::host::written;
use super::making::Hook;
use crate::instance::InstanceId;
use crate::model::Model;
use crate::names::FileIndex;
use crate::refusals::effects as refused;
use hyde_diag::InstancePath;
use hyde_syntax::ast::{ClassKind, EffectUse};

/// Notes the effects of a model, to be put on their sites as those are made.
pub(super) fn hook<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    file: FileIndex,
    effects: &'a [EffectUse],
) {
    for used in effects {
        let found = model.names.class(file, &used.effect);
        let Some((file, class)) = found.filter(|(_, class)| class.kind == ClassKind::Effect) else {
            let diagnostic = match found {
                Some((_, class)) => refused::with_no_effect(&class.name.text, used.effect.span),
                None => model.names.unknown(file, &used.effect),
            };
            model.report(diagnostic);
            continue;
        };
        for site in &used.sites {
            model.making.hooks.push(Hook {
                host: model.tree.path(id).child(&written(site)),
                site,
                file,
                class,
                changes: &used.changes,
                scope: id,
                name: &class.name.text,
                keep: false,
                used: false,
            });
        }
    }
}

/// Notes the effects that are put on the model from outside its text.
pub(super) fn hook_additions(model: &mut Model<'_, '_>, root: InstanceId) {
    for addition in model.input.additions.list() {
        let Some((file, class)) = model.names.class(0, &addition.effect) else {
            let diagnostic = model.names.unknown(0, &addition.effect);
            model.report(diagnostic);
            continue;
        };
        model.making.hooks.push(Hook {
            host: InstancePath::root().child(&written(&addition.site)),
            site: &addition.site,
            file,
            class,
            changes: &[],
            scope: root,
            name: &addition.name,
            keep: model.input.additions.keeps_neutral(),
            used: false,
        });
    }
}
