//! What adjustments do to rows of pixels: tables of 65,536 tones where channels are adjusted by
//! themselves, else the formula for each pixel. Made once and kept with the parameters. Floor 3.

use super::{ColorAdjustment, Invert};
use crate::memory::RemadeCell;
use crate::raster::planar::PixelRow;
use crate::raster::{PlanarTile, TILE};
use std::sync::Arc;

/// An adjustment together with what is computed from its parameters, which clones share.
#[derive(Clone)]
pub struct LiveAdjustment {
    params: Arc<ColorAdjustment>,
    prepared: Arc<RemadeCell<Arc<RowAdjuster>>>,
}

impl std::fmt::Debug for LiveAdjustment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.params.fmt(f)
    }
}

impl PartialEq for LiveAdjustment {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.params, &other.params) || self.params == other.params
    }
}

impl LiveAdjustment {
    /// With the nearest numbers that a document may hold.
    pub fn new(adjustment: ColorAdjustment) -> Self {
        Self { params: Arc::new(adjustment.clamp_to_ranges()), prepared: Arc::default() }
    }

    /// What it was made of.
    pub fn params(&self) -> &ColorAdjustment {
        &self.params
    }

    /// Adjusts premultiplied pixels in place; alpha stays.
    pub fn apply(&self, pixels: &mut PlanarTile) {
        let prepared = self.prepare();
        pixels.rows_mut().iter_mut().for_each(|row| prepared.adjust(row));
    }

    /// Computes now what many tiles would otherwise wait for.
    pub fn warm(&self) {
        self.prepare();
    }

    /// What is kept for speed, bytes.
    pub fn kept_bytes(&self) -> u64 {
        let tables = match self.prepared.get().as_deref() {
            Some(RowAdjuster::Tones([r, g, b])) if Arc::ptr_eq(r, g) && Arc::ptr_eq(g, b) => 1,
            Some(RowAdjuster::Tones(_)) => 3,
            _ => 0,
        };
        tables * (TONES * size_of::<f32>()) as u64
    }

    /// Drops it; it is computed again when pixels are adjusted.
    pub fn clear_kept(&self) {
        self.prepared.clear();
    }

    /// The address of what clones share.
    pub fn place(&self) -> usize {
        Arc::as_ptr(&self.prepared).cast::<()>() as usize
    }

    fn prepare(&self) -> Arc<RowAdjuster> {
        // Nothing in it is divided among threads.
        self.prepared.get_or_make(|| Arc::new(RowAdjuster::of(&self.params)))
    }
}

/// Tones of 16 bits: bytes hit entries exactly, since 65535 = 255 · 257.
type ToneTable = Arc<[f32]>;
const TONES: usize = 65_536;

enum RowAdjuster {
    /// A table for each channel.
    Tones([ToneTable; 3]),
    /// A formula, compiled into its own loop.
    Colors(Box<dyn Fn(&mut PixelRow) + Send + Sync>),
    Nothing,
}

fn tabulate(tone: impl Fn(f32) -> f32) -> ToneTable {
    let entry = |i: usize| tone(i as f32 / (TONES - 1) as f32).max(0.0).min(1.0);
    (0..TONES).map(entry).collect()
}

fn alike(tone: impl Fn(f32) -> f32) -> RowAdjuster {
    let table = tabulate(tone);
    RowAdjuster::Tones([table.clone(), table.clone(), table])
}

fn colors(color: impl Fn([f32; 3]) -> [f32; 3] + Send + Sync + 'static) -> RowAdjuster {
    RowAdjuster::Colors(Box::new(move |row| adjust_colors(row, &color)))
}

impl RowAdjuster {
    fn of(adjustment: &ColorAdjustment) -> Self {
        use ColorAdjustment as A;
        match adjustment {
            A::Levels(own) if own.is_gray() => alike(|v| own.tone(0, v)),
            A::Levels(own) => Self::Tones([0, 1, 2].map(|c| tabulate(|v| own.tone(c, v)))),
            A::Curves(own) if own.is_gray() => alike(own.tone(0)),
            A::Curves(own) => Self::Tones([0, 1, 2].map(|c| tabulate(own.tone(c)))),
            A::BrightnessContrast(own) => alike(own.tone()),
            A::Exposure(own) => alike(|v| own.tone(v)),
            A::Invert(_) => alike(Invert::tone),
            A::Posterize(own) => alike(|v| own.tone(v)),
            A::HueSaturation(own) => colors(own.color()),
            A::ColorBalance(own) => colors({
                let own = *own;
                move |rgb| own.color(rgb)
            }),
            A::Vibrance(own) => colors({
                let own = *own;
                move |rgb| own.color(rgb)
            }),
            A::PhotoFilter(own) => colors({
                let own = *own;
                move |rgb| own.color(rgb)
            }),
            A::ChannelMixer(own) => colors({
                let own = *own;
                move |rgb| own.color(rgb)
            }),
            A::BlackWhite(own) => colors({
                let own = *own;
                move |rgb| own.color(rgb)
            }),
            A::SelectiveColor(own) => colors({
                let own = *own;
                move |rgb| own.color(rgb)
            }),
            A::Threshold(own) => colors({
                let own = *own;
                move |rgb| own.color(rgb)
            }),
            A::GradientMap(own) => colors(own.color()),
            A::ColorLookup(own) => match own.table.clone() {
                Some(table) => colors(move |rgb| table.color(rgb)),
                None => Self::Nothing,
            },
        }
    }

    fn adjust(&self, row: &mut PixelRow) {
        match self {
            Self::Tones(tables) => adjust_tones(row, tables),
            Self::Colors(adjust) => adjust(row),
            Self::Nothing => {}
        }
    }
}

/// Straight values are looked up to the nearest 16 bits.
fn adjust_tones(row: &mut PixelRow, tables: &[ToneTable; 3]) {
    let mut per_a = [0.0; TILE];
    for (per_a, &a) in per_a.iter_mut().zip(&row.a) {
        *per_a = if a > 0.0 { (TONES - 1) as f32 / a } else { 0.0 };
    }
    for (channel, table) in row.rgb.iter_mut().zip(tables) {
        for ((v, &per_a), &a) in channel.iter_mut().zip(&per_a).zip(&row.a) {
            let place = (*v * per_a).max(0.0).min((TONES - 1) as f32) + 0.5;
            // In range: the table has all tones.
            *v = table[place as usize & (TONES - 1)] * a;
        }
    }
}

#[inline(always)]
fn adjust_colors(row: &mut PixelRow, color: &impl Fn([f32; 3]) -> [f32; 3]) {
    let PixelRow { rgb: [r, g, b], a } = row;
    for x in 0..TILE {
        let alpha = a[x];
        let per_a = if alpha > 0.0 { 1.0 / alpha } else { 0.0 };
        let straight = [r[x], g[x], b[x]].map(|v| (v * per_a).max(0.0).min(1.0));
        let out = color(straight).map(|v| v.max(0.0).min(1.0) * alpha);
        [r[x], g[x], b[x]] = out;
    }
}
