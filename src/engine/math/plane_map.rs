//! Maps of the plane onto itself: affine and perspective ones, from a layer's own frame to the
//! canvas. Floor 0. Not here: what pixels become under a map (`raster::warp`).

use super::{Affine2, Mat2, Rect, Size, Vec2, vec2};
use glam::{DMat2, DMat3, DVec2, DVec3, dvec2};

/// An invertible projective map, with its inverse. In f64: maps are composed, and ten turns of 36°
/// must give the identity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneMap {
    forward: DMat3,
    backward: DMat3,
}

/// A map that moves every pixel onto one other pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelMove {
    /// Where the pixel's step to the right leads, and its step down: unit vectors along the axes.
    pub right: (i32, i32),
    /// Where the next pixel below goes.
    pub down: (i32, i32),
    /// Where the corner (0, 0) of the plane goes.
    pub origin: (i32, i32),
}

/// A map whose positions are within this distance of a simpler map's is replaced by it, px: far
/// below what a byte shows.
const SAME_PX: f64 = 1.0 / 512.0;

/// Farther than any pixel lies.
const FAR: f32 = 1e7;
const EVERYWHERE: Rect =
    Rect { x0: -(FAR as i32), y0: -(FAR as i32), x1: FAR as i32, y1: FAR as i32 };

impl Default for PlaneMap {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl PlaneMap {
    /// Every point stays.
    pub const IDENTITY: PlaneMap = PlaneMap { forward: DMat3::IDENTITY, backward: DMat3::IDENTITY };

    /// x′ = a x + c y + e, y′ = b x + d y + f. `None` if numbers are not finite or the map cannot
    /// be inverted.
    pub fn affine([a, b, c, d, e, f]: [f64; 6]) -> Option<Self> {
        Self::of(DMat3::from_cols_array(&[a, b, 0.0, c, d, 0.0, e, f, 1.0]))
    }

    /// Every point moves by the same vector, px.
    pub fn translation(by: Vec2) -> Self {
        let by = by.as_dvec2();
        Self { forward: DMat3::from_translation(by), backward: DMat3::from_translation(-by) }
    }

    /// The whole of one canvas over the whole of another.
    pub fn scaling(from: Size, to: Size) -> Self {
        let side = |to: u32, from: u32| f64::from(to) / f64::from(from.max(1));
        let (x, y) = (side(to.width, from.width), side(to.height, from.height));
        Self::affine([x, 0.0, 0.0, y, 0.0, 0.0]).unwrap_or_default()
    }

    /// A turn counter-clockwise as seen about a point, degrees.
    pub fn rotation(degrees: f64, about: Vec2) -> Self {
        // y points down, so counter-clockwise as seen is a negative angle.
        let angle = -degrees.to_radians();
        let about = about.as_dvec2();
        let map = |angle| {
            DMat3::from_translation(about)
                * DMat3::from_angle(angle)
                * DMat3::from_translation(-about)
        };
        Self { forward: map(angle), backward: map(-angle) }
    }

    /// The perspective in which the corners of a canvas (upper left, upper right, lower right,
    /// lower left) go to four points. `None` unless these form a convex quadrilateral.
    pub fn quad(canvas: Size, corners: [DVec2; 4]) -> Option<Self> {
        Self::rect_to_quad(
            DVec2::ZERO,
            dvec2(f64::from(canvas.width), f64::from(canvas.height)),
            corners,
        )
    }

