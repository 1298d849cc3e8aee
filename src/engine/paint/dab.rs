//! One dab on one tile: F(A⁻¹(D(q) − q_0)) at every pixel it may touch. Floor 3. Not here: where
//! dabs are placed (`dab_walker`), the tips (`profile`, `stamp`), rows of the round tip (`round`),
//! how dabs add up to a stroke (`stroke`).

mod coverage;
mod round;
pub mod shape;
mod softened;

pub use coverage::Footprint;
pub use shape::TipShape;
pub use softened::SoftenedStamps;

use super::dab_walker::Dab;
use super::image::transform;
use super::patches::Patches;
use super::profile::RoundProfile;
use super::scene::Scene;
use super::stamp::TipStamp;
use super::stroke_tile::{CoveredRow, DabPaint, StrokeTile};
use crate::math::{Rect, simd::prefetch, srgb::Color};
use crate::raster::sampler::Antialias;
use crate::raster::{Outside, TILE, TileAt};
use crate::surface::deformation::{Deformation, DeformedRect, OwnPlane};
use crate::surface::support::{
    BLOCK, DabExtent, SupportBounds, TILE_BLOCKS, TileBlocks, is_out_of_reach,
};
use crate::surface::{DabReach, Operator, Surface};
use round::{
    BentPart, BlockPixels, RoundTip, RowPaint, RowZones, fill_bent_row, fill_bent_rows, flat_row,
    flat_rows,
};
use std::ops::Range;

/// One dab on the canvas it is painted on.
pub struct PlacedDab<'s> {
    dab: Dab,
    scene: &'s Scene,
    deformation: Deformation<'s>,
    /// `None` where D is the identity.
    bent_over: Option<&'s Surface>,
    support: SupportBounds<'s>,
    /// On a far side: its blocks that the dab may touch.
    far_blocks: Option<TileBlocks>,
}

/// Half a pixel's width on either side: the box of the round tip's filter.
const ROUND_FILTER_PX: f32 = 0.5;

/// Radii within which every footprint lies: the softest rim at 2, a square picture's corner at √2.
const PUSH_RADII: f32 = 3.0;

/// How far a round dab reaches.
pub fn round_extent(dab: &Dab) -> DabExtent {
    let profile = RoundProfile::new(dab.hardness, dab.softness);
    DabExtent { radius_px: dab.radius * profile.outer_radius(), filter_px: ROUND_FILTER_PX }
}

/// Buffers of one dab, reused for the next.
#[derive(Default)]
pub struct DabScratch {
    deformed: DeformedRect,
    stamping: StampScratch,
    row: RowZones,
    /// Coverage of a row, or part of a tile.
    covered: Vec<f32>,
    /// The share of each of its pixels that the dab reaches.
    shares: Vec<f32>,
    /// The pixels that a picture tip paints on a part of a tile.
    stamped: Vec<[u8; 4]>,
}

/// Buffers for reading a picture tip.
#[derive(Default)]
struct StampScratch {
    patches: Patches,
    /// Allocated for the first stamp: round dabs do not need it.
    antialias: Option<Box<Antialias>>,
    row: Vec<[u8; 4]>,
}

impl<'s> PlacedDab<'s> {
    /// `extent`: of the tip's footprint.
    pub fn new(dab: Dab, scene: &'s Scene, extent: DabExtent) -> Self {
        let surface = scene.surface.as_deref();
        if surface.is_some_and(|surface| is_out_of_reach(surface, dab.operator, dab.at, extent)) {
            let deformation = Deformation::of_dab(None, scene.size, Operator::None, dab.at);
            let support = SupportBounds::nowhere(scene.size, dab.at, extent);
            return Self { dab, scene, deformation, bent_over: None, support, far_blocks: None };
        }
        let reach = DabReach::new(dab.at, dab.reach_px, PUSH_RADII * dab.radius);
        let deformation =
            Deformation::of_dab(surface, scene.size, dab.operator, dab.at).within(reach);
        // The pixels of a far side lie where D says, even if it is the identity.
        let far_blocks = scene.as_far_side().map(|_| TileBlocks::default());
        let bent_over = surface.filter(|_| far_blocks.is_some() || !deformation.is_identity());
        let bounding = surface.filter(|_| far_blocks.is_none());
        let support =
            SupportBounds::new(bounding, scene.size, dab.operator, dab.at, extent).within(reach);
        Self { dab, scene, deformation, bent_over, support, far_blocks }
    }

