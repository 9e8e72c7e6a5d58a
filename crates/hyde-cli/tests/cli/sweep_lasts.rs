//! A batch is the same however it comes about: in shards, by processes that are killed, on disks that are full.

use crate::command::{Folder, command, errors, hyde, read, status, text};
use crate::sweep::with;
use serde_json::Value;
use std::process::{Command, Stdio};
use std::time::Duration;

/// A batch of many short cases, and the bytes of its data set as one process makes it.
fn many(folder: &Folder, count: usize) -> (String, Vec<u8>) {
    let body = format!(
        "vary m in 0.5 .. 5 [kg], d in 0 .. 10 [N.s/m], stimulus u = {{1 [N], 6 [N]}}; latin {};",
        count / 2
    );
    let model = folder.file("swing.hyde", &with(&body));
    let whole = folder.path("whole");
    assert_eq!(
        status(&hyde(&[
            "sweep", &model, "s", "--out", &whole, "--quiet", "--jobs", "1"
        ])),
        0
    );
    (
        model,
        std::fs::read(format!("{whole}/cases.parquet")).unwrap(),
    )
}

#[test]
fn shards_jobs_and_repetitions_make_the_same_bytes() {
    let folder = Folder::new();
    let (model, whole) = many(&folder, 300);
    let out = folder.path("out");
    let bytes = || std::fs::read(format!("{out}/cases.parquet")).unwrap();
    // The folder with nothing solved: told what is missing.
    let missing = || text(&hyde(&["sweep", &out, "--missing", "7"]));
    let made = hyde(&["sweep", &model, "s", "--out", &out, "--shard", "3/7"]);
    assert_eq!(status(&made), 0, "{}", errors(&made));
    assert_eq!(missing().trim(), "1-2,4-7");
    let children: Vec<_> = [1, 2, 4, 5, 6]
        .into_iter()
        .map(|shard: i32| {
            let mut child = command(&["sweep", &out, "--shard", "auto/7"]);
            // As each of four schedulers numbers its tasks.
            let name = [
                "SLURM_ARRAY_TASK_ID",
                "PBS_ARRAY_INDEX",
                "LSB_JOBINDEX",
                "SGE_TASK_ID",
            ][shard as usize % 4];
            child.env(name, shard.to_string()).spawn().unwrap()
        })
        .collect();
    for mut child in children {
        assert!(child.wait().unwrap().success());
    }
    assert_eq!(missing().trim(), "7");
    let journals = folder.names("out/journal").len();
    let last = hyde(&["sweep", &out, "--json", "--jobs", "2"]);
    assert_eq!(status(&last), 0);
    // Of 300 cases the seventh shard has 43.
    let summary: Value = serde_json::from_str(text(&last).lines().last().unwrap()).unwrap();
    assert_eq!(
        (&summary["solved"], &summary["cases"]),
        (&Value::from(43), &Value::from(300))
    );
    assert_eq!(bytes(), whole);
    assert_eq!(folder.names("out/journal").len(), journals + 1);
    // Nothing is left to do.
    let again = hyde(&["sweep", &model, "s", "--out", &out, "--json"]);
    let summary: Value = serde_json::from_str(text(&again).lines().last().unwrap()).unwrap();
    assert_eq!(summary["solved"], 0);
    assert_eq!(bytes(), whole);
}

#[test]
fn a_process_that_is_killed_loses_no_finished_case() {
    let folder = Folder::new();
    let (model, whole) = many(&folder, 600);
    let out = folder.path("out");
    let line = ["sweep", &model, "s", "--out", &out, "--quiet"];
    for round in 1..=6 {
        let mut child = command(&line).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(60 * round));
        let before = child.try_wait().unwrap();
        child.kill().unwrap();
        child.wait().unwrap();
        if before.is_some() {
            break;
        }
    }
    // Killed while it wrote an input, it has left a part of that.
    let unfinished = folder.file("out/inputs/.hyde-Xy12ab", "half");
    assert_eq!(status(&hyde(&line)), 0);
    assert!(!std::path::Path::new(&unfinished).exists());
    assert_eq!(
        std::fs::read(format!("{out}/cases.parquet")).unwrap(),
        whole
    );
}

