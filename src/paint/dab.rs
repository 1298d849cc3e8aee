//! One dab on one tile: F(A⁻¹(D(q) − q_0)) at every pixel it may touch.
//! Floor 3. Not here: where dabs stand (`laying`), the tips (`profile`, `stamp`), how dabs add up to a stroke (`stroke`).

mod covered;

pub use covered::Footprint;

use super::image::transform;
use super::laying::Dab;
use super::patches::Patches;
use super::profile::RoundProfile;
use super::scene::Scene;
use super::stamp::Stamp;
use super::wash::{DabPaint, Wash};
use crate::math::{Rect, Vec2, srgb::Color};
use crate::raster::sampler::Antialias;
use crate::raster::{Outside, TILE, TileAt};
use crate::surface::deformation::{Deformation, DeformedRect};
use crate::surface::reach::{BLOCK, Extent, Reach, TileBlocks};
use crate::surface::{Surface, links};

/// One dab on the canvas it is painted on.
pub struct PlacedDab<'s> {
    dab: Dab,
    scene: &'s Scene,
    deformation: Deformation<'s>,
    /// `None` where D is the identity.
    bent_over: Option<&'s Surface>,
    reach: Reach<'s>,
}

/// Half a pixel's width on either side: the box of the round tip's filter.
const ROUND_FILTER_PX: f32 = 0.5;

/// How far a round dab reaches.
pub fn round_extent(dab: &Dab) -> Extent {
    let profile = RoundProfile::new(dab.hardness, dab.softness);
    Extent { radius_px: dab.radius * profile.reach(), filter_px: ROUND_FILTER_PX }
}

/// Buffers of one dab, used again for the next.
#[derive(Default)]
pub struct DabScratch {
    deformed: DeformedRect,
    stamping: Stamping,
    /// Coverage of a row, or of a part of a tile.
    covered: Vec<f32>,
    /// What a picture tip brings to a part of a tile.
    stamped: Vec<[u8; 4]>,
}

/// What reading a picture tip takes.
#[derive(Default)]
struct Stamping {
    patches: Patches,
    /// Made for the first stamp: round dabs do without.
    antialias: Option<Box<Antialias>>,
    row: Vec<[u8; 4]>,
}