    /// The same, painted on those blocks of a far side.
    pub fn on_blocks(self, far_blocks: TileBlocks) -> Self {
        Self { far_blocks: Some(far_blocks), ..self }
    }

    /// The blocks that the dab may touch, among the pixels that represent a tile.
    fn reached_blocks(&self, at: TileAt) -> ReachedBlocks {
        let Some(blocks) = self.far_blocks else {
            let tile = at.rect();
            let Some(judged) = self.support.judge_blocks(at) else {
                return ReachedBlocks::none(tile);
            };
            let area = reached_rect(&judged.touched, tile).intersect(self.scene.size.rect());
            // Near its border a dab is pushed away, and pixels are longer.
            let pixel =
                if self.deformation.is_limited(area.grown(1)) { ANY_LENGTH } else { judged.pixel };
            return ReachedBlocks { tile, blocks: judged.touched, area, step: 1, pixel };
        };
        let whole = self.scene.area(at);
        let tile = Rect::new(0, whole.y0, TILE as i32, whole.y0 + TILE as i32);
        let area = reached_rect(&blocks, tile).intersect(whole);
        ReachedBlocks { tile, blocks, area, step: self.scene.row_step(), pixel: ANY_LENGTH }
    }

    pub fn dab(&self) -> &Dab {
        &self.dab
    }

    pub fn support(&self) -> &SupportBounds<'s> {
        &self.support
    }

    /// D over the touched blocks of a tile and the pixels around them, in rows of their area grown
    /// by one.
    fn fill_touched(&self, part: &ReachedBlocks, deformed: &mut DeformedRect) {
        let ReachedBlocks { tile, ref blocks, area, .. } = *part;
        let touched =
            |y: i32| if (area.y0..area.y1).contains(&y) { row_of(blocks, tile, y) } else { 0 };
        let columns = |y: i32| {
            let columns = columns(touched(y - 1) | touched(y) | touched(y + 1), tile);
            columns.start - 1..columns.end + 1
        };
        self.deformation.fill_spans(area.grown(1), columns, deformed);
    }

    /// Its color, from the stroke's; `None`: the stamp's own colors.
    fn paint(&self, color: Option<Color>) -> DabPaint {
        DabPaint { flow: self.dab.flow, ceiling: self.dab.ceiling, color }
    }

    /// For a picture, which has no rim that could be thinner.
    fn stamp_paint(&self, color: Option<Color>) -> DabPaint {
        DabPaint { flow: self.dab.flow * self.dab.thin, ..self.paint(color) }
    }

    /// Adds a round tip to a tile, row by row: a ← a + f (c − a), f = flow · F, up to its ceiling
    /// c.
    pub fn add_round(&self, at: TileAt, stroke_tile: &mut StrokeTile, scratch: &mut DabScratch) {
        let part = self.reached_blocks(at);
        if part.area.is_empty() {
            return;
        }
        let DabScratch { deformed, covered, shares, row, .. } = scratch;
        let tip = RoundTip::new(&self.dab);
        let (tip, field) = self.round_field(&part, tip, deformed);
        let is_flat = field.is_none();
        let spans = part
            .spans()
            .filter_map(|span| if is_flat { span.reached_by(&tip) } else { Some(span) });
        if let Some(tile) = stroke_tile.plain() {
            let (mut rows, mut n) = ([PixelSpan::default(); TILE], 0);
            for (row, span) in rows.iter_mut().zip(spans) {
                (*row, n) = (span, n + 1);
            }
            let (spans, corner) = (&rows[..n], (part.tile.x0, part.tile.y0));
            return match &field {
                Some(field) => fill_bent_rows(
                    field,
                    BentPart { corner, spans, pixel: &part.pixel },
                    &tip,
                    row,
                    tile,
                ),
                None => flat_rows(corner, spans, &tip, row, tile),
            };
        }
        let mut add = |span: PixelSpan, tip: &RoundTip, out: RowPaint| match &field {
            Some(field) => fill_bent_row(field.span_neighbors(span), tip, row, out),
            None => flat_row(span.x as f32 + 0.5, span.y as f32 + 0.5, tip, row, out),
        };
        // The stroke tile applies the ceiling, because it knows the coverage.
        let mut uncapped = tip;
        uncapped.ceiling = 1.0;
        for span in spans {
            for row in [&mut *covered, &mut *shares] {
                row.clear();
                row.resize(span.n, 0.0);
            }
            add(span, &uncapped, RowPaint { coverage: covered, reach: shares });
            let paint = DabPaint { flow: 1.0, ..self.paint(Some(self.dab.color)) };
            stroke_tile.cover(part.start_of(span), CoveredRow { coverage: covered, shares }, paint);
        }
    }

    /// What a round tip reads over a part of a tile, and the tip there: D, or the unwrapped plane
    /// itself, in which a round tip covers the same pixels however the plane is turned. `None`
    /// where D is the identity.
    fn round_field<'f>(
        &'f self,
        part: &ReachedBlocks,
        tip: RoundTip,
        deformed: &'f mut DeformedRect,
    ) -> (RoundTip, Option<DeformationField<'f>>) {
        let Some(surface) = self.bent_over else { return (tip, None) };
        if let Some(own) = self.deformation.own_plane(part.area) {
            return (tip.with_center(own.at), Some(DeformationField::of_plane(surface, &own)));
        }
        self.fill_touched(part, deformed);
        (tip, Some(DeformationField::new(surface, part.area.grown(1), deformed)))
    }

    /// Adds a picture tip to a tile: its mean over the patch of the image plane under each pixel.
    pub fn add_stamp(
        &self,
        stamp: &TipStamp,
        at: TileAt,
        stroke_tile: &mut StrokeTile,
        scratch: &mut DabScratch,
    ) {
        let part = self.reached_blocks(at);
        let area = part.area;
        let DabScratch { deformed, stamping: StampScratch { patches, antialias, row }, .. } =
            scratch;
        let texels_from_canvas = stamp.texels_from_canvas(&self.dab);
        self.deformation.fill(area.grown(1), deformed);
        transform(texels_from_canvas, &mut deformed.x, &mut deformed.y);
        let antialias = antialias.get_or_insert_default();
        row.resize(area.width(), [0; 4]);
        let paint = self.stamp_paint((!stamp.is_colored).then_some(self.dab.color));
        for span in part.spans() {
            let patches = patches.row(self.scene, area, span.y, deformed, texels_from_canvas);
            antialias.row(stamp.texture(), patches, Outside::None, row);
            let from = (span.x - area.x0) as usize;
            stroke_tile.stamp(part.start_of(span), &row[from..from + span.n], paint);
        }
    }
}

