//! Ramps as Photoshop mixes them: smoothly through their colors, in one of several color spaces.
//! Floor 5. Here a ramp is straight between its stops, so these lie close. Not here: how a ramp
//! lies (`fill`).
//!
//! Fitted to Photoshop's pixels (0.2 of 255 on average): the *smoothness* is the share of a
//! Catmull-Rom curve, whose ends are repeated, in what else is straight.

use super::colors::Colors;
use super::descriptor::DescriptorObject;
use super::fill::{self, GradientFill, Mark, share};
use crate::math::{oklab, srgb};
use crate::paint::GradientStop;

/// Stops from one mark to the next; of inks and Lab, which sRGB cuts off.
const BETWEEN: usize = 8;
const BETWEEN_OWN: usize = 64;
/// Marks of one ramp that are mixed smoothly; no real ramp has more.
const MOST_MARKS: usize = 100;
/// The whole length of a ramp, and all of its smoothness.
const WHOLE: f32 = 4096.0;

/// The color space that a ramp is mixed in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RampMixing {
    /// The document's values.
    #[default]
    Classic,
    /// Light.
    Linear,
    /// As equal steps look.
    Perceptual,
}

impl RampMixing {
    /// By Photoshop's word.
    pub fn of(word: &[u8]) -> Self {
        match word {
            b"Lnr " => Self::Linear,
            b"Perc" => Self::Perceptual,
            _ => Self::Classic,
        }
    }

    fn enter(self, color: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Classic => color,
            Self::Linear => color.map(srgb::decode),
            Self::Perceptual => oklab::from_linear(color.map(srgb::decode)),
        }
    }

    fn leave(self, color: [f32; 3]) -> [f32; 3] {
        let encode = |v: f32| srgb::encode(v.max(0.0));
        match self {
            Self::Classic => color,
            Self::Linear => color.map(encode),
            Self::Perceptual => oklab::to_linear(color).map(encode),
        }
    }
}

/// A ramp and how it lies, as fills and effects say it; `None` of noise.
pub fn gradient(said: &DescriptorObject, colors: &Colors) -> Option<GradientFill> {
    let read = fill::gradient(said, colors)?;
    let ramp = said.object("Grad")?;
    let mixing = RampMixing::of(said.word("gs99").unwrap_or_default());
    // With 32 bits a channel, the document's values are light.
    let is_of_light = colors.is_light && mixing == RampMixing::Classic;
    let mixing = if is_of_light { RampMixing::Linear } else { mixing };
    let smoothness = ramp.number("Intr").unwrap_or(0.0);
    if mixing == RampMixing::Classic
        && let Some(stops) = own_stops(ramp, smoothness, colors)
    {
        return Some(GradientFill { stops: fill::in_direction(stops, said, read.way), ..read });
    }
    if smoothness == 0.0 && mixing == RampMixing::Classic {
        return Some(read);
    }
    let inks = marks(ramp, "Clrs", |object| {
        let [r, g, b, _] = fill::color(object.object("Clr ")?, colors)?.to_f32();
        Some([r, g, b])
    })?;
    let opacities = marks(ramp, "Trns", |object| Some([share(object, "Opct", 1.0)]))?;
    let stops = fill::in_direction(stops(inks, opacities, smoothness, mixing)?, said, read.way);
    Some(GradientFill { stops, ..read })
}

fn marks<const N: usize>(
    ramp: &DescriptorObject,
    list: &str,
    value: impl Fn(&DescriptorObject) -> Option<[f32; N]>,
) -> Option<Vec<Mark<[f32; N]>>> {
    let mark = |object: &DescriptorObject| {
        let t = (object.number("Lctn")? / WHOLE).max(0.0).min(1.0);
        let middle = share(object, "Mdpn", 0.5).max(0.01).min(0.99);
        Some(Mark { t, middle, value: value(object)? })
    };
    ramp.objects(list).map(mark).collect()
}

/// The ramp's colors and opacities as stops of colors with alpha; `None` without a color.
///
/// * `smoothness`: 0 is straight, 4096 all of the curve.
pub fn stops(
    mut inks: Vec<Mark<[f32; 3]>>,
    mut opacities: Vec<Mark<[f32; 1]>>,
    smoothness: f32,
    mixing: RampMixing,
) -> Option<Vec<GradientStop>> {
    inks.sort_by(|a, b| a.t.total_cmp(&b.t));
    opacities.sort_by(|a, b| a.t.total_cmp(&b.t));
    let is_even = inks.windows(2).all(|pair| pair[0].value == pair[1].value)
        && opacities.windows(2).all(|pair| pair[0].value == pair[1].value);
    let is_plain = smoothness == 0.0 && mixing == RampMixing::Classic;
    if is_even || is_plain || inks.len() + opacities.len() > MOST_MARKS {
        return fill::ramp(inks, opacities);
    }
    let entered =
        inks.iter().map(|mark| Mark { value: mixing.enter(mark.value), ..*mark }).collect();
    let leave = |values: Vec<[f32; 3]>| values.into_iter().map(|v| mixing.leave(v)).collect();
    dense_stops(entered, opacities, smoothness, BETWEEN, leave)
}

