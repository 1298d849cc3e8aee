//! `docs/PERFORMANCE.md` is made from the figures that the benches printed, and holds nothing else.

#[path = "../benches/page/figures.rs"]
mod figures;
#[path = "../benches/page/plot.rs"]
mod plot;

use figures::Figures;
use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

#[test]
fn the_page_of_speed_holds_the_kept_figures() {
    let figures = Figures::parse(&read("benches/page/figures.txt"));
    assert_eq!(figures.print(), read("benches/page/figures.txt"));
    let template = read("benches/page/template.md");
    assert!(
        figures.fill(&template) == read("docs/PERFORMANCE.md"),
        "run: cargo run --example performance_page"
    );
    assert!(
        plot::lamps(&figures) == read("docs/lamps.svg"),
        "run: cargo run --example performance_page"
    );
    // A dash is what the run does not hold.
    let missing: Vec<&str> = template
        .split("{{")
        .skip(1)
        .filter_map(|part| part.split_once("}}"))
        .map(|(place, _)| place)
        .filter(|place| figures.fill(&format!("{{{{{place}}}}}")) == "–")
        .collect();
    assert!(missing.is_empty(), "no bench printed {missing:#?}");
}

#[test]
fn what_benches_print_becomes_figures() {
    let output = "   Compiling rilievo v0.1.0\n     Running benches/engine.rs (target/release/deps/engine-0)\n\
        Timer precision: 25 ns\n\
        engine            fastest       │ slowest       │ median        │ mean          │ samples │ iters\n\
        ├─ all_threads                  │               │               │               │         │\n\
        │  ├─ D_n bilinear  28.41 ms    │ 40.12 ms      │ 29.05 ms      │ 30 ms         │ 9       │ 9\n\
        │  │                291 Mitem/s │ 206 Mitem/s   │ 285 Mitem/s   │ 276 Mitem/s   │         │\n\
        │  ╰─ unbent        14.9 ms     │ 16 ms         │ 15.2 ms       │ 15.3 ms       │ 9       │ 9\n\
        ╰─ copy             812.4 µs    │ 1.2 ms        │ 903.7 µs      │ 910 µs        │ 10      │ 10\n\n\
        ns per pixel, 3840 × 2160      one thread   all threads   of peer's one\n\
        D_n bilinear                       7.41          3.52            1.02\n\
        cv2.remap: skipped, python3 with cv2 and numpy is not here\n     \
        Running benches/frame.rs (target/release/deps/frame-0)\n\
        α of an image, 1920 × 1080, one pixel in 1 × 1              14.40    15.50    17.90\n\
        a pan over ten layers                           36.0     45.0     52.0   1 of 39 not seen\n";
    let figures = Figures::of_run(output, "a machine");
    let expected = "a machine\n\
        engine; all_threads/D_n bilinear; 29.1\n\
        engine; all_threads/unbent; 15.2\n\
        engine; copy; 0.904\n\
        engine; D_n bilinear; 7.41 3.52 1.02\n\
        frame; α of an image, 1920 × 1080, one pixel in 1 × 1; 14.40 15.50 17.90\n\
        frame; a pan over ten layers; 36.0 45.0 52.0\n";
    assert_eq!(figures.print(), expected);
    assert_eq!(Figures::parse(expected), figures);
    let page = "{{machine}}: {{engine; copy}}, {{engine; D_n bilinear; 3}}, {{frame; nothing; 1}}, {{engine; copy; 2}}";
    assert_eq!(figures.fill(page), "a machine: 0.904, 1.02, –, –");
}

#[test]
fn figures_of_benches_that_did_not_run_stay() {
    let before = Figures::parse("a machine\nengine; copy; 0.9\nframe; a pan; 36.0 45.0\n");
    let run = Figures::of_run(
        "     Running benches/frame.rs (target/release/deps/frame-0)\na zoom    14.4    15.5\n",
        "another",
    );
    let expected = "another\nengine; copy; 0.9\nframe; a zoom; 14.4 15.5\n";
    assert_eq!(before.with_run(run).print(), expected);
}

#[test]
fn times_become_curves_on_round_scales() {
    let figures = Figures::parse(
        "a machine\nlamps; layer_plain/1; 40 45 50\nlamps; layer_plain/250; 360 365 370\n\
         lamps; canvas_plain/(2000, 1000); 30 35 40\nother; layer_plain/9; 9 9 9\n",
    );
    assert_eq!(figures.under("lamps", "layer_plain", 3), [("1", 50.0), ("250", 370.0)]);
    let svg = plot::lamps(&figures);
    // 250 lamps and 400 ms end the first panel, 2 megapixels and 30 ms the second.
    for ends in ["M46.8 175.8L246.0 46.2\"", "M246.0 30.0\"", ">250<", ">400<", ">30<", ">0.5<"] {
        assert!(svg.contains(ends), "{ends} in {svg}");
    }
    assert_eq!(svg.matches("<circle").count(), 3, "{svg}");
}
