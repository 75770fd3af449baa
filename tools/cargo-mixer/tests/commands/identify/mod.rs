//! `cargo mixer identify`: synthetic sweeps with known truth in every format, the command, real
//! bench data. What it says is in `cases`.

mod alone;
mod bench_data;
mod command;
mod formats;
mod power;
mod saving;
mod spacings;
mod sweep;
mod voltage;
