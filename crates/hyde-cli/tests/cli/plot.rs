//! `hyde plot`: every form of results, over time, over each other, and as a frequency response; what stands below.

use crate::command::{Folder, LAG, errors, hyde, read, status};

/// A relay that a sine drives, and a switch that never moves.
const RELAY: &str = r#"package relay "a relay with a gap, and a switch that stays";
import SI.*;

model Relay
  input Real u;
  Real x(start = 0, fixed = true);
  Real s, f;
  modes state initial off {
    mode off { s = -1; exit u > 0.5 -> on; }
    mode on { s = 1; exit u < -0.5 -> off; }
  }
  modes still initial rest {
    mode rest { f = 0; exit u > 7 -> moves; }
    mode moves { f = 1; exit u < 7 -> rest; }
  }
equation
  1 [s]*der(x) = s + f;
end Relay;

experiment sine of Relay
  stimulus u = sin(2*pi*time/1 [s]);
  stop 2 [s] every 10 [ms];
end sine;
"#;

/// The texts of a figure in the order in which they are drawn.
fn texts(svg: &str) -> Vec<String> {
    let inside = |part: &str| {
        let begin = part.find('>')? + 1;
        Some(part[begin..part.find("</text>")?].to_owned())
    };
    svg.split("<text").skip(1).filter_map(inside).collect()
}

/// Plots into a new SVG and gives its texts.
fn plotted(folder: &Folder, arguments: &[&str]) -> Vec<String> {
    let out = folder.path("figure.svg");
    let line = [&["plot"], arguments, &["--out", &out]].concat();
    let output = hyde(&line);
    assert_eq!(status(&output), 0, "{arguments:?}: {}", errors(&output));
    texts(&read(&out))
}

fn has(texts: &[String], word: &str) -> bool {
    texts.iter().any(|text| text == word)
}

#[test]
fn every_form_of_results_gives_the_same_figure() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let mut figures = Vec::new();
    for form in ["csv", "parquet", "json"] {
        let out = folder.path("out");
        let run = hyde(&["run", &model, "--quiet", "--out", &out, "--format", form]);
        assert_eq!(status(&run), 0, "{}", errors(&run));
        let svg = folder.path("figure.svg");
        let plot = hyde(&["plot", &out, "x,u", "x", "--from", "0.01", "--out", &svg]);
        assert_eq!(status(&plot), 0, "{}", errors(&plot));
        figures.push(read(&svg));
    }
    assert!(texts(&figures[0]).contains(&"time [ms]".to_owned()));
    assert_eq!(figures[0], figures[1]);
    assert_eq!(figures[0], figures[2]);
}

#[test]
fn modes_and_events_stand_below() {
    let folder = Folder::new();
    let model = folder.file("relay.hyde", RELAY);
    let out = folder.path("out");
    let run = hyde(&["run", &model, "--quiet", "--out", &out]);
    assert_eq!(status(&run), 0, "{}", errors(&run));
    let all = plotted(&folder, &[&out, "x"]);
    for word in ["state", "on", "off", "still", "rest"] {
        assert!(has(&all, word), "{word}: {all:?}");
    }
    // sin(2 pi t) passes 0.5 at 1/12 s and -0.5 at 7/12 s: between them the relay is on.
    let cut = plotted(&folder, &[&out, "x", "--from", "0.2", "--to", "0.5"]);
    assert!(has(&cut, "on") && !has(&cut, "off"), "{cut:?}");
    let named = plotted(&folder, &[&out, "x", "--modes", "still"]);
    assert!(has(&named, "rest") && !has(&named, "on"), "{named:?}");
    let output = hyde(&["plot", &out, "x", "--modes", "stil"]);
    assert_eq!(status(&output), 2);
    let told = errors(&output);
    assert!(told.contains("`state`, `still`"), "{told}");
}

#[test]
fn one_column_over_another_in_several_panels() {
    let folder = Folder::new();
    let rows = "t [s],x [mm],y [mm],F [N]\n0,0,0,1\n1,1,0.5,2\n2,2,2,3\n";
    let record = folder.file("record.csv", rows);
    let panels = ["x,y,y,x", "F,x"];
    let all = plotted(&folder, &[&record, panels[0], panels[1], "--xy"]);
    for word in ["x", "y", "F [N]", "x [mm]", "[mm]"] {
        assert!(has(&all, word), "{word}: {all:?}");
    }
    for (panel, word) in [("x", "write pairs"), ("x,y,F,y", "a separate panel")] {
        let output = hyde(&[
            "plot",
            &record,
            panel,
            "--xy",
            "--out",
            &folder.path("x.svg"),
        ]);
        assert_eq!(status(&output), 2);
        assert!(errors(&output).contains(word), "{}", errors(&output));
    }
}

#[test]
fn results_stand_beside_others() {
    let folder = Folder::new();
    let before = folder.file("before.csv", "t [s],x [mm]\n0,0\n1,1\n");
    let after = folder.file("after.csv", "t [s],x [mm],v [m/s]\n0,0,0\n1,2,1\n");
    let all = plotted(&folder, &[&before, "x", "v", "--with", &after]);
    for word in ["before", "after", "x [mm]", "v [m/s]"] {
        assert!(has(&all, word), "{word}: {all:?}");
    }
}