/// A row of pixels that a dab may touch.
#[derive(Clone, Copy, Default)]
struct PixelSpan {
    x: i32,
    y: i32,
    n: usize,
}

impl PixelSpan {
    /// The part of it that an unbent dab may reach; `None` if it is empty.
    fn reached_by(self, tip: &RoundTip) -> Option<Self> {
        let chunks = tip.flat_chunks(self.x, self.y, self.n);
        let part = Self { x: self.x + chunks.start as i32, n: chunks.len(), ..self };
        (part.n > 0).then_some(part)
    }
}

/// The part of a tile that a dab may touch, or of what represents one on a far side.
#[derive(Clone, Copy)]
struct ReachedBlocks {
    /// The pixels of the tile.
    tile: Rect,
    blocks: TileBlocks,
    /// The smallest rectangle that holds the touched blocks.
    area: Rect,
    /// The step from one painted row to the next.
    step: usize,
    pixel: BlockPixels,
}

/// For pixels whose lengths are not known.
const ANY_LENGTH: BlockPixels = [f32::INFINITY; TILE_BLOCKS * TILE_BLOCKS];

impl ReachedBlocks {
    fn none(tile: Rect) -> Self {
        Self { tile, blocks: TileBlocks::default(), area: Rect::EMPTY, step: 1, pixel: ANY_LENGTH }
    }

    /// The rows of the area, each from its first to its last touched block.
    fn spans(&self) -> impl Iterator<Item = PixelSpan> + use<> {
        let ReachedBlocks { tile, blocks, area, step, .. } = *self;
        (area.y0..area.y1).step_by(step).filter_map(move |y| {
            let columns = columns(row_of(&blocks, tile, y), tile);
            let (x0, x1) = (columns.start.max(area.x0), columns.end.min(area.x1));
            (x0 < x1).then(|| PixelSpan { x: x0, y, n: (x1 - x0) as usize })
        })
    }

