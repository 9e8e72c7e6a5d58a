//! What the arguments of `hyde sweep` ask for: the order, a sweep that the file does not have, and the arguments again, for the
//! commands that rerun cases.

use crate::args::SweepArgs;
use crate::files;
use hyde_present::lines::shell_word as word;
use hyde_study::Inputs;
use hyde_study::sweep::Order;
use hyde_study::world::Disk;

/// The order of a batch, from its folder or from the arguments, with the files that it reads.
pub(crate) fn order_of(args: &SweepArgs, kept: bool) -> Result<(Order, Inputs), String> {
    let file = args.file.display();
    if files::is_folder(&args.file) && !kept {
        return Err(format!("the folder `{file}` contains no batch"));
    }
    if !kept {
        return Ok((ordered(args), Inputs::recording_with(written(args))));
    }
    if args.sweep.is_some() || !asked_for_nothing(args) {
        return Err(format!(
            "`{file}` is the folder of a batch, which defines the sweep: leave out the sweep, `--of`, `--set`, `--record`, `--data`, `--seed` and `--keep`"
        ));
    }
    Order::read(&Disk, &args.file)
}

/// Whether the arguments say nothing of what the batch is, as of a folder that knows it.
fn asked_for_nothing(args: &SweepArgs) -> bool {
    let none = args.settings.is_empty() && args.records.is_empty() && args.keep.is_empty();
    none && args.data.is_none() && args.seed.is_none() && args.of.is_none()
}

/// The order that the arguments give.
fn ordered(args: &SweepArgs) -> Order {
    Order {
        file: args.file.clone(),
        sweep: match &args.of {
            Some(_) => ASKED.to_owned(),
            None => args.sweep.clone().unwrap_or_default(),
        },
        settings: args.settings.clone(),
        records: args.records.clone(),
        data: args.data.clone(),
        seed: args.seed,
        keep: args.keep.clone(),
    }
}

/// The name of a sweep that was given in arguments.
const ASKED: &str = "asked";

/// A sweep that was given in arguments, as it would be written below the model.
fn written(args: &SweepArgs) -> String {
    let Some(experiment) = &args.of else {
        return String::new();
    };
    let mut text = format!("\nsweep {ASKED} of {experiment}\n");
    for vary in &args.vary {
        text.push_str(&format!("  vary {vary};\n"));
    }
    if let Some(cases) = &args.cases {
        text.push_str(&format!("  cases \"{cases}\";\n"));
    }
    if let Some(points) = &args.points {
        text.push_str(&format!("  {points};\n"));
    }
    text.push_str(&format!("end {ASKED};\n"));
    text
}

/// The command that makes the same plan from the model's file.
pub(crate) fn from_source(args: &SweepArgs, order: &Order) -> String {
    let mut line = format!("hyde sweep {}", word(&order.file.to_string_lossy()));
    if args.of.is_none() {
        line.push_str(&format!(" {}", order.sweep));
    }
    for (option, value) in [
        ("--of", &args.of),
        ("--cases", &args.cases),
        ("--points", &args.points),
    ] {
        if let Some(value) = value {
            line.push_str(&format!(" {option} {}", word(value)));
        }
    }
    let lists = [
        ("--vary", &args.vary),
        ("--set", &order.settings),
        ("--record", &order.records),
    ];
    for (option, values) in lists {
        for value in values {
            line.push_str(&format!(" {option} {}", word(value)));
        }
    }
    if let Some(data) = &order.data {
        line.push_str(&format!(" --data {}", word(&data.to_string_lossy())));
    }
    if let Some(seed) = order.seed {
        line.push_str(&format!(" --seed {seed}"));
    }
    if args.fmus.sandbox {
        line.push_str(" --sandbox");
    }
    line.trim_end().to_owned()
}
