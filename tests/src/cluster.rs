//! [`Cluster`]: a Slurm of two nodes on this host, private to a folder, for as long as it is held.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A running Slurm. Its daemons end with it.
pub(crate) struct Cluster {
    folder: PathBuf,
    daemons: Vec<Child>,
}

impl Cluster {
    /// Starts one in a folder; `None` where Slurm is not installed.
    ///
    /// # Errors
    /// It is installed and does not come up.
    #[allow(clippy::disallowed_methods, reason = "a cluster is set up")]
    pub(crate) fn start(folder: &Path) -> Result<Option<Self>, String> {
        let program = |name: &str| {
            let folders = [
                "/usr/sbin",
                "/usr/bin",
                "/usr/local/sbin",
                "/usr/local/bin",
                "/opt/slurm/sbin",
            ];
            folders
                .iter()
                .map(|folder| Path::new(folder).join(name))
                .find(|path| path.is_file())
        };
        let (Some(controller), Some(node)) = (program("slurmctld"), program("slurmd")) else {
            return Ok(None);
        };
        let word = |command: &str, arguments: &[&str]| {
            let output = Command::new(command)
                .args(arguments)
                .output()
                .map_err(|error| error.to_string())?;
            Ok::<_, String>(String::from_utf8_lossy(&output.stdout).trim().to_owned())
        };
        let (host, user) = (word("hostname", &["-s"])?, word("id", &["-un"])?);
        for below in ["state", "spool/n1", "spool/n2", "log"] {
            std::fs::create_dir_all(folder.join(below)).map_err(|error| error.to_string())?;
        }
        std::fs::write(
            folder.join("slurm.conf"),
            configuration(folder, &host, &user),
        )
        .map_err(|error| error.to_string())?;
        let mut cluster = Self {
            folder: folder.to_path_buf(),
            daemons: Vec::new(),
        };
        // In the foreground, so that they are children of this process and nobody else's.
        cluster.daemon(&controller, &["-D", "-c"])?;
        cluster.daemon(&node, &["-D", "-N", "n1"])?;
        cluster.daemon(&node, &["-D", "-N", "n2"])?;
        for _ in 0..300 {
            std::thread::sleep(Duration::from_millis(200));
            let mut asked = Command::new("sinfo");
            let told = cluster
                .of(&mut asked)
                .args(["-h", "-t", "idle", "-o", "%D"])
                .output();
            if told.is_ok_and(|told| String::from_utf8_lossy(&told.stdout).trim() == "2") {
                return Ok(Some(cluster));
            }
        }
        let log = std::fs::read_to_string(folder.join("log/slurmctld.log")).unwrap_or_default();
        Err(format!("Slurm did not come up: {log}"))
    }

    /// A command that talks to this Slurm.
    pub(crate) fn of<'c>(&self, command: &'c mut Command) -> &'c mut Command {
        command.env("SLURM_CONF", self.folder.join("slurm.conf"))
    }

    fn daemon(&mut self, program: &Path, arguments: &[&str]) -> Result<(), String> {
        let mut command = Command::new(program);
        command
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        let child = self
            .of(&mut command)
            .spawn()
            .map_err(|error| error.to_string())?;
        self.daemons.push(child);
        Ok(())
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        for daemon in &mut self.daemons {
            drop(daemon.kill());
            drop(daemon.wait());
        }
    }
}

/// One controller and two nodes with two processors each, without accounts, credentials or containers. Ports by the process,
/// so that two of them do not meet.
fn configuration(folder: &Path, host: &str, user: &str) -> String {
    let folder = folder.display();
    let port = 20_000 + std::process::id() % 10_000 * 3;
    let (one, two) = (port + 1, port + 2);
    let mut text = format!(
        "ClusterName=hyde\nSlurmctldHost={host}(127.0.0.1)\nSlurmctldPort={port}\nSlurmUser={user}\nSlurmdUser={user}\n"
    );
    let _ = write!(
        text,
        "AuthType=auth/none\nCredType=cred/none\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n\
         JobAcctGatherType=jobacct_gather/linux\nSelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\n\
         SchedulerType=sched/backfill\nSchedulerParameters=sched_interval=1,sched_min_interval=1000,bf_interval=1\n\
         ReturnToService=2\nMpiDefault=none\nSwitchType=switch/none\nSlurmdTimeout=30\nKillWait=2\nMinJobAge=300\n\
         SlurmdParameters=config_overrides\nJobCompType=jobcomp/none\nAccountingStorageType=accounting_storage/none\n\
         StateSaveLocation={folder}/state\nSlurmdSpoolDir={folder}/spool/%n\nSlurmctldPidFile={folder}/slurmctld.pid\n\
         SlurmdPidFile={folder}/slurmd.%n.pid\nSlurmctldLogFile={folder}/log/slurmctld.log\n\
         SlurmdLogFile={folder}/log/slurmd.%n.log\n\
         NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={one} CPUs=2 RealMemory=1000\n\
         NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={two} CPUs=2 RealMemory=1000\n\
         PartitionName=main Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP\n"
    );
    text
}