/// Stops close to each other, of values that are mixed; all of them in order.
///
/// * `between`: stops from one mark to the next.
/// * `leave`: the colors of values.
fn dense_stops<const N: usize>(
    inks: Vec<Mark<[f32; N]>>,
    opacities: Vec<Mark<[f32; 1]>>,
    smoothness: f32,
    between: usize,
    leave: impl FnOnce(Vec<[f32; N]>) -> Vec<[f32; 3]>,
) -> Option<Vec<GradientStop>> {
    let mut places: Vec<f32> = inks.iter().map(|mark| mark.t).collect();
    places.extend(opacities.iter().map(|mark| mark.t));
    places.sort_by(f32::total_cmp);
    let places_of = |pair: &[f32]| {
        let (from, to) = (pair[0], pair[1]);
        let count = if from == to { 1 } else { between };
        (0..count).map(move |i| from + (to - from) * i as f32 / between as f32)
    };
    let mut all: Vec<f32> =
        places.windows(2).flat_map(places_of).chain(places.last().copied()).collect();
    all.dedup();
    let share = (smoothness / WHOLE).max(0.0).min(1.0);
    let mark = |t: f32, value: [f32; 1]| Mark { t, middle: 0.5, value };
    let (mut values, mut dense_opacities) = (Vec::new(), Vec::new());
    for t in all {
        for side in sides(&inks, &opacities, t).into_iter().flatten() {
            values.push(value_at(&inks, t, side, share)?);
            let opacity = value_at(&opacities, t, side, share).unwrap_or([1.0]);
            dense_opacities.push(mark(t, opacity));
        }
    }
    let colors = leave(values).into_iter().zip(&dense_opacities);
    let dense_inks = colors.map(|(value, at)| Mark { t: at.t, middle: 0.5, value }).collect();
    fill::ramp(dense_inks, dense_opacities)
}

/// The stops of a ramp whose colors are said as values of the file, which mixes those; `None` of
/// others.
fn own_stops(
    ramp: &DescriptorObject,
    smoothness: f32,
    colors: &Colors,
) -> Option<Vec<GradientStop>> {
    let mut inks =
        marks(ramp, "Clrs", |object| fill::own_values(object.object("Clr ")?, colors.mode))?;
    let mut opacities = marks(ramp, "Trns", |object| Some([share(object, "Opct", 1.0)]))?;
    if inks.len() + opacities.len() > MOST_MARKS {
        return None;
    }
    inks.sort_by(|a, b| a.t.total_cmp(&b.t));
    opacities.sort_by(|a, b| a.t.total_cmp(&b.t));
    let show = |values: Vec<[f32; 4]>| fill::show_values(&values, colors);
    dense_stops(inks, opacities, smoothness, BETWEEN_OWN, show)
}

/// From which side a place is seen.
#[derive(Clone, Copy, PartialEq, Eq)]
enum RampSide {
    Before,
    Behind,
}

/// Both sides of a hard edge, one of any other place.
fn sides<const N: usize>(
    inks: &[Mark<[f32; N]>],
    opacities: &[Mark<[f32; 1]>],
    t: f32,
) -> [Option<RampSide>; 2] {
    let is_edge = inks.iter().filter(|mark| mark.t == t).count() > 1
        || opacities.iter().filter(|mark| mark.t == t).count() > 1;
    [is_edge.then_some(RampSide::Before), Some(RampSide::Behind)]
}

/// The value at a place, `smooth` of it on the curve through the marks.
fn value_at<const N: usize>(
    marks: &[Mark<[f32; N]>],
    t: f32,
    side: RampSide,
    smooth: f32,
) -> Option<[f32; N]> {
    let next = match side {
        RampSide::Before => marks.partition_point(|mark| mark.t < t),
        RampSide::Behind => marks.partition_point(|mark| mark.t <= t),
    };
    let (Some(i), Some(to)) = (next.checked_sub(1), marks.get(next)) else {
        return if next == 0 { marks.first() } else { marks.last() }.map(|mark| mark.value);
    };
    let from = marks[i];
    let s = to.bend((t - from.t) / (to.t - from.t));
    // A curve ends where a ramp does, and at hard edges.
    let before = i.checked_sub(1).map(|i| marks[i]).filter(|mark| mark.t < from.t);
    let behind = marks.get(next + 1).filter(|mark| mark.t > to.t);
    let (before, behind) = (before.unwrap_or(from).value, behind.unwrap_or(to).value);
    Some(std::array::from_fn(|c| {
        let (a, b) = (from.value[c], to.value[c]);
        let straight = a + (b - a) * s;
        // It stays between the values of its ends.
        let curve = catmull_rom([before[c], a, b, behind[c]], s).max(a.min(b)).min(a.max(b));
        straight + (curve - straight) * smooth
    }))
}

