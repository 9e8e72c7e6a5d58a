//! Every diagnostic of texts that cannot be parsed, as data.

use crate::ast::Name;
use crate::habits::Habit;
use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn more_behind_record(more: Span) = error Syntax {
        "the declaration of the record ends before this"; at more, "not known here";
    }
    fn comment_without_end(opened: Span) = error Syntax {
        "this comment goes on to the end of the file"; at opened, "begins here";
        help "end it with `*/`";
    }
    fn text_without_end(opened: Span) = error Syntax {
        "this text goes on to the end of the file"; at opened, "begins here";
        help "end it with `\"`; if it has an end, an earlier text is not closed";
    }
    fn declared_twice(name: &Name, first: Span) = error Duplicate {
        "`{}` is declared twice", name.text; at name.span, "declared again here"; at first, "declared first here";
        help "rename one of the two, or remove it";
    }
    fn said_twice(word: &str, here: Span, first: Span) = error Duplicate {
        "`{word}` is said twice"; at here, "here again"; at first, "here first";
        help "remove one of the two";
    }
    fn too_deep(here: Span) = error TooDeep {
        "this statement is nested too deeply or too long";
        at here, "the limit of 60 nested brackets or 500 operators is exceeded here";
        help "give parts of it separate names: `Real part = …;`";
    }
    fn block_without_end(word: &str, opened: Span, here: Span) = error Syntax {
        "this `{word}` is not ended"; at opened, "begins here"; at here, "expected `end {word};`";
        help "write `end {word};`";
    }
    fn habit_of_another_language(habit: &Habit, here: Span) = error Syntax {
        "{}", habit.message; at here, "not a part of the language";
        help "{}", habit.help;
    }
    /// `found` is a word in quotes.
    fn keyword_as_name(found: &str, here: Span) = error Syntax {
        "{found} cannot be a name"; at here, "this is a keyword of the language";
        help "choose another name";
    }
    /// `missing` is a sign of which it is certain that it is missing there.
    fn not_expected(
        (expected, found): (&str, &str), missing: Option<&str>, here: Span, repair: Option<&str>,
    ) = error Syntax {
        "expected {expected}, found {found}";
        match missing {
            Some(sign) => { at here, "{sign} is missing here"; }
            None => { at here, "not understood from here on"; }
        }
        if let Some(repair) = repair { help "{repair}"; }
    }
    fn number_not_finite(number: &str, here: Span) = error BadNumber {
        "`{number}` is not a finite number"; at here, "beyond 1.8e308";
        help "write a number that a double can hold, or a larger unit";
    }
    fn two_signs(here: Span, number: &str) = error Syntax {
        "two signs stand one behind the other"; at here, "a sum, or an uncertainty?";
        help "the uncertainty of a parameter is written `~ ±{number}` behind its value; a sum with a negative number is written `+ (-{number})`";
    }
    fn derivative_without_parentheses(of: &Name, here: Span) = error Syntax {
        "the parentheses of a derivative are missing"; at here, "`der` is a function";
        help "write `der({})`", of.text;
    }
    fn range_downwards(here: Span, (low, high): (&str, &str)) = error Syntax {
        "a range goes from the lower bound to the upper one"; at here, "goes downwards";
        help "write `{low} .. {high}`";
    }
    fn second_package(second: Span, first: Span) = error Syntax {
        "a file is one package: a second one begins here"; at second, "a second package"; at first, "the first one";
        help "move it into a separate file with the name of the package, and import it: `import Name.*;`";
    }
    fn end_of_nothing(end: Span) = error Syntax {
        "there is no open block to end here"; at end, "an `end` too many";
        help "leave it out; a package is its file, `package Name;` on the first line, and has no `end`";
    }
    fn nested_class((name, here): (&str, Span), outer: &str) = error Syntax {
        "`{name}` is defined inside `{outer}`"; at here, "a class of its own";
        help "move it before `{outer}`: the classes of a file cannot be nested";
    }
    fn equation_among_declarations(equation: Span) = error Misplaced {
        "an equation is among the declarations"; at equation, "this is an equation";
        help "write `equation` before the first equation";
    }
    fn end_without_name(opened: &Name, end: Span) = error EndName {
        "`{}` ends without its name", opened.text;
        at end, "expected `end {};`", opened.text; at opened.span, "opened here";
        help "write `end {};`", opened.text;
    }
    fn end_of_another(opened: &Name, closed: &Name) = error EndName {
        "`{}` ends with `end {}`", opened.text, closed.text;
        at closed.span, "expected `end {};`", opened.text; at opened.span, "opened here";
        help "write `end {};`", opened.text;
    }
    fn no_end(opened: &Name) = error EndName {
        "`{}` has no end", opened.text; at opened.span, "opened here";
        help "write `end {};`", opened.text;
    }
}
