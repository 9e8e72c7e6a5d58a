//! [`digest`]: an answer without samples.

use serde_json::{Map, Value, json};

/// Longer lists of numbers are told by their count and range.
const MOST_NUMBERS: usize = 8;
/// Longer lists of other things are cut.
const MOST_ITEMS: usize = 20;
/// Larger objects are cut.
const MOST_KEYS: usize = 60;
/// A text beyond this is cut.
const MOST_LETTERS: usize = 4000;

/// The same value with long lists of numbers as `{"numbers": …, "least": …, "most": …}` and other long lists cut, with how
/// many items are left out; and whether anything was left out.
#[must_use]
pub fn digest(value: &Value) -> (Value, bool) {
    let mut cut = false;
    let short = shortened(value, &mut cut);
    (short, cut)
}

fn shortened(value: &Value, cut: &mut bool) -> Value {
    match value {
        Value::Array(items) => {
            let mut numbers = Vec::new();
            let samples = items.len() > MOST_NUMBERS && all_numbers(items, &mut numbers);
            if samples {
                *cut = true;
                let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
                let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                return json!({ "numbers": numbers.len(), "least": finite(least), "most": finite(most) });
            }
            let mut short: Vec<Value> = items
                .iter()
                .take(MOST_ITEMS)
                .map(|item| shortened(item, cut))
                .collect();
            if items.len() > MOST_ITEMS {
                *cut = true;
                short.push(json!({ "left_out": items.len() - MOST_ITEMS }));
            }
            Value::Array(short)
        }
        Value::Object(fields) if fields.len() > MOST_NUMBERS && fields.values().all(is_pair) => {
            *cut = true;
            largest(fields)
        }
        Value::Object(fields) => {
            let mut short: Map<String, Value> = fields
                .iter()
                .take(MOST_KEYS)
                .map(|(key, field)| (key.clone(), shortened(field, cut)))
                .collect();
            if fields.len() > MOST_KEYS {
                *cut = true;
                short.insert("left_out".to_owned(), json!(fields.len() - MOST_KEYS));
            }
            Value::Object(short)
        }
        Value::String(text) if text.chars().count() > MOST_LETTERS => {
            *cut = true;
            let start: String = text.chars().take(MOST_LETTERS).collect();
            json!(format!("{start} …"))
        }
        Value::String(_) | Value::Number(_) | Value::Bool(_) | Value::Null => value.clone(),
    }
}

/// Whether a value is a list of two numbers, as real and imaginary part.
fn is_pair(value: &Value) -> bool {
    let list = value.as_array();
    list.is_some_and(|list| list.len() == 2 && list.iter().all(Value::is_number))
}

/// The largest entries of many, as of the shape of a mode.
fn largest(fields: &Map<String, Value>) -> Value {
    let size = |value: &Value| {
        let parts = value.as_array().into_iter().flatten();
        let parts = parts.filter_map(Value::as_f64);
        parts.map(|part| part * part).sum::<f64>()
    };
    let mut sorted: Vec<(&String, &Value)> = fields.iter().collect();
    sorted.sort_by(|a, b| size(b.1).total_cmp(&size(a.1)));
    let kept = sorted.into_iter().take(MOST_NUMBERS);
    let mut short: Map<String, Value> = kept.map(|(key, own)| (key.clone(), own.clone())).collect();
    let left_out = fields.len() - MOST_NUMBERS;
    short.insert("left_out".to_owned(), json!(left_out));
    Value::Object(short)
}

/// Whether a list holds numbers alone, or lists of numbers alone as real and imaginary parts; collects them.
fn all_numbers(items: &[Value], numbers: &mut Vec<f64>) -> bool {
    items.iter().all(|item| match item {
        Value::Number(number) => {
            numbers.extend(number.as_f64());
            true
        }
        Value::Null => true,
        Value::Array(inner) => !inner.is_empty() && all_numbers(inner, numbers),
        Value::Object(_) | Value::String(_) | Value::Bool(_) => false,
    })
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_become_their_range_and_short_lists_stay() {
        let samples: Vec<f64> = (0..1000).map(f64::from).collect();
        let complex: Vec<[f64; 2]> = (0..20).map(|k| [f64::from(k), -1.0]).collect();
        let names: Vec<String> = (0..50).map(|k| format!("x{k}")).collect();
        let shape: Map<String, Value> = (0..12)
            .map(|k| (format!("x{k}"), json!([0.0, f64::from(k)])))
            .collect();
        let value = json!({ "t": samples, "pole": [-1.0, 2.0], "re_im": complex, "names": names, "shape": shape });
        let (short, cut) = digest(&value);
        assert!(cut);
        assert_eq!(short["shape"]["x11"], json!([0.0, 11.0]));
        assert_eq!(short["shape"]["left_out"], 4);
        assert_eq!(
            short["t"],
            json!({ "numbers": 1000, "least": 0.0, "most": 999.0 })
        );
        assert_eq!(short["pole"], json!([-1.0, 2.0]));
        assert_eq!(
            short["re_im"],
            json!({ "numbers": 40, "least": -1.0, "most": 19.0 })
        );
        assert_eq!(short["names"][20], json!({ "left_out": 30 }));
        assert!(!digest(&json!({ "ok": true })).1);
    }
}
