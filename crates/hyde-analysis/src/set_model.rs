//! A model with the values that its parameters are set to, where those are not in its equations yet.

use hyde_ir::FlatModel;
use std::collections::BTreeMap;

/// The model with these values; `None` where no parameter of it is set to another value than it has.
pub(crate) fn with_values(flat: &FlatModel, settings: &BTreeMap<String, f64>) -> Option<FlatModel> {
    let mut found: Option<FlatModel> = None;
    for param in flat.parameters.ids() {
        let parameter = &flat.parameters[param];
        if parameter.structural || parameter.is_final || parameter.found {
            continue;
        }
        for element in 0..parameter.size() {
            let Some(value) = parameter.setting(element, settings) else {
                continue;
            };
            let own = found.get_or_insert_with(|| flat.clone());
            let value = own.exprs.constant(value);
            own.parameters[param].set(element, value, &mut own.exprs);
        }
    }
    found
}
