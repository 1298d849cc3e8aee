//! One dab on one tile: F(A⁻¹(D(q) − q_0)) at every pixel it may touch.
//! Floor 3. Not here: where dabs stand (`path`), the tips (`profile`, `stamp`), how dabs add up to a stroke (`stroke`).

use super::path::Dab;
use super::profile::RoundProfile;
use super::scene::Scene;
use crate::math::{Rect, Vec2};
use crate::raster::TileAt;
use crate::raster::tile::{TILE, TILE_AREA};
use crate::surface::deformation::{Deformation, DeformedRect};
use crate::surface::reach::{BLOCK, Extent, Reach, TileBlocks};
use crate::surface::{Operator, Surface, links};

/// One dab on the canvas it is painted on.
pub struct PlacedDab<'s> {
    dab: Dab,
    scene: &'s Scene,
    /// `None` where D is the identity.
    bent: Option<(&'s Surface, Deformation<'s>)>,
    reach: Reach<'s>,
}

/// Half a pixel's width on either side: the box of the round tip's filter.
const ROUND_FILTER_PX: f32 = 0.5;

/// How far a round dab reaches.
pub fn round_extent(dab: &Dab) -> Extent {
    let profile = RoundProfile::new(dab.hardness, dab.softness);
    Extent { radius_px: dab.radius * profile.reach(), filter_px: ROUND_FILTER_PX }
}

impl<'s> PlacedDab<'s> {
    /// `extent`: of the tip's footprint.
    pub fn new(dab: Dab, operator: Operator, scene: &'s Scene, extent: Extent) -> Self {
        let surface = scene.surface.as_deref();
        let d = Deformation::of_dab(surface, scene.size, operator, dab.at);
        let bent = surface.filter(|_| !d.is_identity()).map(|s| (s, d));
        let reach = Reach::new(surface, scene.size, operator, dab.at, extent);
        Self { dab, scene, bent, reach }
    }
    pub fn reach(&self) -> &Reach<'s> {
        &self.reach
    }
    /// Adds a round tip's coverage to a tile, row by row: a ← a + f (1 − a), f = flow · F.
    pub fn add_round(&self, at: TileAt, coverage: &mut [f32; TILE_AREA], scratch: &mut DeformedRect) {
        let blocks = self.reach.blocks(at);
        let area = touched(&blocks, at).intersect(self.scene.size.rect());
        let tip = RoundTip::new(&self.dab);
        let field = self.bent.as_ref().map(|(surface, d)| Field::over(surface, d, area, scratch));
        for span in spans(&blocks, at, area) {
            let out = &mut coverage[span.start_in(at)..][..span.n];
            match &field {
                Some(field) => bent_row(field.around(span), &tip, out),
                None => flat_row(span.x as f32 + 0.5, span.y as f32 + 0.5, &tip, out),
            }
        }
    }
}

/// A row of pixels that a dab may touch.
#[derive(Clone, Copy)]
struct Span {
    x: i32,
    y: i32,
    n: usize,
}

impl Span {
    fn start_in(self, at: TileAt) -> usize {
        let tile = at.rect();
        (self.y - tile.y0) as usize * TILE + (self.x - tile.x0) as usize
    }
}

/// The smallest rectangle that holds the touched blocks of a tile.
fn touched(blocks: &TileBlocks, at: TileAt) -> Rect {
    let (tile, side) = (at.rect(), BLOCK as i32);
    let rows = blocks.iter().enumerate().filter(|(_, bits)| **bits != 0);
    rows.fold(Rect::EMPTY, |r, (row, bits)| {
        let y = tile.y0 + row as i32 * side;
        let x0 = tile.x0 + bits.trailing_zeros() as i32 * side;
        let x1 = tile.x0 + (8 - bits.leading_zeros() as i32) * side;
        r.union(Rect::new(x0, y, x1, y + side))
    })
}

/// The rows of `area`, each from its first to its last touched block.
fn spans(blocks: &TileBlocks, at: TileAt, area: Rect) -> impl Iterator<Item = Span> {
    let (blocks, tile, side) = (*blocks, at.rect(), BLOCK as i32);
    (area.y0..area.y1).filter_map(move |y| {
        let bits = blocks[(y - tile.y0) as usize / BLOCK];
        let x0 = (tile.x0 + bits.trailing_zeros() as i32 * side).max(area.x0);
        let x1 = (tile.x0 + (8 - bits.leading_zeros() as i32) * side).min(area.x1);
        (bits != 0 && x0 < x1).then(|| Span { x: x0, y, n: (x1 - x0) as usize })
    })
}

/// D over a rectangle and the pixels around it.
struct Field<'f> {
    surface: &'f Surface,
    rect: Rect,
    d: &'f DeformedRect,
}

