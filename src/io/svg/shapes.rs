//! The paths of SVG drawings, with the colors, clips and outlines that they have: shapes for parts.
//! Floor 5. Not here: what an SVG looks like (`svg`).

use super::tree;
use crate::math::{Affine2, Mat2, Vec2, srgb::Color, vec2};
use crate::paint::{LivePath, PathCap, PathJoin, PathNode, PathRule, Subpath};
use crate::{Budget, Error, Result};
use resvg::usvg::tiny_skia_path::{PathSegment, Transform};
use resvg::usvg::{self, Group, Node, Paint, PaintOrder};
use std::path::Path;

/// More paths are no flat drawing.
pub const MOST_SHAPES: usize = 4096;

/// The most nodes of all paths.
pub const MOST_NODES: usize = 1_000_000;

/// Points as near as this are one, px.
const SAME_PX: f32 = 1e-4;

/// A path of an SVG.
pub struct SvgShape {
    /// Its id, or that of the innermost group around it that has one; may be empty.
    pub name: String,
    /// Its points are pixels of the SVG at its own size.
    pub path: LivePath,
    /// What it is seen inside of, the outermost first.
    pub clips: Vec<LivePath>,
    /// Its opacity with those of the groups around it, `[0, 1]`.
    pub opacity: f32,
}

/// The paths of an SVG.
pub struct SvgShapes {
    /// The size of the drawing, px.
    pub size: Vec2,
    /// The lowest first.
    pub shapes: Vec<SvgShape>,
    /// They look like the drawing: it has no ramps, patterns, pictures, masks or filters.
    pub is_exact: bool,
}

/// Reads the paths of an SVG; its text becomes paths, too.
pub fn read_shapes(file: &Path, bytes: &[u8], budget: &Budget) -> Result<SvgShapes> {
    let tree = tree(file, bytes, budget)?;
    let size = vec2(tree.size().width(), tree.size().height());
    let mut reader = ShapeReader { file, shapes: Vec::new(), nodes: 0, is_exact: true };
    reader.group(tree.root(), &Around::default())?;
    let ShapeReader { shapes, is_exact, .. } = reader;
    Ok(SvgShapes { size, shapes, is_exact })
}

/// What the groups around a node do to it.
#[derive(Clone)]
struct Around {
    name: String,
    opacity: f32,
    clips: Vec<LivePath>,
}

impl Default for Around {
    fn default() -> Self {
        Self { name: String::new(), opacity: 1.0, clips: Vec::new() }
    }
}

struct ShapeReader<'a> {
    file: &'a Path,
    shapes: Vec<SvgShape>,
    nodes: usize,
    is_exact: bool,
}

