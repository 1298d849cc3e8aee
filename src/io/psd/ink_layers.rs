//! Layers of files of inks, Lab and gray with the colors that they have on each other. Floor 5.
//!
//! Photoshop blends and adjusts the file's values, and here layers blend as sRGB. Where that shows,
//! each layer gets the color, and where that is beyond sRGB the alpha, with which it looks on what
//! lies beneath it as its values do. Not here: whether it shows (`tree`), adjustments that stay live
//! (`inks`, `gray`).

mod fit;
mod steps;

use super::colors::{Mode, Press, lab_to_linear};
use super::gray::GrayTones;
use super::{LayerRecord, RecordSection};
use crate::math::{Rect, Size, srgb};
use crate::raster::BlendMode;
use fit::FittedLayer;
use steps::{InkStep, InkTone};

/// Rows that are composed at once.
const ROWS: usize = 32;
/// Pixels of layers that are composed: some seconds.
const MOST_PIXELS: u64 = 1 << 26;
/// What is noted of a layer that became what it looks like.
const NOTE: &str = "other programs blend the values of the file's colors: its pixels became what that \
                    looks like on the layers beneath";
/// The same of an adjustment.
pub const ADJUSTED: &str = "it adjusts the values of the file's colors, and became pixels: what that \
                            looks like on the layers beneath";

/// A pixel of inks: the light that each lets through times alpha, and alpha.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct InkPixel {
    light: [f32; 4],
    alpha: f32,
}

impl InkPixel {
    /// The light alone; all of it where nothing is.
    fn straight(self) -> [f32; 4] {
        if self.alpha <= 0.0 { [1.0; 4] } else { self.light.map(|v| (v / self.alpha).min(1.0)) }
    }

    /// With ink on top that covers `alpha` of it.
    fn with(self, ink: [f32; 4], mode: BlendMode, alpha: f32) -> Self {
        let mixed = blend_inks(mode, self.straight(), ink);
        let part = |c: usize| {
            self.light[c] * (1.0 - alpha)
                + alpha * ((1.0 - self.alpha) * ink[c] + self.alpha * mixed[c])
        };
        Self { light: [0, 1, 2, 3].map(part), alpha: alpha + self.alpha * (1.0 - alpha) }
    }
}

/// Cyan, magenta and yellow as colors are blended, black as a gray.
fn blend_inks(mode: BlendMode, beneath: [f32; 4], ink: [f32; 4]) -> [f32; 4] {
    if mode == BlendMode::Normal {
        return ink;
    }
    let opaque = |[c, m, y]: [f32; 3]| [c, m, y, 1.0];
    let blend =
        |below: [f32; 3], own: [f32; 3]| mode.function().composite(opaque(below), opaque(own));
    let ([c, m, y, k], [c2, m2, y2, k2]) = (beneath, ink);
    let [c, m, y, _] = blend([c, m, y], [c2, m2, y2]);
    let [k, ..] = blend([k; 3], [k2; 3]);
    [c, m, y, k]
}

/// How a file's values look: the light of inks, L, a and b, or gray.
pub enum InkView {
    Inks(Option<Press>),
    /// Whether a and b run to 256, as 16 bits hold them.
    Lab(bool),
    Gray(GrayTones),
}

impl InkView {
    /// Inks by a profile, or without one as an ideal press prints; `None` where values blend as
    /// sRGB does.
    pub fn of(
        mode: Mode,
        icc: Option<&[u8]>,
        gray: Option<&GrayTones>,
        is_deep: bool,
    ) -> Option<Self> {
        match mode {
            Mode::Cmyk => Some(Self::Inks(icc.and_then(Press::new))),
            Mode::Lab => Some(Self::Lab(is_deep)),
            Mode::Gray => gray.cloned().map(Self::Gray),
            _ => None,
        }
    }

    /// The encoded sRGB of a file's values.
    fn show(&self, values: &[[f32; 4]]) -> Option<Vec<[f32; 3]>> {
        let each = |show: &dyn Fn([f32; 4]) -> [f32; 3]| values.iter().map(|v| show(*v)).collect();
        match self {
            Self::Inks(Some(press)) => press.show(values),
            Self::Inks(None) => Some(each(&|[c, m, y, k]| [c * k, m * k, y * k])),
            Self::Lab(is_deep) => Some(each(&|[l, a, b, _]| {
                lab_to_linear([l, a, b], *is_deep).map(|v| srgb::encode(v.max(0.0).min(1.0)))
            })),
            Self::Gray(tones) => Some(each(&|[gray, ..]| [tones.tone(gray); 3])),
        }
    }

