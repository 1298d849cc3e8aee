//! Sculpting: dabs on a height layer over a form.
//! Floor 3. Strokes are kept; the layer follows from them.

use super::Form;
use crate::math::{Range, UNIT, Vec2, vec2};
use crate::raster::Plane;

crate::named! {
    /// What a dab does to the heights beneath it.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum SculptTool {
        #[default]
        Raise = "raise",
        Lower = "lower",
        /// Toward the mean of what is around.
        Smooth = "smooth",
        /// Toward the plane under the first dab.
        Flatten = "flatten",
        /// Lowers along a sharp line.
        Crease = "crease",
        /// Pulls heights together toward the middle of the dab.
        Pinch = "pinch",
        /// As flatten, but only what sticks out.
        Scrape = "scrape",
    }
}

impl SculptTool {
    /// Whether a dab's strength is a height in px; for the others it is a share of the way.
    pub fn is_by_height(self) -> bool {
        matches!(self, SculptTool::Raise | SculptTool::Lower | SculptTool::Crease)
    }
}

/// A stroke on the height layer.
#[derive(Clone, Debug, PartialEq)]
pub struct SculptStroke {
    /// What it does to the heights.
    pub tool: SculptTool,
    /// Diameter of a dab, px.
    pub size: f32,
    /// The part of the dab with full strength.
    pub hardness: f32,
    /// For raise, lower and crease: px per dab; for the others: the share of the way that a dab
    /// goes, at most 1.
    pub strength: f32,
    /// Canvas px, and pressure.
    pub samples: Vec<(Vec2, f32)>,
}

impl SculptStroke {
    /// What a diameter may be, px.
    pub const SIZE: Range = 1.0..=8192.0;
    /// What a hardness may be.
    pub const HARDNESS: Range = UNIT;
    /// What a strength may be, px.
    pub const STRENGTH: Range = 0.0..=512.0;
    /// What a pressure may be.
    pub const PRESSURE: Range = UNIT;
    /// The most samples of one stroke, and strokes of one part.
    pub const MOST: usize = 100_000;
    /// From dab to dab, as a share of the diameter.
    const SPACING: f32 = 0.125;

    /// The places of dabs, at the given spacing, with their pressure.
    fn dabs(&self) -> Vec<(Vec2, f32)> {
        let step = (Self::SPACING * self.size).max(0.5);
        let mut dabs: Vec<(Vec2, f32)> = self.samples.first().copied().into_iter().collect();
        let mut since = 0.0;
        for pair in self.samples.windows(2) {
            let (way, length) = (pair[1].0 - pair[0].0, pair[0].0.distance(pair[1].0));
            let mut at = step - since;
            while at <= length && dabs.len() < Self::MOST {
                let t = at / length;
                dabs.push((pair[0].0 + t * way, pair[0].1 + t * (pair[1].1 - pair[0].1)));
                at += step;
            }
            since = length - (at - step);
        }
        dabs
    }
}

/// The height layer that strokes make over a form, px, as large as its planes; 0 where no dab
/// lands.
pub fn sculpt_heights(form: &Form, strokes: &[SculptStroke]) -> Plane<f32> {
    Sculpting::of(form).go_on(form, strokes).layer
}

/// How far strokes came over a form: more samples of the last one, and more strokes, continue from
/// there.
pub struct Sculpting {
    /// The strokes that are done, the last one up to its end at that time.
    strokes: Vec<SculptStroke>,
    layer: Plane<f32>,
    /// Dabs of the last stroke, and the plane under its first.
    dabs: usize,
    first: Option<SculptPlane>,
}

impl Sculpting {
    /// Nothing done yet.
    pub fn of(form: &Form) -> Self {
        Self {
            strokes: Vec::new(),
            layer: Plane::full(form.height.size(), 0.0),
            dabs: 0,
            first: None,
        }
    }

    /// The heights, px, as large as the form's planes.
    pub fn layer(&self) -> &Plane<f32> {
        &self.layer
    }

