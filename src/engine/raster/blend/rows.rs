//! Blending by rows: the fast twin of `spec`, premultiplied, eight pixels an instruction where the
//! processor can. Floor 1. Tested against `spec` for every mode.
//!
//! With S, D the premultiplied source and backdrop, the result is `S (1 − αb) + T + D (1 − αs)`, T
//! = αs αb B(D/αb, S/αs). For most modes T needs no division. Which pixels dissolving leaves is
//! decided before the paint is mixed. *Atop* omits the first term and keeps the backdrop's alpha: a
//! clipped layer.

mod formulas;

use super::modes::blend_modes;
use super::{BlendMode, Mix, TileCoverage, TilePaint, spec};
use crate::math::srgb;
use crate::raster::planar::PixelRow;
use crate::raster::tile::TILE;
use crate::raster::tile::sixteen_bit::Row16;
use formulas::*;

crate::widest! {
    /// Blends paint, weighted by its coverage, into all rows of a tile.
    pub fn blend_rows(rows: &mut [PixelRow], mix: Mix, paint: &TilePaint<'_>, coverage: &TileCoverage) {
        if let (TilePaint::Bytes(bytes), None, BlendMode::Normal, false, false) =
            (paint, coverage.mask(), mix.mode, mix.linear, mix.atop)
        {
            for (row, bytes) in rows.iter_mut().zip(bytes.chunks_exact(4 * TILE)) {
                bytes_over(row, bytes, coverage.opacity());
            }
            return;
        }
        if let (TilePaint::Rows16(rows16), None, BlendMode::Normal, false, false) =
            (paint, coverage.mask(), mix.mode, mix.linear, mix.atop)
        {
            for (row, rows16) in rows.iter_mut().zip(rows16.iter()) {
                over16(row, rows16, coverage.opacity());
            }
            return;
        }
        for (y, row) in rows.iter_mut().enumerate() {
            let mut source = PixelRow::TRANSPARENT;
            load(&mut source, paint, y, coverage);
            if mix.mode == BlendMode::Dissolve {
                dissolve(&mut source, [mix.corner[0], mix.corner[1] + y as i32]);
            }
            if mix.linear {
                in_linear_light(row, &mut source, mix);
            } else {
                blend_row(row, &source, mix);
            }
        }
    }

    /// Moves every row toward another by its coverage: a pass-through group or an adjustment,
    /// faded.
    pub fn mix_rows(rows: &mut [PixelRow], toward: &[PixelRow], coverage: &TileCoverage) {
        for (y, (row, toward)) in rows.iter_mut().zip(toward).enumerate() {
            let mut t = [coverage.opacity(); TILE];
            multiply_by_mask(&mut t, coverage, y);
            let PixelRow { rgb, a } = row;
            for (to, from) in rgb.iter_mut().chain([a]).zip(toward.rgb.iter().chain([&toward.a])) {
                for x in 0..TILE {
                    to[x] += (from[x] - to[x]) * t[x];
                }
            }
        }
    }
}

/// Source-over straight from bytes: the common case, in one pass.
#[inline(always)]
fn bytes_over(row: &mut PixelRow, bytes: &[u8], opacity: f32) {
    let unit = opacity / 255.0;
    let PixelRow { rgb: [r, g, b], a } = row;
    for (x, p) in bytes.chunks_exact(4).enumerate().take(TILE) {
        let p = i32::from_le_bytes([p[0], p[1], p[2], p[3]]);
        let channel = |shift: u32| ((p >> shift) & 255) as f32 * unit;
        let sa = channel(24);
        let rest = 1.0 - sa;
        r[x] = channel(0) + r[x] * rest;
        g[x] = channel(8) + g[x] * rest;
        b[x] = channel(16) + b[x] * rest;
        a[x] = sa + a[x] * rest;
    }
}

