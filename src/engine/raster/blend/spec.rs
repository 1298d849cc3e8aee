//! The blend functions as the specification writes them: straight colors in [0, 1], one function a
//! mode. Floor 1. The reference that reads like W3C Compositing and Blending Level 1, sec. 9;
//! `rows` is the fast twin. Modes that W3C does not define follow Photoshop, compared with files
//! that it saved.

use crate::math::hash;
use crate::raster::planar::sane;

/// One mode's B(cb, cs), backdrop first as in the specification: for a component, or for a whole
/// color.
#[derive(Clone, Copy)]
pub enum BlendFunction {
    /// Each component on its own (sec. 9.1).
    Separable(fn(f32, f32) -> f32),
    /// All three components together (sec. 9.2).
    NonSeparable(fn([f32; 3], [f32; 3]) -> [f32; 3]),
    /// Not a mixing formula but a sum of premultiplied values, clamped at 1 (sec. 7, `lighter`).
    Sum(fn(f32, f32) -> f32),
}

impl BlendFunction {
    /// Composites one premultiplied pixel over another (sec. 5.8): the backdrop's share, the
    /// source's share outside the backdrop, and B where both are.
    ///
    /// Total: every component is brought into `[0, 1]` first, colors to at most their alpha, NaN
    /// to 0.
    pub fn composite(self, backdrop: [f32; 4], source: [f32; 4]) -> [f32; 4] {
        let (backdrop, source) = (sane(backdrop), sane(source));
        let (ab, as_) = (backdrop[3], source[3]);
        let straight = |p: [f32; 4]| [0, 1, 2].map(|c| if p[3] > 0.0 { p[c] / p[3] } else { 0.0 });
        let (cb, cs) = (straight(backdrop), straight(source));
        let mixed = match self {
            BlendFunction::Separable(b) => [0, 1, 2].map(|c| b(cb[c], cs[c])),
            BlendFunction::NonSeparable(b) => b(cb, cs),
            BlendFunction::Sum(sum) => return [0, 1, 2, 3].map(|c| sum(backdrop[c], source[c])),
        };
        let [r, g, b] = [0, 1, 2]
            .map(|c| as_ * (1.0 - ab) * cs[c] + as_ * ab * mixed[c] + (1.0 - as_) * ab * cb[c]);
        [r, g, b, as_ + ab - as_ * ab]
    }
}

/// Any number: a layer dissolves the same way on every run.
const DISSOLVE_SEED: u32 = 0x0d15_5017;
/// Half a step of a byte: sums that are as near to 1 count as 1, so that rounding decides nothing.
const HALF_STEP: f32 = 0.5 / 255.0;

/// What dissolving leaves of a premultiplied pixel at a point of the canvas: all of it, with its
/// alpha as the probability, or nothing.
#[inline(always)]
pub fn dissolve(source: [f32; 4], [x, y]: [i32; 2]) -> [f32; 4] {
    let alpha = source[3];
    if hash::unit(DISSOLVE_SEED, x as u32, y as u32) < alpha {
        source.map(|v| (v / alpha).min(1.0))
    } else {
        [0.0; 4]
    }
}

/// The source alone (sec. 9.1.1).
#[inline(always)]
pub fn normal(_cb: f32, cs: f32) -> f32 {
    cs
}

/// Never lighter than either (sec. 9.1.2).
#[inline(always)]
pub fn multiply(cb: f32, cs: f32) -> f32 {
    cb * cs
}

/// Never darker than either (sec. 9.1.3).
#[inline(always)]
pub fn screen(cb: f32, cs: f32) -> f32 {
    cb + cs - cb * cs
}

/// Multiplies or screens, as the backdrop is dark or light (sec. 9.1.4).
#[inline(always)]
pub fn overlay(cb: f32, cs: f32) -> f32 {
    hard_light(cs, cb)
}

/// The darker of both (sec. 9.1.5).
#[inline(always)]
pub fn darken(cb: f32, cs: f32) -> f32 {
    cb.min(cs)
}

/// The lighter of both (sec. 9.1.6).
#[inline(always)]
pub fn lighten(cb: f32, cs: f32) -> f32 {
    cb.max(cs)
}

/// Brightens the backdrop to reflect the source (sec. 9.1.7).
#[inline(always)]
pub fn color_dodge(cb: f32, cs: f32) -> f32 {
    if cb == 0.0 {
        0.0
    } else if cs == 1.0 {
        1.0
    } else {
        (cb / (1.0 - cs)).min(1.0)
    }
}

/// Darkens the backdrop to reflect the source (sec. 9.1.8).
#[inline(always)]
pub fn color_burn(cb: f32, cs: f32) -> f32 {
    if cb == 1.0 {
        1.0
    } else if cs == 0.0 {
        0.0
    } else {
        1.0 - ((1.0 - cb) / cs).min(1.0)
    }
}

/// Multiplies or screens, as the source is dark or light (sec. 9.1.9).
#[inline(always)]
pub fn hard_light(cb: f32, cs: f32) -> f32 {
    if cs <= 0.5 { multiply(cb, 2.0 * cs) } else { screen(cb, 2.0 * cs - 1.0) }
}

/// Darkens or lightens softly, as the source is dark or light (sec. 9.1.10).
#[inline(always)]
pub fn soft_light(cb: f32, cs: f32) -> f32 {
    let d = if cb <= 0.25 { ((16.0 * cb - 12.0) * cb + 4.0) * cb } else { cb.sqrt() };
    if cs <= 0.5 {
        cb - (1.0 - 2.0 * cs) * cb * (1.0 - cb)
    } else {
        cb + (2.0 * cs - 1.0) * (d - cb)
    }
}