#[test]
fn a_response_is_drawn_as_one() {
    let folder = Folder::new();
    let mut rows = "kind,f [Hz],re,im,coherence\n".to_owned();
    for f in [1.0_f64, 10.0, 100.0] {
        // A lag of 1 s: 1/(1 + 2 pi i f), in rows of no order.
        let w = std::f64::consts::TAU * f;
        let (re, im) = (1.0 / (1.0 + w * w), -w / (1.0 + w * w));
        rows.push_str(&format!(
            "linearised,{f},{re},{im},1\nswept,{f},{re},{im},0.9\n"
        ));
    }
    let response = folder.file("bode-x.csv", &rows);
    let all = plotted(&folder, &[&response, "--title", "a lag"]);
    let words = [
        "a lag",
        "linearised",
        "swept",
        "|x| [dB]",
        "phase [°]",
        "frequency [Hz]",
    ];
    for word in words {
        assert!(has(&all, word), "{word}: {all:?}");
    }
    // From -16 dB to -56 dB in two decades.
    assert!(has(&all, "−20") && has(&all, "−40"), "{all:?}");
    let output = hyde(&["plot", &response, "re", "--out", &folder.path("x.svg")]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("always plotted completely"),
        "{}",
        errors(&output)
    );
}

#[test]
fn a_figure_has_the_size_asked_for() {
    let folder = Folder::new();
    let record = folder.file("record.csv", "t [s],x [mm]\n0,0\n1,1\n");
    let out = folder.path("x.png");
    let line = [
        "plot", &record, "x", "--width", "127", "--dpi", "200", "--out", &out,
    ];
    assert_eq!(status(&hyde(&line)), 0);
    let bytes = std::fs::read(&out).unwrap();
    // The width stands behind the signature and the head of the first chunk: 5 in of 200 pixels.
    assert_eq!(bytes[16..20], 1000_u32.to_be_bytes());
    let output = hyde(&["plot", &record, "x", "--dpi", "0", "--out", &out]);
    assert_eq!(status(&output), 2);
    let output = hyde(&["plot", &folder.path("."), "x"]);
    assert!(
        errors(&output).contains("record.csv"),
        "{}",
        errors(&output)
    );
}

/// A lag of three gains, or of twelve.
const GAINS: &str = r#"package gains;
import SI.*;

model Lag
  parameter Length k = 1 [mm];
  Length x(start = 0, fixed = true);
equation
  20 [ms]*der(x) = k - x;
end Lag;

experiment step of Lag
  measure Length peak = max(x);
  stop 0.2 [s] every 1 [ms];
end step;

sweep few of step
  vary k = {1, 2, 4} [mm];
  keep x;
end few;

sweep many of step
  vary k in 1 .. 4 [mm];
  grid 12;
  keep x;
end many;
"#;

#[test]
fn a_batch_is_drawn_by_case_as_envelope_and_as_points() {
    for form in ["parquet", "csv"] {
        let folder = Folder::new();
        let model = folder.file("gains.hyde", GAINS);
        let swept = |sweep: &str| {
            let out = folder.path(sweep);
            let line = [
                "sweep", &model, sweep, "--out", &out, "--quiet", "--format", form,
            ];
            assert_eq!(status(&hyde(&line)), 0);
            out
        };
        let (few, many) = (swept("few"), swept("many"));
        // A few are lines, on the time of a case and not of the table.
        let lines = plotted(&folder, &[&few, "x"]);
        for word in ["case 1", "case 3", "time [ms]", "x [mm]", "200"] {
            assert!(has(&lines, word), "{word}: {lines:?}");
        }
        let lines = plotted(&folder, &[&many, "x", "--cases", "12,5"]);
        assert!(has(&lines, "case 12") && has(&lines, "case 5") && !has(&lines, "case 1"));
        let all = plotted(&folder, &[&many]);
        assert!(has(&all, "x [mm]") && !has(&all, "case 1"), "{all:?}");
        // The measure over its input: each case a point of its own, no lines between.
        let points = plotted(&folder, &[&many, "--xy", "peak,k"]);
        assert!(
            has(&points, "peak [mm]") && has(&points, "k [mm]"),
            "{points:?}"
        );
        for (line, word) in [
            (vec!["plot", &many, "x,x"], "`--cases 3,7` plots lines"),
            (
                vec!["plot", &many, "x", "--cases", "13"],
                "no rows of case 13",
            ),
            (
                vec!["plot", &many, "--xy", "peak,q"],
                "no column is called `q`",
            ),
        ] {
            let out = folder.path("x.svg");
            let output = hyde(&[&line[..], &["--out", &out]].concat());
            assert_eq!(status(&output), 2);
            assert!(errors(&output).contains(word), "{}", errors(&output));
        }
    }
}