/// The same for 16 bits.
#[inline(always)]
fn over16(row: &mut PixelRow, rows16: &Row16, opacity: f32) {
    let unit = opacity / 65535.0;
    let PixelRow { rgb, a } = row;
    let [red, green, blue, alpha] = rows16;
    for (channel, own) in rgb.iter_mut().zip([red, green, blue]) {
        for x in 0..TILE {
            channel[x] = f32::from(own[x]) * unit + channel[x] * (1.0 - f32::from(alpha[x]) * unit);
        }
    }
    for x in 0..TILE {
        let sa = f32::from(alpha[x]) * unit;
        a[x] = sa + a[x] * (1.0 - sa);
    }
}

/// Row `y` of the paint, times its coverage.
#[inline(always)]
pub(super) fn load(row: &mut PixelRow, paint: &TilePaint<'_>, y: usize, coverage: &TileCoverage) {
    let k = coverage.opacity();
    match paint {
        TilePaint::Solid(color) => {
            let [r, g, b, a] = color.map(|v| v * k);
            *row = PixelRow { rgb: [[r; TILE], [g; TILE], [b; TILE]], a: [a; TILE] };
        }
        TilePaint::Bytes(bytes) => {
            let unit = k / 255.0;
            let PixelRow { rgb: [r, g, b], a } = &mut *row;
            for (x, p) in bytes[y * 4 * TILE..].chunks_exact(4).enumerate().take(TILE) {
                let p = i32::from_le_bytes([p[0], p[1], p[2], p[3]]);
                r[x] = (p & 255) as f32 * unit;
                g[x] = ((p >> 8) & 255) as f32 * unit;
                b[x] = ((p >> 16) & 255) as f32 * unit;
                a[x] = ((p >> 24) & 255) as f32 * unit;
            }
        }
        TilePaint::Rows16(rows16) => {
            let unit = k / 65535.0;
            let PixelRow { rgb, a } = &mut *row;
            for (channel, own) in rgb.iter_mut().chain([a]).zip(&rows16[y]) {
                for x in 0..TILE {
                    channel[x] = f32::from(own[x]) * unit;
                }
            }
        }
        TilePaint::Planar(tile) => {
            *row = tile.rows()[y];
            if k < 1.0 {
                each_channel(row, &[k; TILE]);
            }
        }
    }
    if coverage.mask().is_some() {
        let mut t = [1.0; TILE];
        multiply_by_mask(&mut t, coverage, y);
        each_channel(row, &t);
    }
}

#[inline(always)]
fn multiply_by_mask(t: &mut [f32; TILE], coverage: &TileCoverage, y: usize) {
    if let Some(mask) = coverage.mask() {
        for (t, m) in t.iter_mut().zip(&mask[y * TILE..]) {
            *t *= m;
        }
    }
}

#[inline(always)]
fn each_channel(row: &mut PixelRow, factor: &[f32; TILE]) {
    let PixelRow { rgb, a } = row;
    for channel in rgb.iter_mut().chain([a]) {
        for x in 0..TILE {
            channel[x] *= factor[x];
        }
    }
}