    /// The same for the corners of a box.
    pub fn rect_to_quad(low: DVec2, high: DVec2, corners: [DVec2; 4]) -> Option<Self> {
        let convex = (0..4).map(|i| {
            let [a, b, c] = [corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4]];
            (b - a).perp_dot(c - b)
        });
        let signs: Vec<f64> = convex.collect();
        if !(signs.iter().all(|s| *s > 0.0) || signs.iter().all(|s| *s < 0.0)) {
            return None;
        }
        // Heckbert 1989: the unit square to a quadrilateral, in closed form.
        let [p0, p1, p2, p3] = corners;
        let (d1, d2, s) = (p1 - p2, p3 - p2, p0 - p1 + p2 - p3);
        let det = d1.perp_dot(d2);
        let (g, h) = (s.perp_dot(d2) / det, d1.perp_dot(s) / det);
        let (right, down) = (p1 - p0 + p1 * g, p3 - p0 + p3 * h);
        let unit = DMat3::from_cols(right.extend(g), down.extend(h), p0.extend(1.0));
        Self::of(unit * DMat3::from_scale((high - low).recip()) * DMat3::from_translation(-low))
    }

    fn of(forward: DMat3) -> Option<Self> {
        // Scaled so that the least and the greatest determinants are judged alike on every canvas.
        let determinant = forward.determinant();
        if !forward.is_finite() || determinant.abs() < 1e-12 {
            return None;
        }
        let backward = forward.inverse();
        backward.is_finite().then_some(Self { forward, backward })
    }

    /// First this map, then `outer`.
    pub fn then(&self, outer: &PlaneMap) -> PlaneMap {
        Self { forward: outer.forward * self.forward, backward: self.backward * outer.backward }
    }

    /// The way back.
    pub fn inverse(&self) -> PlaneMap {
        Self { forward: self.backward, backward: self.forward }
    }

    /// a, b, c, d, e, f of an affine map.
    pub fn coefficients(&self) -> Option<[f64; 6]> {
        let [a, b, g, c, d, h, e, f, i] = self.forward.to_cols_array();
        (g == 0.0 && h == 0.0).then(|| [a, b, c, d, e, f].map(|v| v / i))
    }

    /// The same to fifteen digits: short in a file, and without what composing maps rounded.
    pub fn coefficients_as_written(&self) -> Option<[f64; 6]> {
        Some(self.coefficients()?.map(round_as_written))
    }

    /// The same without a perspective; `None` if it has one.
    pub fn as_affine(&self) -> Option<Affine2> {
        let c = self.coefficients()?.map(|v| v as f32);
        Some(Affine2::from_cols_array(&c))
    }

    /// Where a point of the frame lies on the canvas. `None` if it lies beyond the horizon.
    pub fn to_canvas(&self, p: Vec2) -> Option<Vec2> {
        project(&self.forward, p).map(|(q, _)| q)
    }

    /// The point of the frame at a canvas point, and ∂p/∂q there. `None` beyond the horizon.
    pub fn from_canvas(&self, q: Vec2) -> Option<(Vec2, Mat2)> {
        project(&self.backward, q)
    }

    /// The points that a row of canvas points shows, 1 px apart from `first` on, to the bit as
    /// [`PlaneMap::from_canvas`] finds them; points too far away are NaN. For a perspective, whose
    /// points are not evenly spaced, nothing is done and `false` returned.
    ///
    /// * `xs`, `ys`: one for each point wanted.
    pub fn affine_row_from_canvas(&self, first: Vec2, xs: &mut [f32], ys: &mut [f32]) -> bool {
        let [along, down, origin] =
            [self.backward.x_axis, self.backward.y_axis, self.backward.z_axis];
        if along.z != 0.0 || down.z != 0.0 || origin.z <= 1e-9 {
            return false;
        }
        let from = down * f64::from(first.y);
        even_row([along.x, from.x, origin.x, origin.z], first.x, xs);
        even_row([along.y, from.y, origin.y, origin.z], first.x, ys);
        true
    }

    /// ∂q/∂p at a point of the frame; `None` beyond the horizon.
    pub fn stretch_at(&self, p: Vec2) -> Option<Mat2> {
        project(&self.forward, p).map(|(_, jacobian)| jacobian)
    }

