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
    let table = hyde_signal::parquet::read(&bytes, None).unwrap();
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

/// What reads a file in Python: the package, and a program that prints the rows and the sum of `x` of the file named.
const READERS: [(&str, &str); 3] = [
    (
        "pandas",
        "import pandas, pyarrow.parquet as q, sys; f = pandas.read_parquet(sys.argv[1]); \
         u = q.read_schema(sys.argv[1]).metadata[b'unit:x']; print(len(f), repr(float(f['x'].sum())), u.decode())",
    ),
    (
        "polars",
        "import polars, sys; f = polars.read_parquet(sys.argv[1]); \
         u = polars.read_parquet_metadata(sys.argv[1])['unit:x']; print(len(f), repr(f['x'].sum()), u)",
    ),
    (
        "duckdb",
        "import duckdb, sys; p = sys.argv[1]; n, s = duckdb.sql(f\"select count(*), sum(x) from '{p}'\").fetchall()[0]; \
         u = dict(duckdb.sql(f\"select key, value from parquet_kv_metadata('{p}')\").fetchall())[b'unit:x']; \
         print(n, repr(s), u.decode())",
    ),
];

#[test]
fn pandas_polars_and_duckdb_read_results() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let out = folder.path("out");
    let line = ["run", &model, "--out", &out, "--format", "parquet"];
    assert_eq!(status(&hyde(&line)), 0);
    let path = format!("{out}/results.parquet");
    let table = hyde_signal::parquet::read(&std::fs::read(&path).unwrap(), None).unwrap();
    let sum: f64 = table.column("x").unwrap().values().iter().sum();
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
            .args(["-c", program, &path])
            .output()
            .unwrap();
        let printed = String::from_utf8(output.stdout).unwrap();
        let words: Vec<&str> = printed.split_whitespace().collect();
        let [rows, total, unit] = words[..] else {
            panic!(
                "{package}: {printed} {}",
                String::from_utf8_lossy(&output.stderr)
            );
        };
        assert_eq!((rows, unit), ("51", "1"), "{package}");
        // Sums in another order: 51 values of at most 1, an ulp each.
        let total: f64 = total.parse().unwrap();
        assert!(
            (total - sum).abs() < 51.0 * f64::EPSILON * sum,
            "{package}: {total} for {sum}"
        );
    }
}
