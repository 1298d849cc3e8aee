//! A dab of any footprint, evaluated row by row as coverage before it is added, so that a texture
//! or grain can be applied to it. Floor 3. Not here: the plain round tip (`dab`), which adds its
//! coverage directly.

use super::round::{RoundTip, RowPaint, fill_bent_row, flat_row};
use super::shape::{self, TipShape};
use super::softened::SoftenedStamps;
use super::{DabScratch, DeformationField, PixelSpan, PlacedDab, ReachedBlocks, SpanNeighbors};
use crate::math::{Affine2, Mat2, Rect};
use crate::paint::brush_options::Falloff;
use crate::paint::image::transform;
use crate::paint::stamp::TipStamp;
use crate::paint::stroke_tile::{CoveredRow, StrokeTile};
use crate::raster::{Outside, TILE, TileAt};
use crate::surface::deformation::DeformedRect;

/// What a dab covers.
#[derive(Clone, Copy)]
pub enum Footprint<'t> {
    /// A formula.
    Shape(TipShape, Falloff),
    /// A round tip times a picture of its own coverage.
    Textured(&'t SoftenedStamps),
}

impl ReachedBlocks {
    /// Where a span lies among the pixels of the area, row by row.
    fn range(&self, span: PixelSpan) -> std::ops::Range<usize> {
        let start =
            (span.y - self.area.y0) as usize * self.area.width() + (span.x - self.area.x0) as usize;
        start..start + span.n
    }

    fn pixels(&self) -> usize {
        self.area.width() * self.area.height()
    }
}

