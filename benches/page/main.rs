//! Makes `docs/PERFORMANCE.md` and its plots of what the benches printed.
//!
//! ```sh
//! cargo bench 2>&1 | tee bench.txt
//! cargo run --example performance_page -- bench.txt "two idle cores of a Xeon, AVX2, November 2026"
//! ```
//!
//! The figures of the run go to `benches/page/figures.txt`, and into the places of
//! `benches/page/template.md` that name them; those of benches that did not run stay. Without
//! arguments the page is made again from the figures as they are.

mod figures;
mod plot;

use figures::Figures;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let kept = root.join("benches/page/figures.txt");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let before = Figures::parse(&std::fs::read_to_string(&kept)?);
    let figures = match &arguments[..] {
        [] => before,
        [run, machine] => before.with_run(Figures::of_run(&std::fs::read_to_string(run)?, machine)),
        _ => return Err("usage: performance_page [BENCH_OUTPUT MACHINE]".into()),
    };
    let page = figures.fill(&std::fs::read_to_string(root.join("benches/page/template.md"))?);
    std::fs::write(kept, figures.print())?;
    std::fs::write(root.join("docs/PERFORMANCE.md"), page)?;
    std::fs::write(root.join("docs/lamps.svg"), plot::lamps(&figures))?;
    Ok(())
}
