//! Which way hatching lines go: the cross of principal directions, diffused by how directed the form
//! is and combed to one family, or the slope, or an angle on the paper, or along strokes (`guided`).
//! Floor 2. Angles are in the tangent plane, in the frame that S takes from the picture without
//! turning it (MATH 8).

use super::guided::guide_directions;
use super::stretch::{PixelStretch, root};
use super::{GuideLines, HatchSettings, HatchWay};
use crate::math::{Mat2, Vec2, vec2};
use crate::raster::Plane;
use crate::surface::form_lines::{SmoothNormals, blur_copy, diffuse_copy, gradient_of};
use crate::surface::operator::UnwrapSettings;
use crate::surface::unwrap::Unwrapping;
use crate::surface::{Surface, links};
use std::f32::consts::FRAC_PI_2;

/// What is added to the doubled direction everywhere, per px.
const HINT: f32 = 1e-5;
/// A form that bends alike in all directions takes its own from clearer ones around it, up to so many
/// times as far as directions spread.
const AROUND: [f32; 2] = [4.0, 16.0];
/// How clear directions are, of how much the form bends, where those around count wholly, and from
/// where on they do not.
const CLEAR: (f32, f32) = (0.1, 0.4);

/// The field that lines follow.
pub struct DirectionField<'s> {
    surface: &'s Surface,
    /// cos 2θ and sin 2θ of the first family at each pixel.
    doubled: Plane<[f32; 2]>,
    /// How the surface is stretched there.
    stretch: Plane<PixelStretch>,
}

/// The principal directions at a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Principal {
    /// Of the direction in which the surface bends most, in the tangent plane.
    pub angle: f32,
    /// How clear that is: half of how much more it bends there than across, per px.
    pub directed: f32,
    /// How much it bends: the mean of both, without their signs, per px.
    pub bend: f32,
}

/// K = −S⁻¹ (∂n̄/∂q) S⁻¹, made symmetric: the shape operator in the tangent plane.
///
/// * `slopes`: ∇n̄_x and ∇n̄_y.
/// * `root`: S.
pub fn principal(slopes: [Vec2; 2], root: Mat2) -> Principal {
    let inverse = root.inverse();
    // Columns of ∂n̄/∂q are the derivatives along x and y.
    let turn = Mat2::from_cols(vec2(slopes[0].x, slopes[1].x), vec2(slopes[0].y, slopes[1].y));
    let k = inverse * turn * inverse * -1.0;
    let (xx, yy) = (k.x_axis.x, k.y_axis.y);
    let xy = 0.5 * (k.x_axis.y + k.y_axis.x);
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let larger = 0.5 * xy.atan2(half);
    // The larger eigenvalue is the one that bends more if the mean is positive.
    let angle = if mean >= 0.0 { larger } else { larger + FRAC_PI_2 };
    let (half, mean) = (half.hypot(xy), mean.abs());
    // Half the difference of the absolute curvatures, and half their sum: nothing is clear on a
    // symmetric saddle.
    Principal { angle, directed: half.min(mean), bend: half.max(mean) }
}