impl PlacedDab<'_> {
    /// Adds a dab to a tile: its flow times its footprint.
    pub fn add_covered(
        &self,
        footprint: Footprint,
        at: TileAt,
        stroke_tile: &mut StrokeTile,
        scratch: &mut DabScratch,
    ) {
        let part = self.reached_blocks(at);
        if part.area.is_empty() {
            return;
        }
        self.deformation.fill(part.area.grown(1), &mut scratch.deformed);
        let mut covered = std::mem::take(&mut scratch.covered);
        let mut shares = std::mem::take(&mut scratch.shares);
        for plane in [&mut covered, &mut shares] {
            plane.clear();
            plane.resize(part.pixels(), 0.0);
        }
        match footprint {
            Footprint::Shape(shape, falloff) => self.cover_shape(
                (shape, falloff),
                &part,
                &mut scratch.deformed,
                (&mut covered, &mut shares),
            ),
            Footprint::Textured(stamps) => {
                self.cover_round(&part, scratch, (&mut covered, &mut shares));
                self.read(stamps, &part, scratch);
                covered
                    .iter_mut()
                    .zip(&scratch.stamped)
                    .for_each(|(c, s)| *c *= f32::from(s[3]) / 255.0);
            }
        }
        for span in part.spans() {
            let row = CoveredRow {
                coverage: &covered[part.range(span)],
                shares: &shares[part.range(span)],
            };
            stroke_tile.cover(part.start_of(span), row, self.paint(Some(self.dab.color)));
        }
        (scratch.covered, scratch.shares) = (covered, shares);
    }

    /// Adds a picture tip to a tile at the dab's own softness.
    pub fn add_softened(
        &self,
        stamps: &SoftenedStamps,
        at: TileAt,
        stroke_tile: &mut StrokeTile,
        scratch: &mut DabScratch,
    ) {
        if let SoftenedStamps::One(stamp) = stamps {
            return self.add_stamp(stamp, at, stroke_tile, scratch);
        }
        let part = self.reached_blocks(at);
        if part.area.is_empty() {
            return;
        }
        self.deformation.fill(part.area.grown(1), &mut scratch.deformed);
        self.read(stamps, &part, scratch);
        let paint = self.stamp_paint((!stamps.is_colored()).then_some(self.dab.color));
        for span in part.spans() {
            stroke_tile.stamp(part.start_of(span), &scratch.stamped[part.range(span)], paint);
        }
    }

    /// The round tip over a part; D over the part and the pixels around it is in
    /// `scratch.deformed`.
    fn cover_round(
        &self,
        part: &ReachedBlocks,
        scratch: &mut DabScratch,
        (covered, shares): (&mut [f32], &mut [f32]),
    ) {
        let DabScratch { deformed, row, .. } = scratch;
        let tip = RoundTip::plain(&self.dab);
        let field = self
            .bent_over
            .map(|surface| DeformationField::new(surface, part.area.grown(1), deformed));
        for span in part.spans() {
            let out = RowPaint {
                coverage: &mut covered[part.range(span)],
                reach: &mut shares[part.range(span)],
            };
            match &field {
                Some(field) => fill_bent_row(field.span_neighbors(span), &tip, row, out),
                None => flat_row(span.x as f32 + 0.5, span.y as f32 + 0.5, &tip, row, out),
            }
        }
    }

    /// An ellipse or a square over a part; `deformed` becomes tip space.
    fn cover_shape(
        &self,
        (shape, falloff): (TipShape, Falloff),
        part: &ReachedBlocks,
        deformed: &mut DeformedRect,
        (covered, shares): (&mut [f32], &mut [f32]),
    ) {
        let tip_from_canvas = shape.tip_from_canvas(&self.dab);
        transform(tip_from_canvas, &mut deformed.x, &mut deformed.y);
        for span in part.spans() {
            let around =
                self.span_neighbors(span, part.area.grown(1), deformed, tip_from_canvas.matrix2);
            shape.row(
                falloff,
                &self.dab,
                around,
                &mut covered[part.range(span)],
                &mut shares[part.range(span)],
            );
        }
    }

    fn span_neighbors<'f>(
        &'f self,
        span: PixelSpan,
        rect: Rect,
        d: &'f DeformedRect,
        flat: Mat2,
    ) -> shape::TipSpanNeighbors<'f> {
        /// Where D is the identity, no derivative is needed.
        const UNLINKED: [u8; TILE] = [0; TILE];
        match self.bent_over {
            Some(surface) => {
                let SpanNeighbors { above, row, below, linked } =
                    DeformationField::new(surface, rect, d).span_neighbors(span);
                shape::TipSpanNeighbors { above, row, below, linked, flat }
            }
            None => {
                let row = |y: i32| {
                    let start =
                        (y - rect.y0) as usize * rect.width() + (span.x - 1 - rect.x0) as usize;
                    (&d.x[start..start + span.n + 2], &d.y[start..start + span.n + 2])
                };
                shape::TipSpanNeighbors {
                    above: row(span.y - 1),
                    row: row(span.y),
                    below: row(span.y + 1),
                    linked: &UNLINKED[..span.n.min(TILE)],
                    flat,
                }
            }
        }
    }

    /// Reads the picture of a part at the dab's softness into `scratch.stamped`; `scratch.deformed`
    /// is converted to texels.
    fn read(&self, stamps: &SoftenedStamps, part: &ReachedBlocks, scratch: &mut DabScratch) {
        let (stamp, above) = stamps.at(self.dab.softness);
        scratch.stamped.clear();
        scratch.stamped.resize(part.pixels(), [0; 4]);
        let texels_from_canvas = stamp.texels_from_canvas(&self.dab);
        self.read_stamp(stamp, texels_from_canvas, part, scratch, |_, read| read);
        if let Some((above, share)) = above {
            let next = above.texels_from_canvas(&self.dab) * texels_from_canvas.inverse();
            let mix = |known: u8, read: u8| {
                (f32::from(known) + (f32::from(read) - f32::from(known)) * share + 0.5) as u8
            };
            let mixed =
                |known: [u8; 4], read: [u8; 4]| std::array::from_fn(|c| mix(known[c], read[c]));
            self.read_stamp(above, next, part, scratch, mixed);
        }
    }

    /// `map`: to this stamp's texels from what is in `scratch.deformed`. `mix`: combines the old
    /// values with those read.
    fn read_stamp(
        &self,
        stamp: &TipStamp,
        map: Affine2,
        part: &ReachedBlocks,
        scratch: &mut DabScratch,
        mix: impl Fn([u8; 4], [u8; 4]) -> [u8; 4],
    ) {
        let DabScratch { deformed, stamping, stamped, .. } = scratch;
        transform(map, &mut deformed.x, &mut deformed.y);
        let antialias = stamping.antialias.get_or_insert_default();
        let row = &mut stamping.row;
        row.resize(part.area.width(), [0; 4]);
        let texels_from_canvas = stamp.texels_from_canvas(&self.dab);
        for span in part.spans() {
            let patches =
                stamping.patches.row(self.scene, part.area, span.y, deformed, texels_from_canvas);
            antialias.row(stamp.texture(), patches, Outside::None, row);
            let from = (span.x - part.area.x0) as usize;
            for (known, read) in stamped[part.range(span)].iter_mut().zip(&row[from..]) {
                *known = mix(*known, *read);
            }
        }
    }
}
