//! The gradient tool: a color ramp between two anchors, bent before it is applied (SF sec. 5.2,
//! fig. 8). Floor 3. Not here: the ramp itself (`ramp`), D (`surface::deformation`).

use super::image::{BentFrame, transform};
pub use super::ramp::GradientStop;
use super::ramp::Ramp;
use super::ramp_style::RampStyle;
use super::scene::{ImageFilter, Scene};
use crate::math::{Affine2, PlaneMap, Rect, Vec2, srgb::Color, vec2};
use crate::raster::tile::{TILE, transparent_f32};
use crate::raster::{PlanarTile, Tile, TileAt};
use crate::surface::deformation::{Deformation, DeformedRect};
use crate::surface::plane_piece::PlanePiece;
use crate::surface::{Anchor, Bend, Operator, Weights, links};

/// ramp(t(D(q))), t the position on the segment [from, to] in one of several styles, clamped; on a
/// straight ramp the projection. Its two ends are its anchors.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// Where the ramp begins, px of its frame.
    pub from: Vec2,
    /// Where it ends.
    pub to: Vec2,
    /// How it runs from there to there: straight, around, outward.
    pub style: RampStyle,
    /// At least one. Between two stops straight-alpha encoded values are interpolated linearly.
    pub stops: Vec<GradientStop>,
    /// How it is bent over the surface.
    pub operator: Operator,
    /// How the ramp is read.
    pub filter: ImageFilter,
    /// Where the frame of both ends is on the canvas.
    pub frame: PlaneMap,
    /// Of the operator that unwraps the surface: pieces on which the ramp is turned, moved and
    /// scaled alone.
    pub pieces: Vec<PlanePiece>,
}

impl Gradient {
    /// The stops of one ramp.
    pub const MOST_STOPS: usize = 1_000;

    /// A ramp of these colors, evenly spaced from one point to the other, canvas px. It is not
    /// bent.
    pub fn new(from: Vec2, to: Vec2, colors: &[Color]) -> Self {
        let steps = colors.len().saturating_sub(1).max(1) as f32;
        let stop =
            |(i, color): (usize, &Color)| GradientStop { t: i as f32 / steps, color: *color };
        Self {
            from,
            to,
            style: RampStyle::default(),
            stops: colors.iter().enumerate().map(stop).collect(),
            operator: Operator::None,
            filter: ImageFilter::default(),
            frame: PlaneMap::IDENTITY,
            pieces: Vec::new(),
        }
    }

    /// The same ramp, bent by an operator.
    pub fn with_operator(self, operator: Operator) -> Self {
        Self { operator, ..self }
    }

    /// The *where*: both ends are anchors, and their weights change along the segment (MATH 2).
    pub fn bend(&self) -> Bend {
        let on_canvas = |p: Vec2| self.frame.to_canvas(p).unwrap_or(p);
        let anchors = vec![Anchor::pin(on_canvas(self.from)), Anchor::pin(on_canvas(self.to))];
        Bend {
            operator: self.operator,
            anchors,
            weights: Weights::Segment,
            pieces: self.pieces.clone(),
        }
    }

    /// One tile of the layer. `None` if it is transparent, without stops, or beyond the canvas.
    pub fn render_tile(&self, scene: &Scene, at: TileAt) -> Option<Tile> {
        self.render_pixels(scene, at)?.quantize()
    }

    /// The same before it is rounded to bytes.
    pub fn render_pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile> {
        let ramp = Ramp::new(&self.stops)?;
        let area = scene.area(at);
        if area.is_empty() {
            return None;
        }
        // One more pixel on every side, for differences.
        let field = RampPositions::over(self, scene, area.grown(1).intersect(scene.pixels()));
        let mut pixels = transparent_f32();
        for y in scene.rows(area) {
            let row = (y - area.y0) as usize * TILE;
            for x in area.x0..area.x1 {
                let color = match self.filter {
                    ImageFilter::Bilinear => ramp.at(field.at(x, y)),
                    ImageFilter::Antialias => {
                        let (t, width) = (field.at(x, y), field.footprint(x, y, scene));
                        match self.style.is_closed() {
                            true => ramp.closed_mean(t, width),
                            false => ramp.mean(t, width),
                        }
                    }
                };
                pixels[row + (x - area.x0) as usize] = color;
            }
        }
        Some(PlanarTile::from_pixels(&pixels))
    }
}

