//! Throwaway.
#![allow(clippy::all)]
use hyde_diag::*;
use std::collections::BTreeMap;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).unwrap();
    let mut sources = Sources::new();
    let mut d = Diagnostics::new();
    let file = hyde_compiler::load(&mut sources, &args[1], &text, &mut d);
    let exp = args.get(3).map(|s| s.as_str()).filter(|s| *s != "-");
    let mut records = BTreeMap::new();
    let u = |t: &str| hyde_units::NamedUnit::parse(t).ok();
    records.insert(
        "file".to_string(),
        hyde_compiler::Header {
            columns: vec![
                ("r".into(), u("m")),
                ("i_inj".into(), u("A")),
                ("i_ref".into(), u("A")),
                ("i".into(), u("A")),
                ("phi_m".into(), u("rad")),
                ("v_tacho".into(), u("V")),
                ("x".into(), u("m")),
            ],
        },
    );
    let settings = BTreeMap::new();
    let req = hyde_compiler::Request {
        sources: &sources,
        file: &file,
        model: &args[2],
        experiment: exp,
        settings: &settings,
        records: &records,
        free_inputs: false,
        backend: Default::default(),
    };
    if let Some(stage) = args.get(4) {
        let st = match stage.as_str() {
            "ast" => hyde_compiler::Stage::Ast,
            "flat" => hyde_compiler::Stage::Flat,
            "structure" => hyde_compiler::Stage::Structure,
            "dae" => hyde_compiler::Stage::Dae,
            "clif" => hyde_compiler::Stage::Clif,
            _ => hyde_compiler::Stage::Asm,
        };
        if let Some(t) = hyde_compiler::emit(&req, st, &mut d) {
            println!("{t}");
        }
    }
    for x in d.iter() {
        println!("{} {}", x.code, x.message);
        for l in &x.labels {
            println!(
                "    {} `{}` {}",
                sources.place(l.span),
                sources.text(l.span),
                l.text
            );
        }
        for n in &x.notes {
            println!("    note {n}")
        }
        if let Some(h) = &x.help {
            println!("    help {h}");
        }
    }
    if args.len() > 4 {
        return;
    }
    let c = hyde_compiler::compile(&req, &mut d).unwrap();
    println!("{:?}", c.times);
    let p = &c.program;
    let stop: f64 = std::env::var("STOP")
        .ok()
        .map(|s| s.parse().unwrap())
        .unwrap_or(1.0);
    let mut par = vec![0.0; p.n_parameters];
    p.kernels.parameters(&[], &mut par);
    let mut recs = BTreeMap::new();
    if let Ok(r) = std::env::var("RECORD") {
        recs.insert(
            "file".to_string(),
            hyde_signal::csv::read(&std::fs::read(r).unwrap(), None).unwrap(),
        );
    }
    let mut setup = hyde_sim::Setup::new(par, &recs, stop);
    setup.rows_s = hyde_sim::Setup::rows_every(0.0, stop, 1e-3);
    let t0 = std::time::Instant::now();
    match hyde_sim::simulate(p, &setup) {
        Ok(r) => {
            println!("{:?} {:?}", t0.elapsed(), r.statistics);
            for e in r.events.iter().take(20) {
                println!(
                    "  {:.6} {:?} {} {}",
                    e.t,
                    e.kind,
                    e.cause,
                    sources.place(e.origin.span)
                );
            }
            for (k, o) in p.outputs.iter().enumerate() {
                println!("{} = {:?}", o.name, r.columns[k].last());
            }
            for m in &p.experiment.measured {
                let t = &recs["file"];
                let col = t.column(&m.source.1).unwrap().values();
                let time = t.time();
                let mut s = 0.0;
                let mut n = 0;
                for (k, &tk) in time.iter().enumerate() {
                    if let Some((a, b)) = r.rows_at(tk) {
                        let v = r.columns[m.output][if m.clocked { b } else { a }];
                        s += (v - col[k]).powi(2);
                        n += 1;
                    }
                }
                println!("rms {} {} {}", m.name, (s / n as f64).sqrt(), n);
            }
        }
        Err(f) => {
            println!(
                "FAILED {:?} at {} {:?} {:?}",
                f.kind,
                f.t,
                f.origins
                    .iter()
                    .map(|o| format!("{} {}", o.instance, sources.place(o.span)))
                    .collect::<Vec<_>>(),
                f.unknowns
            );
            println!("{:?}", f.results.statistics);
            for e in f.results.events.iter().rev().take(20) {
                println!(
                    "  {:.9} {:?} {} {}",
                    e.t,
                    e.kind,
                    e.cause,
                    sources.place(e.origin.span)
                );
            }
        }
    }
}
