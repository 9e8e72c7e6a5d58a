//! [`Change`]: thresholds with other values than those of the method.

use hyde_calibrate::{TABLE, Threshold, Thresholds};

/// Thresholds with other values.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// What it is called: `NAME`, `NAME=VALUE`, several with `+` between; `method` if nothing is changed.
    pub name: String,
    /// All thresholds with the change.
    pub thresholds: Thresholds,
}

impl Change {
    /// The name of no change.
    pub const METHOD: &str = "method";

    /// No change.
    #[must_use]
    pub fn none() -> Self {
        Self {
            name: Self::METHOD.to_owned(),
            thresholds: Thresholds::default(),
        }
    }

    /// One threshold removed.
    #[must_use]
    pub fn removing(threshold: &Threshold) -> Self {
        let mut changed = Self::none();
        threshold.set(&mut changed.thresholds, threshold.removed);
        threshold.name.clone_into(&mut changed.name);
        changed
    }

    /// What a name asks for.
    ///
    /// # Errors
    /// No threshold is called so, or a value is not a number.
    pub fn read(name: &str) -> Result<Self, String> {
        let mut changed = Self::none();
        if name == Self::METHOD {
            return Ok(changed);
        }
        for one in name.split('+') {
            let (own, value) = match one.split_once('=') {
                Some((own, value)) => (own, Some(value)),
                None => (one, None),
            };
            let known = TABLE.iter().find(|threshold| threshold.name == own);
            let known = known.ok_or_else(|| format!("no threshold is called `{own}`"))?;
            let value = match value {
                Some(text) => text
                    .parse()
                    .map_err(|_| format!("`{text}` is not a number"))?,
                None => known.removed,
            };
            known.set(&mut changed.thresholds, value);
        }
        name.clone_into(&mut changed.name);
        Ok(changed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_gives_thresholds_and_values() {
        let method = Thresholds::default();
        let one = Change::read("retries").unwrap().thresholds;
        let expected = Thresholds {
            retries: 0,
            ..method
        };
        assert_eq!(one, expected);
        let two = Change::read("too_good=5+few=1").unwrap().thresholds;
        assert_eq!((two.too_good, two.few), (5.0, 1));
        assert_eq!(two.chance.to_bits(), method.chance.to_bits());
        assert!(Change::read("retries+unheard").is_err());
    }

    #[test]
    fn removing_any_threshold_changes_it() {
        for threshold in TABLE {
            let changed = Change::removing(threshold).thresholds;
            assert_ne!(changed, Thresholds::default(), "{}", threshold.name);
            let mut back = changed;
            threshold.set(&mut back, threshold.value);
            assert_eq!(back, Thresholds::default(), "{}", threshold.name);
        }
    }
}