#[test]
fn one_process_at_a_time_and_one_batch_a_folder() {
    let folder = Folder::new();
    let (model, _) = many(&folder, 4000);
    let out = folder.path("out");
    let line = ["sweep", &model, "s", "--out", &out, "--quiet"];
    let mut first = command(&line).spawn().unwrap();
    while !std::path::Path::new(&format!("{out}/journal")).exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    let second = hyde(&line);
    assert_eq!(status(&second), 2);
    assert!(
        errors(&second).contains("another process is working"),
        "{}",
        errors(&second)
    );
    assert!(first.wait().unwrap().success());
    assert_eq!(status(&hyde(&line)), 0);

    let other = folder.file(
        "swing.hyde",
        &read(&model).replace("d = 2 [N.s/m]", "d = 3 [N.s/m]"),
    );
    let refused = hyde(&["sweep", &other, "s", "--out", &out]);
    assert_eq!(status(&refused), 2);
    assert!(
        errors(&refused).contains("contains another batch: it differs in the model"),
        "{}",
        errors(&refused)
    );
    let refused = hyde(&["sweep", &out, "--seed", "3"]);
    assert!(
        errors(&refused).contains("is the folder of a batch"),
        "{}",
        errors(&refused)
    );
}

#[test]
fn a_disk_that_takes_no_more_is_told_and_what_is_there_stays() {
    let folder = Folder::new();
    let (model, whole) = many(&folder, 300);
    let out = folder.path("out");
    // No file may have more than 16 blocks of 512 or 1024 bytes; without the signal that goes with it.
    let limited = format!(
        "trap '' XFSZ; ulimit -f 16; exec {} sweep {model} s --out {out} --quiet",
        env!("CARGO_BIN_EXE_hyde")
    );
    let output = Command::new("sh").args(["-c", &limited]).output().unwrap();
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("cannot write") && errors(&output).contains(".journal"),
        "{}",
        errors(&output)
    );
    let output = hyde(&["sweep", &out, "--json"]);
    let summary: Value = serde_json::from_str(text(&output).lines().last().unwrap()).unwrap();
    let solved = summary["solved"].as_u64().unwrap();
    // Some were kept before the journal was full, and are not solved again.
    assert!((1..300).contains(&solved), "{solved}");
    assert_eq!(
        std::fs::read(format!("{out}/cases.parquet")).unwrap(),
        whole
    );

    // A folder where nothing can be written.
    let taken = folder.file("taken", "");
    let output = hyde(&["sweep", &model, "s", "--out", &format!("{taken}/out")]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("cannot make the folder"),
        "{}",
        errors(&output)
    );
}

#[test]
fn a_full_disk_and_a_read_only_one_are_told_and_leave_what_is_there() {
    let folder = Folder::new();
    let (model, whole) = many(&folder, 300);
    let hyde_there = env!("CARGO_BIN_EXE_hyde");
    let disk = folder.path("disk");
    std::fs::create_dir(&disk).unwrap();
    let saved = folder.path("saved");
    // A disk of 32 kB in a name space of its own: the batch fills it, is copied off, and meets it read-only.
    let script = format!(
        "mount -t tmpfs -o size=32k hyde {disk} || exit 77
         {hyde_there} sweep {model} s --out {disk}/out --quiet; echo full $? >&2
         cp -r {disk}/out {saved}
         mount -o remount,ro {disk} || exit 77
         {hyde_there} sweep {disk}/out --quiet; echo read-only $? >&2
         {hyde_there} sweep {model} s --out {disk}/other --quiet; echo new $? >&2"
    );
    let output = Command::new("unshare")
        .args(["-rm", "sh", "-c", &script])
        .output();
    let told = match &output {
        Ok(output) if status(output) == 0 => errors(output),
        Ok(_) | Err(_) => {
            println!("not tested: here nobody may mount a disk of his own");
            return;
        }
    };
    for word in [
        "the disk is full",
        "full 2",
        "the disk is read-only",
        "read-only 2",
        "new 2",
    ] {
        assert!(told.contains(word), "{word}: {told}");
    }
    // What was kept before the disk was full is whole.
    let output = hyde(&["sweep", &saved, "--json"]);
    let summary: Value = serde_json::from_str(text(&output).lines().last().unwrap()).unwrap();
    let solved = summary["solved"].as_u64().unwrap();
    assert!((1..300).contains(&solved), "{solved}");
    assert_eq!(
        std::fs::read(format!("{saved}/cases.parquet")).unwrap(),
        whole
    );
}
