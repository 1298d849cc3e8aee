//! Formulas of blend modes without divisions: αs αb B(D/αb, S/αs) of premultiplied values, and B of
//! whole colors. Floor 1. The twins of those in `spec`.

use crate::raster::blend::spec;

// One instruction each on x86-64, unlike `f32::min` and `max`, which also order NaN; rows hold
// none.
#[inline(always)]
pub(super) fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn greatest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// 1/a for `a ≥ 0`; finite at 0, where its factor is 0, too. Without a branch, which would keep
/// loops scalar.
#[inline(always)]
pub(super) fn reciprocal(a: f32) -> f32 {
    1.0 / greatest(a, f32::MIN_POSITIVE)
}

#[inline(always)]
pub(super) fn hard_light(s: f32, d: f32, as_: f32, ab: f32) -> f32 {
    let dark = 2.0 * s * d;
    let light = as_ * ab - 2.0 * (as_ - s) * (ab - d);
    if 2.0 * s <= as_ { dark } else { light }
}

#[inline(always)]
pub(super) fn color_dodge(s: f32, d: f32, as_: f32, ab: f32) -> f32 {
    let full = as_ * ab;
    let lit = if s < as_ { least(full, as_ * as_ * d / (as_ - s)) } else { full };
    if d > 0.0 { lit } else { 0.0 }
}

#[inline(always)]
pub(super) fn color_burn(s: f32, d: f32, as_: f32, ab: f32) -> f32 {
    let full = as_ * ab;
    let burnt = if s > 0.0 { full - least(full, as_ * as_ * (ab - d) / s) } else { 0.0 };
    if d < ab { burnt } else { full }
}

#[inline(always)]
pub(super) fn linear_light(s: f32, d: f32, as_: f32, ab: f32) -> f32 {
    let full = as_ * ab;
    least(greatest(d * as_ + 2.0 * s * ab - full, 0.0), full)
}

#[inline(always)]
pub(super) fn vivid_light(s: f32, d: f32, as_: f32, ab: f32) -> f32 {
    let tilt = 2.0 * s - as_;
    let burnt = color_burn(2.0 * s, d, as_, ab);
    let dodged = color_dodge(tilt, d, as_, ab);
    let lit = if tilt <= 0.0 { burnt } else { dodged };
    let with_white = if s < as_ { lit } else { as_ * ab };
    if s > 0.0 { with_white } else { 0.0 }
}

#[inline(always)]
pub(super) fn pin_light(s: f32, d: f32, as_: f32, ab: f32) -> f32 {
    let tilt = 2.0 * s - as_;
    let dark = least(d * as_, 2.0 * s * ab);
    let light = greatest(d * as_, tilt * ab);
    if tilt <= 0.0 { dark } else { light }
}

#[inline(always)]
pub(super) fn soft_light(s: f32, d: f32, as_: f32, ab: f32) -> f32 {
    let cb = d * reciprocal(ab);
    let steep = ((16.0 * cb - 12.0) * cb + 4.0) * cb;
    let curve = if cb <= 0.25 { steep } else { cb.sqrt() };
    let tilt = 2.0 * s - as_;
    d * as_ + if tilt <= 0.0 { tilt * d * (1.0 - cb) } else { tilt * ab * (curve - cb) }
}

// Named, because a closure of this size is called rather than inlined, and its loop stays scalar
// (15 times slower).
#[inline(always)]
pub(super) fn hue(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    set_lum(set_sat(cs, sat(cb)), spec::lum(cb))
}

#[inline(always)]
pub(super) fn saturation(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    set_lum(set_sat(cb, sat(cs)), spec::lum(cb))
}

#[inline(always)]
pub(super) fn color(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    set_lum(cs, spec::lum(cb))
}

#[inline(always)]
pub(super) fn luminosity(cb: [f32; 3], cs: [f32; 3]) -> [f32; 3] {
    set_lum(cb, spec::lum(cs))
}

#[inline(always)]
pub(super) fn sat([r, g, b]: [f32; 3]) -> f32 {
    // Not `greatest` and `least`: their comparisons would be merged into branches, and the loop
    // would stay scalar.
    r.max(g).max(b) - r.min(g).min(b)
}

#[inline(always)]
pub(super) fn set_sat([r, g, b]: [f32; 3], s: f32) -> [f32; 3] {
    let n = r.min(g).min(b);
    let k = s * reciprocal(sat([r, g, b]));
    [(r - n) * k, (g - n) * k, (b - n) * k]
}

#[inline(always)]
pub(super) fn set_lum(c: [f32; 3], l: f32) -> [f32; 3] {
    let shift = l - spec::lum(c);
    let [r, g, b] = [c[0] + shift, c[1] + shift, c[2] + shift];
    let (n, x) = (least(least(r, g), b), greatest(greatest(r, g), b));
    // ClipColor: first up to 0, then down to 1, both along the line to the gray, so their factors
    // multiply.
    let up = if n < 0.0 { l * reciprocal(l - n) } else { 1.0 };
    let x = l + (x - l) * up;
    let down = if x > 1.0 { (1.0 - l) * reciprocal(x - l) } else { 1.0 };
    let k = up * down;
    [l + (r - l) * k, l + (g - l) * k, l + (b - l) * k]
}
