//! What is painted and of no flat color, such as lines and specks, is given to the areas beside
//! it. Floor 3.

use super::areas::{pixels, spread};
use super::palette::NOTHING;
use super::picture::{Between, FlatPicture, MOSTLY, MixedPixel};
use crate::raster::Plane;

/// The border of two areas in the middle of a line is drawn through the pixels this far around, px.
const AROUND: i32 = 3;
/// How wide the edge there is, px: wide enough that both areas meet in some pixel everywhere.
const EDGE_PX: f32 = 1.25;

/// What is given to areas.
pub struct Given {
    /// Which pixels are.
    pub is_given: Plane<bool>,
    /// Those that two areas share.
    pub mixed: Vec<MixedPixel>,
    /// The number of the nearest area for every painted pixel, one more; 0 where there is none.
    pub nearest: Plane<u32>,
}

/// Gives opaque pixels that no area takes to the nearest one.
pub fn complete(owner: &mut Plane<u16>, picture: &FlatPicture, between: &[Between]) -> Given {
    let mut is_missing = Plane::from_fn(owner.size(), |x, y| {
        owner.at(x, y) > NOTHING && picture.pixels.at(x, y)[3] == 255
    });
    between.iter().for_each(|mixed| is_missing.values_mut()[mixed.index] = false);
    let mut labels = owner.map(|of| if of < NOTHING { u32::from(of) + 1 } else { 0 });
    // On the way are pixels that are mixed of the lines and what is beside them.
    spread(&mut labels, |x, y| picture.pixels.at(x, y)[3] >= MOSTLY);
    let mut mixed = Vec::new();
    for (x, y) in pixels((owner.width(), owner.height())) {
        let label = labels.at(x, y);
        if !is_missing.at(x, y) || label == 0 {
            continue;
        }
        match border_through(&labels, &is_missing, x, y) {
            Some((other, share @ 1..)) => {
                let sides = [label, other].map(|label| (label - 1) as u16);
                mixed.push(MixedPixel { index: y * owner.width() + x, sides, share });
            }
            _ => owner.set(x, y, (label - 1) as u16),
        }
    }
    Given { is_given: is_missing, mixed, nearest: labels }
}

/// The other area in a pixel of a line through which a border goes, and its share: as if the border
/// were straight.
fn border_through(
    labels: &Plane<u32>,
    is_missing: &Plane<bool>,
    x: usize,
    y: usize,
) -> Option<(u32, u8)> {
    let (own, (x, y)) = (labels.at(x, y), (x as i32, y as i32));
    let around = |reach: i32| {
        (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| (x + dx, y + dy)))
    };
    let is_other =
        |(x, y): &(i32, i32)| labels.get(*x, *y).is_some_and(|label| label > 0 && label != own);
    let (x1, y1) =
        around(1).filter(is_other).find(|(x, y)| is_missing.get(*x, *y) == Some(true))?;
    let other = labels.get(x1, y1)?;
    let count =
        |of: u32| around(AROUND).filter(|(x, y)| labels.get(*x, *y) == Some(of)).count() as f32;
    let (of_own, of_other) = (count(own), count(other));
    let from_border_px = (of_own / (of_own + of_other) - 0.5) * (2 * AROUND + 1) as f32;
    Some((other, ((0.5 - from_border_px / EDGE_PX).clamp(0.0, 1.0) * 255.0).round() as u8))
}