    /// Whether strokes begin as those that are done.
    pub fn is_continued_by(&self, strokes: &[SculptStroke]) -> bool {
        let Some((last, before)) = self.strokes.split_last() else { return true };
        let begins = |now: &SculptStroke| {
            let same = |a: &SculptStroke, b: &SculptStroke| {
                (a.tool, a.size, a.hardness, a.strength) == (b.tool, b.size, b.hardness, b.strength)
            };
            same(last, now) && now.samples.starts_with(&last.samples)
        };
        strokes.len() > before.len()
            && strokes.starts_with(before)
            && begins(&strokes[before.len()])
    }

    /// With what the strokes have beyond those that are done, which must be their beginning.
    /// Bit-identical to doing all of them again.
    pub fn go_on(mut self, form: &Form, strokes: &[SculptStroke]) -> Self {
        let done = self.strokes.len().saturating_sub(1);
        let corner = vec2(form.corner.0 as f32, form.corner.1 as f32);
        for (i, stroke) in strokes.iter().enumerate().skip(done) {
            if i > done || self.strokes.is_empty() {
                (self.dabs, self.first) = (0, None);
            }
            if !(stroke.size.is_finite() && stroke.size > 0.0) {
                continue;
            }
            let dabs = stroke.dabs();
            if let Some(dab) = dabs.first().filter(|_| self.dabs == 0) {
                self.first =
                    SculptPlane::under(form, &self.layer, dab.0 - corner, 0.5 * stroke.size);
            }
            for (at, pressure) in &dabs[self.dabs.min(dabs.len())..] {
                let dab = SculptDab {
                    center: *at - corner,
                    radius: 0.5 * stroke.size,
                    stroke,
                    pressure: *pressure,
                };
                dab.press(form, &mut self.layer, self.first);
            }
            self.dabs = dabs.len();
        }
        strokes.clone_into(&mut self.strokes);
        self
    }
}

/// A plane through heights: `height + slope · (p − at)`.
#[derive(Clone, Copy)]
struct SculptPlane {
    at: Vec2,
    height: f32,
    slope: Vec2,
}

impl SculptPlane {
    /// The plane nearest to the heights under a dab, by least squares.
    fn under(form: &Form, layer: &Plane<f32>, center: Vec2, radius: f32) -> Option<Self> {
        let (mut n, mut sum, mut squares, mut products) = (0.0f32, 0.0f32, Vec2::ZERO, Vec2::ZERO);
        let pixels: Vec<_> = pixels_of(form, center, radius).collect();
        let middle = pixels.iter().map(|(p, _, _)| *p).sum::<Vec2>() / pixels.len().max(1) as f32;
        for (p, x, y) in &pixels {
            let (z, from) = (form.height.at(*x, *y) + layer.at(*x, *y), *p - middle);
            n += 1.0;
            sum += z;
            squares += from * from;
            products += from * z;
        }
        (n > 0.0).then(|| Self {
            at: middle,
            height: sum / n,
            slope: products / squares.max(Vec2::splat(1e-3)),
        })
    }
}

/// The covered pixels under a dab: their centers in px of the planes, column and row.
fn pixels_of(
    form: &Form,
    center: Vec2,
    radius: f32,
) -> impl Iterator<Item = (Vec2, usize, usize)> + '_ {
    let (w, h) = (form.height.width(), form.height.height());
    let side = |low: f32, high: f32, n: usize| {
        low.floor().max(0.0) as usize..(high.ceil().max(0.0) as usize).min(n)
    };
    let columns = side(center.x - radius, center.x + radius, w);
    side(center.y - radius, center.y + radius, h).flat_map(move |y| {
        columns.clone().filter_map(move |x| {
            let p = vec2(x as f32 + 0.5, y as f32 + 0.5);
            (form.coverage.at(x, y) > 0 && p.distance(center) <= radius).then_some((p, x, y))
        })
    })
}