    /// Whether it is known how values are blended in a mode.
    fn can_blend(&self, mode: BlendMode) -> bool {
        mode == BlendMode::Normal || !matches!(self, Self::Lab(_))
    }
}

/// Gives the records the pixels with which they look as inks do. Whether it could; if not, they are
/// as they were.
///
/// * `records`: bottom first, with their inks.
/// * `is_deep`: the file has more than bytes.
pub fn try_fit(records: &mut [LayerRecord], size: Size, view: &InkView, is_deep: bool) -> bool {
    let Some(fitted) = steps::plan(records, view, is_deep)
        .and_then(|steps| InkComposer { records, size, view }.compose(&steps))
    else {
        return false;
    };
    for (number, layer) in fitted {
        if layer.is_needed() {
            let record = &mut records[number];
            let note = if record.adjustment.is_some() { ADJUSTED } else { NOTE };
            layer.put_into(record, note);
        }
    }
    true
}

/// Memory that fitting takes besides the records.
pub fn fitting_bytes(records: &[LayerRecord], size: Size) -> u64 {
    let seen = |record: &LayerRecord| area_of(seen_rect(record, size)) as u64;
    records.iter().map(seen).sum::<u64>().saturating_mul(8)
}

/// The canvas pixels that a layer paints or adjusts.
fn seen_rect(record: &LayerRecord, size: Size) -> Rect {
    match (&record.adjustment, &record.mask) {
        _ if record.section != RecordSection::Layer || !record.visible => Rect::EMPTY,
        (None, _) => record.rect.intersect(size.rect()),
        (Some(_), Some(mask)) if !mask.disabled && mask.outside == 0 => {
            mask.rect.intersect(size.rect())
        }
        _ => size.rect(),
    }
}

/// How much of a record is there at a pixel, besides its own alpha.
fn coverage(record: &LayerRecord, x: i32, y: i32) -> f32 {
    let mask = record.mask.as_ref().filter(|mask| !mask.disabled);
    let masked = mask.map_or(1.0, |mask| f32::from(mask.at(x, y)) / 255.0);
    masked * f32::from(record.opacity) / 255.0 * f32::from(record.fill_opacity) / 255.0
}

/// Composes the inks of a file.
struct InkComposer<'a> {
    records: &'a [LayerRecord],
    size: Size,
    view: &'a InkView,
}

