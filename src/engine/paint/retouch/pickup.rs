//! Paint that a brush picks up on its way, and the color of its dabs: its own mixed with what it
//! holds. Floor 3. Colors are premultiplied, so that transparent pixels add nothing.

use super::pixels::RetouchPixels;
use crate::math::parallel;
use crate::math::srgb::Color;
use crate::paint::brush::Brush;
use crate::paint::dab::{DabScratch, PlacedDab, round_extent};
use crate::paint::dab_walker::Dab;
use crate::paint::dynamics::Property;
use crate::paint::rim::Rim;
use crate::paint::scene::Scene;
use crate::paint::stroke::dabs::tiles_of;
use crate::paint::stroke_tile::StrokeTile;
use crate::paint::tint;
use crate::raster::{TILE, TileAt};

/// Most paint is picked up in the middle: a soft round dab whose weights add up to half its disc.
const SOFT: f32 = 0.4;
/// A dab of fewer pixels than this reads each of them, a larger one reads this many.
const LOOKS: f32 = 1024.0;

/// What a brush holds of the paint that it picked up; `None` before its first dab.
pub(super) type PickedUpPaint = Option<[f32; 4]>;

/// The color that a dab paints, premultiplied: less than opaque if it picked up transparency. The
/// held paint changes.
///
/// With the paint there, c, and the length l: h ← l h + (1 − l) c, at the first dab h ← c. With the
/// amount a and the brush's own color b: a h + (1 − a) b.
pub(super) fn mix_color(
    brush: &Brush,
    own: Color,
    dab: &Dab,
    held: &mut PickedUpPaint,
    retouched: &RetouchPixels,
    scene: &Scene,
) -> [f32; 4] {
    let unit = |v: f32| v.max(0.0).min(1.0);
    let value = |property, plain: f32| unit(brush.dynamics.value(property, plain, &dab.inputs));
    let [r, g, b, _] = own.to_f32();
    if brush.is_picking_up() {
        let length = value(Property::PickupLength, brush.pickup.length);
        let length = if held.is_none() { 0.0 } else { length };
        if length < 1.0
            && let Some(there) = pick_up(brush, dab, retouched, scene)
        {
            let before = held.unwrap_or_default();
            *held = Some(std::array::from_fn(|c| there[c] + (before[c] - there[c]) * length));
        }
    }
    let amount = value(Property::Pickup, brush.pickup.amount);
    let own = [r, g, b, 1.0];
    let held = held.unwrap_or(own);
    let mixed: [f32; 4] = std::array::from_fn(|c| own[c] + (held[c] - own[c]) * amount);
    if tint::has_varied_color(brush) { vary_color(brush, mixed, dab) } else { mixed }
}

/// The mixed color, varied as the brush varies a dab's.
fn vary_color(brush: &Brush, mixed: [f32; 4], dab: &Dab) -> [f32; 4] {
    let alpha = mixed[3];
    let straight =
        |v: f32| if alpha > 0.0 { (255.0 * (v / alpha).max(0.0).min(1.0) + 0.5) as u8 } else { 0 };
    let [r, g, b] = [mixed[0], mixed[1], mixed[2]].map(straight);
    let [r, g, b, _] = tint::of(brush, Color { r, g, b, a: 255 }, &dab.inputs).to_f32();
    [r * alpha, g * alpha, b * alpha, alpha]
}

/// The mean of what lies under a dab; `None` if it is off the canvas.
fn pick_up(brush: &Brush, dab: &Dab, retouched: &RetouchPixels, scene: &Scene) -> Option<[f32; 4]> {
    let radius = (dab.radius * brush.pickup.radius).max(1.0);
    let plain = Dab { hardness: SOFT, softness: 0.0, thin: 1.0, rim: Rim::SOFT, ..*dab };
    let dab = Dab { radius, ratio: 1.0, flow: 1.0, ceiling: 1.0, ..plain };
    let placed = PlacedDab::new(dab, scene, round_extent(&dab));
    let stride = (radius * radius * std::f32::consts::PI / LOOKS).sqrt().max(1.0) as usize;
    let seen = |scratch: &mut DabScratch, at: &TileAt| {
        let mut stroke_tile = StrokeTile::one_color();
        placed.add_round(*at, &mut stroke_tile, scratch);
        let mut sum = [0.0f32; 5];
        let Some(coverage) = stroke_tile.coverage() else { return sum };
        let (mut reader, corner) = (retouched.reader(), at.rect());
        for (y, x) in
            (0..TILE).step_by(stride).flat_map(|y| (0..TILE).step_by(stride).map(move |x| (y, x)))
        {
            let weight = coverage[y * TILE + x];
            if weight > 0.0 {
                let [r, g, b, a] = reader.pixel(corner.x0 + x as i32, corner.y0 + y as i32);
                let add = [r, g, b, a, 1.0];
                sum = std::array::from_fn(|c| sum[c] + weight * add[c]);
            }
        }
        sum
    };
    let sums: Vec<[f32; 5]> = parallel::map_with(&tiles_of(&placed), DabScratch::default, seen);
    // In the tiles' order, whichever thread added them up.
    let sum = sums.iter().fold([0.0f32; 5], |all, sum| std::array::from_fn(|c| all[c] + sum[c]));
    (sum[4] > 0.0).then(|| [0, 1, 2, 3].map(|c| sum[c] / sum[4]))
}