struct SculptDab<'a> {
    center: Vec2,
    radius: f32,
    stroke: &'a SculptStroke,
    pressure: f32,
}

impl SculptDab<'_> {
    /// Coverage at a distance from the middle: whole up to the hardness, then falling smoothly.
    fn coverage(&self, distance: f32) -> f32 {
        let hard = self.stroke.hardness.min(0.99);
        let t = ((distance / self.radius - hard) / (1.0 - hard)).max(0.0).min(1.0);
        let left = 1.0 - t * t;
        left * left * self.pressure
    }

    fn press(&self, form: &Form, layer: &mut Plane<f32>, first: Option<SculptPlane>) {
        let strength = self.stroke.strength;
        let share = |coverage: f32| (strength * coverage).min(1.0);
        let total = |layer: &Plane<f32>, x: usize, y: usize| form.height.at(x, y) + layer.at(x, y);
        let changed: Vec<(usize, usize, f32)> = pixels_of(form, self.center, self.radius)
            .map(|(p, x, y)| {
                let from = p - self.center;
                let coverage = self.coverage(from.length());
                let toward_plane =
                    || first.map_or(0.0, |f| f.height + f.slope.dot(p - f.at) - total(layer, x, y));
                let change = match self.stroke.tool {
                    SculptTool::Raise => strength * coverage,
                    SculptTool::Lower => -strength * coverage,
                    SculptTool::Crease => -strength * coverage.powi(4),
                    SculptTool::Flatten => share(coverage) * toward_plane(),
                    SculptTool::Scrape => share(coverage) * toward_plane().min(0.0),
                    SculptTool::Smooth => {
                        share(coverage) * (self.mean_height(form, layer, x, y) - total(layer, x, y))
                    }
                    SculptTool::Pinch => {
                        let out = p + from * (0.25 * share(coverage));
                        height_at(form, layer, out).map_or(0.0, |z| z - total(layer, x, y))
                    }
                };
                (x, y, if change.is_finite() { change } else { 0.0 })
            })
            .collect();
        for (x, y, change) in changed {
            layer.set(x, y, layer.at(x, y) + change);
        }
    }

    /// The mean height of a pixel and eight places around it, an eighth of the dab away.
    fn mean_height(&self, form: &Form, layer: &Plane<f32>, x: usize, y: usize) -> f32 {
        let p = vec2(x as f32 + 0.5, y as f32 + 0.5);
        let far = (0.25 * self.radius).max(1.0);
        let around =
            (0..8).map(|i| p + far * Vec2::from_angle(i as f32 * std::f32::consts::FRAC_PI_4));
        let (mut sum, mut count) = (form.height.at(x, y) + layer.at(x, y), 1.0);
        for z in around.filter_map(|q| height_at(form, layer, q)) {
            sum += z;
            count += 1.0;
        }
        sum / count
    }
}