impl InkComposer<'_> {
    /// What each layer became, by number.
    fn compose(&self, steps: &[InkStep]) -> Option<Vec<(usize, FittedLayer)>> {
        let numbers = || steps.iter().filter_map(InkStep::layer);
        let seen = |number: usize| seen_rect(&self.records[number], self.size);
        let all: u64 = numbers().map(|number| area_of(seen(number)) as u64).sum();
        if all > MOST_PIXELS {
            return None;
        }
        let mut fitted: Vec<_> =
            numbers().map(|number| (number, FittedLayer::new(seen(number)))).collect();
        for top in (0..self.size.height as usize).step_by(ROWS) {
            let rows = ROWS.min(self.size.height as usize - top);
            let strip = Rect::new(0, top as i32, self.size.width as i32, (top + rows) as i32);
            self.compose_strip(steps, strip, &mut fitted)?;
        }
        Some(fitted)
    }

    fn compose_strip(
        &self,
        steps: &[InkStep],
        strip: Rect,
        fitted: &mut [(usize, FittedLayer)],
    ) -> Option<()> {
        let blank = vec![InkPixel::default(); area_of(strip)];
        let mut open = vec![blank.clone()];
        let mut layers = fitted.iter_mut();
        for step in steps {
            match step {
                InkStep::Open(number) => open.push(self.ground(*number, strip, &blank)),
                InkStep::Close(number, mode) => {
                    let own = open.pop()?;
                    self.lay_group(*number, *mode, strip, &own, open.last_mut()?);
                }
                InkStep::Paint(number, mode) => {
                    let (_, layer) = layers.next()?;
                    self.paint(*number, *mode, strip, open.last_mut()?, layer)?;
                }
                InkStep::Adjust(number, tone) => {
                    let (_, layer) = layers.next()?;
                    self.adjust(*number, tone, strip, open.last_mut()?, layer)?;
                }
            }
        }
        Some(())
    }

    /// What a group begins with: an artboard's white, or nothing.
    fn ground(&self, number: usize, strip: Rect, blank: &[InkPixel]) -> Vec<InkPixel> {
        let mut pixels = blank.to_vec();
        let ground = self.records[number].ground.filter(|ground| ground.color.is_some());
        for (x, y) in pixels_of(ground.map_or(Rect::EMPTY, |g| g.rect.intersect(strip))) {
            pixels[place(strip, x, y)] = InkPixel { light: [1.0; 4], alpha: 1.0 };
        }
        pixels
    }

    fn lay_group(
        &self,
        number: usize,
        mode: BlendMode,
        strip: Rect,
        own: &[InkPixel],
        onto: &mut [InkPixel],
    ) {
        let group = &self.records[number];
        let seen = group.ground.map_or(strip, |ground| ground.rect.intersect(strip));
        for (x, y) in pixels_of(seen) {
            let at = place(strip, x, y);
            let alpha = own[at].alpha * coverage(group, x, y);
            onto[at] = onto[at].with(own[at].straight(), mode, alpha);
        }
    }

    fn paint(
        &self,
        number: usize,
        mode: BlendMode,
        strip: Rect,
        onto: &mut [InkPixel],
        layer: &mut FittedLayer,
    ) -> Option<()> {
        let record = &self.records[number];
        layer.is_plain = mode == BlendMode::Normal;
        let change = |at: usize, x: i32, y: i32| {
            let within = place(record.rect, x, y);
            let &[r, g, b, a] = record.rgba.as_chunks::<4>().0.get(within)?;
            let ink = record.inks.get(within)?.map(|v| f32::from(v) / 65535.0);
            let alpha = coverage(record, x, y) * f32::from(a) / 255.0;
            let own = [r, g, b].map(|v| f32::from(v) / 255.0);
            Some((onto[at].with(ink, mode, alpha), alpha, own))
        };
        let changes = self.changes(strip, layer.rect, change);
        layer.fit(changes, onto, self.view)
    }

    fn adjust(
        &self,
        number: usize,
        tone: &InkTone,
        strip: Rect,
        onto: &mut [InkPixel],
        layer: &mut FittedLayer,
    ) -> Option<()> {
        let record = &self.records[number];
        let change = |at: usize, x: i32, y: i32| {
            let before: InkPixel = onto[at];
            let share = coverage(record, x, y);
            let after = tone.of(before.straight());
            let part =
                |c: usize| before.light[c] + share * (before.alpha * after[c] - before.light[c]);
            let light = [0, 1, 2, 3].map(part);
            Some((InkPixel { light, ..before }, share * before.alpha, [0.0; 3]))
        };
        let changes = self.changes(strip, layer.rect, change);
        layer.fit(changes, onto, self.view)
    }

    /// What a layer changes in a strip, where it changes anything.
    fn changes(
        &self,
        strip: Rect,
        rect: Rect,
        change: impl Fn(usize, i32, i32) -> Option<(InkPixel, f32, [f32; 3])>,
    ) -> Vec<fit::Change> {
        let pixels = pixels_of(rect.intersect(strip));
        let changed = pixels.filter_map(|(x, y)| {
            let at = place(strip, x, y);
            let (after, alpha, own) = change(at, x, y)?;
            (alpha > 0.0).then_some(fit::Change { at, x, y, after, alpha, own })
        });
        changed.collect()
    }
}

fn area_of(rect: Rect) -> usize {
    rect.width() * rect.height()
}

/// The pixels of a rectangle, row by row.
fn pixels_of(rect: Rect) -> impl Iterator<Item = (i32, i32)> {
    (rect.y0..rect.y1).flat_map(move |y| (rect.x0..rect.x1).map(move |x| (x, y)))
}

/// The place of a pixel in a rectangle that holds it.
fn place(rect: Rect, x: i32, y: i32) -> usize {
    (y - rect.y0) as usize * rect.width() + (x - rect.x0) as usize
}

#[cfg(test)]
mod tests;