    /// A rectangle of the frame that holds everything a rectangle of the canvas shows, with room
    /// for a filter; the whole plane if the rectangle reaches beyond the horizon.
    pub fn source_rect(&self, canvas: Rect) -> Rect {
        let corner = |x: i32, y: i32| self.from_canvas(vec2(x as f32, y as f32));
        let Rect { x0, y0, x1, y1 } = canvas;
        let corners = [corner(x0, y0), corner(x1, y0), corner(x1, y1), corner(x0, y1)];
        let Some(corners) = corners.into_iter().collect::<Option<Vec<_>>>() else {
            return EVERYWHERE;
        };
        let (mut low, mut high, mut reach) = (Vec2::INFINITY, Vec2::NEG_INFINITY, 1.0f32);
        for (p, jacobian) in corners {
            (low, high) = (low.min(p), high.max(p));
            reach = reach.max(jacobian.x_axis.length() + jacobian.y_axis.length());
        }
        let side = |v: f32| v.max(-FAR).min(FAR) as i32;
        let reach = 2.0 + reach;
        Rect::new(
            side(low.x - reach),
            side(low.y - reach),
            side(high.x + reach) + 1,
            side(high.y + reach) + 1,
        )
    }

    /// Whether it leaves everything on a canvas in place, within far less than a byte shows.
    pub fn is_identity_on(&self, canvas: Size) -> bool {
        self.pixel_move_on(canvas) == Some(PixelMove::NONE)
    }

    /// Whether it takes every point of a frame to the same place as another map, within far less
    /// than a byte shows.
    pub fn is_same_on(&self, other: &PlaneMap, frame: Size) -> bool {
        let (w, h) = (frame.width as f32, frame.height as f32);
        [vec2(0.0, 0.0), vec2(w, 0.0), vec2(w, h), vec2(0.0, h)].into_iter().all(|corner| {
            let both = self.to_canvas(corner).zip(other.to_canvas(corner));
            both.is_some_and(|(a, b)| (a - b).abs().max_element() <= SAME_PX as f32)
        })
    }

    /// The move of whole pixels that it is on a canvas: a shift, quarter turns, mirrors.
    pub fn pixel_move_on(&self, canvas: Size) -> Option<PixelMove> {
        let [a, b, c, d, e, f] = self.coefficients()?;
        let whole = [a, b, c, d, e, f].map(f64::round);
        let reach = f64::from(canvas.longer_side());
        let off = |i: usize, j: usize, k: usize, v: [f64; 6]| {
            ((v[i] - whole[i]).abs() + (v[j] - whole[j]).abs()) * reach + (v[k] - whole[k]).abs()
        };
        let coefficients = [a, b, c, d, e, f];
        if off(0, 2, 4, coefficients).max(off(1, 3, 5, coefficients)) > SAME_PX {
            return None;
        }
        // Other scales and farther moves are none, and may not fit into an `i32`.
        let is_move = whole[..4].iter().all(|v| v.abs() <= 1.0)
            && whole[4..].iter().all(|v| v.abs() <= f64::from(FAR));
        if !is_move {
            return None;
        }
        let [a, b, c, d, e, f] = whole.map(|v| v as i32);
        let turns = (a * d - b * c).abs() == 1 && a.abs() + b.abs() == 1 && c.abs() + d.abs() == 1;
        turns.then_some(PixelMove { right: (a, b), down: (c, d), origin: (e, f) })
    }
}

impl PixelMove {
    /// Every pixel stays.
    pub const NONE: PixelMove = PixelMove { right: (1, 0), down: (0, 1), origin: (0, 0) };

    /// The pixel of the frame that a pixel of the canvas shows.
    pub fn source(&self, x: i32, y: i32) -> (i32, i32) {
        // Centers are half a pixel in. The matrix is orthogonal, so its inverse is its transpose.
        let (dx, dy) = (2 * (x - self.origin.0) + 1, 2 * (y - self.origin.1) + 1);
        let along = |axis: (i32, i32)| (axis.0 * dx + axis.1 * dy - 1).div_euclid(2);
        (along(self.right), along(self.down))
    }

