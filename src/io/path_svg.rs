//! Paths as SVG, for other programs. Floor 5. Not here: SVG files that are read (`svg`).

#![warn(missing_docs)]

use crate::math::{Vec2, srgb::Color};
use crate::paint::{LivePath, PathCap, PathJoin, PathRule, Subpath};
use std::fmt::Write;

/// An SVG file of a path, at the size of its plane. An outline of differing widths has its own
/// width everywhere.
pub fn write(path: &LivePath) -> String {
    let bounds = path.bounds();
    let (width, height) = (bounds.width(), bounds.height());
    let mut out = r#"<svg xmlns="http://www.w3.org/2000/svg""#.to_owned();
    let corner = format!("{} {}", bounds.x0, bounds.y0);
    let _ =
        write!(out, r#" width="{width}" height="{height}" viewBox="{corner} {width} {height}">"#);
    let lines: Vec<String> = path.subpaths().iter().map(line).collect();
    let _ = write!(out, "\n<path d=\"{}\"{}/>\n</svg>\n", lines.join(" "), look(path));
    out
}

/// One line in the commands of SVG's path data.
pub(crate) fn line(line: &Subpath) -> String {
    let mut out = String::new();
    let Some(first) = line.nodes.first() else { return out };
    let point = |p: Vec2| format!("{} {}", number(p.x), number(p.y));
    let _ = write!(out, "M{}", point(first.at));
    for [a, b, c, d] in line.curves() {
        let _ = match a == b && c == d {
            true => write!(out, " L{}", point(d)),
            false => write!(out, " C{} {} {}", point(b), point(c), point(d)),
        };
    }
    if line.closed {
        out.push_str(" Z");
    }
    out
}

/// Thousandths of a pixel are enough.
fn number(v: f32) -> f32 {
    (v * 1000.0).round() / 1000.0
}

/// The attributes that say how a path looks.
fn look(path: &LivePath) -> String {
    let mut out = String::new();
    let opacity = |color: Color| f32::from(color.a) / 255.0;
    let hex = |Color { r, g, b, .. }: Color| format!("#{r:02x}{g:02x}{b:02x}");
    match path.fill {
        Some(fill) => {
            let _ = write!(out, r#" fill="{}" fill-opacity="{}""#, hex(fill), opacity(fill));
        }
        None => out.push_str(r#" fill="none""#),
    }
    if path.rule == PathRule::EvenOdd {
        out.push_str(r#" fill-rule="evenodd""#);
    }
    if path.outline > 0.0 {
        let (color, width) = (path.outline_color, path.outline);
        let cap = match path.cap {
            PathCap::Butt => "butt",
            PathCap::Round => "round",
            PathCap::Square => "square",
        };
        let join = match path.join {
            PathJoin::Miter => "miter",
            PathJoin::Round => "round",
            PathJoin::Bevel => "bevel",
        };
        let (hex, opacity) = (hex(color), opacity(color));
        let _ = write!(out, r#" stroke="{hex}" stroke-opacity="{opacity}" stroke-width="{width}""#);
        let _ = write!(out, r#" stroke-linecap="{cap}" stroke-linejoin="{join}""#);
        if path.dashes.iter().any(|dash| *dash > 0.0) {
            let dashes: Vec<String> = path.dashes.iter().map(|dash| dash.to_string()).collect();
            let _ = write!(out, r#" stroke-dasharray="{}""#, dashes.join(" "));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Budget;
    use crate::math::vec2;
    use crate::paint::{Figure, FigureKind};
    use crate::raster::picture::Texels;

    /// The greatest difference between a path and its SVG, drawn at the same size, and the mean one.
    fn differences(path: &LivePath) -> (u8, f64) {
        let file = std::path::Path::new("path.svg");
        let drawing = crate::svg::decode(file, write(path).as_bytes(), &Budget::default()).unwrap();
        let size = path.picture_size();
        let own = path.picture();
        let drawn = drawing.drawing.unwrap().draw(size).unwrap();
        let Texels::Srgb8(texels) = &own.texels else { panic!("bytes") };
        let apart = |(a, b): (&[u8; 4], &[u8; 4])| a[3].abs_diff(b[3]);
        let all: Vec<u8> = texels.iter().zip(&drawn).map(apart).collect();
        let sum: f64 = all.iter().map(|apart| f64::from(*apart)).sum();
        (all.iter().copied().max().unwrap_or(0), sum / all.len() as f64)
    }

    #[test]
    fn every_figure_looks_the_same_as_its_svg() {
        for (kind, label) in FigureKind::LABELS {
            let (from, to) = (vec2(10.0, 14.0), vec2(90.5, 70.0));
            let figure = Figure { kind, from, to, corner: 6.0, ..Figure::DEFAULT };
            let outline_color = Color { r: 20, g: 200, b: 90, a: 128 };
            let path = LivePath {
                outline: 5.0,
                outline_color,
                cap: PathCap::Square,
                join: PathJoin::Round,
                ..LivePath::new(figure).with_fill(Color::rgb(200, 30, 20))
            };
            let dashed = LivePath { dashes: vec![12.0, 9.0], ..path.clone() };
            // The other library samples a pixel at four heights, so that each of two edges through it
            // may be an eighth off, and a dash may end half a pixel elsewhere: it measures arcs more
            // coarsely.
            for (path, limits) in [(path, (80, 1.0)), (dashed, (140, 2.0))] {
                let (most, mean) = differences(&path);
                assert!(most <= limits.0 && mean < limits.1, "{label}: {most}, {mean}");
            }
        }
    }
}
