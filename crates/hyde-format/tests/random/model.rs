//! Random models, word by word, and what may stand between two words.

use proptest::prelude::*;

/// The words of a piece of text; white space and comments come between them later.
pub(crate) type Words = Vec<String>;

fn words(text: &str) -> Words {
    text.split(' ').map(str::to_owned).collect()
}

fn joined(parts: Vec<Words>) -> Words {
    parts.concat()
}

fn list(items: Vec<Words>, sign: &str) -> Words {
    let mut all = Words::new();
    for (index, item) in items.into_iter().enumerate() {
        if index > 0 {
            all.push(sign.to_owned());
        }
        all.extend(item);
    }
    all
}

fn name() -> impl Strategy<Value = Words> {
    prop_oneof![
        "[a-d]{1,3}".prop_map(|name| vec![format!("v{name}")]),
        Just(words("motor . shaft . tau")),
        Just(words("x [ 2 ]")),
        "[a-z]{30,60}".prop_map(|name| vec![format!("long_{name}")]),
    ]
}

fn expression() -> impl Strategy<Value = Words> {
    let leaf = prop_oneof![
        name(),
        (0..2000_u32).prop_map(|n| vec![n.to_string()]),
        Just(words("3.5e-4 [N.m/rad]")),
        Just(words("true")),
    ];
    leaf.prop_recursive(5, 40, 4, |inner| {
        let operators = ["+", "-", "*", "/", "^", "<", ">=", "<>", "and", "or"];
        prop_oneof![
            (
                inner.clone(),
                prop::sample::select(operators.to_vec()),
                inner.clone()
            )
                .prop_map(|(a, op, b)| joined(vec![
                    words("("),
                    a,
                    words(op),
                    b,
                    words(")")
                ])),
            (
                inner.clone(),
                prop::sample::select(operators[..5].to_vec()),
                inner.clone()
            )
                .prop_map(|(a, op, b)| joined(vec![a, words(op), b])),
            inner
                .clone()
                .prop_map(|a| joined(vec![words("- ("), a, words(")")])),
            inner
                .clone()
                .prop_map(|a| joined(vec![words("not ("), a, words(")")])),
            prop::collection::vec(inner.clone(), 1..5).prop_map(|items| joined(vec![
                words("f ("),
                list(items, ","),
                words(")")
            ])),
            prop::collection::vec(inner.clone(), 1..6).prop_map(|items| joined(vec![
                words("{"),
                list(items, ","),
                words("}")
            ])),
            (inner.clone(), inner.clone(), inner.clone(), inner.clone()).prop_map(
                |(a, b, c, d)| joined(vec![
                    words("( if"),
                    a,
                    words("then"),
                    b,
                    words("elseif"),
                    c,
                    words("then 1 else"),
                    d,
                    words(")"),
                ])
            ),
            (inner.clone(), inner).prop_map(|(a, b)| joined(vec![
                words("{"),
                a,
                words("for i in 1 :"),
                b,
                words("}")
            ])),
        ]
    })
}

fn equation() -> impl Strategy<Value = Words> {
    let leaf = prop_oneof![
        (name(), expression()).prop_map(|(a, b)| joined(vec![a, words("="), b, words(";")])),
        (name(), name(), name()).prop_map(|(a, b, c)| joined(vec![
            words("connect ("),
            list(vec![a, b, c], ","),
            words(") ;")
        ])),
        (name(), expression()).prop_map(|(a, b)| joined(vec![
            words("reinit ("),
            a,
            words(","),
            b,
            words(") ;")
        ])),
        expression().prop_map(|a| joined(vec![words("assert ("), a, words(", \"no\" ) ;")])),
    ];
    leaf.prop_recursive(3, 12, 3, |inner| {
        let some = prop::collection::vec(inner, 0..3).prop_map(joined);
        prop_oneof![
            (expression(), some.clone()).prop_map(|(n, body)| joined(vec![
                words("for i in 1 :"),
                n,
                words("loop"),
                body,
                words("end for ;")
            ])),
            (expression(), some.clone(), some.clone()).prop_map(|(a, yes, no)| joined(vec![
                words("if"),
                a,
                words("then"),
                yes,
                words("else"),
                no,
                words("end if ;"),
            ])),
            (expression(), some.clone(), expression(), some).prop_map(|(a, one, b, two)| joined(
                vec![
                    words("when"),
                    a,
                    words("then"),
                    one,
                    words("elsewhen"),
                    b,
                    words("then"),
                    two,
                    words("end when ;"),
                ]
            )),
        ]
    })
}

fn declaration() -> impl Strategy<Value = Words> {
    let prefix = prop::sample::select(vec![
        "",
        "parameter ",
        "final parameter ",
        "input ",
        "site ",
    ]);
    let change = (name(), expression()).prop_map(|(a, b)| joined(vec![a, words("="), b]));
    (
        prefix,
        prop::collection::vec(change, 0..5),
        expression(),
        any::<bool>(),
    )
        .prop_map(|(prefix, changes, value, doc)| {
            let mut all = words(&format!("{prefix}Part part"));
            if !changes.is_empty() {
                all.extend(joined(vec![words("("), list(changes, ","), words(")")]));
            }
            all.extend(joined(vec![words("="), value]));
            if doc {
                all.push("\"a text with // no comment\"".to_owned());
            }
            all.extend(words(", other ;"));
            all
        })
}

fn modes() -> impl Strategy<Value = Words> {
    (
        prop::collection::vec(equation(), 1..3),
        expression(),
        prop::collection::vec(equation(), 0..3),
    )
        .prop_map(|(own, guard, actions)| {
            joined(vec![
                words("modes initial a { mode a {"),
                joined(own),
                words("exit"),
                guard,
                words("-> b ( 1 ) {"),
                joined(actions.clone()),
                words("} ; enter {"),
                joined(actions),
                words("} } mode b ( Real s ) { exit x > 1 -> a impact ; } }"),
            ])
        })
}

/// A model and an experiment, word by word.
pub(crate) fn model() -> impl Strategy<Value = Words> {
    (
        prop::collection::vec(declaration(), 0..4),
        prop::option::of(modes()),
        prop::collection::vec(equation(), 0..4),
        expression(),
    )
        .prop_map(|(declarations, modes, equations, stop)| joined(vec![
            words("model A"),
            joined(declarations),
            modes.unwrap_or_default(),
            words("equation"),
            joined(equations),
            words("end A ; experiment e of A ( k = 1 ) stimulus a ="),
            stop.clone(),
            words(", b = 2 ; bode from u to y , z over 1 .. 50 [Hz] by stepped ( n = 1 ) in g = slip , h = stuck ; stop"),
            stop,
            words("; end e ;"),
        ]))
}

/// What may stand between two words.
pub(crate) fn gap() -> impl Strategy<Value = &'static str> {
    prop_oneof![
        20 => Just(" "),
        4 => Just("\n"),
        1 => Just("\n\n\n   "),
        1 => Just(" // comment\n"),
        1 => Just(" /* comment */ "),
        1 => Just("\n/* comment\n of two lines */\n"),
    ]
}