#[inline(always)]
fn blend_row(d: &mut PixelRow, s: &PixelRow, mix: Mix) {
    match mix.mode {
        BlendMode::Normal => separable(d, s, mix, |s, _, _, ab| s * ab),
        BlendMode::Multiply => separable(d, s, mix, |s, d, _, _| s * d),
        BlendMode::Screen => separable(d, s, mix, |s, d, as_, ab| s * ab + d * as_ - s * d),
        BlendMode::Overlay => separable(d, s, mix, |s, d, as_, ab| hard_light(d, s, ab, as_)),
        BlendMode::Darken => separable(d, s, mix, |s, d, as_, ab| least(s * ab, d * as_)),
        BlendMode::Lighten => separable(d, s, mix, |s, d, as_, ab| greatest(s * ab, d * as_)),
        BlendMode::ColorDodge => separable(d, s, mix, color_dodge),
        BlendMode::ColorBurn => separable(d, s, mix, color_burn),
        BlendMode::HardLight => separable(d, s, mix, hard_light),
        BlendMode::SoftLight => separable(d, s, mix, soft_light),
        BlendMode::Difference => separable(d, s, mix, |s, d, as_, ab| (s * ab - d * as_).abs()),
        BlendMode::Exclusion => {
            separable(d, s, mix, |s, d, as_, ab| s * ab + d * as_ - 2.0 * s * d)
        }
        BlendMode::Hue => non_separable(d, s, mix, hue),
        BlendMode::Saturation => non_separable(d, s, mix, saturation),
        BlendMode::Color => non_separable(d, s, mix, color),
        BlendMode::Luminosity => non_separable(d, s, mix, luminosity),
        BlendMode::LinearDodge => {
            separable(d, s, mix, |s, d, as_, ab| least(s * ab + d * as_, as_ * ab))
        }
        BlendMode::LinearBurn => {
            separable(d, s, mix, |s, d, as_, ab| greatest(s * ab + d * as_ - as_ * ab, 0.0))
        }
        BlendMode::LinearLight => separable(d, s, mix, linear_light),
        BlendMode::VividLight => separable(d, s, mix, vivid_light),
        BlendMode::PinLight => separable(d, s, mix, pin_light),
        BlendMode::Subtract => {
            separable(d, s, mix, |s, d, as_, ab| greatest(d * as_ - s * ab, 0.0))
        }
        BlendMode::Dissolve => separable(d, s, mix, |s, _, _, ab| s * ab),
        _ => blend_by_formula(d, s, mix),
    }
}

/// Leaves each pixel of the source wholly, or nothing of it; `[x, y]` is the row's place on the
/// canvas.
#[inline(always)]
fn dissolve(source: &mut PixelRow, [x, y]: [i32; 2]) {
    for i in 0..TILE {
        let kept = spec::dissolve(source.pixel(i), [x + i as i32, y]);
        let [r, g, b] = &mut source.rgb;
        [r[i], g[i], b[i], source.a[i]] = kept;
    }
}