    /// Where a pixel of the frame goes: the inverse of [`PixelMove::source`].
    pub fn target(&self, x: i32, y: i32) -> (i32, i32) {
        let (dx, dy) = self.turned(2 * x + 1, 2 * y + 1);
        ((dx + 2 * self.origin.0 - 1).div_euclid(2), (dy + 2 * self.origin.1 - 1).div_euclid(2))
    }

    /// A step of the frame as one of the canvas.
    pub fn turned(&self, dx: i32, dy: i32) -> (i32, i32) {
        (self.right.0 * dx + self.down.0 * dy, self.right.1 * dx + self.down.1 * dy)
    }

    /// Any vector of the frame as one of the canvas.
    pub fn turned_vector(&self, v: Vec2) -> Vec2 {
        let as_vec = |(x, y): (i32, i32)| vec2(x as f32, y as f32);
        as_vec(self.right) * v.x + as_vec(self.down) * v.y
    }
}

/// The turn, or the mirror and turn, that is nearest to a map's matrix: its orthogonal factor. The
/// identity for one that only scales.
pub fn orthogonal(matrix: Mat2) -> Mat2 {
    let mirror =
        Mat2::from_diagonal(vec2(if matrix.determinant() < 0.0 { -1.0 } else { 1.0 }, 1.0));
    let m = matrix * mirror;
    let (sine, cosine) = (m.x_axis.y - m.y_axis.x, m.x_axis.x + m.y_axis.y);
    let length = sine.hypot(cosine);
    if !(length > 0.0 && length.is_finite()) {
        return mirror;
    }
    let (sine, cosine) = (sine / length, cosine / length);
    Mat2::from_cols(vec2(cosine, sine), vec2(-sine, cosine)) * mirror
}

/// A number to fifteen digits, and no more than fifteen after the point.
pub fn round_as_written(v: f64) -> f64 {
    let text = if v.abs() < 1.0 { format!("{v:.15}") } else { format!("{v:.14e}") };
    // −0 becomes 0.
    text.parse().unwrap_or(v) + 0.0
}

crate::widest! {
    /// One coordinate of a row of points under an affine map, in the order in which a matrix is
    /// multiplied.
    fn even_row(map: [f64; 4], first: f32, out: &mut [f32]) {
        let [along, from, origin, scale] = map;
        for (k, v) in out.iter_mut().enumerate() {
            let x = f64::from(first + k as u32 as f32);
            *v = ((along * x + from + origin) / scale) as f32;
        }
    }
}