impl ShapeReader<'_> {
    fn group(&mut self, group: &Group, around: &Around) -> Result<()> {
        let mut within = around.clone();
        if !group.id().is_empty() {
            within.name = group.id().into();
        }
        let opacity = group.opacity().get();
        within.opacity *= opacity;
        // What lies over each other in a group is faded as one there, and each by itself here.
        let is_faded_whole = opacity < 1.0 && group.children().len() > 1;
        let is_blended = group.blend_mode() != usvg::BlendMode::Normal;
        if is_faded_whole || is_blended || group.mask().is_some() || !group.filters().is_empty() {
            self.is_exact = false;
        }
        if let Some(clip) = group.clip_path() {
            self.push_clips(clip, group.abs_transform(), &mut within.clips)?;
        }
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group, &within)?,
                Node::Path(path) => self.path(path, &within)?,
                Node::Text(text) => self.group(text.flattened(), &within)?,
                Node::Image(_) => self.is_exact = false,
            }
        }
        Ok(())
    }

    fn path(&mut self, path: &usvg::Path, around: &Around) -> Result<()> {
        if !path.is_visible() {
            return Ok(());
        }
        let map = affine(path.abs_transform());
        let lines = lines(path.data(), &map);
        let (fill, outline) = (self.fill(path), self.outline(path, &map));
        let rule = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::EvenOdd) => PathRule::EvenOdd,
            _ => PathRule::Nonzero,
        };
        let mut own = LivePath { fill, rule, ..LivePath::new(lines) };
        if let Some(outline) = outline {
            let LivePath { outline, outline_color, cap, join, dashes, .. } = outline;
            own = LivePath { outline, outline_color, cap, join, dashes, ..own };
        }
        if own.fill.is_none() && own.outline <= 0.0 {
            return Ok(());
        }
        self.take(&own)?;
        let id = if path.id().is_empty() { &around.name } else { path.id() };
        self.shapes.push(SvgShape {
            name: id.into(),
            path: own,
            clips: around.clips.clone(),
            opacity: around.opacity,
        });
        Ok(())
    }

    /// Counts a path, if it and a document can be.
    fn take(&mut self, path: &LivePath) -> Result<()> {
        let refused = |reason: String| Err(Error::unsupported_file(self.file, reason));
        self.nodes += path.count_nodes();
        if self.shapes.len() >= MOST_SHAPES {
            return refused(format!("it has more than {MOST_SHAPES} paths; place it as an image"));
        }
        if self.nodes > MOST_NODES {
            return refused(format!(
                "its paths have more than {MOST_NODES} nodes; place it as an image"
            ));
        }
        path.fits().or_else(|why| refused(format!("one of its paths cannot be kept: {why}")))
    }

    /// The color that fills a path; of a ramp the one in its middle.
    fn fill(&mut self, path: &usvg::Path) -> Option<Color> {
        let fill = path.fill()?;
        let color = self.color(fill.paint());
        Some(with_opacity(color, fill.opacity().get()))
    }

    fn color(&mut self, paint: &Paint) -> Color {
        let of_stops = |stops: &[usvg::Stop]| {
            let stop = stops.get(stops.len() / 2);
            let color = stop.map(usvg::Stop::color);
            color.map_or(Color::BLACK, |c| Color::rgb(c.red, c.green, c.blue))
        };
        match paint {
            Paint::Color(c) => Color::rgb(c.red, c.green, c.blue),
            other => {
                self.is_exact = false;
                match other {
                    Paint::LinearGradient(ramp) => of_stops(ramp.stops()),
                    Paint::RadialGradient(ramp) => of_stops(ramp.stops()),
                    _ => Color::rgb(128, 128, 128),
                }
            }
        }
    }

    /// The outline of a path, in a path without lines.
    fn outline(&mut self, path: &usvg::Path, map: &Affine2) -> Option<LivePath> {
        let stroke = path.stroke()?;
        let scale = map.matrix2.determinant().abs().sqrt();
        let dashes: Vec<f32> = stroke.dasharray().unwrap_or_default().to_vec();
        let is_kept = path.paint_order() == PaintOrder::FillAndStroke
            && is_similar(map.matrix2)
            && stroke.dashoffset() == 0.0
            && dashes.len() <= LivePath::MOST_DASHES
            && (stroke.linejoin() != usvg::LineJoin::Miter
                || stroke.miterlimit().get() == LivePath::MITER)
            && stroke.linejoin() != usvg::LineJoin::MiterClip;
        self.is_exact &= is_kept;
        let color = self.color(stroke.paint());
        Some(LivePath {
            outline: stroke.width().get() * scale,
            outline_color: with_opacity(color, stroke.opacity().get()),
            cap: match stroke.linecap() {
                usvg::LineCap::Butt => PathCap::Butt,
                usvg::LineCap::Round => PathCap::Round,
                usvg::LineCap::Square => PathCap::Square,
            },
            join: match stroke.linejoin() {
                usvg::LineJoin::Round => PathJoin::Round,
                usvg::LineJoin::Bevel => PathJoin::Bevel,
                _ => PathJoin::Miter,
            },
            dashes: dashes.iter().take(LivePath::MOST_DASHES).map(|dash| dash * scale).collect(),
            ..LivePath::new(Vec::new())
        })
    }

    /// The insides of a clip, each of which limits what is seen.
    fn push_clips(
        &mut self,
        clip: &usvg::ClipPath,
        around: Transform,
        clips: &mut Vec<LivePath>,
    ) -> Result<()> {
        if let Some(outer) = clip.clip_path() {
            self.push_clips(outer, around, clips)?;
        }
        let (mut lines, mut rules) = (Vec::new(), Vec::new());
        self.clip_lines(clip.root(), around.pre_concat(clip.transform()), &mut lines, &mut rules);
        let is_holed = rules.contains(&PathRule::EvenOdd);
        // Several ones of that rule have no rule in common.
        self.is_exact &= !is_holed || rules.len() == 1;
        let rule = if is_holed { PathRule::EvenOdd } else { PathRule::Nonzero };
        let path = LivePath { rule, frames: true, ..LivePath::new(lines) };
        self.take(&path)?;
        clips.push(path);
        Ok(())
    }

    fn clip_lines(
        &mut self,
        group: &Group,
        map: Transform,
        out: &mut Vec<Subpath>,
        rules: &mut Vec<PathRule>,
    ) {
        for node in group.children() {
            match node {
                Node::Path(path) if path.is_visible() => {
                    let Some(fill) = path.fill() else { continue };
                    out.extend(lines(path.data(), &affine(map)));
                    rules.push(match fill.rule() {
                        usvg::FillRule::EvenOdd => PathRule::EvenOdd,
                        usvg::FillRule::NonZero => PathRule::Nonzero,
                    });
                }
                Node::Group(inner) => {
                    self.is_exact &= inner.clip_path().is_none();
                    self.clip_lines(inner, map.pre_concat(inner.transform()), out, rules);
                }
                Node::Text(text) => self.clip_lines(text.flattened(), map, out, rules),
                _ => {}
            }
        }
    }
}

