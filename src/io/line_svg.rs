//! The form lines of a document as paths of an SVG, for other programs. Floor 5. Not here: where the
//! lines are (`surface::form_lines`), paths of a path layer (`path_svg`).

use crate::document::{Content, Document};
use crate::math::srgb::Color;
use crate::paint::{FormDrawing, FormPattern, Stroke};
use crate::surface::form_lines::{FormLine, LineKind, LineSettings};
use std::fmt::Write;
use std::sync::Arc;

/// The lowest layer of lines that is shown, or what one begins with.
pub fn drawing_of(document: &Document) -> FormDrawing {
    let layers = document.walk();
    let shown = layers.iter().filter(|(_, layer)| layer.visible);
    let mut drawing = shown.filter_map(|(_, layer)| match &layer.content {
        Content::FormDrawing(live) => Some(live.params()),
        _ => None,
    });
    let lines = drawing.find(|drawing| matches!(drawing.pattern, FormPattern::Lines(_)));
    let plain = || FormDrawing::new(FormPattern::Lines(LineSettings::DEFAULT));
    lines.cloned().unwrap_or_else(plain)
}

/// An SVG of the document's size: a group for each kind of lines, a path for each line, as wide as
/// the mean of what the brush draws. Empty without a surface.
pub fn write(document: &Document, drawing: &FormDrawing) -> String {
    let (scene, Color { r, g, b, .. }) = (document.scene(), drawing.color);
    let (width, height) = (scene.size.width, scene.size.height);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">\n<g fill=\"none\" stroke=\"#{r:02x}{g:02x}{b:02x}\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\">\n"
    );
    if let (FormPattern::Lines(settings), Some(surface)) = (&drawing.pattern, &scene.surface) {
        let (lines, strokes) = (drawing.lines(surface, settings), drawing.strokes(&scene));
        for (kind, name) in LineKind::ALL {
            let all = lines.lines.iter().zip(strokes.iter());
            write_group(&mut out, name, drawing, all.filter(|(line, _)| line.kind == kind));
        }
    }
    out + "</g>\n</svg>\n"
}

/// The lines of a kind, if there are any.
fn write_group<'a>(
    out: &mut String,
    name: &str,
    drawing: &FormDrawing,
    lines: impl Iterator<Item = (&'a FormLine, &'a Arc<Stroke>)>,
) {
    let mut lines = lines.peekable();
    if lines.peek().is_none() {
        return;
    }
    let _ = writeln!(out, "<g id=\"{name}\">");
    for (line, stroke) in lines {
        let samples = stroke.samples();
        let mean = samples.iter().map(|s| s.pressure).sum::<f32>() / samples.len().max(1) as f32;
        let width_px = drawing.brush.size * mean;
        let _ = writeln!(out, "<path stroke-width=\"{width_px:.2}\" d=\"{}\"/>", path(line));
    }
    out.push_str("</g>\n");
}

/// Every other point of a line: between them it is straight within a hundredth of a pixel.
fn path(line: &FormLine) -> String {
    let last = line.points.len().saturating_sub(1);
    let kept = line.points.iter().enumerate().filter(|(i, _)| i % 2 == 0 || *i == last);
    let mut out = String::new();
    for (i, point) in kept {
        let verb = if i == 0 { 'M' } else { 'L' };
        let _ = write!(out, "{verb}{:.2} {:.2}", point.at.x, point.at.y);
    }
    if line.is_closed {
        out.push('Z');
    }
    out
}