macro_rules! formula {
    (separable, $b:ident, $d:ident, $s:ident, $mix:ident) => {
        straight($d, $s, $mix, spec::$b)
    };
    (non_separable, $b:ident, $d:ident, $s:ident, $mix:ident) => {
        non_separable($d, $s, $mix, spec::$b)
    };
    (sum, $b:ident, $d:ident, $s:ident, $mix:ident) => {
        sum($d, $s, $mix, spec::$b)
    };
}
macro_rules! blend_by_formula {
    ($(
        $(#[$meta:meta])*
        $mode:ident, $name:literal, $label:literal, $ora:literal, $psd:literal, $kind:ident($b:ident);
    )+) => {
        /// Modes without a twin of their own, from the formula of the table.
        #[inline(always)]
        fn blend_by_formula(d: &mut PixelRow, s: &PixelRow, mix: Mix) {
            match mix.mode {
                $(BlendMode::$mode => formula!($kind, $b, d, s, mix),)+
            }
        }
    };
}
blend_modes!(blend_by_formula);

/// A formula of straight components.
#[inline(always)]
fn straight(d: &mut PixelRow, s: &PixelRow, mix: Mix, b: impl Fn(f32, f32) -> f32 + Copy) {
    // Divided, not multiplied by a reciprocal: some formulas break at 0 and at 1.
    let of = |v: f32, a: f32| v / greatest(a, f32::MIN_POSITIVE);
    separable(d, s, mix, |s, d, as_, ab| as_ * ab * b(of(d, ab), of(s, as_)));
}

/// `term(S, D, αs, αb)` is T.
#[inline(always)]
fn separable(
    d: &mut PixelRow,
    s: &PixelRow,
    mix: Mix,
    term: impl Fn(f32, f32, f32, f32) -> f32 + Copy,
) {
    let outside = if mix.atop { 0.0 } else { 1.0 };
    let (ab, as_) = (&mut d.a, &s.a);
    for (d, s) in d.rgb.iter_mut().zip(&s.rgb) {
        for x in 0..TILE {
            let beyond = s[x] * (outside * (1.0 - ab[x]));
            d[x] = beyond + term(s[x], d[x], as_[x], ab[x]) + d[x] * (1.0 - as_[x]);
        }
    }
    for x in 0..TILE {
        ab[x] += as_[x] * (outside * (1.0 - ab[x]));
    }
}

#[inline(always)]
fn non_separable(
    d: &mut PixelRow,
    s: &PixelRow,
    mix: Mix,
    b: impl Fn([f32; 3], [f32; 3]) -> [f32; 3] + Copy,
) {
    let outside = if mix.atop { 0.0 } else { 1.0 };
    let PixelRow { rgb: [dr, dg, db], a: ab } = d;
    let PixelRow { rgb: [sr, sg, sb], a: as_ } = s;
    for x in 0..TILE {
        let (ab, as_) = (&mut ab[x], as_[x]);
        let (inv_b, inv_s) = (reciprocal(*ab), reciprocal(as_));
        let mixed = b(
            [dr[x] * inv_b, dg[x] * inv_b, db[x] * inv_b],
            [sr[x] * inv_s, sg[x] * inv_s, sb[x] * inv_s],
        );
        let (both, beyond, rest) = (as_ * *ab, outside * (1.0 - *ab), 1.0 - as_);
        dr[x] = sr[x] * beyond + mixed[0] * both + dr[x] * rest;
        dg[x] = sg[x] * beyond + mixed[1] * both + dg[x] * rest;
        db[x] = sb[x] * beyond + mixed[2] * both + db[x] * rest;
        *ab += as_ * beyond;
    }
}

#[inline(always)]
fn sum(d: &mut PixelRow, s: &PixelRow, mix: Mix, sum: impl Fn(f32, f32) -> f32 + Copy) {
    let ab = &mut d.a;
    for (d, s) in d.rgb.iter_mut().zip(&s.rgb) {
        for x in 0..TILE {
            // Clipped, only the share on the backdrop counts, and its alpha is the ceiling.
            let (share, ceiling) = if mix.atop { (ab[x], ab[x]) } else { (1.0, 1.0) };
            d[x] = least(sum(d[x], s[x] * share), ceiling);
        }
    }
    if !mix.atop {
        for (ab, as_) in ab.iter_mut().zip(&s.a) {
            *ab = sum(*ab, *as_);
        }
    }
}

/// Decodes both, blends linear light, encodes again; without paint the backdrop does not change by
/// a bit.
#[inline(always)]
fn in_linear_light(d: &mut PixelRow, s: &mut PixelRow, mix: Mix) {
    let before = *d;
    apply_to_straight(d, srgb::decode_fast);
    apply_to_straight(s, srgb::decode_fast);
    blend_row(d, s, mix);
    apply_to_straight(d, srgb::encode_fast);
    for (d, before) in d.rgb.iter_mut().zip(&before.rgb) {
        for x in 0..TILE {
            d[x] = if s.a[x] > 0.0 { d[x] } else { before[x] };
        }
    }
}

/// Applies a transfer curve to the straight colors of a premultiplied row.
#[inline(always)]
fn apply_to_straight(row: &mut PixelRow, curve: impl Fn(f32) -> f32) {
    for channel in &mut row.rgb {
        for (v, &a) in channel.iter_mut().zip(&row.a) {
            *v = curve(least(*v * reciprocal(a), 1.0)) * a;
        }
    }
}

/// One pixel of [`blend_by_formula`], for modes that otherwise take another path.
#[cfg(test)]
pub(super) fn pixel_by_formula(mix: Mix, backdrop: [f32; 4], source: [f32; 4]) -> [f32; 4] {
    let [mut d, s] = [backdrop, source]
        .map(|[r, g, b, a]| PixelRow { rgb: [[r; TILE], [g; TILE], [b; TILE]], a: [a; TILE] });
    blend_by_formula(&mut d, &s, mix);
    d.pixel(TILE - 1)
}