/// A point under a projective map, and the map's Jacobian there.
fn project(map: &DMat3, p: Vec2) -> Option<(Vec2, Mat2)> {
    let v = *map * DVec3::new(f64::from(p.x), f64::from(p.y), 1.0);
    // The horizon: beyond it a point would come back mirrored.
    if v.z <= 1e-9 {
        return None;
    }
    let q = v.truncate() / v.z;
    let [x, y] = [map.x_axis, map.y_axis].map(|axis| (axis.truncate() - q * axis.z) / v.z);
    let jacobian = DMat2::from_cols(x, y).as_mat2();
    (q.is_finite() && jacobian.is_finite()).then(|| (vec2(q.x as f32, q.y as f32), jacobian))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CANVAS: Size = Size::new(400, 300);

    #[test]
    fn a_map_of_numbers_beyond_32_bits_moves_no_whole_pixels() {
        for far in [[4e9, 0.0, 0.0, 4e9, 0.0, 0.0], [1e9, -2e9, 2e9, 1e9, 0.0, 0.0]] {
            let map = PlaneMap::affine(far).unwrap();
            assert!(map.pixel_move_on(CANVAS).is_none() && !map.is_identity_on(CANVAS));
        }
        let far = PlaneMap::affine([1.0, 0.0, 0.0, 1.0, 1e12, 0.0]).unwrap();
        assert!(far.pixel_move_on(CANVAS).is_none());
    }

    #[test]
    fn ten_turns_of_36_degrees_leave_every_pixel() {
        let turn = PlaneMap::rotation(36.0, vec2(200.0, 150.0));
        let all = (0..10).fold(PlaneMap::IDENTITY, |map, _| map.then(&turn));
        assert!(all.is_identity_on(CANVAS));
        assert!(!turn.is_identity_on(CANVAS));
    }

    #[test]
    fn quarter_turns_and_mirrors_move_pixels_onto_pixels() {
        // Counter-clockwise as seen: what was on the right is on top.
        let turn = PlaneMap::rotation(90.0, vec2(50.0, 50.0)).pixel_move_on(CANVAS).unwrap();
        assert_eq!(turn.source(10, 0), (99, 10));
        let mirror = PlaneMap::affine([-1.0, 0.0, 0.0, 1.0, 100.0, 0.0])
            .unwrap()
            .pixel_move_on(CANVAS)
            .unwrap();
        assert_eq!(mirror.source(0, 7), (99, 7));
        for by in [turn, mirror] {
            assert_eq!(by.target(by.source(31, 8).0, by.source(31, 8).1), (31, 8));
        }
        let shift = PlaneMap::translation(vec2(7.0, -3.0)).pixel_move_on(CANVAS).unwrap();
        assert_eq!(shift.source(7, 0), (0, 3));
        assert_eq!(PlaneMap::translation(vec2(0.5, 0.0)).pixel_move_on(CANVAS), None);
    }

    #[test]
    fn a_quad_takes_the_corners_where_they_are_to_go_and_back() {
        let corners =
            [dvec2(20.0, 10.0), dvec2(350.0, 40.0), dvec2(300.0, 280.0), dvec2(5.0, 200.0)];
        let map = PlaneMap::quad(CANVAS, corners).unwrap();
        let of = [vec2(0.0, 0.0), vec2(400.0, 0.0), vec2(400.0, 300.0), vec2(0.0, 300.0)];
        for (p, q) in of.into_iter().zip(corners) {
            let found = map.to_canvas(p).unwrap();
            assert!((found.as_dvec2() - q).length() < 1e-3, "{found} for {q}");
            assert!((map.from_canvas(found).unwrap().0 - p).length() < 1e-2);
        }
        // Differences agree with the Jacobian.
        let (p, jacobian) = map.from_canvas(vec2(120.0, 90.0)).unwrap();
        let (ahead, _) = map.from_canvas(vec2(120.5, 90.0)).unwrap();
        assert!(((ahead - p) / 0.5 - jacobian.x_axis).length() < 1e-2);
        // Straight lines stay straight: the diagonals meet where the canvas's do.
        assert!(map.to_canvas(vec2(200.0, 150.0)).is_some());
        let crossed = [corners[0], corners[2], corners[1], corners[3]];
        assert_eq!(PlaneMap::quad(CANVAS, crossed), None, "crossed sides");
    }

    #[test]
    fn the_orthogonal_factor_of_a_map_is_its_turn_and_mirror() {
        let turn = Mat2::from_angle(0.7);
        for matrix in [turn * 3.0, turn * Mat2::from_diagonal(vec2(-1.0, 1.0)) * 0.5] {
            let found = orthogonal(matrix);
            assert!(
                (found - matrix * matrix.determinant().abs().sqrt().recip())
                    .abs()
                    .x_axis
                    .max_element()
                    < 1e-6
            );
        }
        assert_eq!(orthogonal(Mat2::from_diagonal(vec2(2.0, 5.0))), Mat2::IDENTITY);
        assert_eq!(orthogonal(Mat2::ZERO), Mat2::IDENTITY);
    }

    #[test]
    fn what_cannot_be_inverted_is_no_map() {
        assert_eq!(PlaneMap::affine([1.0, 2.0, 2.0, 4.0, 0.0, 0.0]), None);
        assert_eq!(PlaneMap::affine([f64::NAN, 0.0, 0.0, 1.0, 0.0, 0.0]), None);
    }
}