    /// Where a span begins among the pixels of the tile.
    fn start_of(&self, span: PixelSpan) -> usize {
        (span.y - self.tile.y0) as usize * TILE + (span.x - self.tile.x0) as usize
    }
}

/// The smallest rectangle that holds the touched blocks of a tile.
fn reached_rect(blocks: &TileBlocks, tile: Rect) -> Rect {
    let side = BLOCK as i32;
    let rows = blocks.iter().enumerate().filter(|(_, bits)| **bits != 0);
    rows.fold(Rect::EMPTY, |r, (row, bits)| {
        let y = tile.y0 + row as i32 * side;
        let x0 = tile.x0 + bits.trailing_zeros() as i32 * side;
        let x1 = tile.x0 + (8 - bits.leading_zeros() as i32) * side;
        r.union(Rect::new(x0, y, x1, y + side))
    })
}

/// Which blocks of a row of pixels of a tile are touched.
fn row_of(blocks: &TileBlocks, tile: Rect, y: i32) -> u8 {
    blocks[(y - tile.y0) as usize / BLOCK]
}

/// The columns of a tile from the first of some blocks to the last; none without blocks.
fn columns(bits: u8, tile: Rect) -> Range<i32> {
    let side = BLOCK as i32;
    let last = 8 - bits.leading_zeros() as i32;
    tile.x0 + (bits.trailing_zeros() as i32).min(last) * side..tile.x0 + last * side
}

/// D over a rectangle and the pixels around it.
struct DeformationField<'f> {
    surface: &'f Surface,
    /// The first pixel of `d`, and how many it has in a row.
    corner: (i32, i32),
    width: usize,
    d: (&'f [f32], &'f [f32]),
    /// It is as large as the canvas, and its rows are pages apart.
    is_plane: bool,
}

impl<'f> DeformationField<'f> {
    fn new(surface: &'f Surface, rect: Rect, d: &'f DeformedRect) -> Self {
        let (corner, width) = ((rect.x0, rect.y0), rect.width());
        Self { surface, corner, width, d: (&d.x, &d.y), is_plane: false }
    }

    fn of_plane(surface: &'f Surface, own: &OwnPlane<'f>) -> Self {
        let d = (own.x.values(), own.y.values());
        Self { surface, corner: (0, 0), width: own.x.width(), d, is_plane: true }
    }

    /// Prefetches the row below the one below a span.
    #[inline(always)]
    fn prefetch(&self, span: PixelSpan) {
        if self.is_plane && span.y as usize + 2 < self.d.0.len() / self.width.max(1) {
            let start = (span.y as usize + 2) * self.width + span.x as usize - 1;
            prefetch(&self.d.0[start..start + span.n + 2]);
            prefetch(&self.d.1[start..start + span.n + 2]);
            prefetch(
                &self.surface.smooth_links_plane().row(span.y as usize + 1)[span.x as usize..]
                    [..span.n],
            );
        }
    }

    #[inline(always)]
    fn span_neighbors(&self, span: PixelSpan) -> SpanNeighbors<'f> {
        let start = |y: i32| {
            (y - self.corner.1) as usize * self.width + (span.x - 1 - self.corner.0) as usize
        };
        let row = |y: i32| {
            let range = start(y)..start(y) + span.n + 2;
            (&self.d.0[range.clone()], &self.d.1[range])
        };
        let linked =
            &self.surface.smooth_links_plane().row(span.y as usize)[span.x as usize..][..span.n];
        SpanNeighbors { above: row(span.y - 1), row: row(span.y), below: row(span.y + 1), linked }
    }
}

/// D of a span's pixels, of one more at each end, and of the rows above and below; (x, y) each.
#[derive(Clone, Copy)]
struct SpanNeighbors<'f> {
    above: (&'f [f32], &'f [f32]),
    row: (&'f [f32], &'f [f32]),
    below: (&'f [f32], &'f [f32]),
    /// Which neighbors continue the surface, one a pixel of the span.
    linked: &'f [u8],
}
