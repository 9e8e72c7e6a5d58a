//! Every diagnostic of models that are not written as Modelica, as data.

use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn too_long() = error CannotExport {
        "the Modelica text of the model is longer than 50 MB";
        help "reduce the number of cells of fields, or export with `hyde export fmu`";
    }
    fn chooses_states(candidates: &[String], constraint: Option<Span>) = error CannotExport {
        "the run chooses its states anew among `{}`, which flat Modelica does not express", candidates.join("`, `");
        if let Some(constraint) = constraint { at constraint, "a constraint between them"; }
        help "write the constraint in coordinates that stay independent, or export with `hyde export fmu`";
    }
    fn edge_in_condition(edge: Span) = error CannotExport {
        "`edge` inside a condition is not exported to Modelica"; at edge, "this edge";
        help "write a `when` with the condition itself, or export with `hyde export fmu`";
    }
}
