//! A self-test as JSON; numbers are SI.

use hyde_calibrate::{Case, Claim, Designed, Found, Planting, Relation, Size};
use hyde_study::selftest::Tested;
use hyde_study::selftest::{Kept, relation_word, word};
use serde_json::{Value, json};

/// The report.
pub fn report(told: &Tested<'_>) -> Value {
    let hypotheses: Vec<Value> = (0..told.hypotheses.len()).map(|n| named(told, n)).collect();
    let table = told.table;
    let rows: Vec<Value> = table
        .rows
        .iter()
        .map(|row| {
            let taken: Vec<Value> = row
                .taken_for
                .iter()
                .map(|(other, count)| json!({ "found": claimed(told, *other), "cases": count }))
                .collect();
            json!({
                "planted": named(told, row.hypothesis),
                "visible": row.visible,
                "right": row.right,
                "alone": row.alone,
                "further_claims": row.extras,
                "hidden": row.hidden,
                "hidden_right": row.hidden_right,
                "hidden_wrong": row.hidden_wrong,
                "taken_for": taken,
                "detectable": row.detectable,
                "unit": told.hypotheses[row.hypothesis].sizes.first().map(|size| size.unit.si().text().to_owned()),
                "size_found_over_planted": row.ratios,
            })
        })
        .collect();
    let control = |(cases, right): (usize, usize)| json!({ "cases": cases, "right": right });
    let (visible, right) = sums(told);
    let cases: Vec<Value> = told
        .outcomes
        .iter()
        .map(|(c, k)| case(told, c, k))
        .collect();
    let mut report = json!({
        "ok": true,
        "diagnosis": told.plan.name,
        "seed": told.seed,
        "sizes": told.asked.sizes.iter().map(|&size| shown(size)).collect::<Vec<_>>(),
        "hypotheses": hypotheses,
        "visible": visible,
        "right": right,
        "planted": rows,
        "controls": {
            "empty": control(table.empty),
            "parameter": control(table.parameter),
            "unknown": control(table.open_set),
            "unknown_neighbours": table.neighbours,
            "unknown_laws": table.laws,
            "unknown_equivalents": table.equivalents,
            "sensor": control(table.sensor),
        },
        "without_site": told.siteless,
        "cases": cases,
    });
    if let Some(designs) = told.designs {
        let (one_of, resolved) = table.designed;
        let unmade = designs.unmade().iter();
        let unmade = unmade.map(|(name, reason)| json!({ "signal": name, "reason": reason }));
        report["designed"] = json!({
            "one_of": one_of,
            "resolved": resolved,
            "assumed": designs.assumed(),
            "unmade": unmade.collect::<Vec<_>>(),
        });
    }
    report
}

/// Planted cases that show, and those of them that are named right.
pub(super) fn sums(told: &Tested<'_>) -> (usize, usize) {
    let rows = told.table.rows.iter();
    rows.fold((0, 0), |(v, r), row| (v + row.visible, r + row.right))
}

/// A size as it is asked for.
pub(super) fn shown(size: Size) -> String {
    match size {
        Size::Part(part) => format!("{part}"),
        Size::Detectable(times) => format!("{times}x"),
    }
}

/// What is claimed; a law of its own has no name.
fn claimed(told: &Tested<'_>, found: Found) -> Value {
    match found {
        Found::Nothing => json!("nothing"),
        Found::Law => json!("law"),
        Found::Effect(number) => named(told, number),
    }
}

fn named(told: &Tested<'_>, number: usize) -> Value {
    let hypothesis = &told.hypotheses[number];
    json!({ "effect": hypothesis.effect, "site": hypothesis.site })
}

fn case(told: &Tested<'_>, case: &Case, kept: &Kept) -> Value {
    let planted = match case.kind {
        Planting::Planted(number, _) | Planting::OpenSet(number, _) => Some(number),
        Planting::Empty | Planting::Parameter(_) | Planting::Sensor(..) => None,
    };
    let outcome = match kept {
        Err(reason) => return json!({ "name": case.key, "failed": reason }),
        Ok(outcome) => outcome,
    };
    let mut value = json!({
        "name": case.key,
        "verdict": word(outcome.verdict),
        "effects": effects(told, &outcome.claims),
        "unexplained": outcome.unexplained,
        "right": outcome.is_right(&case.kind),
    });
    if let Some(number) = planted {
        value["planted"] = named(told, number);
        value["size"] = json!(outcome.size);
        value["sizes"] = json!(outcome.planted.0);
        value["shapes"] = json!(outcome.planted.1);
        value["detectable"] = json!(outcome.detectable);
        value["expected_gain"] = json!(outcome.expected.map(|(gain, _)| gain));
        value["gate"] = json!(outcome.expected.map(|(_, gate)| gate));
        value["shows"] = json!(outcome.is_visible());
        value["equivalent"] = json!(outcome.equivalent);
        if let Some(own) = &outcome.designed {
            value["designed"] = designed(told, own, number);
        }
    }
    value
}

fn effects(told: &Tested<'_>, claims: &[Claim]) -> Vec<Value> {
    let each = claims.iter().map(|claim| {
        let equivalents = claim.alternatives.iter();
        let equivalents = equivalents.filter(|(_, own)| *own != Relation::Another);
        let equivalents = equivalents.map(|(number, own)| {
            let mut other = named(told, *number);
            other["relation"] = json!(relation_word(*own));
            other
        });
        json!({
            "claimed": claim.hypothesis.map(|n| named(told, n)),
            "size": claim.size,
            "interval": [claim.interval.0, claim.interval.1],
            "one_of": claim.related(Relation::Another).map(|n| named(told, n)).collect::<Vec<_>>(),
            "equivalents": equivalents.collect::<Vec<_>>(),
        })
    });
    each.collect()
}

/// What became of a verdict `one of` with a designed record.
fn designed(told: &Tested<'_>, designed: &Designed, planted: usize) -> Value {
    let resolved = designed.resolves(planted);
    match designed {
        Designed::NoSignal => json!({ "signal": null, "resolved": resolved }),
        Designed::Unrecorded(signal) => {
            json!({ "signal": signal, "verdict": null, "resolved": resolved })
        }
        Designed::Diagnosed {
            signal,
            apart,
            verdict,
            claims,
        } => json!({
            "signal": signal,
            "apart": apart,
            "verdict": word(*verdict),
            "effects": effects(told, claims),
            "resolved": resolved,
        }),
    }
}