/// Where every pixel center of a rectangle is on the ramp, before it is clamped.
struct RampPositions {
    style: RampStyle,
    rect: Rect,
    /// D(q) along the segment, in its lengths, from its beginning on.
    along: Vec<f32>,
    /// The same across it; empty where it does not matter.
    across: Vec<f32>,
    /// ∇ of both on a flat canvas.
    flat: [Vec2; 2],
}

impl RampPositions {
    fn over(gradient: &Gradient, scene: &Scene, rect: Rect) -> Self {
        let bend = gradient.bend();
        let mut d = DeformedRect::default();
        let deformation = Deformation::new(scene.surface.as_deref(), scene.size, &bend);
        let deformation = deformation.with_origin(BentFrame::origin(&gradient.frame));
        deformation.fill(rect, &mut d);
        let frame = BentFrame::of(&gradient.frame, rect, deformation.origin());
        if !frame.apply(&mut d.x, &mut d.y) && frame.linear != Affine2::IDENTITY {
            transform(frame.linear, &mut d.x, &mut d.y);
        }
        let (from, along) = (gradient.from, gradient.to - gradient.from);
        let squared = along.length_squared();
        if squared > 0.0 {
            let to_position = |axis: Vec2| -> Vec<f32> {
                let along = |(&x, &y)| (x - from.x) * axis.x + (y - from.y) * axis.y;
                d.x.iter().zip(&d.y).map(along).collect()
            };
            let axes = [along, along.perp()].map(|axis| axis / squared);
            let is_straight = matches!(gradient.style, RampStyle::Linear | RampStyle::Reflected);
            Self {
                style: gradient.style,
                rect,
                along: to_position(axes[0]),
                across: if is_straight { Vec::new() } else { to_position(axes[1]) },
                flat: axes.map(|axis| frame.linear.matrix2.transpose() * axis),
            }
        } else {
            // A segment of length 0: the whole canvas lies beyond its end.
            let style = RampStyle::Linear;
            let (along, across) = (vec![1.0; d.x.len()], Vec::new());
            Self { style, rect, along, across, flat: [Vec2::ZERO; 2] }
        }
    }

    fn index(&self, x: i32, y: i32) -> usize {
        (y - self.rect.y0) as usize * self.rect.width() + (x - self.rect.x0) as usize
    }

    /// Along and across.
    fn point(&self, x: i32, y: i32) -> Vec2 {
        let i = self.index(x, y);
        vec2(self.along[i], self.across.get(i).copied().unwrap_or(0.0))
    }

    fn at(&self, x: i32, y: i32) -> f32 {
        self.style.position(self.point(x, y))
    }

