//! What `hyde export modelica` writes.

use crate::command::{Folder, errors, hyde, read, status};

fn exported(model: &str, experiment: &str) -> String {
    let folder = Folder::new();
    let model = folder.file("m.hyde", model);
    let out = folder.path("m.mo");
    let output = hyde(&["export", "modelica", &model, experiment, "--out", &out]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    read(&out)
}

const CLOCKS: &str = "package m;
import SI.*;

model M
  parameter Time late = 20 [ms];
  Real y = hold(c.n);
  Real z = hold(d.n);
  Real s(start = 0, fixed = true);
  clocked c(10 [ms], delay = 25 [ms])
    Real n(start = 0) = pre(n) + 1;
  end c;
  clocked d(10 [ms], delay = late)
    Real n(start = 0) = pre(n) + 1;
  end d;
equation
  der(s) = 1 [1/s];
end M;

experiment e of M
  expect abs(last(y) - 8) < 0.5 and abs(last(z) - 9) < 0.5;
  stop 0.101 [s];
end e;
";

#[test]
fn a_held_value_is_that_of_the_tick_before_its_delay() {
    let class = exported(CLOCKS, "e");
    // At 25 ms three ticks have run; what the first one gave is held then.
    let line = "algorithm
  when sample(0.0 + 0.025, 0.01) then
    'hold(c.n)' := pre('c.n.2 ticks ago');
  end when;
";
    assert!(class.contains(line), "{class}");
    let moves = "  when sample(0.0, 0.01) then
    'c.n.2 ticks ago' := pre('c.n.1 ticks ago');
    'c.n.1 ticks ago' := pre('c.n');
    'c.n' := (pre('c.n') + 1.0);
";
    assert!(class.contains(moves), "{class}");
    // The tick at the instant of the change does not count.
    assert!(
        class.contains("'hold(d.n)' := pre('d.n.1 ticks ago');"),
        "{class}"
    );
    assert!(!class.contains("'d.n.2 ticks ago'"), "{class}");
    // Another delay of the parameter needs another class.
    assert!(class.contains("assert('late'/0.01 > "), "{class}");
    assert!(!class.contains("assert(0.025"), "{class}");
}

#[test]
fn a_parameter_whose_number_is_in_the_class_cannot_be_changed() {
    let model = "package m;
import SI.*;

model M
  parameter Time Td = 0.1 [s];
  parameter Real x1 = 2, k = 3;
  Real s(start = 0, fixed = true);
  Real d = delay(s, Td);
  Real tb = k*table(s, {0, x1, 10}, {0, 7, 20});
equation
  der(s) = 1 [1/s];
end M;

experiment e of M
  stop 1 [s];
end e;
";
    let class = exported(model, "e");
    for line in [
        "  final parameter Real 'Td'(unit = \"s\") = 0.1;",
        "  final parameter Real 'x1' = 2.0;",
        "  parameter Real 'k' = 3.0;",
    ] {
        assert!(class.contains(line), "`{line}` is missing:\n{class}");
    }
}
