//! The words of the user for the rules of the grammar, so that no message speaks of `binding` or `kw_end`.

use crate::grammar::Rule;
use crate::matcher;

/// What the parser expected, in the user's words: at most a handful, each once.
pub(crate) fn expected(rules: &[Rule]) -> String {
    let mut words: Vec<String> = Vec::new();
    for &rule in rules {
        let word = word(rule);
        if !word.is_empty() && !words.contains(&word) {
            words.push(word);
        }
    }
    if words.iter().any(|word| word == "an expression") {
        words.retain(|word| word != "a name" && word != "an operator");
    }
    words.truncate(5);
    match words.split_last() {
        None => "something else".to_owned(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}

/// Whether a name, in back quotes or not, is a word of the language.
#[must_use]
pub fn is_reserved(found: &str) -> bool {
    let token = found.trim_matches('`');
    matcher::parse(Rule::keyword, token).is_some()
}

fn word(rule: Rule) -> String {
    let name = format!("{rule:?}");
    if let Some(keyword) = name.strip_prefix("kw_") {
        return format!("`{keyword}`");
    }
    #[allow(
        clippy::wildcard_enum_match_arm,
        reason = "a grammar has many rules and few that a message names"
    )]
    let text = match rule {
        Rule::expression
        | Rule::number
        | Rule::quantity
        | Rule::string
        | Rule::boolean
        | Rule::group
        | Rule::array
        | Rule::named
        | Rule::conditional
        | Rule::negative
        | Rule::positive
        | Rule::not => "an expression",
        Rule::ident
        | Rule::reference
        | Rule::path
        | Rule::part
        | Rule::member
        | Rule::member_name
        | Rule::quoted_name => "a name",
        Rule::or
        | Rule::and
        | Rule::le
        | Rule::ge
        | Rule::ne
        | Rule::eq
        | Rule::lt
        | Rule::gt
        | Rule::plus
        | Rule::minus
        | Rule::times
        | Rule::over
        | Rule::power => "an operator",
        Rule::unit | Rule::unit_text => "a unit in brackets",
        Rule::binding => "`=`",
        Rule::modification => "a modification in parentheses",
        Rule::change => "a modification",
        Rule::arguments | Rule::argument => "arguments in parentheses",
        // Never the point of a message.
        Rule::prefix_word | Rule::keyword | Rule::on_domain | Rule::section => "",
        Rule::declaration | Rule::declarator => "a declaration",
        Rule::equation | Rule::equality => "an equation",
        Rule::doc => "a documentation string",
        Rule::layout => "settings in parentheses",
        Rule::layout_kind => "`layout`",
        Rule::layout_unit => "a unit in brackets",
        Rule::layout_wraps => "`wraps`",
        Rule::prior | Rule::noise => "`~`",
        Rule::source => "`from`",
        Rule::within => "`in`",
        Rule::over_variables => "`over`",
        Rule::subscript => "a subscript",
        Rule::counted => "`for`",
        Rule::upper => "`:`",
        Rule::mode => "`mode`",
        Rule::exit => "`exit`",
        Rule::class_kind => "`model`, `connector`, `effect` or `function`",
        Rule::end_clause => "`end`",
        _ => return format!("{} {}", article(&name), name.replace('_', " ")),
    };
    text.to_owned()
}

fn article(name: &str) -> &'static str {
    if name.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    }
}
