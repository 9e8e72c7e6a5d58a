//! Finds statements nested so deeply, or with so many operators, that a recursive parser could run out of stack.

use crate::recover::Scanner;

/// Brackets inside brackets at most.
const MAX_DEPTH: usize = 60;
/// Operators in one statement at most: a chain of them is as deep as it is long.
const MAX_OPERATORS: usize = 500;

/// The places (bytes) where a statement exceeds a limit, one a statement.
pub(crate) fn too_deep(text: &str) -> Vec<usize> {
    let mut found = Vec::new();
    let (mut depth, mut operators, mut reported) = (0_usize, 0_usize, false);
    for (at, token) in Scanner::new(text, 0) {
        match token {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            ";" => {
                operators = 0;
                reported = false;
                if depth > MAX_DEPTH {
                    depth = 0;
                }
            }
            "+" | "-" | "*" | "/" | "^" | "<" | ">" | "and" | "or" | "not" | "if" | "elseif"
            | "for" | "when" => {
                operators += 1;
            }
            _ => {}
        }
        if (depth > MAX_DEPTH || operators > MAX_OPERATORS) && !reported {
            found.push(at);
            reported = true;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::too_deep;

    #[test]
    fn depth_and_length_are_limited_and_strings_do_not_count() {
        assert!(too_deep(&format!("x = {}1{};", "(".repeat(50), ")".repeat(50))).is_empty());
        assert_eq!(
            too_deep(&format!("x = {}1{};", "(".repeat(80), ")".repeat(80))).len(),
            1
        );
        assert_eq!(
            too_deep(&format!("x = 1{}; y = 2;", "+1".repeat(600))).len(),
            1
        );
        assert!(too_deep(&format!("x = \"{}\";", "(".repeat(500))).is_empty());
    }
}
