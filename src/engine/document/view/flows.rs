//! Views of flows: hue is the direction in which a picture is compressed most, saturation the
//! amount, and the lines run along the direction of least change (SF fig. 2, 3). Floor 4.

use super::{ViewOptions, paint_pixels};
use crate::math::{Size, Vec2, Vec3, vec2, vec3};
use crate::raster::line_integral::{LineStyle, smear_noise};
use crate::raster::{Picture, Plane};
use crate::surface::{Bend, FlowField, Surface, links};

/// What one pixel shows.
#[derive(Clone, Copy, Default)]
struct FlowPixel {
    /// Unit or zero; image axes.
    line: Vec2,
    /// Unit or zero; image axes.
    hue_of: Vec2,
    /// `≥ 0`, in any unit: shown relative to those of the whole picture.
    magnitude: f32,
}

pub(super) fn of_depth(surface: &Surface, options: &ViewOptions) -> Picture {
    of_flow(FlowField::of_depth(surface), Some(surface), options)
}

pub(super) fn of_normals(surface: &Surface, options: &ViewOptions) -> Picture {
    of_flow(FlowField::of_normals(surface), Some(surface), options)
}

pub(super) fn of_operator(
    surface: Option<&Surface>,
    size: Size,
    bend: &Bend,
    options: &ViewOptions,
) -> Picture {
    of_flow(FlowField::of_deformation(surface, size, bend), surface, options)
}

fn of_flow(flow: FlowField, surface: Option<&Surface>, options: &ViewOptions) -> Picture {
    let flow = flow.smoothed(surface.map(Surface::coverage_plane), options.blur_px);
    let marks = Plane::from_fn(flow.size(), |x, y| {
        let direction = flow.at(x, y).eigen().direction;
        FlowPixel { line: direction.perp(), hue_of: direction, magnitude: flow.magnitude(x, y) }
    });
    draw_flows(&marks, surface)
}

/// Lines along u, the direction that curves most; hue u, saturation |k_u − k_v|.
pub(super) fn directions(surface: &Surface, options: &ViewOptions) -> Picture {
    let curvature = surface.curvature(options.blur_px);
    let marks = Plane::from_fn(surface.size(), |x, y| {
        let (ku, kv, u) = curvature.principal(x, y);
        // The direction in which the surface turns most, either way: for a groove this is across
        // it, where k_v < 0.
        let u = if ku.abs() >= kv.abs() { u } else { u.perp() };
        let u = vec2(u.x, -u.y);
        FlowPixel { line: u, hue_of: u, magnitude: (ku.abs() - kv.abs()).abs() }
    });
    draw_flows(&marks, Some(surface))
}

fn draw_flows(marks: &Plane<FlowPixel>, surface: Option<&Surface>) -> Picture {
    let covered = |x: usize, y: usize| surface.is_none_or(|s| s.coverage(x, y) > 0);
    let lines = marks.map(|mark| mark.line);
    let gray = smear_noise(&lines, LineStyle::for_size(marks.size()), |from, to| {
        surface.is_none_or(|s| is_passable(s.links_plane(), from, to))
    });
    let full = strong(marks, covered);
    paint_pixels(marks.size(), surface, |x, y| {
        let mark = marks.at(x, y);
        let saturation = 1.0 - (-1.5 * mark.magnitude / full).exp();
        let light = 0.25 + 0.75 * gray.at(x, y);
        (Vec3::ONE.lerp(hue(mark.hue_of), saturation) * light).to_array()
    })
}

/// Whether a line may go from a pixel to the next without leaving the surface; at a corner, along
/// both sides.
fn is_passable(plane: &Plane<u8>, from: (usize, usize), to: (usize, usize)) -> bool {
    let linked = |(x, y): (usize, usize), bit: u8| plane.at(x, y) & bit != 0;
    let across = if to.0 > from.0 { links::RIGHT } else { links::LEFT };
    let along = if to.1 > from.1 { links::DOWN } else { links::UP };
    match (to.0 != from.0, to.1 != from.1) {
        (false, false) => true,
        (true, false) => linked(from, across),
        (false, true) => linked(from, along),
        (true, true) => {
            linked(from, across) && linked((to.0, from.1), along)
                || linked(from, along) && linked((from.0, to.1), across)
        }
    }
}

/// The magnitude below which four fifths of the covered pixels stay; at least a tiny value.
fn strong(marks: &Plane<FlowPixel>, covered: impl Fn(usize, usize) -> bool) -> f32 {
    // A regular sample of the pixels is enough.
    let step = (marks.size().area() / 100_000).max(1);
    let mut sample: Vec<f32> = (0..marks.size().area())
        .step_by(step)
        .filter(|i| covered(i % marks.width(), i / marks.width()))
        .map(|i| marks.values()[i].magnitude)
        .collect();
    if sample.is_empty() {
        return 1.0;
    }
    let at = sample.len() * 4 / 5;
    sample.select_nth_unstable_by(at, f32::total_cmp).1.max(1e-4)
}

/// The color of a direction; opposite directions have the same. Horizontal is red, and hues run
/// counter-clockwise as seen.
fn hue(direction: Vec2) -> Vec3 {
    let turn = (-direction.y).atan2(direction.x) / std::f32::consts::PI;
    let channel = |offset: f32| {
        let t = (turn + offset).rem_euclid(1.0) * 6.0;
        ((t - 3.0).abs() - 1.0).clamp(0.0, 1.0)
    };
    vec3(channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposite_directions_have_one_color_and_crossing_ones_opposite_colors() {
        let d = vec2(0.8, 0.6);
        assert!((hue(d) - hue(-d)).length() < 1e-5);
        assert!((hue(d) + hue(d.perp()) - Vec3::ONE).length() < 1e-4);
        assert_eq!(hue(Vec2::X), vec3(1.0, 0.0, 0.0));
    }
}