    /// |∇t|: the width of a pixel along the ramp. A box of that width has the variance of the
    /// pixel's square in every direction.
    ///
    /// Differences are taken only between neighbors of one surface; a pixel without neighbors
    /// counts as unbent.
    fn footprint(&self, x: i32, y: i32, scene: &Scene) -> f32 {
        let linked = scene
            .surface
            .as_deref()
            .map_or(0, |s| s.smooth_links_plane().at(x as usize, y as usize));
        let slope = |before: u8, after: u8, dx: i32, dy: i32, flat: Vec2| {
            let back = if linked & before != 0 { 1 } else { 0 };
            let ahead = if linked & after != 0 { 1 } else { 0 };
            match back + ahead {
                0 => flat,
                n => {
                    (self.point(x + ahead * dx, y + ahead * dy)
                        - self.point(x - back * dx, y - back * dy))
                        / n as f32
                }
            }
        };
        let [along, across] = self.flat;
        let dx = slope(links::LEFT, links::RIGHT, 1, 0, vec2(along.x, across.x));
        let dy = slope(links::UP, links::DOWN, 0, 1, vec2(along.y, across.y));
        let steepest = self.style.slope(self.point(x, y));
        dx.dot(steepest).hypot(dy.dot(steepest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    fn black_to_white(from: Vec2, to: Vec2) -> Gradient {
        Gradient::new(from, to, &[Color::BLACK, Color::WHITE])
    }

    fn pixel(gradient: &Gradient, x: i32, y: i32) -> [u8; 4] {
        let scene = Scene { size: Size::new(100, 100), surface: None };
        let at = TileAt::of_pixel(x, y);
        let tile = gradient.render_tile(&scene, at).unwrap();
        let i = ((y - at.rect().y0) as usize * TILE + (x - at.rect().x0) as usize) * 4;
        tile.bytes()[i..i + 4].try_into().unwrap()
    }

    #[test]
    fn the_ramp_runs_along_the_segment_and_is_constant_across_it() {
        let gradient = black_to_white(vec2(10.0, 50.0), vec2(90.0, 50.0));
        assert_eq!(pixel(&gradient, 5, 3), [0, 0, 0, 255]);
        assert_eq!(pixel(&gradient, 95, 97), [255; 4]);
        for y in [0, 40, 99] {
            // t = (49.5 + 0.5 − 10) / 80 at the center of pixel 49 is 0.49375.
            assert_eq!(pixel(&gradient, 49, y), [126, 126, 126, 255]);
        }
    }

    #[test]
    fn both_filters_agree_on_a_slow_ramp_and_differ_at_a_sharp_edge() {
        let slow = black_to_white(vec2(10.0, 20.0), vec2(90.0, 70.0));
        let exact = Gradient { filter: ImageFilter::Bilinear, ..slow.clone() };
        assert!(pixel(&slow, 44, 47)[0].abs_diff(pixel(&exact, 44, 47)[0]) <= 1);
        // The whole ramp from black to white is in the right half of pixel 50.
        let sharp = black_to_white(vec2(50.5, 0.0), vec2(51.0, 0.0));
        assert_eq!(pixel(&sharp, 50, 10)[0], 64);
        assert_eq!(pixel(&Gradient { filter: ImageFilter::Bilinear, ..sharp }, 50, 10)[0], 0);
    }

    #[test]
    fn ramps_run_outward_around_and_both_ways() {
        let line = black_to_white(vec2(50.0, 50.0), vec2(90.0, 50.0));
        let styled = |style| Gradient { style, ..line.clone() };
        let gray = |style, x, y| pixel(&styled(style), x, y)[0];
        // Pixel centers are 0.5 from the middle's corner.
        assert_eq!(gray(RampStyle::Radial, 50, 70), 131);
        assert_eq!(gray(RampStyle::Radial, 50, 29), 131);
        assert_eq!(gray(RampStyle::Reflected, 29, 3), 131);
        assert_eq!(gray(RampStyle::Diamond, 60, 60), 134);
        assert_eq!(gray(RampStyle::Angle, 50, 20), 63);
        assert_eq!(gray(RampStyle::Angle, 10, 49), 127);
    }

    #[test]
    fn a_closed_ramp_has_a_sharp_seam_and_its_mean_in_the_middle() {
        let style = RampStyle::Angle;
        let around = Gradient { style, ..black_to_white(vec2(50.0, 50.5), vec2(90.0, 50.5)) };
        // The seam runs through the middle of this row: half of both ends.
        assert!(pixel(&around, 80, 50)[0].abs_diff(127) <= 2);
        assert!(pixel(&around, 80, 49)[0] < 6 && pixel(&around, 80, 51)[0] > 249);
        assert!(pixel(&around, 49, 50)[0].abs_diff(127) < 20, "around the middle");
    }

    #[test]
    fn a_segment_without_length_shows_the_last_stop() {
        let gradient = black_to_white(vec2(30.0, 30.0), vec2(30.0, 30.0));
        assert_eq!(pixel(&gradient, 5, 5), [255; 4]);
    }

    #[test]
    fn beyond_the_canvas_nothing_is_painted() {
        let gradient = black_to_white(vec2(10.0, 50.0), vec2(90.0, 50.0));
        let scene = Scene { size: Size::new(100, 100), surface: None };
        assert!(gradient.render_tile(&scene, TileAt::new(2, 0)).is_none());
        let edge = gradient.render_tile(&scene, TileAt::new(1, 1)).unwrap();
        assert_eq!(&edge.bytes()[(TILE * TILE - 1) * 4..], [0; 4]);
    }
}
