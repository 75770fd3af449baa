//! Host time per mix as ratios within one run: `cargo bench -p mixer-tests`.
//!
//! Criterion prints nanoseconds per 256 requests; what is comparable between machines is the ratio of one mixer's to
//! another's. The requests are those of `mixer_setpoints::Requests`, the same for all mixers of an airframe.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{
    BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime,
};
use mixer_compiler::isolated::IsolatedTables;
use mixer_rt::baselines::IsolatedRotors;
use mixer_rt::{Airmode, Wrench};
use mixer_setpoints::{Kind, Requests};
use mixer_tests::golden;

mixer_macros::airframe!("../airframes/isae-x8.toml");
mixer_macros::airframe!("../airframes/px4-y6.toml");
mixer_macros::airframe!("../airframes/px4-x12.toml");

/// Requests per iteration.
const REQUESTS: usize = 256;

type Asked = Vec<(Wrench, f32)>;

fn asked<P: mixer_rt::Quantity, I, S>(tables: &mixer_rt::Tables<'_, P, I, S>, kind: Kind) -> Asked {
    Requests::new(tables, kind, 8)
        .take(REQUESTS)
        .map(|request| (Wrench::from_array(request.wrench), request.voltage_v))
        .collect()
}

fn bench(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    asked: &Asked,
    mut mix: impl FnMut(&Wrench, f32),
) {
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            for (setpoint, voltage_v) in asked {
                mix(black_box(setpoint), black_box(*voltage_v));
            }
        });
    });
}

fn baselines<const ROTORS: usize>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    asked: &Asked,
    isolated: &IsolatedRotors<'_>,
    airmode: Airmode,
) {
    bench(group, "conventional", asked, |setpoint, voltage_v| {
        let mut throttle = [0.0; ROTORS];
        let _ = black_box(isolated.conventional(setpoint, voltage_v, &mut throttle));
        black_box(throttle);
    });
    bench(group, "sequential", asked, |setpoint, voltage_v| {
        let mut throttle = [0.0; ROTORS];
        let _ = black_box(isolated.sequential(airmode, setpoint, voltage_v, &mut throttle));
        black_box(throttle);
    });
}

macro_rules! airframe {
    ($criterion:ident, $name:literal, $module:ident) => {
        let compiled = golden::compile($name).unwrap_or_else(|e| panic!("{e}"));
        let isolated = IsolatedTables::new(&compiled);
        for (kind, set) in [(Kind::Attainable, "attainable"), (Kind::Saturated, "saturated")] {
            let asked = asked(&$module::TABLES, kind);
            let mut group = $criterion.benchmark_group(format!("{}/{set}", $name));
            group.throughput(Throughput::Elements(REQUESTS as u64));
            bench(&mut group, "coaxial", &asked, |setpoint, voltage_v| {
                let _ = black_box($module::mix(setpoint, voltage_v));
            });
            let airmode = $module::TABLES.desaturation.airmode;
            baselines::<{ $module::CHANNELS }>(&mut group, &asked, &isolated.view(), airmode);
            group.finish();
        }
    };
}

fn mixers(criterion: &mut Criterion) {
    airframe!(criterion, "isae-x8", isae_x8);
    airframe!(criterion, "px4-y6", px4_y6);
    airframe!(criterion, "px4-x12", px4_x12);
}

criterion_group!(benches, mixers);
criterion_main!(benches);
