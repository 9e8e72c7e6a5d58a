//! Parsing and printing: round trips, several errors in one file, and limits.

use hyde_diag::{Diagnostics, Sources};

fn parse(text: &str) -> (hyde_syntax::ast::File, Vec<String>) {
    let mut sources = Sources::new();
    let file = sources.add("test.hyde", text);
    let mut diagnostics = Diagnostics::new();
    let tree = hyde_syntax::parse(&sources, file, &mut diagnostics);
    let messages = diagnostics
        .iter()
        .map(|d| {
            let place = d
                .labels
                .first()
                .map_or(String::new(), |label| sources.place(label.span));
            format!("{} {place}: {}", d.code, d.message)
        })
        .collect();
    (tree, messages)
}

/// Every construct of the language, as the design writes it.
const EVERYTHING: &str = r#"
package demo "everything";
import SI.*;
type Lead = Real [m/rad] "advance an angle";
connector Flange "shaft end" Angle phi; flow Torque tau; end Flange;
model Base
  parameter Real k[3] = {1, 2, 3} [mm] "stiffness";
  Mass m[4](each M = 2 [kg]);
end Base;
model Guide extends Base(k = {1, 2, 3} [mm]);
  Rail a "left", b; parameter Force F = 260 [N] ~ ±8% from "SOURCE.md"; final parameter Real Ip = pi*d^4/32;
  input Real u(start = 0); output Real y; site Force grip = F; replaceable Contact contact(k = 1.6e8 [N/m], e = x - b.s);
  domain bar(x in 0 .. len);
  field Angle th(start = 0, fixed = true) on bar;
  field AngularVelocity w on bar = der(th);
  measure Length peak = max(abs(a.s)) "largest";
  modes initial stuck {
    mode stuck { v = 0; exit a.f > grip -> slip(+1); exit a.f < -grip -> slip(-1); }
    mode slip(Real s) { a.f = s*grip + b*v; exit s*v < 0 -> stuck impact; exit x > 1 -> slip(-s) { reinit(v, -e*v); }; }
  }
  clocked cnc(1 [ms], delay = 0.2 [ms])
    site Angle count = floor_to(sample(phi), 1e-4 [rev]);
    Controller control(r = sample(r), e = count);
  end cnc;
initial equation
  der(x) = 0;
equation
  connect(a, b, c[2].a);
  rho*Ip*der(w) = pder(q, x) indomain bar load(xn, -partial(advance, thn)*contact.F);
  th = a.phi indomain bar.left;
  for i in 1:n loop m[i].f = k[i]*(m[i + 1].s - m[i].s); end for;
  if gain > 0 then y = gain*u; elseif gain < -1 then y = 0; else y = u; end if;
  when x > 1 [mm] then reinit(v, -0.8*v); elsewhen time > 3 then n = pre(n) + 1; end when;
  assert(x < len, "the nut leaves the screw");
  y = if a > b and not (c or d) then 2^-3 else -(a - (b - c))/(d*e)^2;
  discretize bar by fem(n = 24);
end Guide;
effect Stribeck on Guide
  size Force dF = 0 in 0 .. 1 [kN]; shape Velocity vs = 5 [mm/s] in 0.1 .. 50 [mm/s];
  wrap grip by grip + dF*exp(-(v/vs)^2);
  add a.tau = 3; a.f = m*der(vz);
  replace contact by GapContact(gap = gap);
  signature velocity, angle(N); confounds LuGre, SqrtDrag;
end Stribeck;
model With = Guide(F = 2 [N]) with Stribeck(dF = 150 [N]) on guide, Cogging on motor.shaft, nut.a;
experiment bench(record file every 1 [ms] = "records/strokes.csv") of Guide(F = 3 [N]) "a test"
  stimulus r = file.r, r_next = file.r.next;
  measured file.i = motor.i ~ 0.02 [A], lowpass(file.x, 100 [Hz]) = round_to(s, 1 [um]);
  replay motor.i_ref = file.i_ref;
  expect max(abs(v)) < 1 [m/s] "slow";
  measure Length worst = max(abs(file.x - s));
  bode from u to motor.w, der(v) over 1 .. 50 [Hz] in guide = slip, nut.contact = positive;
  figure lag = r - s, {guide.a.f, screw.F} over time in 0.8 [s] .. 1 [s] "the reversal";
  figure contour = circle(x, y - 25 [mm], 25 [mm]);
  budget backlash(gap = 0) "no play", belt(belt(k = 1e9 [N/m]), redeclare Rigid nut), bed(each k = 1);
  solve ida(rtol = 1e-6) stop file.end every 1 [ms] skip 50 [ms];
end bench;
calibrate bench of Guide fit bench("fit-*.csv"); holdout bench("validate-*.csv"); vary uncertain; end bench;
diagnose bench of calibrate bench candidates Effects.*, demo.*; max_effects 3; seed 1; end bench;
sweep masses of bench vary F in 200 .. 400 [N], m = {1, 2}; count 100; end masses;
"#;

#[test]
fn everything_parses_and_the_printed_form_is_a_fixed_point() {
    let (tree, messages) = parse(EVERYTHING);
    assert_eq!(messages, Vec::<String>::new());
    let once = hyde_syntax::format(&tree);
    let (again, messages) = parse(&once);
    assert_eq!(messages, Vec::<String>::new(), "{once}");
    assert_eq!(once, hyde_syntax::format(&again));
    insta::assert_snapshot!(once);
}

#[test]
fn one_error_does_not_hide_the_next() {
    let (tree, messages) = parse(
        "model A\n  Real x\n  Real y;\n  parameter = 3;\nequation\n  x := 1;\n  for i in 1:3 loop y = ; end for;\n  y = 2;\n\
         end A;\nmodel B Real z; equation z = (1; end C;\nexperiment e of A stop 3; foo 1; end e;\nmodel\nmodel D end D;\n",
    );
    insta::assert_snapshot!(messages.join("\n"));
    assert_eq!(tree.items.len(), 4, "A, B, e and D are still there");
}

#[test]
fn deep_nesting_is_an_error_and_not_a_crash() {
    let deep = format!(
        "model A Real x; equation x = {}1{}; x = 2; end A;",
        "(".repeat(100_000),
        ")".repeat(100_000)
    );
    let (tree, messages) = parse(&deep);
    assert_eq!(messages.len(), 1);
    assert!(messages[0].starts_with("E0103"));
    assert_eq!(tree.items.len(), 1);
    let long = format!(
        "model A Real x; equation x = 1{}; x = {}1; end A;",
        "+1".repeat(100_000),
        "-".repeat(100_000)
    );
    assert_eq!(parse(&long).1.len(), 2);
    let blocks = format!(
        "model A Real x; equation {} x = 1; {} end A;",
        "for i in 1:2 loop ".repeat(5000),
        "end for; ".repeat(5000)
    );
    assert!(!parse(&blocks).1.is_empty());
    assert!(
        parse(&blocks)
            .1
            .iter()
            .all(|message| message.starts_with("E01"))
    );
}

#[test]
fn garbage_never_panics() {
    for text in [
        "",
        "model",
        "end;",
        "\"",
        "/*",
        "model A \u{1F600} end A;",
        "experiment",
        "}}}}",
        "model A modes initial x {",
        "type",
        "[[[",
    ] {
        let _ = parse(text);
    }
}
