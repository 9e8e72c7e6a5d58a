//! From source text to the first step of the solver, timed with care.

use criterion::{Criterion, criterion_group, criterion_main};
use hyde_tests::Example;
use hyde_tests::figures::{START, first_step};

fn start(criterion: &mut Criterion) {
    let (path, experiment) = START;
    let example = Example::load(path, Some(experiment));
    criterion.bench_function("start_to_first_step", |bencher| {
        bencher.iter(|| example.as_ref().map_err(Clone::clone).and_then(first_step));
    });
}

criterion_group!(benches, start);
criterion_main!(benches);