/// Whether a matrix keeps the proportions of what it maps.
fn is_similar(m: Mat2) -> bool {
    let (a, b) = (m.x_axis.length(), m.y_axis.length());
    (a - b).abs() <= 1e-3 * a.max(b) && m.x_axis.dot(m.y_axis).abs() <= 1e-3 * a * b
}

fn with_opacity(color: Color, opacity: f32) -> Color {
    Color { a: (opacity.max(0.0).min(1.0) * 255.0 + 0.5) as u8, ..color }
}

fn affine(t: Transform) -> Affine2 {
    Affine2::from_cols_array(&[t.sx, t.ky, t.kx, t.sy, t.tx, t.ty])
}

/// The lines of a path, mapped.
fn lines(path: &usvg::tiny_skia_path::Path, map: &Affine2) -> Vec<Subpath> {
    let at = |p: usvg::tiny_skia_path::Point| map.transform_point2(vec2(p.x, p.y));
    let mut lines: Vec<Subpath> = Vec::new();
    let mut begin = Vec2::ZERO;
    for segment in path.segments() {
        if let PathSegment::MoveTo(p) = segment {
            begin = at(p);
            lines.push(Subpath { nodes: vec![PathNode::corner(begin)], closed: false });
            continue;
        }
        // After the end of a closed line another one begins where that began.
        if lines.last().is_none_or(|line| line.closed) {
            lines.push(Subpath { nodes: vec![PathNode::corner(begin)], closed: false });
        }
        let Some(line) = lines.last_mut() else { continue };
        let Some(last) = line.nodes.last_mut() else { continue };
        match segment {
            PathSegment::LineTo(p) => line.nodes.push(PathNode::corner(at(p))),
            PathSegment::QuadTo(b, c) => {
                let (b, c) = (at(b), at(c));
                last.after = (b - last.at) * (2.0 / 3.0);
                let before = (b - c) * (2.0 / 3.0);
                line.nodes.push(PathNode { before, ..PathNode::corner(c) });
            }
            PathSegment::CubicTo(b, c, d) => {
                let (b, c, d) = (at(b), at(c), at(d));
                last.after = b - last.at;
                line.nodes.push(PathNode { before: c - d, ..PathNode::corner(d) });
            }
            PathSegment::Close => close(line),
            PathSegment::MoveTo(_) => {}
        }
    }
    lines.retain(|line| line.nodes.len() > 1);
    lines
}

