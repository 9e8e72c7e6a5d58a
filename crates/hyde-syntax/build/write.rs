//! Writes one Rust function for each rule of the grammar: `fn NAME(m: &mut Matcher) -> bool`, which moves `m` past what
//! matches and records the constructs, or leaves `m` as it was.
//!
//! The meaning is that of the code which `pest_derive` generates: in a rule that is not atomic, white space and comments
//! are skipped between the parts of a sequence and of a repetition; the constructs inside of an atomic rule are not
//! recorded. A rule that is called from an atomic one is written a second time, as `NAME_in_atomic`.

use crate::first::{Firsts, is_atomic};
use pest_meta::ast::RuleType;
use pest_meta::optimizer::{OptimizedExpr, OptimizedRule};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The functions of all rules, and `fn start(rule)` which has the function of each.
pub(crate) fn functions(rules: &[OptimizedRule]) -> Result<String, String> {
    let mut writer = Writer {
        firsts: Firsts::of(rules),
        wanted: rules
            .iter()
            .map(|rule| (rule.name.clone(), false))
            .collect(),
        done: BTreeSet::new(),
    };
    let mut text = String::from("// Written by build.rs from grammar/hyde.pest.\n\n");
    while let Some((name, inside)) = writer.wanted.pop_first() {
        if !writer.done.insert((name.clone(), inside)) {
            continue;
        }
        let rule = writer.firsts.rule(&name);
        let rule = rule.ok_or_else(|| format!("the grammar has no rule `{name}`"))?;
        let body = writer.body(rule, inside)?;
        let function = called(&name, inside);
        let _ = writeln!(
            text,
            "fn {function}(m: &mut Matcher<'_>) -> bool {{\n    {body}\n}}\n"
        );
    }
    text.push_str("fn start(rule: Rule) -> fn(&mut Matcher<'_>) -> bool {\n    match rule {\n");
    for rule in rules {
        let _ = writeln!(
            text,
            "        Rule::{} => {},",
            rule.name,
            called(&rule.name, false)
        );
    }
    text.push_str("    }\n}\n");
    Ok(text)
}

fn called(rule: &str, inside: bool) -> String {
    let end = if inside { "_in_atomic" } else { "" };
    format!("match_{}{end}", rule.to_lowercase())
}

struct Writer<'g> {
    firsts: Firsts<'g>,
    /// Rules still to write, each with whether it is called from an atomic one.
    wanted: BTreeSet<(String, bool)>,
    done: BTreeSet<(String, bool)>,
}