impl<'s> PlacedDab<'s> {
    /// `extent`: of the tip's footprint.
    pub fn new(dab: Dab, scene: &'s Scene, extent: Extent) -> Self {
        let surface = scene.surface.as_deref();
        let deformation = Deformation::of_dab(surface, scene.size, dab.operator, dab.at);
        let bent_over = surface.filter(|_| !deformation.is_identity());
        let reach = Reach::new(surface, scene.size, dab.operator, dab.at, extent);
        Self { dab, scene, deformation, bent_over, reach }
    }
    pub fn dab(&self) -> &Dab {
        &self.dab
    }
    pub fn reach(&self) -> &Reach<'s> {
        &self.reach
    }
    /// What it brings of the stroke's colours; `None`: a stamp's own.
    fn paint(&self, color: Option<Color>) -> DabPaint {
        DabPaint { flow: self.dab.flow, ceiling: self.dab.ceiling, color }
    }
    /// Adds a round tip to a tile, row by row: a ← a + f (c − a), f = flow · F, up to its ceiling c.
    pub fn add_round(&self, at: TileAt, wash: &mut Wash, scratch: &mut DabScratch) {
        let blocks = self.reach.blocks(at);
        let area = touched(&blocks, at).intersect(self.scene.size.rect());
        let mut tip = RoundTip::new(&self.dab);
        let DabScratch { deformed, covered, .. } = scratch;
        let field = self.bent_over.map(|surface| {
            self.deformation.fill(area.grown(1), deformed);
            Field { surface, rect: area.grown(1), d: deformed }
        });
        let add = |span: Span, tip: &RoundTip, out: &mut [f32]| match &field {
            Some(field) => bent_row(field.around(span), tip, out),
            None => flat_row(span.x as f32 + 0.5, span.y as f32 + 0.5, tip, out),
        };
        if wash.is_one_color() {
            for span in spans(&blocks, at, area) {
                add(span, &tip, wash.coverage(span.start_in(at), span.n));
            }
            return;
        }
        // The ceiling is the wash's to keep, which knows the coverage.
        tip.ceiling = 1.0;
        for span in spans(&blocks, at, area) {
            covered.clear();
            covered.resize(span.n, 0.0);
            add(span, &tip, covered);
            wash.cover(span.start_in(at), covered, DabPaint { flow: 1.0, ..self.paint(Some(self.dab.color)) });
        }
    }
    /// Adds a picture tip to a tile: its mean over the patch of the image plane under each pixel.
    pub fn add_stamp(&self, stamp: &Stamp, at: TileAt, wash: &mut Wash, scratch: &mut DabScratch) {
        let blocks = self.reach.blocks(at);
        let area = touched(&blocks, at).intersect(self.scene.size.rect());
        let DabScratch { deformed, stamping: Stamping { patches, antialias, row }, .. } = scratch;
        let texels_from_canvas = stamp.texels_from_canvas(&self.dab);
        self.deformation.fill(area.grown(1), deformed);
        transform(texels_from_canvas, &mut deformed.x, &mut deformed.y);
        let antialias = antialias.get_or_insert_default();
        row.resize(area.width(), [0; 4]);
        let paint = self.paint((!stamp.is_colored).then_some(self.dab.color));
        for span in spans(&blocks, at, area) {
            let patches = patches.row(self.scene, area, span.y, deformed, texels_from_canvas);
            antialias.row(stamp.texture(), patches, Outside::None, row);
            let from = (span.x - area.x0) as usize;
            wash.stamp(span.start_in(at), &row[from..from + span.n], paint);
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
fn spans(blocks: &TileBlocks, at: TileAt, area: Rect) -> impl Iterator<Item = Span> + use<> {
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
    fn around(&self, span: Span) -> Around<'f> {
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
    ceiling: f32,
}

impl RoundTip {
    fn new(dab: &Dab) -> Self {
        let profile = RoundProfile::new(dab.hardness, dab.softness);
        Self { at: dab.at, per_radius: 1.0 / dab.radius, profile, flow: dab.flow, ceiling: dab.ceiling }
    }
    /// Adds the coverage of one pixel.
    ///
    /// * `distance_squared`: from the centre to D(q), image-plane px².
    /// * `width_squared`: of the pixel along that line, px²; what is not a number adds nothing.
    #[inline(always)]
    fn add(&self, coverage: &mut f32, distance_squared: f32, width_squared: f32) {
        let per_radius = self.per_radius;
        let r = distance_squared.sqrt() * per_radius;
        let f = self.flow * self.profile.mean(r, width_squared * per_radius * per_radius);
        // Comparisons turn NaN into nothing, and rounding must not leave the range.
        let f = if f > 0.0 { f } else { 0.0 };
        let f = if f < 1.0 { f } else { 1.0 };
        let room = self.ceiling - *coverage;
        *coverage += f * if room > 0.0 { room } else { 0.0 };
    }
    /// Adds a pixel at (x, y) from the centre in the image plane, J's columns `across` and `along`.
    ///
    /// Its width toward the centre is |Jᵀ p|, p the unit vector from the centre to it.
    #[inline(always)]
    fn add_bent(&self, coverage: &mut f32, (x, y): (f32, f32), across: (f32, f32), along: (f32, f32)) {
        // At the very centre there is no direction; the pixel beside it tells how wide this one is as well as any.
        let distance_squared = x * x + y * y + 1e-12;
        let (a, b) = (across.0 * x + across.1 * y, along.0 * x + along.1 * y);
        self.add(coverage, distance_squared, (a * a + b * b) / distance_squared);
    }
}

/// A pixel all of whose neighbours continue its surface.
const INSIDE: u8 = links::LEFT | links::RIGHT | links::UP | links::DOWN;

fn bent_row(d: Around, tip: &RoundTip, coverage: &mut [f32]) {
    if d.linked.iter().all(|&bits| bits == INSIDE) { inside_row(d, tip, coverage) } else { rim_row(d, tip, coverage) }
}

crate::widest! {
    /// Where D is the identity; (x, y) is the centre of the first pixel.
    fn flat_row(x: f32, y: f32, tip: &RoundTip, coverage: &mut [f32]) {
        let dy = y - tip.at.y;
        for (i, a) in coverage.iter_mut().enumerate() {
            // Through i32: AVX2 converts no 64-bit integers.
            let dx = x + i as i32 as f32 - tip.at.x;
            tip.add(a, dx * dx + dy * dy, 1.0);
        }
    }
    /// Within one piece of surface: J by central differences.
    fn inside_row(d: Around, tip: &RoundTip, coverage: &mut [f32]) {
        let n = coverage.len();
        let (cx, cy) = (&d.row.0[..n + 2], &d.row.1[..n + 2]);
        let (ax, ay) = (&d.above.0[..n + 2], &d.above.1[..n + 2]);
        let (bx, by) = (&d.below.0[..n + 2], &d.below.1[..n + 2]);
        for i in 0..n {
            let from_center = (cx[i + 1] - tip.at.x, cy[i + 1] - tip.at.y);
            let across = (0.5 * (cx[i + 2] - cx[i]), 0.5 * (cy[i + 2] - cy[i]));
            let along = (0.5 * (bx[i + 1] - ax[i + 1]), 0.5 * (by[i + 1] - ay[i + 1]));
            tip.add_bent(&mut coverage[i], from_center, across, along);
        }
    }
    /// Along a silhouette, a depth jump or outside: J from linked neighbours only.
    fn rim_row(d: Around, tip: &RoundTip, coverage: &mut [f32]) {
        let n = coverage.len();
        let (cx, cy) = (&d.row.0[..n + 2], &d.row.1[..n + 2]);
        let (ax, ay) = (&d.above.0[..n + 2], &d.above.1[..n + 2]);
        let (bx, by) = (&d.below.0[..n + 2], &d.below.1[..n + 2]);
        let linked = &d.linked[..n];
        for i in 0..n {
            let (x, y) = (cx[i + 1], cy[i + 1]);
            let has = |bit: u8| linked[i] & bit != 0;
            let (l, r, u, d) = (has(links::LEFT), has(links::RIGHT), has(links::UP), has(links::DOWN));
            let across = (slope(l, r, cx[i], x, cx[i + 2], 1.0), slope(l, r, cy[i], y, cy[i + 2], 0.0));
            let along = (slope(u, d, ax[i + 1], x, bx[i + 1], 0.0), slope(u, d, ay[i + 1], y, by[i + 1], 1.0));
            tip.add_bent(&mut coverage[i], (x - tip.at.x, y - tip.at.y), across, along);
        }
    }
}

/// The derivative at `here` from those of its two neighbours that are linked; `flat`, the identity's, without any.
#[inline(always)]
pub fn slope(has_before: bool, has_after: bool, before: f32, here: f32, after: f32, flat: f32) -> f32 {
    let low = if has_before { before } else { here };
    let high = if has_after { after } else { here };
    let mean = if has_before & has_after { 0.5 * (high - low) } else { high - low };
    if has_before | has_after { mean } else { flat }
}
