//! What is said of fields: their domains, where they are read, and the derivatives and integrals of them.

use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::Reference;

diagnostics! {
    fn no_end(domain: &str, (end, here): (&str, Span)) = error FieldUse {
        "a domain has no end `{end}`"; at here, "not an end";
        help "write `{domain}.left` or `{domain}.right`";
    }
    fn integral_over_no_domain(here: Span) = error FieldUse {
        "an integral is taken over a domain"; at here, "not a domain of this component";
        help "write `integral(rho*A*v^2/2, bar)` with `domain bar(…)`";
    }
    fn integral_outside_account(here: Span) = error FieldUse {
        "an integral over a domain is allowed only as a separate term of an energy account";
        at here, "not a term of an energy account";
        help "write `stored Energy kinetic = integral(rho*A*v^2/2, bar);`; over time: `measure Energy loss = integral(P);`";
    }
    fn outside_domain((cell, cells): (f64, usize), here: Span, domain: Span) = error FieldUse {
        "the position is outside the domain"; at here, "{cell:.3} cells from the start, of {cells}";
        at domain, "the domain";
    }
    fn too_few_cells((cells, least): (usize, usize), here: Span, domain: Span) = error FieldUse {
        "too few cells for a moving position"; at here, "moves along the domain"; at domain, "has {cells}";
        help "discretize it with `n = {least}` or more";
    }
    /// `why` is what is wrong with an expression of the equation.
    fn unknown_wave_speed(domain: &str, (here, why): (Span, &str), asked: Span) = error WaveSpeed {
        "how fast waves run along `{domain}` is not known"; at here, "{why}";
        at asked, "requests as many cells as they need";
        help "give the number: `fem(n = 24)`";
    }
    fn of_another_domain(domain: &str, here: Span) = error FieldUse {
        "a field of another domain"; at here, "lies on `{domain}`";
    }
    fn flux_outside_pder(flux: &str, here: Span) = error FieldUse {
        "the flux `{flux}` is used outside `pder`"; at here, "a flux lies between the nodes, this is evaluated at them";
        help "write `pder(q, x)`, or read the flux in another flux";
    }
    fn wrong_coordinate(coordinate: &str, here: Span) = error FieldUse {
        "the coordinate of this field is `{coordinate}`"; at here, "not its coordinate";
    }
    fn slope_outside_flux(here: Span) = error FieldUse {
        "a space derivative outside a flux"; at here, "an equation of a field takes derivatives of fluxes";
        help "give the flux a name: `field Torque q on bar = k*pder(th, x);` and write `pder(q, x)`";
    }
    fn derivative_outside_domain(here: Span) = error FieldUse {
        "the derivative of a flux outside an equation on the domain"; at here, "evaluated where there are no nodes";
        help "write the equation `indomain bar`";
    }
    fn flux_at_point(flux: &str, here: Span) = error FieldUse {
        "the flux `{flux}` is not read at a point"; at here, "lies between the nodes";
    }
    fn derivative_of_expression(here: Span) = error FieldUse {
        "the derivative of an expression"; at here, "not a field by name";
        help "give it a name: `field … q on bar = …;`";
    }
    fn derivative_of_no_field(name: &Reference, here: Span) = error FieldUse {
        "`{}` is not a field", name.dotted(); at here, "has no derivative in space";
    }
    fn position_of_no_field(name: &Reference) = error FieldUse {
        "`{}` is not a field", name.dotted(); at name.span, "only a field can be read at a position";
    }
    fn no_length(domain: &str, here: Span) = error NotAllowed {
        "the domain `{domain}` has no length"; at here, "its upper end is not above its lower end";
        help "write the lower end first: `domain {domain}(x in 0 .. 1 [m]);`";
    }
    fn needs_place(field: &str, here: Span) = error FieldUse {
        "the field `{field}` has no single value"; at here, "at which position?";
        help "read it at a position, `{}.at(xn)`, or write the equation `indomain …`",
            field.rsplit('.').next().unwrap_or(field);
    }
}
