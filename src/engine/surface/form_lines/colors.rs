//! Edges of the colors of a picture that lies on a surface. Floor 2. An edge is where the color
//! changes most along the way in which it changes (Di Zenzo 1986; Canny 1986), traced as crests of
//! form are (`fields`).

use super::fields::trace_lines;
use super::smooth::diffuse;
use super::tidy::RawLine;
use super::turns::Turns;
use super::{LineKind, LinePoint, LineSettings};
use crate::math::{Size, oklab, srgb};
use crate::raster::Plane;
use crate::surface::links;
use std::f32::consts::TAU;
use std::sync::{Arc, Weak};

/// Steps between two colors, Oklab, from which an edge is seen at all, and up to which it grows
/// clearer.
const STEP: (f32, f32) = (0.02, 0.25);
/// Beside an edge, σ away, the color changes by no more than this, of the change in it.
const BESIDE: f32 = 0.9;

/// The colors of a picture on white paper, whose edges are drawn.
#[derive(Debug)]
pub struct PaperColors(Plane<[u8; 3]>);

impl PaperColors {
    /// sRGB codes of a canvas, or of a copy of it in another size.
    pub fn new(codes: Plane<[u8; 3]>) -> Self {
        Self(codes)
    }

    /// Its size.
    pub fn size(&self) -> Size {
        self.0.size()
    }

    /// Whether both look alike.
    pub fn is_alike(&self, other: &Self) -> bool {
        self.0 == other.0
    }

    /// Its edges on a canvas, which may be of another size.
    pub(super) fn trace(&self, canvas: Size, settings: &LineSettings) -> Vec<RawLine> {
        let size = self.size();
        let scale = canvas.width as f32 / size.width.max(1) as f32;
        let sigma = (settings.smooth / scale.max(1e-6)).clamp(0.5, 0.25 * size.longer_side());
        let linked = link_all(size);
        let [l, a, b] = [0, 1, 2].map(|channel| self.blurred(channel, sigma, &linked));
        let turns = Turns::of([&l, &a, &b], &linked);
        let crossing = |from: (usize, usize), to: (usize, usize)| {
            let crest = turns.crest(from, to, &linked, sigma)?;
            // A step that was blurred by σ changes most in its middle: by its height / (√2π σ).
            let step = crest.most * sigma * TAU.sqrt();
            let is_edge = step > STEP.0 && crest.beside < BESIDE * crest.most;
            is_edge.then_some((crest.t, ((step - STEP.0) / STEP.1).min(1.0)))
        };
        let least = STEP.0 / (sigma * TAU.sqrt());
        let mut lines = trace_lines(LineKind::Color, &linked, turns.crest_cells(least), crossing);
        let points = lines.iter_mut().flat_map(|line| &mut line.points);
        points.for_each(|point: &mut LinePoint| point.at *= scale);
        lines
    }

    /// A channel of Oklab, blurred by σ px.
    fn blurred(&self, channel: usize, sigma: f32, linked: &Plane<u8>) -> Plane<f32> {
        let mut plane = self.0.map(|code| oklab::from_linear(code.map(srgb::decode_u8))[channel]);
        diffuse(&mut plane, linked, sigma);
        plane
    }
}

/// A canvas on which every pixel is linked to its neighbors.
fn link_all(size: Size) -> Plane<u8> {
    Plane::from_fn(size, |x, y| {
        let link = |bit: u8, is_there: bool| if is_there { bit } else { 0 };
        link(links::LEFT, x > 0)
            | link(links::RIGHT, x + 1 < size.width as usize)
            | link(links::UP, y > 0)
            | link(links::DOWN, y + 1 < size.height as usize)
    })
}

/// Which picture lines follow; not held by this.
#[derive(Clone, Debug)]
pub(super) struct ColorsKey(Weak<PaperColors>);

impl ColorsKey {
    pub fn of(colors: &Arc<PaperColors>) -> Self {
        Self(Arc::downgrade(colors))
    }
}

impl PartialEq for ColorsKey {
    fn eq(&self, other: &Self) -> bool {
        // A weak pointer keeps its address from being used again.
        self.0.ptr_eq(&other.0)
    }
}