/// The curve through the second and third of four values.
fn catmull_rom([p0, p1, p2, p3]: [f32; 4], s: f32) -> f32 {
    let (begin, end) = ((p2 - p0) / 2.0, (p3 - p1) / 2.0);
    let (square, cube) = (s * s, s * s * s);
    p1 * (2.0 * cube - 3.0 * square + 1.0)
        + begin * (cube - 2.0 * square + s)
        + p2 * (3.0 * square - 2.0 * cube)
        + end * (cube - square)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn color_at(stops: &[GradientStop], t: f32) -> [u8; 3] {
        let stop = stops.iter().find(|stop| (stop.t - t).abs() < 1e-4).unwrap();
        [stop.color.r, stop.color.g, stop.color.b]
    }

    fn ink(t: f32, value: [f32; 3]) -> Mark<[f32; 3]> {
        Mark { t, middle: 0.5, value }
    }

    #[test]
    fn a_smooth_ramp_leaves_its_ends_slowly() {
        let (black, white) = (ink(0.0, [0.0; 3]), ink(1.0, [1.0; 3]));
        let of =
            |smoothness, mixing| stops(vec![black, white], Vec::new(), smoothness, mixing).unwrap();
        assert_eq!(color_at(&of(0.0, RampMixing::Classic), 0.25)[0], 64, "straight");
        let smooth = of(4096.0, RampMixing::Classic);
        // (s + 3 s² − 2 s³) / 2
        assert_eq!([0.25, 0.5, 0.75].map(|t| color_at(&smooth, t)[0]), [52, 128, 203]);
        let half = of(2048.0, RampMixing::Classic);
        assert_eq!(color_at(&half, 0.25)[0], 58);
    }

    #[test]
    fn ramps_are_mixed_as_light_or_as_equal_steps_look() {
        let ends = vec![ink(0.0, [1.0, 0.0, 0.0]), ink(1.0, [0.0, 1.0, 0.0])];
        let middle = |mixing| color_at(&stops(ends.clone(), Vec::new(), 0.0, mixing).unwrap(), 0.5);
        // Half the light of red and of green.
        assert_eq!(middle(RampMixing::Linear), [188, 188, 0]);
        let [r, g, b] = middle(RampMixing::Perceptual);
        assert!(r > 190 && g > 150 && b < 60, "{:?}", [r, g, b]);
    }

    /// A quarter of a ramp of three inks in a file of Photoshop: 129.0, 10.1 and 128.1 of 255.
    #[test]
    fn a_curve_stays_between_the_values_of_its_ends() {
        let mark = |t, value| Mark { t, middle: 0.5, value };
        let marks = [
            mark(0.0, [0.0, 15.84, 246.56]),
            mark(0.5, [255.0, 10.1, 13.49]),
            mark(1.0, [230.9, 255.0, 44.4]),
        ];
        let found = value_at(&marks, 0.25, RampSide::Behind, 1.0).unwrap();
        let far = found.iter().zip([129.0, 10.1, 128.1]).map(|(v, w)| (v - w).abs());
        assert!(far.fold(0.0, f32::max) < 0.1, "{found:?}");
    }

    #[test]
    fn the_middle_of_a_color_lies_before_it() {
        let marks = [
            ink(0.0, [0.0; 3]),
            Mark { middle: 0.8, ..ink(0.5, [1.0; 3]) },
            Mark { middle: 0.2, ..ink(1.0, [0.0; 3]) },
        ];
        // A narrow light line in the middle.
        for (t, tone) in [(0.2, 0.25), (0.4, 0.5), (0.5, 1.0), (0.6, 0.5), (0.8, 0.25)] {
            let [found, ..] = value_at(&marks, t, RampSide::Behind, 0.0).unwrap();
            assert!((found - tone).abs() < 1e-5, "{t}: {found}");
        }
    }

    #[test]
    fn hard_edges_stay_hard() {
        let inks =
            vec![ink(0.0, [0.0; 3]), ink(0.5, [0.0; 3]), ink(0.5, [1.0; 3]), ink(1.0, [1.0; 3])];
        let made = stops(inks, Vec::new(), 4096.0, RampMixing::Classic).unwrap();
        let at_edge: Vec<u8> =
            made.iter().filter(|stop| stop.t == 0.5).map(|stop| stop.color.r).collect();
        assert_eq!(at_edge, [0, 255]);
        assert!(made.iter().all(|stop| (stop.t < 0.5) != (stop.color.r == 255) || stop.t == 0.5));
    }
}
