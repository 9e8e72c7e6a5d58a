//! What is said of `connect`.

use crate::words::listed;
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::Reference;

diagnostics! {
    fn lengths_differ((side, length): (&Reference, usize), (array, len): (Span, usize)) = error BadConnection {
        "arrays of different lengths are connected"; at side.span, "has {length} elements";
        at array, "has {len} elements";
        help "connect as many: `a[1:3]` means three elements of `a`";
    }
    fn array_with_one(side: &Reference, (array, len): (Span, usize)) = error BadConnection {
        "an array and a single one are connected"; at side.span, "one"; at array, "has {len} elements";
        help "name an element, `a[1]`, or join each with it: `for i in 1:n loop connect(a[i], b); end for;`";
    }
    fn too_deep(side: &Reference) = error BadConnection {
        "`{}` is too deep to connect", side.dotted(); at side.span, "a connector of a part of a part";
        help "connect it inside the part, or give the part a connector";
    }
    fn component(side: &Reference, class: &str, connectors: &[&str]) = error BadConnection {
        "`{}` is a component ({class}), not a connector", side.dotted(); at side.span, "a component";
        match connectors {
            [] => {}
            known => { help "connect one of its connectors: {}", listed(known); }
        }
    }
    fn not_a_connector(side: &Reference) = error BadConnection {
        "`{}` is not a connector", side.dotted(); at side.span, "cannot be connected";
    }
    fn connector_and_signal(connector: Span, signal: Span) = error BadConnection {
        "a connector and a signal are connected"; at connector, "a connector"; at signal, "a signal";
        help "connect connectors with each other; a signal is the value of an input, `Part part(u = x);`, or stands in an equation";
    }
    fn types_differ((first, a): (Span, &str), (other, b): (Span, &str)) = error BadConnection {
        "connectors of different types are connected: `{a}` and `{b}`"; at other, "a `{b}`"; at first, "a `{a}`";
        help "connect connectors of the same type; between `{a}` and `{b}` use a component that has both";
    }
    fn connected_to_itself(side: &Reference) = error BadConnection {
        "`{}` is connected to itself", side.dotted(); at side.span, "the same connector again";
        help "name the connector of another component";
    }
}
