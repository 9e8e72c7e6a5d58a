//! The header: what a program in C sees of the model.

use crate::factors::Factors;
use crate::fixed_step::FixedStep;
use crate::names::Names;
use hyde_program::Coefficients;
use std::fmt::Write as _;

/// The text of `NAME.h`.
pub(crate) fn text(
    model: &FixedStep<'_>,
    names: &Names,
    (factors, coefficients): (&Factors, &Coefficients),
) -> String {
    let name = &model.name;
    let mut text = format!(
        "/* The model {} with a fixed step, written by Hyde {}. All values are in SI units.\n\n\
         \x20  {name} m;                                    the model, without pointers: copy it to keep a state\n\
         \x20  {name}_init(&m);                             start values, at {name}_time(&m)\n\
         \x20  {name}_set(&m, {name}_in_…, value);          an input, constant during a step\n\
         \x20  {name}_step(&m);                             one step of {name}_STEP seconds\n\
         \x20  {name}_get(&m, {name}_out_…);                an output at the end of the step\n\n\
         \x20  Events and ticks happen at the end of the step in which they are due; a tick reads the inputs of that step.\n\
         \x20  A step that fails leaves the model as it was. Parameters that are not listed are fixed: set them with\n\
         \x20  `hyde export c --set`. Functions of different instances may run at the same time. */\n\n\
         #ifndef {name}_H\n#define {name}_H\n\n",
        model.program.name,
        env!("CARGO_PKG_VERSION")
    );
    let _ = writeln!(text, "#define {name}_STEP {:?} /* s */\n", model.step_s);
    let inputs = model.inputs.iter().map(|own| (&own.name, &own.unit));
    enumeration(&mut text, name, "INPUTS", &names.inputs, inputs);
    let settable = model.settable.iter().map(|own| (&own.name, &own.unit));
    enumeration(&mut text, name, "PARAMETERS", &names.parameters, settable);
    let outputs: Vec<(String, String)> = model
        .outputs
        .iter()
        .map(|&number| {
            let output = &model.program.outputs[number];
            (output.name.clone(), output.dimension.usual_unit())
        })
        .collect();
    let outputs = outputs.iter().map(|(name, unit)| (name, unit));
    enumeration(&mut text, name, "OUTPUTS", &names.outputs, outputs);
    let _ = writeln!(text, "/* What a function returns. */\nenum {{");
    for (status, what) in [
        ("OK", "in order"),
        ("NOT_SOLVED", "Newton's method does not converge"),
        ("SINGULAR", "the equations do not determine all unknowns"),
        ("NOT_FINITE", "an equation has no finite value"),
        ("ASSERT", "an assert of the model does not hold"),
        ("NO_SUCH", "no such input or parameter"),
        (
            "NOT_ALLOWED",
            "a value is not finite, or outside the bounds of its parameter or of one that follows from it",
        ),
    ] {
        let _ = writeln!(text, "    {name}_{status}, /* {what} */");
    }
    text.push_str("};\n\n");
    structure(&mut text, model, (factors, coefficients));
    let _ = write!(
        text,
        "#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n\
         int {name}_init({name} *m);\n\
         int {name}_step({name} *m);\n\
         double {name}_time(const {name} *m);\n\
         int {name}_set({name} *m, int input, double value);\n\
         double {name}_get(const {name} *m, int output);\n\
         int {name}_set_parameter({name} *m, int parameter, double value);\n\
         double {name}_get_parameter(const {name} *m, int parameter);\n\
         /* How often the events of an instant did not come to an end in 50 rounds, and the last ones were taken. */\n\
         long long {name}_unsettled(const {name} *m);\n\
         /* What a status means; of an assert its message. */\n\
         const char *{name}_message(const {name} *m, int status);\n\n\
         #ifdef __cplusplus\n}}\n#endif\n\n#endif\n"
    );
    text
}

fn enumeration<'n>(
    text: &mut String,
    model: &str,
    kind: &str,
    names: &[String],
    about: impl Iterator<Item = (&'n String, &'n String)>,
) {
    text.push_str("enum {\n");
    for (name, (own, unit)) in names.iter().zip(about) {
        let unit = match unit.as_str() {
            "1" => String::new(),
            unit => format!(" [{unit}]"),
        };
        let _ = writeln!(text, "    {name}, /* {}{unit} */", own.replace("*/", "* /"));
    }
    let _ = writeln!(text, "    {model}_{kind}\n}};\n");
}

/// Arrays of C have one element at least.
fn structure(
    text: &mut String,
    model: &FixedStep<'_>,
    (factors, coefficients): (&Factors, &Coefficients),
) {
    let (program, name) = (model.program, &model.name);
    let n = program.n_unknowns.max(1);
    let at_least = |count: usize| count.max(1);
    let z = at_least(program.n_memory);
    let u = at_least(2 * program.columns.len());
    let p = at_least(program.n_parameters);
    let relations = at_least(program.relations.len());
    let reactions = at_least(program.reactions.len());
    let values = at_least(program.assignments.len() + program.pins.len());
    let pins = at_least(program.pins.len());
    let holds = at_least(program.holds.iter().map(|hold| hold.len).sum());
    let automata = at_least(program.automata.len());
    let clauses = at_least(crate::source::clauses(program));
    let _ = write!(
        text,
        "/* All of a model. Nothing of it is for others to read or write. */\n\
         typedef struct {name} {{\n\
         \x20   long long count, unsettled, pending_at[{holds}], before_pending_at[{holds}];\n\
         \x20   int set, quiet, broken, fresh[2], first[2][{n}], last[2][{n}];\n\
         \x20   double y[{n}], yp[{n}], z[{z}], u[{u}], p[{p}], w[{w}], out[{out}];\n\
         \x20   double before_y[{n}], before_yp[{n}], before_z[{z}], left_y[{n}], left_yp[{n}], left_z[{z}];\n\
         \x20   double now_z[{z}], after_z[{z}], base[{n}], largest[{n}], residual[{n}], solution[{n}], scale[2][{n}], inverse[2][{n}], matrix[2][{square}], factors[2][{factors}], mode[2][{modes}];\n\
         \x20   double partials[{partials}], roots[{relations}], later[{relations}], truths[{reactions}], values[{values}];\n\
         \x20   double pin_value[{pins}], before_pin_value[{pins}], pending[{holds}], before_pending[{holds}];\n\
         \x20   unsigned short column[2][{square}], equation[2][{n}];\n\
         \x20   unsigned char in_order[2], given[{p}], conditions[{reactions}], before_conditions[{reactions}], flipped[{relations}];\n\
         \x20   unsigned char fired[{reactions}], pin_on[{pins}], before_pin_on[{pins}], left[{automata}], clause[{clauses}];\n\
         }} {name};\n\n",
        w = at_least(program.n_work),
        out = at_least(model.outputs.len()),
        square = n * n,
        factors = at_least(factors.count),
        modes = at_least(coefficients.modes.len()),
        partials = at_least(program.partials(hyde_program::Function::Residual).len()),
    );
}
