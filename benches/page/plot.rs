//! The plots of the page, as SVG: times by lamps and by canvas (RS fig. 7), from the kept figures.

use super::figures::Figures;
use std::fmt::Write;

/// What one panel shows: its title, the unit of x, and rows of the bench as curves.
struct Panel {
    title: &'static str,
    x_unit: &'static str,
    curves: &'static [(&'static str, &'static str, &'static str)],
}

/// Name, row of the bench, color.
const PANELS: [Panel; 3] = [
    Panel {
        title: "A layer, 1024 × 768",
        x_unit: "lamps",
        curves: &[("plain", "layer_plain", PLAIN), ("scaled", "layer_scaled", SCALED)],
    },
    Panel {
        title: "A layer, 16 lamps",
        x_unit: "megapixels",
        curves: &[("plain", "canvas_plain", PLAIN), ("scaled", "canvas_scaled", SCALED)],
    },
    Panel {
        title: "One loop for all, 512 × 384",
        x_unit: "lamps",
        curves: &[
            ("plain", "loop_plain", PLAIN),
            ("scaled", "loop_scaled", SCALED),
            ("warped", "loop_warped", "#3d6fb4"),
        ],
    },
];
const PLAIN: &str = "#6b6b6b";
const SCALED: &str = "#c8511b";

/// The column of the bench that is plotted: the least of its times, which others disturbed least.
const LEAST: usize = 1;
const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 230.0;
/// Room left of a panel for its numbers, right for the names of its curves, above and below.
const LEFT: f64 = 46.0;
const RIGHT: f64 = 54.0;
const ABOVE: f64 = 30.0;
const BELOW: f64 = 38.0;

/// `docs/lamps.svg`.
pub fn lamps(figures: &Figures) -> String {
    let width = WIDTH * PANELS.len() as f64;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {HEIGHT}\" width=\"{width}\" \
         height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"11\" fill=\"#333\">\n\
         <rect width=\"{width}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n"
    );
    for (i, panel) in PANELS.iter().enumerate() {
        let _ = writeln!(svg, "<g transform=\"translate({} 0)\">", WIDTH * i as f64);
        draw(&mut svg, panel, figures);
        svg += "</g>\n";
    }
    svg + "</svg>\n"
}

fn draw(svg: &mut String, panel: &Panel, figures: &Figures) {
    let curves: Vec<Vec<(f64, f64)>> =
        panel.curves.iter().map(|(_, row, _)| points(figures, row)).collect();
    let most = |of: fn(&(f64, f64)) -> f64| curves.iter().flatten().map(of).fold(0.0, f64::max);
    let (step_x, step_y) = (step(most(|p| p.0)), step(most(|p| p.1)));
    let (end_x, end_y) = (end(most(|p| p.0), step_x), end(most(|p| p.1), step_y));
    let x = |value: f64| LEFT + (WIDTH - LEFT - RIGHT) * value / end_x;
    let y = |value: f64| HEIGHT - BELOW - (HEIGHT - ABOVE - BELOW) * value / end_y;
    let (mut lines, mut labels) = (String::new(), String::new());
    let mut text = |x: f64, y: f64, anchor: &str, color: &str, text: &str| {
        let _ = writeln!(
            labels,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{color}\">{text}</text>"
        );
    };
    text(LEFT, 16.0, "start", "#111", panel.title);
    text(x(0.5 * end_x), HEIGHT - 6.0, "middle", "#333", panel.x_unit);
    text(LEFT - 6.0, 16.0, "end", "#333", "ms");
    for i in 0..=(end_y / step_y).round() as usize {
        let value = i as f64 * step_y;
        text(LEFT - 6.0, y(value) + 4.0, "end", "#333", &label(value));
        let (from, to, at) = (x(0.0), x(end_x), y(value));
        let _ = writeln!(lines, "<path d=\"M{from:.1} {at:.1}H{to:.1}\" stroke=\"#ddd\"/>");
    }
    for i in 0..=(end_x / step_x).round() as usize {
        let value = i as f64 * step_x;
        text(x(value), HEIGHT - BELOW + 15.0, "middle", "#333", &label(value));
    }
    let mut names = Vec::new();
    for ((name, _, color), points) in panel.curves.iter().zip(&curves) {
        let Some(last) = points.last() else { continue };
        names.push((y(last.1), x(last.0), *name, *color));
        let path: Vec<String> =
            points.iter().map(|p| format!("{:.1} {:.1}", x(p.0), y(p.1))).collect();
        let path = path.join("L");
        let line = "fill=\"none\" stroke-width=\"2\"";
        let _ = writeln!(lines, "<path d=\"M{path}\" stroke=\"{color}\" {line}/>");
        for p in points {
            let (x, y) = (x(p.0), y(p.1));
            let _ =
                writeln!(lines, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\" fill=\"{color}\"/>");
        }
    }
    // Names of curves that end close to each other move apart, from the lowest up.
    names.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut free = f64::INFINITY;
    for (end, last, name, color) in names {
        let at = end.min(free);
        text(last + 6.0, at + 4.0, "start", color, name);
        free = at - 12.0;
    }
    *svg += &lines;
    *svg += &labels;
}

/// The times of a row of the bench by its argument: a number of lamps, or the sides of a canvas,
/// which become megapixels.
fn points(figures: &Figures, row: &str) -> Vec<(f64, f64)> {
    let point = |(argument, ms): (&str, f64)| {
        let sides = argument.trim_matches(['(', ')']).split(", ").map(str::parse::<f64>);
        match sides.collect::<Result<Vec<f64>, _>>().ok()?[..] {
            [lamps] => Some((lamps, ms)),
            [width, height] => Some((width * height / 1e6, ms)),
            _ => None,
        }
    };
    figures.under("lamps", row, LEAST).into_iter().filter_map(point).collect()
}

/// A number of a scale, without the last digits of binary fractions.
fn label(value: f64) -> String {
    ((value * 1000.0).round() / 1000.0).to_string()
}

/// A round distance between the lines of a scale: at most five of them.
fn step(most: f64) -> f64 {
    let rough = (most / 5.0).max(1e-9);
    let power = 10f64.powf(rough.log10().floor());
    let round = [1.0, 2.0, 2.5, 5.0, 10.0].map(|factor| factor * power);
    round.into_iter().find(|step| *step >= rough).unwrap_or(10.0 * power)
}

/// Where a scale ends: at its first line above everything.
fn end(most: f64, step: f64) -> f64 {
    (most / step).ceil().max(1.0) * step
}
