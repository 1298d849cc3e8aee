//! A path with its fill and its outline. Floor 3. Not here: how it is drawn (`drawing`).

use super::figure::Figure;
use super::subpath::{PathNode, Subpath};
use crate::math::range::{COORDINATE, at_most, check_range};
use crate::math::{Range, Vec2, srgb::Color};
use std::borrow::Cow;

/// A path that stays parameters. Lengths are px of its plane, y down.
#[derive(Clone, Debug, PartialEq)]
pub struct LivePath {
    /// Its lines.
    pub geometry: PathGeometry,
    /// What fills it; `None`: nothing.
    pub fill: Option<Color>,
    /// What is inside of it.
    pub rule: PathRule,
    /// The width of its outline; 0: none. Half of it lies inside.
    pub outline: f32,
    /// Of the outline.
    pub outline_color: Color,
    /// How the outline ends.
    pub cap: PathCap,
    /// How the outline turns at corners.
    pub join: PathJoin,
    /// Lengths of dashes and gaps, px, in turn; empty: one line.
    pub dashes: Vec<f32>,
    /// It is the frame of the group that it lies in: what lies beneath it there is seen inside of it
    /// only.
    pub frames: bool,
}

/// The lines of a path.
#[derive(Clone, Debug, PartialEq)]
pub enum PathGeometry {
    /// As numbers.
    Figure(Figure),
    /// As nodes.
    Nodes(Vec<Subpath>),
}

crate::named! {
    /// What is inside of a path that crosses itself, or has several lines.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum PathRule {
        #[default]
        Nonzero = "nonzero" => ("Union", "All that a line runs around"),
        EvenOdd = "even-odd" => ("Holes", "What lies inside twice is a hole"),
    }
}

crate::named! {
    /// How an outline ends.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum PathCap {
        #[default]
        Butt = "butt" => "Cut",
        Round = "round" => "Round",
        Square = "square" => "Square",
    }
}

crate::named! {
    /// How an outline turns at corners.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum PathJoin {
        #[default]
        Miter = "miter" => "Sharp",
        Round = "round" => "Round",
        Bevel = "bevel" => "Cut",
    }
}

impl From<Figure> for PathGeometry {
    fn from(figure: Figure) -> Self {
        PathGeometry::Figure(figure)
    }
}

impl From<Vec<Subpath>> for PathGeometry {
    fn from(lines: Vec<Subpath>) -> Self {
        PathGeometry::Nodes(lines)
    }
}

impl LivePath {
    /// The range of an outline, px.
    pub const OUTLINE: Range = 0.0..=4096.0;
    /// How much longer than an outline's width a sharp corner may be.
    pub const MITER: f32 = 4.0;
    /// The range of a dash, px.
    pub const DASH: Range = 0.0..=65_536.0;
    /// The most dashes and gaps.
    pub const MOST_DASHES: usize = 16;
    /// The most lines.
    pub const MOST_LINES: usize = 10_000;
    /// The most nodes of all lines.
    pub const MOST_NODES: usize = 100_000;
    /// The longest side of what it covers, px.
    pub const LONGEST_PX: f32 = 65_536.0;

    /// Lines without a fill or an outline.
    pub fn new(geometry: impl Into<PathGeometry>) -> Self {
        Self {
            geometry: geometry.into(),
            fill: None,
            rule: PathRule::default(),
            outline: 0.0,
            outline_color: Color::BLACK,
            cap: PathCap::default(),
            join: PathJoin::default(),
            dashes: Vec::new(),
            frames: false,
        }
    }

    /// The same path, filled.
    pub fn with_fill(self, fill: Color) -> Self {
        Self { fill: Some(fill), ..self }
    }

    /// The figure that it is, if it is one.
    pub fn figure(&self) -> Option<&Figure> {
        match &self.geometry {
            PathGeometry::Figure(figure) => Some(figure),
            PathGeometry::Nodes(_) => None,
        }
    }

    /// Its lines; those of a figure are made.
    pub fn subpaths(&self) -> Cow<'_, [Subpath]> {
        match &self.geometry {
            PathGeometry::Figure(figure) => figure.subpaths().into(),
            PathGeometry::Nodes(lines) => lines.as_slice().into(),
        }
    }

    /// The same look on other lines.
    pub fn with_lines(&self, lines: Vec<Subpath>) -> Self {
        Self { geometry: lines.into(), ..self.clone() }
    }

    /// The same path elsewhere in its plane.
    pub fn moved(&self, by: Vec2) -> Self {
        let geometry = match &self.geometry {
            PathGeometry::Figure(figure) => figure.moved(by).into(),
            PathGeometry::Nodes(lines) => {
                lines.iter().map(|line| line.mapped(|p| p + by)).collect::<Vec<_>>().into()
            }
        };
        Self { geometry, ..self.clone() }
    }

    /// The number of its nodes.
    pub fn count_nodes(&self) -> usize {
        match &self.geometry {
            PathGeometry::Figure(_) => 0,
            PathGeometry::Nodes(lines) => lines.iter().map(|line| line.nodes.len()).sum(),
        }
    }

    /// What it is called in the window.
    pub fn label(&self) -> &'static str {
        self.figure().map_or("Path", |figure| figure.kind.label())
    }

    /// Whether a file can hold it, and its picture be made.
    pub fn fits(&self) -> Result<(), String> {
        check_range("the width of the outline", self.outline, &Self::OUTLINE)?;
        at_most("dashes", self.dashes.len(), Self::MOST_DASHES)?;
        self.dashes.iter().try_for_each(|dash| check_range("a dash", *dash, &Self::DASH))?;
        match &self.geometry {
            PathGeometry::Figure(figure) => figure.fits()?,
            PathGeometry::Nodes(lines) => {
                at_most("lines of the path", lines.len(), Self::MOST_LINES)?;
                at_most("nodes of the path", self.count_nodes(), Self::MOST_NODES)?;
                lines.iter().flat_map(|line| &line.nodes).try_for_each(node_fits)?;
            }
        }
        let bounds = self.bounds();
        let longest = bounds.width().max(bounds.height()) as f32;
        match longest <= Self::LONGEST_PX {
            true => Ok(()),
            false => Err(format!(
                "the path would be {longest} px long; at most {} are allowed",
                Self::LONGEST_PX
            )),
        }
    }
}

fn node_fits(node: &PathNode) -> Result<(), String> {
    let points = [node.at, node.before, node.after];
    points
        .into_iter()
        .flat_map(|p| [p.x, p.y])
        .try_for_each(|v| check_range("a node", v, &COORDINATE))?;
    check_range("the width at a node", node.width, &PathNode::WIDTH)
}