/// How far both differ (sec. 9.1.11).
#[inline(always)]
pub fn difference(cb: f32, cs: f32) -> f32 {
    (cb - cs).abs()
}

/// As the difference, with less contrast (sec. 9.1.12).
#[inline(always)]
pub fn exclusion(cb: f32, cs: f32) -> f32 {
    cb + cs - 2.0 * cb * cs
}

/// The sum of both, at most white.
#[inline(always)]
pub fn linear_dodge(cb: f32, cs: f32) -> f32 {
    (cb + cs).min(1.0)
}

/// The sum less white, at least black.
#[inline(always)]
pub fn linear_burn(cb: f32, cs: f32) -> f32 {
    (cb + cs - 1.0).max(0.0)
}

/// Burns or dodges linearly, as the source is dark or light.
#[inline(always)]
pub fn linear_light(cb: f32, cs: f32) -> f32 {
    (cb + 2.0 * cs - 1.0).max(0.0).min(1.0)
}

/// Burns or dodges, as the source is dark or light. Unlike in the modes of those names, a black
/// source is black on white too, and a white one is white on black.
#[inline(always)]
pub fn vivid_light(cb: f32, cs: f32) -> f32 {
    if cs == 0.0 {
        0.0
    } else if cs == 1.0 {
        1.0
    } else if cs <= 0.5 {
        color_burn(cb, 2.0 * cs)
    } else {
        color_dodge(cb, 2.0 * cs - 1.0)
    }
}

/// Replaces what is darker, or lighter, than the source allows.
#[inline(always)]
pub fn pin_light(cb: f32, cs: f32) -> f32 {
    if cs <= 0.5 { darken(cb, 2.0 * cs) } else { lighten(cb, 2.0 * cs - 1.0) }
}

/// Each channel wholly black or white; where both sum up to white, the backdrop decides.
#[inline(always)]
pub fn hard_mix(cb: f32, cs: f32) -> f32 {
    let over = cb + cs - 1.0;
    if over > HALF_STEP || (over > -HALF_STEP && cb > 0.5) { 1.0 } else { 0.0 }
}

/// The backdrop less the source.
#[inline(always)]
pub fn subtract(cb: f32, cs: f32) -> f32 {
    (cb - cs).max(0.0)
}

/// The backdrop over the source; black over black is black.
#[inline(always)]
pub fn divide(cb: f32, cs: f32) -> f32 {
    if cs > 0.0 {
        (cb / cs).min(1.0)
    } else if cb > 0.0 {
        1.0
    } else {
        0.0
    }
}

/// Of premultiplied values, and of the alphas.
#[inline(always)]
pub fn plus(backdrop: f32, source: f32) -> f32 {
    (backdrop + source).min(1.0)
}

/// The darker of both, as a whole.
#[inline(always)]
pub fn darker(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    if lum(cs) < lum(cb) { cs } else { cb }
}

/// The lighter of both, as a whole.
#[inline(always)]
pub fn lighter(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    if lum(cs) > lum(cb) { cs } else { cb }
}

/// The source's hue with the backdrop's saturation and luminosity (sec. 9.2.1).
#[inline(always)]
pub fn hue(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    set_lum(set_sat(cs, sat(cb)), lum(cb))
}

/// The source's saturation with the backdrop's hue and luminosity (sec. 9.2.2).
#[inline(always)]
pub fn saturation(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    set_lum(set_sat(cb, sat(cs)), lum(cb))
}

/// The source's hue and saturation with the backdrop's luminosity (sec. 9.2.3).
#[inline(always)]
pub fn color(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    set_lum(cs, lum(cb))
}

/// The source's luminosity with the backdrop's hue and saturation (sec. 9.2.4).
#[inline(always)]
pub fn luminosity(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    set_lum(cb, lum(cs))
}

/// Luminosity, as the specification weighs it (not Rec. 709's).
#[inline(always)]
pub fn lum([r, g, b]: [f32; 3]) -> f32 {
    0.3 * r + 0.59 * g + 0.11 * b
}

/// Brings a color back into [0, 1] along the line to its gray.
#[inline(always)]
pub fn clip_color(c: [f32; 3]) -> [f32; 3] {
    let l = lum(c);
    let n = c[0].min(c[1]).min(c[2]);
    let x = c[0].max(c[1]).max(c[2]);
    let c = if n < 0.0 { c.map(|v| l + (v - l) * l / (l - n)) } else { c };
    if x > 1.0 { c.map(|v| l + (v - l) * (1.0 - l) / (x - l)) } else { c }
}

/// `SetLum` of sec. 9.2: a color with another luminosity.
#[inline(always)]
pub fn set_lum(c: [f32; 3], l: f32) -> [f32; 3] {
    let d = l - lum(c);
    clip_color(c.map(|v| v + d))
}

/// `Sat` of sec. 9.2: the largest component less the smallest.
#[inline(always)]
pub fn sat([r, g, b]: [f32; 3]) -> f32 {
    r.max(g).max(b) - r.min(g).min(b)
}

/// The least component becomes 0, the greatest `s`; the middle one keeps its ratio between them.
#[inline(always)]
pub fn set_sat(c: [f32; 3], s: f32) -> [f32; 3] {
    let n = c[0].min(c[1]).min(c[2]);
    let range = sat(c);
    if range > 0.0 { c.map(|v| (v - n) * s / range) } else { [0.0; 3] }
}
