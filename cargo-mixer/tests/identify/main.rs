//! `cargo mixer identify`: synthetic sweeps with known truth in every format, refusals, the
//! command, real bench data.

mod alone;
mod bench_data;
mod command;
mod doubts;
mod first_hour;
mod formats;
#[path = "../measured/mod.rs"]
mod measured;
mod plan;
mod power;
mod refusals;
mod saving;
mod spacings;
mod sweep;
mod voltage;
