//! Host time per mix as ratios within one run: `cargo bench -p mixer-tests`.
//!
//! Criterion prints nanoseconds per 256 requests; what is comparable between machines is the ratio
//! of one mixer's to another's, which a table at the end gives. The requests are those of
//! `mixer_setpoints::Requests`, the same for all mixers of an airframe.
#![allow(missing_docs)]

mod ratios;
mod wls;

use std::hint::black_box;
use std::time::SystemTime;

use criterion::{BenchmarkGroup, Criterion, Throughput, measurement::WallTime};
use isolated_rotors::{IsolatedRotors, IsolatedTables};
use mixer_rt::Wrench;
use mixer_rt::tables::{Airmode, AllocationMethod, Kinds, Tables};
use mixer_setpoints::{RequestKind, Requests};
use mixer_tests::golden;
use wls::WeightedLeastSquares;
use wls_alloc::wls::ControlAllocator;

mixer_macros::airframe!("../airframes/isae-x8.toml");
mixer_macros::airframe!("../airframes/px4-y6.toml");
mixer_macros::airframe!("../airframes/px4-x12.toml");

/// Requests per iteration.
const REQUESTS: usize = 256;

type Asked = Vec<(Wrench, f32)>;

fn asked<K: Kinds, S: AllocationMethod>(tables: &Tables<'_, K, S>, kind: RequestKind) -> Asked {
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
    bench(group, MIXERS[1], asked, |setpoint, voltage_v| {
        let mut throttle = [0.0; ROTORS];
        let _ = black_box(isolated.conventional(setpoint, voltage_v, &mut throttle));
        black_box(throttle);
    });
    bench(group, MIXERS[2], asked, |setpoint, voltage_v| {
        let mut throttle = [0.0; ROTORS];
        let _ = black_box(isolated.sequential(airmode, setpoint, voltage_v, &mut throttle));
        black_box(throttle);
    });
}

/// The mixers, this one first.
const MIXERS: [&str; 4] = ["coaxial", "conventional", "sequential", "wls"];

/// Benchmarks of one airframe; adds the names of its groups.
macro_rules! airframe {
    ($criterion:ident, $groups:ident, $name:literal, $module:ident) => {
        const ROTORS: usize = $module::CHANNELS;
        let compiled = golden::compile($name).unwrap_or_else(|e| panic!("{e}"));
        let isolated = IsolatedTables::new(&compiled);
        for (kind, set) in [
            (RequestKind::Attainable, "attainable"),
            (RequestKind::Saturated, "saturated"),
        ] {
            let asked = asked(&$module::TABLES, kind);
            let name = format!("{}, {set}", $name);
            let mut group = $criterion.benchmark_group(&name);
            group.throughput(Throughput::Elements(REQUESTS as u64));
            bench(&mut group, MIXERS[0], &asked, |setpoint, voltage_v| {
                let _ = black_box($module::mix(setpoint, voltage_v));
            });
            let airmode = $module::TABLES.priorities.airmode;
            baselines::<ROTORS>(&mut group, &asked, &isolated.view(), airmode);
            let voltage = $module::TABLES.voltage.as_ref();
            let mut wls = WeightedLeastSquares::<ControlAllocator<ROTORS, 4, { ROTORS + 4 }>, ROTORS>::new(
                &isolated, voltage,
            );
            bench(&mut group, MIXERS[3], &asked, |setpoint, voltage_v| {
                black_box(wls.mix(setpoint, voltage_v));
            });
            group.finish();
            $groups.push(name);
        }
    };
}

fn x8(criterion: &mut Criterion, groups: &mut Vec<String>) {
    airframe!(criterion, groups, "isae-x8", isae_x8);
}

fn y6(criterion: &mut Criterion, groups: &mut Vec<String>) {
    airframe!(criterion, groups, "px4-y6", px4_y6);
}

fn x12(criterion: &mut Criterion, groups: &mut Vec<String>) {
    airframe!(criterion, groups, "px4-x12", px4_x12);
}

fn main() {
    let start = SystemTime::now();
    let mut criterion = Criterion::default()
        .output_directory(&ratios::folder())
        .configure_from_args();
    let mut groups = Vec::new();
    x8(&mut criterion, &mut groups);
    y6(&mut criterion, &mut groups);
    x12(&mut criterion, &mut groups);
    criterion.final_summary();
    ratios::print(&groups, &MIXERS, start);
}
