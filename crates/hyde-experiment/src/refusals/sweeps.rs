//! What is said of sweeps: of what varies, in which values, and how these are sampled.

use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn second_experiment(here: Span) = error BadSweep {
        "a sweep is of one experiment"; at here, "a second experiment";
        help "write a sweep for each experiment";
    }
    fn label(here: Span) = error BadSweep {
        "a sweep has no labels"; at here, "only the records of a calibration have labels";
        help "leave out `at`";
    }
    fn varies_nothing(sweep: Span) = error BadSweep {
        "this sweep has no `vary`"; at sweep, "no parameter changes from case to case";
        help "write `vary gap in 5 .. 50 [um];` and the number of points: `grid 10;`";
    }
    fn varies_all_of(part: &str, here: Span) = error BadSweep {
        "`vary` takes parameters by name, and `{part}.*` is not one"; at here, "in this sweep";
        help "name each with its values, `vary {part}.k in 1 .. 2 [N/m];`, or write `vary uncertain;`: all that have a spread";
    }
    fn not_one_number(plan: &str, here: Span) = error BadSweep {
        "`{plan}` takes one number"; at here, "how many cases?";
        help "write `{plan} 500;`";
    }
    fn not_one_seed(here: Span) = error BadSweep {
        "`seed` takes one number"; at here, "which?";
        help "write `seed 1;`";
    }
    fn not_one_table(here: Span) = error BadSweep {
        "`cases` takes the name of one file"; at here, "which table?";
        help "write `cases \"cases.csv\";`, a table with a column for each parameter";
    }
    fn unknown_setting(word: &str, here: Span) = error BadSweep {
        "a sweep has no setting `{word}`"; at here, "not known";
        help "settings are `grid`, `random`, `latin`, `sobol`, `seed`, `cases` and `keep`";
    }
    fn two_plans(first: Span, second: Span) = error BadSweep {
        "the sweep has two sampling plans"; at second, "and this"; at first, "by this";
        help "keep one of `grid`, `random`, `latin` and `sobol`";
    }
    fn not_a_count(here: Span) = error BadSweep {
        "this is not a count"; at here, "a whole number from 1 to 1e9 is expected";
        help "write `grid 10;`, `random 500;`, `latin 500;`, `sobol 512;`, `seed 1;`";
    }
    fn nothing_uncertain(here: Span) = error BadSweep {
        "no parameter of the model is uncertain"; at here, "which?";
        help "give them a spread: `parameter Mass M = 300 [kg] ~ ±8%;`";
    }
    fn no_parameter(name: &str, here: Span, near: &[&str]) = error BadSweep {
        "the model has no parameter `{name}`"; at here, "not known";
        match near {
            [] => {
                help "vary a parameter, the start of a variable as `x.start`, or a component by `= {{A, B}}` of models";
            }
            near => { help "did you mean `{}`?", near.join("`, `"); }
        }
    }
    fn whole_array(name: &str, len: usize, here: Span) = error BadSweep {
        "`{name}` is an array of {len}"; at here, "one value for all of it";
        help "vary an element: `{name}[1]`";
    }
    fn final_parameter(name: &str, here: Span, declared: Span) = error BadSweep {
        "`{name}` is final"; at here, "cannot vary"; at declared, "made final here";
    }
    fn varies_twice(name: &str, here: Span) = error BadSweep {
        "`{name}` varies twice"; at here, "again";
        help "name it once: in a list, a range or the table of cases";
    }
    fn plan_without_range(here: Span) = error BadSweep {
        "the sweep has no range"; at here, "points need a range";
        help "write `vary gap in 5 .. 50 [um];`, or remove this";
    }
    fn ranges_without_plan(range: Span) = error BadSweep {
        "the ranges have no sampling plan"; at range, "how many points?";
        help "write `grid 10;`, `random 500;`, `latin 500;` or `sobol 512;`";
    }
    fn counts_of_grid(counts: usize, ranges: usize, here: Span) = error BadSweep {
        "{counts} counts for {ranges} ranges"; at here, "give one for all, or one for each";
    }
    fn long_sobol_sequence((points, ranges): (usize, usize), here: Span) = error BadSweep {
        "a Sobol sequence has at most {points} points of {ranges} ranges"; at here, "too many";
        help "write `latin` or `random` instead";
    }
    fn samples_structure(parameter: &str, range: Span) = error BadSweep {
        "`{parameter}` changes the structure of the equations: each value is compiled separately"; at range, "sampled";
        help "give it few values: `vary {parameter} = {{…, …}}`";
    }
    fn range_of_boolean(name: &str, range: Span) = error BadSweep {
        "`{name}` is a Boolean and has no range"; at range, "it is `true` or `false`";
        help "give it both values: `vary {name} = {{false, true}};`";
    }
    fn fractions_of_integer(name: &str, list: &str, range: Span) = error BadSweep {
        "`{name}` is an Integer, and not all points of its range are whole numbers"; at range, "fractions would be run";
        help "write whole numbers, `vary {name} = {list};`, or a `grid` whose points are whole numbers";
    }
    fn missing_table(here: Span) = error BadSweep {
        "the table of cases is missing"; at here, "named here";
    }
    fn too_many_cases(sweep: Span) = error BadSweep {
        "this sweep has more than 1e9 cases"; at sweep, "lists and ranges multiply";
        help "sample the ranges together: `latin 1000;`";
    }
    fn per_label(here: Span) = error BadSweep {
        "a sweep has no `per`"; at here, "a sweep sets one value for a whole run";
        help "only a calibration has values per label: `vary saddle.M per load;`";
    }
    fn not_a_list(here: Span) = error BadSweep {
        "the alternatives are not a list"; at here, "one value is not a sweep";
        help "write them in braces: `{{…, …}}`";
    }
    fn varies_between_nothing(name: &str, here: Span) = error BadSweep {
        "`{name}` has neither a range nor a list of values"; at here, "between what?";
        help "write `in 5 .. 50 [um]` for a range, or `= {{5, 10, 20}} [um]` for these values";
    }
    fn not_a_model(here: Span) = error BadSweep {
        "this is not the name of a model"; at here, "a name is expected";
        help "give the variant a name, `model Worn = Axis(gap = 20 [um]);`, and write `vary model = {{Axis, Worn}};`";
    }
    fn not_a_file(here: Span) = error BadSweep {
        "this is not the name of a file"; at here, "a text is expected";
        help "write `vary record file = {{\"slow.csv\", \"fast.csv\"}};`";
    }
    fn not_a_number(here: Span) = error BadSweep {
        "this is not a number"; at here, "a number with its unit is expected";
        help "write `5 [um]`; for parameters that change together use a table: `cases \"cases.csv\";`";
    }
    fn bad_unit(why: &str, unit: Span) = error BadUnit {
        "{why}"; at unit, "cannot be read";
    }
    fn other_dimension(
        (name, why): (&str, &str), value: Span, (declared, unit): (Span, &str), repair: Option<String>,
    ) = error UnitMismatch {
        "`{name}` {why}"; at value, "does not fit"; at declared, "in {unit}";
        if let Some(repair) = repair { help "{repair}"; }
    }
    fn misfit(
        (name, why): (&str, &str), value: Span, (declared, unit): (Span, &str), repair: Option<String>,
    ) = error BadSweep {
        "`{name}` {why}"; at value, "does not fit"; at declared, "in {unit}";
        if let Some(repair) = repair { help "{repair}"; }
    }
}