impl<'f> Field<'f> {
    fn over(surface: &'f Surface, d: &Deformation, area: Rect, scratch: &'f mut DeformedRect) -> Self {
        let rect = area.grown(1);
        d.fill(rect, scratch);
        Self { surface, rect, d: scratch }
    }
    fn around(&self, span: Span) -> Around<'_> {
        let start = |y: i32| (y - self.rect.y0) as usize * self.rect.width() + (span.x - 1 - self.rect.x0) as usize;
        let row = |y: i32| {
            let range = start(y)..start(y) + span.n + 2;
            (&self.d.x[range.clone()], &self.d.y[range])
        };
        let linked = &self.surface.links_plane().row(span.y as usize)[span.x as usize..][..span.n];
        Around { above: row(span.y - 1), row: row(span.y), below: row(span.y + 1), linked }
    }
}

/// D of a span's pixels, of one more at each end, and of the rows above and below; (x, y) each.
#[derive(Clone, Copy)]
struct Around<'f> {
    above: (&'f [f32], &'f [f32]),
    row: (&'f [f32], &'f [f32]),
    below: (&'f [f32], &'f [f32]),
    /// Which neighbours continue the surface, one a pixel of the span.
    linked: &'f [u8],
}

/// A round dab made ready for the rows.
#[derive(Clone, Copy)]
struct RoundTip {
    at: Vec2,
    per_radius: f32,
    profile: RoundProfile,
    flow: f32,
}

impl RoundTip {
    fn new(dab: &Dab) -> Self {
        let profile = RoundProfile::new(dab.hardness, dab.softness);
        Self { at: dab.at, per_radius: 1.0 / dab.radius, profile, flow: dab.flow }
    }
    /// Adds the coverage of one pixel, `distance` px of the image plane from the centre and `width` px wide toward it.
    #[inline(always)]
    fn add(&self, coverage: &mut f32, distance: f32, width_squared: f32) {
        let per_radius = self.per_radius;
        let f = self.flow * self.profile.mean(distance * per_radius, width_squared * per_radius * per_radius);
        // `max` first turns NaN into nothing.
        *coverage += f.max(0.0).min(1.0) * (1.0 - *coverage);
    }
}

crate::widest! {
    /// Where D is the identity; (x, y) is the centre of the first pixel.
    fn flat_row(x: f32, y: f32, tip: &RoundTip, coverage: &mut [f32]) {
        let dy = y - tip.at.y;
        for (i, a) in coverage.iter_mut().enumerate() {
            let dx = x + i as f32 - tip.at.x;
            tip.add(a, (dx * dx + dy * dy).sqrt(), 1.0);
        }
    }
    /// The width of a pixel toward the centre is |Jᵀ p|, p the unit vector from the centre to D(q): J's columns are
    /// differences between linked neighbours, and those of the identity where there are none.
    fn bent_row(d: Around, tip: &RoundTip, coverage: &mut [f32]) {
        let n = coverage.len();
        let (cx, cy) = (&d.row.0[..n + 2], &d.row.1[..n + 2]);
        let (ax, ay) = (&d.above.0[..n + 2], &d.above.1[..n + 2]);
        let (bx, by) = (&d.below.0[..n + 2], &d.below.1[..n + 2]);
        let linked = &d.linked[..n];
        for i in 0..n {
            let (x, y) = (cx[i + 1] - tip.at.x, cy[i + 1] - tip.at.y);
            let distance = (x * x + y * y).sqrt();
            let per_distance = 1.0 / distance.max(1e-9);
            let (px, py) = (x * per_distance, y * per_distance);
            let toward = |qx: f32, qy: f32| (qx - cx[i + 1]) * px + (qy - cy[i + 1]) * py;
            let bits = u32::from(linked[i]);
            let across = slope(
                bits & u32::from(links::LEFT) != 0,
                bits & u32::from(links::RIGHT) != 0,
                toward(cx[i], cy[i]),
                toward(cx[i + 2], cy[i + 2]),
                px,
            );
            let along = slope(
                bits & u32::from(links::UP) != 0,
                bits & u32::from(links::DOWN) != 0,
                toward(ax[i + 1], ay[i + 1]),
                toward(bx[i + 1], by[i + 1]),
                py,
            );
            tip.add(&mut coverage[i], distance, across * across + along * along);
        }
    }
}

/// The derivative from the steps to two neighbours, of which only linked ones count; `flat` without any.
#[inline(always)]
fn slope(has_before: bool, has_after: bool, before: f32, after: f32, flat: f32) -> f32 {
    let back = if has_before { -before } else { 0.0 };
    let ahead = if has_after { after } else { 0.0 };
    let sum = back + ahead;
    let mean = if has_before & has_after { 0.5 * sum } else { sum };
    if has_before | has_after { mean } else { flat }
}
