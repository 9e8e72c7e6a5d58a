//! A batch on a cluster is the batch of one process.

use hyde_tests::batches::Batch;
use std::path::Path;

#[test]
fn slurm_gives_the_bytes_of_one_process_though_a_task_is_killed() {
    let hyde = Path::new(env!("CARGO_BIN_EXE_hyde-tested"));
    let batch = Batch::backlash(hyde, 240, 10.0).unwrap();
    batch.run("whole", &[]).unwrap();
    match batch.on_slurm(&batch.dataset("whole").unwrap()).unwrap() {
        Some(equal) => assert!(equal),
        // The shards themselves are tested without a scheduler, in the tests of the command line.
        None => println!(
            "not tested: there is no slurmctld here; apt-get install slurmctld slurmd slurm-client"
        ),
    }
}