impl Writer<'_> {
    fn body(&mut self, rule: &OptimizedRule, inside: bool) -> Result<String, String> {
        let atomic = inside || is_atomic(rule);
        let silent = inside || rule.ty == RuleType::Silent;
        if rule.ty == RuleType::CompoundAtomic || rule.ty == RuleType::NonAtomic {
            return Err(format!(
                "`{}`: rules with `$` or `!` are not known here",
                rule.name
            ));
        }
        let matched = self.expression(&rule.expr, atomic)?;
        Ok(if silent {
            matched
        } else {
            format!("m.rule(Rule::{}, |m| {matched})", rule.name)
        })
    }

    /// A Rust expression that is true where `expr` matches. Where it is false, the matcher stands where it stood.
    fn expression(&mut self, expr: &OptimizedExpr, atomic: bool) -> Result<String, String> {
        Ok(match expr {
            OptimizedExpr::Str(text) => format!("m.literal({text:?}.as_bytes())"),
            OptimizedExpr::Insens(text) => format!("m.letters({text:?}.as_bytes())"),
            OptimizedExpr::Ident(name) => self.named(name, atomic),
            OptimizedExpr::Seq(..) => {
                let between = if atomic { " && " } else { " && m.blank() && " };
                let texts = self.each(&parts(expr), atomic)?;
                format!("m.sequence(|m| {})", texts.join(between))
            }
            OptimizedExpr::Choice(..) => self.choice(&alternatives(expr), atomic)?,
            OptimizedExpr::Opt(inner) => {
                format!("m.optional(|m| {})", self.expression(inner, atomic)?)
            }
            OptimizedExpr::Rep(inner) => {
                let inner = self.expression(inner, atomic)?;
                let repeat = if atomic { "repeat" } else { "repeat_spaced" };
                format!("m.{repeat}(|m| {inner})")
            }
            OptimizedExpr::PosPred(inner) => {
                format!("m.ahead(|m| {})", self.expression(inner, atomic)?)
            }
            OptimizedExpr::NegPred(inner) => {
                format!("!m.ahead(|m| {})", self.expression(inner, atomic)?)
            }
            OptimizedExpr::Skip(ends) => {
                let ends: Vec<String> = ends
                    .iter()
                    .map(|end| format!("{end:?}.as_bytes()"))
                    .collect();
                format!("m.skip_until(&[{}])", ends.join(", "))
            }
            OptimizedExpr::RestoreOnErr(inner) => self.expression(inner, atomic)?,
            OptimizedExpr::Range(..) | OptimizedExpr::PeekSlice(..) | OptimizedExpr::Push(_) => {
                return Err(format!("an expression that is not known here: {expr:?}"));
            }
        })
    }

    fn each(&mut self, list: &[&OptimizedExpr], atomic: bool) -> Result<Vec<String>, String> {
        list.iter()
            .map(|part| self.expression(part, atomic))
            .collect()
    }

    fn named(&mut self, name: &str, atomic: bool) -> String {
        let class = match name {
            "ANY" => return "m.any()".to_owned(),
            "ASCII_DIGIT" => "is_ascii_digit",
            "ASCII_ALPHA" => "is_ascii_alphabetic",
            "ASCII_ALPHA_LOWER" => "is_ascii_lowercase",
            "ASCII_ALPHA_UPPER" => "is_ascii_uppercase",
            "ASCII_ALPHANUMERIC" => "is_ascii_alphanumeric",
            _ => {
                self.wanted.insert((name.to_owned(), atomic));
                return format!("{}(m)", called(name, atomic));
            }
        };
        format!("m.one(|byte| byte.{class}())")
    }

    /// By the next byte, the alternatives that can begin with it, in the order of the grammar.
    fn choice(&mut self, list: &[&OptimizedExpr], atomic: bool) -> Result<String, String> {
        let texts = self.each(list, atomic)?;
        let firsts: Vec<_> = list
            .iter()
            .map(|part| self.firsts.expression(part, atomic))
            .collect();
        let mut groups: Vec<(Vec<usize>, Vec<u8>)> = Vec::new();
        for byte in 0..=u8::MAX {
            let able: Vec<usize> = (0..list.len())
                .filter(|&index| firsts[index].admits(byte))
                .collect();
            match groups.iter_mut().find(|(group, _)| *group == able) {
                Some((_, bytes)) => bytes.push(byte),
                None => groups.push((able, vec![byte])),
            }
        }
        groups.sort_by_key(|(_, bytes)| bytes.len());
        let last = groups.pop();
        let mut text = String::from("match m.peek() {");
        for (able, bytes) in &groups {
            let _ = write!(text, " {} => {},", pattern(bytes), either(able, &texts));
        }
        let most = last.map_or_else(String::new, |(able, _)| either(&able, &texts));
        let _ = write!(text, " _ => {most} }}");
        Ok(text)
    }
}

fn either(able: &[usize], texts: &[String]) -> String {
    if able.is_empty() {
        return "false".to_owned();
    }
    let texts: Vec<&str> = able.iter().map(|&index| texts[index].as_str()).collect();
    texts.join(" || ")
}

/// The bytes as a pattern of ranges.
fn pattern(bytes: &[u8]) -> String {
    let mut ranges: Vec<(u8, u8)> = Vec::new();
    for &byte in bytes {
        match ranges.last_mut() {
            Some((_, last)) if last.checked_add(1) == Some(byte) => *last = byte,
            _ => ranges.push((byte, byte)),
        }
    }
    let ranges: Vec<String> = ranges
        .iter()
        .map(|(first, last)| format!("{first}..={last}"))
        .collect();
    ranges.join(" | ")
}

/// `a ~ (b ~ c)` as the list `a, b, c`.
fn parts(expr: &OptimizedExpr) -> Vec<&OptimizedExpr> {
    let mut list = Vec::new();
    let mut rest = expr;
    while let OptimizedExpr::Seq(left, right) = rest {
        list.push(&**left);
        rest = right;
    }
    list.push(rest);
    list
}

/// `a | (b | c)` as the list `a, b, c`.
fn alternatives(expr: &OptimizedExpr) -> Vec<&OptimizedExpr> {
    let mut list = Vec::new();
    let mut rest = expr;
    while let OptimizedExpr::Choice(left, right) = rest {
        list.push(&**left);
        rest = right;
    }
    list.push(rest);
    list
}
