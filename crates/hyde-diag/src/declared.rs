//! [`diagnostics!`](crate::diagnostics): declares diagnostics as data, away from the algorithms that report them.

/// Declares functions that make a [`Diagnostic`](crate::Diagnostic): severity (`error` or `warning`) and
/// [`Code`](crate::Code), message, and parts.
///
/// ```
/// use hyde_diag::{Sources, Span, diagnostics};
///
/// diagnostics! {
///     fn unknown_part(name: &str, here: Span, known: &[&str], near: Option<&str>) = error UnknownName {
///         "there is no part `{name}`"; at here, "not known";
///         match near {
///             Some(near) => { help "did you mean `{near}`?"; }
///             None => { help "the parts are {}", known.join(", "); }
///         }
///     }
/// }
///
/// let here = Span::new(Sources::new().add("axis.hyde", "mtoor"), 0, 5);
/// let diagnostic = unknown_part("mtoor", here, &["motor", "screw"], Some("motor"));
/// assert_eq!(diagnostic.help.as_deref(), Some("did you mean `motor`?"));
/// ```
///
/// The functions are seen in the whole crate. The message and every text are literals of `format!`, with its arguments behind a
/// comma. The parts, each ended by `;`, stand in the order in which they are shown:
///
/// | Part | Adds |
/// |---|---|
/// | `at SPAN, TEXT;` | a place and what is there; the first one is where the mistake is |
/// | `note TEXT;` | a fact |
/// | `help TEXT;` | what to write instead |
/// | `match VALUE { PATTERN => { PARTS } … }` | the parts of one arm; `VALUE` is a name, or stands in parentheses |
/// | `if let PATTERN = NAME { PARTS }` | the parts if the pattern fits |
/// | `for PATTERN in VALUE { PARTS }` | the parts for each item |
#[macro_export]
macro_rules! diagnostics {
    (@parts $made:ident;) => {};
    (@parts $made:ident; at $span:expr, $text:literal $(, $value:expr)* $(,)?; $($rest:tt)*) => {
        $made = $made.label($span, format!($text $(, $value)*));
        $crate::diagnostics!(@parts $made; $($rest)*);
    };
    (@parts $made:ident; $part:ident $text:literal $(, $value:expr)* $(,)?; $($rest:tt)*) => {
        $made = $made.$part(format!($text $(, $value)*));
        $crate::diagnostics!(@parts $made; $($rest)*);
    };
    (@parts $made:ident; match $value:ident $($rest:tt)*) => {
        $crate::diagnostics!(@parts $made; match ($value) $($rest)*);
    };
    (@parts $made:ident; match ($value:expr) { $($pattern:pat $(if $guard:expr)? => { $($part:tt)* })+ } $($rest:tt)*) => {
        match $value {
            $($pattern $(if $guard)? => { $crate::diagnostics!(@parts $made; $($part)*); })+
        }
        $crate::diagnostics!(@parts $made; $($rest)*);
    };
    (@parts $made:ident; match ($first:expr, $($value:expr),+) { $($arm:tt)* } $($rest:tt)*) => {
        $crate::diagnostics!(@parts $made; match (($first, $($value),+)) { $($arm)* } $($rest)*);
    };
    (@parts $made:ident; if let $pattern:pat = $value:ident { $($part:tt)* } $($rest:tt)*) => {
        if let $pattern = $value {
            $crate::diagnostics!(@parts $made; $($part)*);
        }
        $crate::diagnostics!(@parts $made; $($rest)*);
    };
    (@parts $made:ident; for $item:pat in $items:ident $($rest:tt)*) => {
        $crate::diagnostics!(@parts $made; for $item in ($items) $($rest)*);
    };
    (@parts $made:ident; for $item:pat in ($items:expr) { $($part:tt)* } $($rest:tt)*) => {
        for $item in $items {
            $crate::diagnostics!(@parts $made; $($part)*);
        }
        $crate::diagnostics!(@parts $made; $($rest)*);
    };
    ($(
        $(#[$meta:meta])*
        fn $name:ident($($parameter:tt: $type:ty),* $(,)?) = $severity:ident $code:ident {
            $message:literal $(, $value:expr)* $(,)?;
            $($part:tt)*
        }
    )+) => {$(
        $(#[$meta])*
        #[must_use]
        pub(crate) fn $name($($parameter: $type),*) -> $crate::Diagnostic {
            let message = format!($message $(, $value)*);
            let mut made = $crate::Diagnostic::$severity($crate::Code::$code, message);
            $crate::diagnostics!(@parts made; $($part)*);
            made
        }
    )+};
}
