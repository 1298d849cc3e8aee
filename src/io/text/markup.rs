//! The SVG of a text. Floor 5.

use super::columns::{self, Column};
use super::lines::{Line, LineCurve};
use crate::math::srgb::Color;
use crate::math::{Rect, Vec2};
use crate::paint::{TextAlign, TextRun, TextStyle};
use std::fmt::Write;

/// What every SVG begins with.
const NAMESPACES: &str =
    r#"xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink""#;

/// An SVG of ours with some elements.
pub(super) fn document(elements: &str) -> String {
    format!(r#"<svg {NAMESPACES} width="1" height="1">{elements}</svg>"#)
}

/// An SVG of a line as a text whose baseline begins, ends or has its middle at the origin.
pub(super) fn of_straight_line(line: &Line, align: TextAlign) -> String {
    let (anchor, runs) = (anchor(align), runs(&line.pieces));
    document(&format!(r#"<text xml:space="preserve" text-anchor="{anchor}">{runs}</text>"#))
}

/// An SVG of a line that runs along a curve.
pub(super) fn of_curve(line: &Line, curve: &LineCurve) -> String {
    let LineCurve { data, start, align, below, .. } = curve;
    let (anchor, runs) = (anchor(*align), runs(&line.pieces));
    let mut out = String::new();
    let _ = write!(out, r##"<path id="c" fill="none" d="{data}"/>"##);
    let text = format!(r#"text xml:space="preserve" text-anchor="{anchor}""#);
    let place = format!(r##"xlink:href="#c" startOffset="{start}""##);
    let runs = format!(r#"<tspan dy="{below}">{runs}</tspan>"#);
    let _ = write!(out, "<{text}><textPath {place}>{runs}</textPath></text>");
    document(&out)
}

/// An SVG of the outlines of a column that is held at the origin.
pub(super) fn of_column(column: &Column, align: TextAlign) -> String {
    let y = columns::begin(align, column.length());
    let mut out = String::new();
    for (data, style) in column.outlines.iter().filter(|(data, _)| !data.is_empty()) {
        let look = look(style);
        let _ = write!(out, r#"<path transform="translate(0 {y})" d="{data}"{look}/>"#);
    }
    document(&out)
}

/// Adds elements, moved.
pub(super) fn push_moved(out: &mut String, elements: &str, by: Vec2) {
    let _ = write!(out, r#"<g transform="translate({} {})">{elements}</g>"#, by.x, by.y);
}

/// The elements of an SVG that `usvg` wrote.
pub(super) fn elements(drawing: &str) -> &str {
    let start = drawing.find("<svg").unwrap_or(drawing.len());
    let begin = drawing[start..].find('>').map_or(drawing.len(), |end| start + end + 1);
    let end = drawing.rfind("</svg>").unwrap_or(begin).max(begin);
    &drawing[begin..end]
}

/// A drawing of some elements whose picture is a rectangle of its plane.
pub(super) fn drawing_of(elements: &str, bounds: Rect) -> String {
    let (width, height) = (bounds.width(), bounds.height());
    let view = format!("{} {} {width} {height}", bounds.x0, bounds.y0);
    let size = format!(r#"width="{width}" height="{height}" viewBox="{view}""#);
    format!("<svg {NAMESPACES} {size}>{elements}</svg>")
}

fn anchor(align: TextAlign) -> &'static str {
    match align {
        TextAlign::Start => "start",
        TextAlign::Middle => "middle",
        TextAlign::End => "end",
    }
}

/// Runs as `tspan` elements.
fn runs(pieces: &[TextRun]) -> String {
    let mut out = String::new();
    pieces.iter().for_each(|run| push_run(&mut out, run));
    out
}

fn push_run(out: &mut String, run: &TextRun) {
    let TextStyle { family, size, weight, italic, tracking, kerning, .. } = &run.style;
    let family = if family.is_empty() {
        "sans-serif".to_owned()
    } else {
        format!("'{}', sans-serif", escape(&family.replace('\'', "")))
    };
    let slant = if *italic { r#" font-style="italic""# } else { "" };
    let kern = if *kerning { "" } else { r#" font-kerning="none""# };
    let spacing = tracking * size / 1000.0;
    let (look, string) = (look(&run.style), escape(&run.string));
    let _ = write!(
        out,
        r#"<tspan font-family="{family}" font-size="{size}" font-weight="{weight}"
letter-spacing="{spacing}"{slant}{kern}{look}>{string}</tspan>"#
    );
}

/// The colors of letters, as attributes.
fn look(style: &TextStyle) -> String {
    let opacity = |color: Color| f32::from(color.a) / 255.0;
    let mut out =
        format!(r#" fill="{}" fill-opacity="{}""#, hex(style.color), opacity(style.color));
    if style.outline > 0.0 {
        let color = style.outline_color;
        // The half of the line that lies within the letters is beneath them.
        let _ = write!(
            out,
            r#" stroke="{}" stroke-opacity="{}" stroke-width="{}"
stroke-linejoin="round" paint-order="stroke""#,
            hex(color),
            opacity(color),
            2.0 * style.outline
        );
    }
    out
}

fn hex(Color { r, g, b, .. }: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Text within XML; what XML cannot hold is left out.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() && c != '\t' => {}
            c => out.push(c),
        }
    }
    out
}