/// Closes a line; an end that lies on its beginning is the same node.
fn close(line: &mut Subpath) {
    line.closed = true;
    if let [first, .., last] = &mut line.nodes[..]
        && first.at.distance(last.at) < SAME_PX
    {
        first.before = last.before;
        line.nodes.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(inner: &str) -> SvgShapes {
        let text = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="40" viewBox="0 0 30 20">{inner}</svg>"#
        );
        read_shapes(Path::new("a.svg"), text.as_bytes(), &Budget::default()).unwrap()
    }

    fn points(shape: &SvgShape) -> Vec<Vec2> {
        shape.path.subpaths().iter().flat_map(|line| line.nodes.iter().map(|n| n.at)).collect()
    }

    #[test]
    fn paths_come_in_order_with_transforms_rules_and_colors() {
        let read = read(
            r##"<g id="head" transform="translate(5 2)" opacity="0.5">
              <path id="face" fill="#c06030" d="M0 0 H10 V8 H0 Z M2 2 H4 V4 H2 Z" fill-rule="evenodd"/></g>
            <rect x="1" y="1" width="2" height="2" fill="#102030" stroke="#ff0000" stroke-width="0.5"/>"##,
        );
        assert_eq!(read.size, vec2(60.0, 40.0));
        assert!(read.is_exact);
        let [face, square] = &read.shapes[..] else { panic!("{}", read.shapes.len()) };
        assert_eq!((face.name.as_str(), face.opacity), ("face", 0.5));
        assert_eq!(face.path.rule, PathRule::EvenOdd);
        assert_eq!(face.path.fill, Some(Color::rgb(0xc0, 0x60, 0x30)));
        // The view box doubles, after the group has moved.
        assert_eq!(
            points(face)[..4],
            [vec2(10.0, 4.0), vec2(30.0, 4.0), vec2(30.0, 20.0), vec2(10.0, 20.0)]
        );
        assert_eq!(face.path.subpaths().len(), 2);
        assert_eq!((square.path.outline, square.path.outline_color), (1.0, Color::rgb(255, 0, 0)));
        assert_eq!(points(square).len(), 4);
    }

    #[test]
    fn clips_are_kept_and_what_paths_cannot_show_is_said() {
        let clipped = read(
            r##"<clipPath id="c" clip-path="url(#d)"><circle cx="5" cy="5" r="4"/></clipPath>
            <clipPath id="d"><rect width="10" height="5"/></clipPath>
            <g clip-path="url(#c)"><rect width="30" height="20" fill="#00ff00"/></g>"##,
        );
        assert!(clipped.is_exact);
        let clips = &clipped.shapes[0].clips;
        assert_eq!(clips.len(), 2);
        assert!(clips.iter().all(|clip| clip.frames));
        let bounds = clips[0].bounds();
        assert_eq!((bounds.x0, bounds.y1), (-1, 11), "the rectangle, a pixel around it");
        let ramp = read(
            r##"<linearGradient id="r"><stop stop-color="#ff0000"/>
            <stop offset="1" stop-color="#0000ff"/></linearGradient>
            <rect width="9" height="9" fill="url(#r)"/>"##,
        );
        assert!(!ramp.is_exact);
        assert_eq!(ramp.shapes[0].path.fill, Some(Color::rgb(0, 0, 255)));
        assert!(
            !read(
                r##"<g opacity="0.5"><rect width="9" height="9"/><rect width="5" height="9"/></g>"##
            )
            .is_exact
        );
        assert!(read("").shapes.is_empty());
    }

    #[test]
    fn arcs_and_quadratic_curves_become_cubic_ones() {
        let read = read(r##"<path d="M0 0 Q5 10 10 0 Z"/><circle cx="15" cy="10" r="5"/>"##);
        let curve = &read.shapes[0].path.subpaths()[0];
        assert_eq!(curve.nodes[0].after, vec2(10.0, 20.0) * (2.0 / 3.0));
        assert!(curve.closed && curve.nodes.len() == 2);
        let area = read.shapes[1].path.subpaths()[0].area_px();
        assert!((area - 100.0 * std::f32::consts::PI).abs() < 3.0, "{area}");
    }
}