impl<'s> DirectionField<'s> {
    pub fn of(
        surface: &'s Surface,
        normals: &'s SmoothNormals,
        settings: &HatchSettings,
        guides: &GuideLines,
    ) -> Self {
        let turned = settings.angle.to_radians();
        let of_angle = |angle: &(dyn Fn(usize, usize) -> f32 + Sync)| {
            let angles = Plane::from_fn(surface.size(), angle);
            [f32::cos, f32::sin].map(|of| angles.map(move |angle| of(2.0 * angle)))
        };
        let doubled = match settings.way {
            HatchWay::Paper => of_angle(&|x, y| {
                // y down: counter-clockwise as seen is negative.
                let way = vec2(turned.cos(), -turned.sin());
                let on_surface = root(normals, x, y) * way;
                on_surface.y.atan2(on_surface.x)
            }),
            HatchWay::Slope => {
                let nbar = |i: usize| diffuse_copy(&normals.planes[i], surface, settings.spread);
                let [nx, ny] = [nbar(0), nbar(1)];
                of_angle(&|x, y| ny.at(x, y).atan2(nx.at(x, y)) - turned)
            }
            HatchWay::Wires => {
                let along = vec2(turned.cos(), -turned.sin());
                let unwrapped = surface.unwrapping(UnwrapSettings::OF_WIRES);
                of_angle(&|x, y| wire_angle(&unwrapped, surface, normals, along, (x, y)))
            }
            HatchWay::Guides => {
                let form = of_form(surface, normals, settings, -turned);
                guide_directions(surface, normals, guides, -turned, form)
            }
            HatchWay::Around => of_form(surface, normals, settings, -turned),
            HatchWay::Along => of_form(surface, normals, settings, FRAC_PI_2 - turned),
        };
        let unit = |x: usize, y: usize| {
            let way = vec2(doubled[0].at(x, y), doubled[1].at(x, y));
            way.normalize_or(Vec2::X).to_array()
        };
        let doubled = Plane::from_fn(surface.size(), unit);
        let stretch = Plane::from_fn(surface.size(), |x, y| PixelStretch::of(normals, x, y));
        Self { surface, doubled, stretch }
    }

    /// S at a pixel.
    pub fn root(&self, x: usize, y: usize) -> Mat2 {
        self.stretch.at(x, y).root()
    }

    /// S⁻¹ at a pixel.
    pub fn inverse_root(&self, x: usize, y: usize) -> Mat2 {
        self.stretch.at(x, y).inverse_root()
    }

    /// Whether a pixel and the one that a step leads to are of one piece.
    pub fn is_joined(&self, from: (usize, usize), to: (usize, usize)) -> bool {
        let all = self.surface.links_plane();
        let linked = |at: (usize, usize), bit: u8| all.at(at.0, at.1) & bit != 0;
        let across = match to.0 as isize - from.0 as isize {
            0 => true,
            1 => linked((from.0, from.1), links::RIGHT),
            -1 => linked((from.0, from.1), links::LEFT),
            _ => false,
        };
        let down = match to.1 as isize - from.1 as isize {
            0 => true,
            1 => linked((to.0, from.1), links::DOWN),
            -1 => linked((to.0, from.1), links::UP),
            _ => false,
        };
        across && down
    }

    /// Whether a pixel shows the surface wholly.
    pub fn is_on(&self, x: usize, y: usize) -> bool {
        self.surface.coverage(x, y) >= 128
    }

    /// The direction of a family at a place, unit, in the tangent plane: of both, the one nearer to
    /// `near`.
    pub fn direction(&self, at: Vec2, family: u8, near: Vec2) -> Vec2 {
        let along = halve_angle(self.interpolate(at));
        let way = if family == 0 { along } else { along.perp() };
        if way.dot(near) < 0.0 { -way } else { way }
    }

    /// The doubled direction between pixels, of those that are linked to the nearest.
    fn interpolate(&self, at: Vec2) -> Vec2 {
        let size = self.surface.size();
        let (w, h) = (size.width as i32, size.height as i32);
        let middle = ((at.x as i32).clamp(0, w - 1), (at.y as i32).clamp(0, h - 1));
        let corner = at - 0.5;
        let (x, y) = (corner.x.floor() as i32, corner.y.floor() as i32);
        let (fx, fy) = (corner.x - x as f32, corner.y - y as f32);
        let own = (middle.0 as usize, middle.1 as usize);
        let is_inside = x >= 0 && y >= 0 && x < w && y < h;
        let links = self.surface.links_plane();
        if is_inside && links::is_one_piece(links, x as usize, y as usize) {
            let (x, y) = (x as usize, y as usize);
            let row = |y: usize| {
                let [left, right] = [x, x + 1].map(|x| Vec2::from(self.doubled.at(x, y)));
                left + fx * (right - left)
            };
            let (above, below) = (row(y), row(y + 1));
            return above + fy * (below - above);
        }
        let mut sum = Vec2::ZERO;
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let weight = if dx == 1 { fx } else { 1.0 - fx } * if dy == 1 { fy } else { 1.0 - fy };
            let (px, py) = ((x + dx).clamp(0, w - 1), (y + dy).clamp(0, h - 1));
            let there = (px as usize, py as usize);
            let from = if self.is_joined(own, there) { there } else { own };
            sum += weight * Vec2::from(self.doubled.at(from.0, from.1));
        }
        sum
    }
}