/// Height between pixels, px of the planes; `None` where one of the four is not covered.
fn height_at(form: &Form, layer: &Plane<f32>, p: Vec2) -> Option<f32> {
    let q = p - 0.5;
    let (x, y) = (q.x.floor() as i32, q.y.floor() as i32);
    let at = |dx: i32, dy: i32| {
        let covered = form.coverage.get(x + dx, y + dy).is_some_and(|c| c > 0);
        covered.then(|| {
            form.height.at((x + dx) as usize, (y + dy) as usize)
                + layer.at((x + dx) as usize, (y + dy) as usize)
        })
    };
    let (fx, fy) = (q.x - x as f32, q.y - y as f32);
    let row = |dy: i32| Some(at(0, dy)? * (1.0 - fx) + at(1, dy)? * fx);
    Some(row(0)? * (1.0 - fy) + row(1)? * fy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3, hash};

    fn plate(height: impl Fn(usize, usize) -> f32 + Sync) -> Form {
        let size = Size::new(120, 90);
        Form {
            corner: (10, 20),
            height: Plane::from_fn(size, height).into(),
            normals: Plane::full(size, Vec3::Z).into(),
            coverage: Plane::full(size, 255).into(),
        }
    }

    fn stroke(tool: SculptTool, strength: f32, samples: &[(f32, f32)]) -> SculptStroke {
        let samples = samples.iter().map(|s| (vec2(s.0, s.1), 1.0)).collect();
        SculptStroke { tool, size: 40.0, hardness: 0.5, strength, samples }
    }

    #[test]
    fn a_dab_raises_by_its_strength_and_nothing_beyond_its_size() {
        let layer =
            sculpt_heights(&plate(|_, _| 0.0), &[stroke(SculptTool::Raise, 3.0, &[(70.0, 60.0)])]);
        assert!((layer.at(60, 40) - 3.0).abs() < 1e-4);
        assert_eq!(layer.at(60 + 21, 40), 0.0);
        let lowered =
            sculpt_heights(&plate(|_, _| 0.0), &[stroke(SculptTool::Lower, 3.0, &[(70.0, 60.0)])]);
        assert!((lowered.at(60, 40) + 3.0).abs() < 1e-4);
    }

    #[test]
    fn smoothing_calms_flattening_levels_and_scraping_only_lowers() {
        let rough = plate(|x, y| 8.0 * hash::unit(3, x as u32, y as u32));
        let spread = |layer: &Plane<f32>| {
            let values: Vec<f32> =
                (50..70).map(|x| rough.height.at(x, 40) + layer.at(x, 40)).collect();
            let mean = values.iter().sum::<f32>() / values.len() as f32;
            values.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / values.len() as f32
        };
        let before = spread(&Plane::full(rough.height.size(), 0.0));
        let line = [(55.0, 60.0), (85.0, 60.0)];
        for tool in [SculptTool::Smooth, SculptTool::Flatten, SculptTool::Scrape] {
            let layer = sculpt_heights(&rough, &[stroke(tool, 0.6, &line)]);
            assert!(spread(&layer) < 0.5 * before, "{tool:?}: {} of {before}", spread(&layer));
            assert!(tool != SculptTool::Scrape || layer.values().iter().all(|h| *h <= 0.0));
        }
    }

    #[test]
    fn strokes_that_go_on_are_to_the_bit_what_they_are_at_once() {
        let rough = plate(|x, y| 8.0 * hash::unit(3, x as u32, y as u32));
        let way: Vec<(f32, f32)> =
            (0..30).map(|i| (40.0 + 2.3 * i as f32, 60.0 + (i as f32 * 0.4).sin() * 9.0)).collect();
        for (tool, name) in &SculptTool::ALL {
            let first = stroke(SculptTool::Raise, 2.0, &[(60.0, 50.0), (80.0, 70.0)]);
            let strokes = |n: usize| vec![first.clone(), stroke(*tool, 0.6, &way[..n])];
            let mut going = Sculpting::of(&rough).go_on(&rough, std::slice::from_ref(&first));
            for n in [1, 2, 9, 30] {
                assert!(going.is_continued_by(&strokes(n)), "{name} {n}");
                going = going.go_on(&rough, &strokes(n));
                assert!(going.layer() == &sculpt_heights(&rough, &strokes(n)), "{name} {n}");
            }
            assert!(!going.is_continued_by(&strokes(29)) && !going.is_continued_by(&[]));
            let other = vec![first.clone(), SculptStroke { size: 41.0, ..strokes(30).remove(1) }];
            assert!(!going.is_continued_by(&other));
        }
    }

    #[test]
    fn dabs_stand_as_far_apart_however_many_samples_there_are() {
        let far = stroke(SculptTool::Raise, 1.0, &[(0.0, 0.0), (100.0, 0.0)]);
        let near: Vec<(f32, f32)> = (0..=50).map(|i| (i as f32 * 2.0, 0.0)).collect();
        assert_eq!(far.dabs().len(), stroke(SculptTool::Raise, 1.0, &near).dabs().len());
        assert_eq!(far.dabs().len(), 21);
    }
}
