//! Parquet: the same numbers as CSV, for our reader and for everybody's.

use crate::command::{Folder, LAG, hyde, read, rows, status};
use std::process::Command;

#[test]
fn results_hold_the_numbers_of_the_csv_with_their_units() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let out = folder.path("out");
    let run = |form: &str| hyde(&["run", &model, "--out", &out, "--format", form]);
    assert_eq!(status(&run("csv")), 0);
    let csv = rows(&read(&format!("{out}/results.csv")));
    assert_eq!(status(&run("parquet")), 0);
    // The results of one run only.
    assert_eq!(
        folder.names("out"),
        [
            "events.csv",
            "report.html",
            "results.parquet",
            "summary.json"
        ]
    );
    let bytes = std::fs::read(format!("{out}/results.parquet")).unwrap();
    let table = hyde_signal::parquet::read(&bytes, &hyde_signal::Layout::default()).unwrap();
    assert_eq!(table.columns()[0].unit().unwrap().text(), "s");
    for (at, column) in table.columns().iter().enumerate() {
        let expected: Vec<f64> = csv.iter().map(|row| row[at]).collect();
        assert_eq!(column.in_unit(), expected, "{}", column.name());
    }

    // A result stands in for a record, and is plotted.
    let replayed = LAG
        .replace(
            "step of Lag",
            "step(record file = \"out/results.parquet\") of Lag",
        )
        .replace("stimulus u = 1", "stimulus u = file.u");
    let again = folder.file("again.hyde", &replayed);
    assert_eq!(status(&hyde(&["run", &again, "--quiet"])), 0);
    let figure = folder.path("x.svg");
    assert_eq!(status(&hyde(&["plot", &out, "x", "--out", &figure])), 0);
    assert!(read(&figure).contains("<svg"));
}

/// What reads a file in Python: the package, and a program that prints of the file named first the rows, the sum of the
/// column named second, its unit, and how many rows have no value there.
const READERS: [(&str, &str); 3] = [
    (
        "pandas",
        "import pandas, pyarrow.parquet as q, sys; p, c = sys.argv[1:]; f = pandas.read_parquet(p); \
         u = q.read_schema(p).metadata[b'unit:' + c.encode()].decode(); \
         print(len(f), repr(float(f[c].sum())), u, int(f[c].isna().sum()))",
    ),
    (
        "polars",
        "import polars, sys; p, c = sys.argv[1:]; f = polars.read_parquet(p); \
         u = polars.read_parquet_metadata(p)['unit:' + c]; print(len(f), repr(f[c].sum()), u, f[c].null_count())",
    ),
    (
        "duckdb",
        "import duckdb, sys; p, c = sys.argv[1:]; \
         n, s, k = duckdb.sql(f\"select count(*), sum({c}), count({c}) from '{p}'\").fetchall()[0]; \
         m = duckdb.sql(f\"select key, value from parquet_kv_metadata('{p}')\").fetchall(); \
         print(n, repr(s), dict(m)[b'unit:' + c.encode()].decode(), n - k)",
    ),
];

/// Has every reader read a column: its rows, the sum of it, its unit, and how many have no value.
#[allow(clippy::print_stdout, reason = "a test tells what it leaves out")]
fn read_by_others(path: &str, column: &str, expected: (usize, f64, &str, usize)) {
    // A set-up without them says so below; the readers of this project are tested all the same.
    let python = option_env!("HYDE_TEST_PYTHON").unwrap_or("python3");
    for (package, program) in READERS {
        let there = Command::new(python)
            .args(["-c", &format!("import {package}")])
            .output();
        if !there.is_ok_and(|output| output.status.success()) {
            println!("not tested: {python} has no {package}");
            continue;
        }
        let output = Command::new(python)
            .args(["-c", program, path, column])
            .output()
            .unwrap();
        let printed = String::from_utf8(output.stdout).unwrap();
        let words: Vec<&str> = printed.split_whitespace().collect();
        let [rows, total, unit, without] = words[..] else {
            panic!(
                "{package}: {printed} {}",
                String::from_utf8_lossy(&output.stderr)
            );
        };
        let found = (rows.parse().unwrap(), unit, without.parse().unwrap());
        assert_eq!(found, (expected.0, expected.2, expected.3), "{package}");
        // Sums in another order: an ulp a value.
        let (total, sum): (f64, f64) = (total.parse().unwrap(), expected.1);
        assert!(
            (total - sum).abs() <= expected.0 as f64 * f64::EPSILON * sum,
            "{package}: {total} for {sum}"
        );
    }
}

#[test]
fn pandas_polars_and_duckdb_read_results() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let out = folder.path("out");
    let line = ["run", &model, "--out", &out, "--format", "parquet"];
    assert_eq!(status(&hyde(&line)), 0);
    let path = format!("{out}/results.parquet");
    let table = hyde_signal::parquet::read(
        &std::fs::read(&path).unwrap(),
        &hyde_signal::Layout::default(),
    )
    .unwrap();
    let sum: f64 = table.column("x").unwrap().values().iter().sum();
    read_by_others(&path, "x", (51, sum, "1", 0));
}

/// A spring that yields beyond 3 mm.
const YIELDS: &str = r#"package yields;
import SI.*;

model Pressed
  parameter Force F = 1 [N];
  Length x(start = 0, fixed = true);
equation
  1 [ms]*der(x) = F/1000 [N/m] - x;
  assert(x < 3 [mm], "it yields");
end Pressed;

experiment press of Pressed
  measure Length peak = max(x);
  stop 20 [ms] every 1 [ms];
end press;

sweep forces of press
  vary F in 1 .. 4 [N];
  grid 7;
  keep x;
end forces;
"#;

#[test]
fn pandas_polars_and_duckdb_read_a_batch_with_failed_cases() {
    let folder = Folder::new();
    let model = folder.file("yields.hyde", YIELDS);
    let out = folder.path("out");
    assert_eq!(
        status(&hyde(&["sweep", &model, "--out", &out, "--quiet"])),
        0
    );
    let read = |name: &str| {
        let bytes = std::fs::read(format!("{out}/{name}.parquet")).unwrap();
        hyde_signal::parquet::read_frame(&bytes).unwrap()
    };
    // 3.5 and 4 N press it beyond 3 mm, 3 N not quite.
    let peak = read("cases").numbers("peak").unwrap().to_vec();
    let sum = peak.iter().filter(|value| !value.is_nan()).sum();
    let cases = format!("{out}/cases.parquet");
    read_by_others(&cases, "peak", (7, sum, "m", 2));
    let frame = read("trajectories");
    let sum = frame.numbers("x").unwrap().iter().sum();
    let trajectories = format!("{out}/trajectories.parquet");
    read_by_others(&trajectories, "x", (5 * 21, sum, "m", 0));
}