/// The angle in the tangent plane of what runs along a direction of the unwrapped plane.
fn wire_angle(
    unwrapped: &Unwrapping,
    surface: &Surface,
    normals: &SmoothNormals,
    along: Vec2,
    (x, y): (usize, usize),
) -> f32 {
    let linked = surface.links_plane().at(x, y);
    let [u, v] = unwrapped.planes().map(|plane| gradient_of(plane, linked, x, y));
    // The inverse of (∇u, ∇v), but for its scale.
    let way = vec2(v.y * along.x - u.y * along.y, u.x * along.y - v.x * along.x);
    let on_surface = root(normals, x, y) * way;
    on_surface.y.atan2(on_surface.x)
}

/// The unit direction whose angle is half of another's, with cos ≥ 0: (1 + cos 2θ, sin 2θ) is along
/// it, and (sin 2θ, 1 − cos 2θ), where the other vanishes.
fn halve_angle(doubled: Vec2) -> Vec2 {
    let length = doubled.length();
    if length < 1e-12 {
        return Vec2::X;
    }
    if doubled.x >= 0.0 {
        return vec2(length + doubled.x, doubled.y).normalize();
    }
    let half = vec2(doubled.y, length - doubled.x).normalize();
    if half.x < 0.0 { -half } else { half }
}

/// e^{2iθ} of the direction in which the form bends most, weighted by how clear it is and diffused;
/// then turned. Where the form bends alike in all directions these would waver, and lines with them:
/// there what is diffused farther is added.
fn of_form(
    surface: &Surface,
    normals: &SmoothNormals,
    settings: &HatchSettings,
    turned: f32,
) -> [Plane<f32>; 2] {
    let found = Plane::from_fn(surface.size(), |x, y| {
        let linked = surface.links_plane().at(x, y);
        if linked == 0 {
            return Principal::default();
        }
        let slopes = [0, 1].map(|i| gradient_of(&normals.planes[i], linked, x, y));
        principal(slopes, root(normals, x, y))
    });
    // Where nothing is clear, as on a ball, lines lie level: a hint that weighs next to nothing.
    let weighted = |of: fn(f32) -> f32| {
        found.map(move |p| of(2.0 * (p.angle + turned)) * p.directed + of(2.0 * turned) * HINT)
    };
    let spread = |plane: Plane<f32>| diffuse_copy(&plane, surface, settings.spread);
    let bend = found.map(|p| p.bend + HINT);
    let ((c, s), bend) = rayon::join(
        || rayon::join(|| spread(weighted(f32::cos)), || spread(weighted(f32::sin))),
        || spread(bend),
    );
    let unclear = Plane::from_fn(surface.size(), |x, y| {
        let clear = c.at(x, y).hypot(s.at(x, y)) / bend.at(x, y);
        let t = ((CLEAR.1 - clear) / (CLEAR.1 - CLEAR.0)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    });
    let with_around = |near: &Plane<f32>| {
        let far = AROUND.map(|times| blur_copy(near, surface, times * settings.spread));
        Plane::from_fn(surface.size(), |x, y| {
            near.at(x, y) + unclear.at(x, y) * (far[0].at(x, y) + far[1].at(x, y))
        })
    };
    let (c, s) = rayon::join(|| with_around(&c), || with_around(&s));
    [c, s]
}
