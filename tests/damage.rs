//! Damaged and hostile files, read while the allocator is watched. A binary of its own, whose tests
//! run one at a time.

mod hostile;
mod memory;
mod mutated;
mod readers;
mod seeds;
mod watch;

#[global_allocator]
static WATCH: watch::Watch = watch::Watch;
