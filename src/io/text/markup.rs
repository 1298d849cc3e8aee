//! The SVG of a text. Floor 5.

use super::columns;
use super::lines::{Line, LineCurve};
use crate::math::Rect;
use crate::math::srgb::Color;
use crate::paint::{Text, TextAlign, TextRun, TextStyle};
use std::fmt::Write;

/// What every SVG begins with.
const NAMESPACES: &str =
    r#"xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink""#;

/// An SVG of lines, the first baseline at the origin, one `text` element each.
pub(super) fn of_lines(text: &Text, lines: &[Line]) -> String {
    let mut out = format!(r#"<svg {NAMESPACES} width="1" height="1">"#);
    for (i, line) in lines.iter().enumerate() {
        if text.is_in_columns() {
            push_column(&mut out, text, line);
        } else if line.curve.is_none() {
            let (x, y) = (line.at.x, line.at.y);
            let anchor = anchor(text.align);
            let runs = runs(&line.pieces);
            let _ = write!(
                out,
                r#"<text xml:space="preserve" x="{x}" y="{y}" text-anchor="{anchor}">{runs}</text>"#
            );
        } else if let Some(LineCurve { data, start, align, below, .. }) = &line.curve {
            let (anchor, runs) = (anchor(*align), runs(&line.pieces));
            let _ = write!(out, r##"<path id="c{i}" fill="none" d="{data}"/>"##);
            let text = format!(r#"text xml:space="preserve" text-anchor="{anchor}""#);
            let place = format!(r##"xlink:href="#c{i}" startOffset="{start}""##);
            let runs = format!(r#"<tspan dy="{below}">{runs}</tspan>"#);
            let _ = write!(out, "<{text}><textPath {place}>{runs}</textPath></text>");
        }
    }
    out.push_str("</svg>");
    out
}

/// A drawing whose picture is a rectangle of its plane; `None` for something else than an SVG.
pub(super) fn drawing_within(drawing: &str, bounds: Rect) -> Option<String> {
    let start = drawing.find("<svg")?;
    let end = start + drawing[start..].find('>')?;
    let (width, height) = (bounds.width(), bounds.height());
    let is_empty = drawing[..end].ends_with('/');
    let close = if is_empty { "/>" } else { ">" };
    Some(format!(
        r#"<svg {NAMESPACES} width="{width}" height="{height}" viewBox="{} {} {width} {height}"{close}{}"#,
        bounds.x0,
        bounds.y0,
        &drawing[end + 1..]
    ))
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

/// The outlines of a column.
fn push_column(out: &mut String, text: &Text, line: &Line) {
    let column = columns::lay(line);
    let (x, y) = (line.at.x, line.at.y + columns::begin(text.align, column.length()));
    for (data, style) in column.outlines.iter().filter(|(data, _)| !data.is_empty()) {
        let look = look(style);
        let _ = write!(out, r#"<path transform="translate({x} {y})" d="{data}"{look}/>"#);
    }
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
