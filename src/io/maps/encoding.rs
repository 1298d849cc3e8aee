//! Detects how stored numbers encode the components of normals: the right decoding gives vectors of
//! length 1. Floor 5. Not here: which way the axes point (`orientation`).

use super::{findings::Findings, stored::StoredMap};
use crate::document::source::{NormalConvention, NormalEncoding};
use crate::math::{Vec3, srgb, vec3};
use crate::{Error, Result};

/// A way to decode a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelReading {
    pub encoding: NormalEncoding,
    /// The numbers went through the sRGB curve.
    pub srgb: bool,
    /// The two channels of `two-channel` are signed numbers.
    signed_pair: bool,
}

impl TexelReading {
    /// The vector of a texel, in the file's own order of channels, of any length.
    pub fn vector(&self, texel: [f32; 4]) -> Vec3 {
        let v = if self.srgb { texel.map(srgb::decode) } else { texel };
        let biased = |v: f32| 2.0 * v - 1.0;
        match self.encoding {
            NormalEncoding::Unsigned => vec3(biased(v[0]), biased(v[1]), biased(v[2])),
            NormalEncoding::Signed => vec3(v[0], v[1], v[2]),
            NormalEncoding::FullZ => vec3(biased(v[0]), biased(v[1]), v[2]),
            NormalEncoding::TwoChannel if self.signed_pair => rebuild_normal(v[0], v[1]),
            NormalEncoding::TwoChannel => rebuild_normal(biased(v[0]), biased(v[1])),
            NormalEncoding::Dxt5nm => rebuild_normal(biased(v[3]), biased(v[1])),
        }
    }
}

/// z = √(1 − x² − y²); 0 where rounding pushed x and y beyond the unit circle.
fn rebuild_normal(x: f32, y: f32) -> Vec3 {
    vec3(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())
}

/// How many times better than its rivals `full-z` has to fit. Maps of games are unsigned. Averaging
/// and compression shorten their normals, to 0.96 in a mipmap, and the larger z of `full-z` makes up
/// for half of that and more. A map that is `full-z` fits it ten times better, unless it is flat.
const FULL_Z_WEIGHT: f32 = 4.0;

/// Chooses the decoding that fits the sampled texels; what the convention fixes is kept.
pub fn choose(
    stored: &StoredMap,
    samples: &[usize],
    overrides: &NormalConvention,
    findings: &mut Findings,
) -> Result<TexelReading> {
    let texels: Vec<[f32; 4]> = samples.iter().map(|&i| stored.texel(i)).collect();
    let shape = TexelStats::of(stored, &texels);
    refuse_gray(stored, overrides, &shape)?;
    let signed_pair = shape.least < -0.02;
    let encodings: Vec<NormalEncoding> = match overrides.encoding {
        Some(encoding) => vec![encoding],
        None => plausible(stored, &shape),
    };
    let curves = match overrides.srgb {
        Some(srgb) => vec![srgb],
        // Only numbers that were a picture's can have gone through its curve.
        None if shape.least >= -0.02 && shape.most <= 1.02 => vec![false, true],
        None => vec![false],
    };
    // Weighted error, error, reading.
    let mut scored: Vec<(f32, f32, TexelReading)> = Vec::new();
    for &encoding in &encodings {
        for &srgb in &curves {
            let reading = TexelReading { encoding, srgb, signed_pair };
            // Rebuilt normals always have length 1; the curve shows in how often x and y leave the
            // unit circle: it does not.
            let rebuilt = matches!(encoding, NormalEncoding::TwoChannel | NormalEncoding::Dxt5nm);
            if rebuilt && srgb && overrides.srgb.is_none() {
                continue;
            }
            let error = length_error(&reading, &texels);
            let weight = if encoding == NormalEncoding::FullZ { FULL_Z_WEIGHT } else { 1.0 };
            scored.push((weight * error, error, reading));
        }
    }
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(&(weighted, error, reading)) = scored.first() else {
        return Err(Error::decode(&stored.file, "no encoding of normals fits these numbers"));
    };
    // A rival counts only where it decodes the numbers differently.
    let rival = scored.iter().skip(1).map(|s| s.0).next();
    let confidence = rival.map_or(0.95, |r| 1.0 - weighted / r.max(1e-6));
    report(overrides, &reading, confidence, error, findings);
    Ok(reading)
}

fn report(
    overrides: &NormalConvention,
    reading: &TexelReading,
    confidence: f32,
    error: f32,
    findings: &mut Findings,
) {
    match overrides.encoding {
        Some(encoding) => findings.add_given("normal.encoding", encoding.name()),
        None => findings.add_detected("normal.encoding", reading.encoding.name(), confidence),
    }
    match overrides.srgb {
        Some(srgb) => findings.add_given("normal.srgb", srgb),
        None => findings.add_detected("normal.srgb", reading.srgb, confidence),
    }
    if reading.srgb && overrides.srgb.is_none() {
        findings.note("the normals went through the sRGB curve by mistake; it was undone");
    }
    findings.length_error = error;
    if findings.is_doubtful() {
        findings.note(format!(
            "the normals are not of length 1 (off by {error:.2} on average); they were renormalized"
        ));
    }
}

/// Facts about the sampled texels that narrow the choice.
struct TexelStats {
    least: f32,
    most: f32,
    /// Largest minus smallest number of each channel.
    spread: [f32; 4],
    /// Share of alpha values strictly between clear and opaque.
    gray_alpha: f32,
    gray: bool,
}

impl TexelStats {
    fn of(stored: &StoredMap, texels: &[[f32; 4]]) -> Self {
        let fold = |c: usize, start: f32, pick: fn(f32, f32) -> f32| {
            texels.iter().map(|t| t[c]).fold(start, pick)
        };
        let low: [f32; 4] = std::array::from_fn(|c| fold(c, f32::INFINITY, f32::min));
        let high: [f32; 4] = std::array::from_fn(|c| fold(c, f32::NEG_INFINITY, f32::max));
        let channels = stored.colors().clamp(1, 3);
        let between = texels.iter().filter(|t| t[3] > 0.02 && t[3] < 0.98).count();
        Self {
            least: low[..channels].iter().copied().fold(f32::INFINITY, f32::min),
            most: high[..channels].iter().copied().fold(f32::NEG_INFINITY, f32::max),
            spread: std::array::from_fn(|c| high[c] - low[c]),
            gray_alpha: if stored.channels.len() == 4 {
                between as f32 / texels.len().max(1) as f32
            } else {
                0.0
            },
            gray: stored.colors() == 1
                || (stored.colors() == 3 && stored.is_gray(if stored.lossy { 0.02 } else { 0.0 })),
        }
    }

    /// x in alpha, y in green, nothing in red and blue (or green repeated in them).
    fn is_dxt5nm(&self) -> bool {
        let still = |c: usize| self.spread[c] < 0.01;
        self.gray_alpha > 0.5 && self.spread[3] > 0.1 && ((still(0) && still(2)) || self.gray)
    }
}

fn plausible(stored: &StoredMap, shape: &TexelStats) -> Vec<NormalEncoding> {
    use NormalEncoding::{Dxt5nm, FullZ, Signed, TwoChannel, Unsigned};
    if stored.channels.len() == 2 {
        return vec![TwoChannel];
    }
    if shape.is_dxt5nm() {
        return vec![Dxt5nm];
    }
    if shape.least < -0.05 {
        return vec![Signed];
    }
    // Blue that is constant while red and green vary has no meaning, unless it is the 1 of a flat
    // map.
    let blue_is_empty = shape.spread[2] < 0.008 && shape.spread[0].max(shape.spread[1]) > 0.05;
    if blue_is_empty {
        return vec![TwoChannel];
    }
    match stored.step {
        Some(_) => vec![Unsigned, FullZ],
        None => vec![Unsigned, Signed, FullZ],
    }
}

fn refuse_gray(stored: &StoredMap, overrides: &NormalConvention, shape: &TexelStats) -> Result<()> {
    let is_given_as_pair = matches!(overrides.encoding, Some(NormalEncoding::Dxt5nm));
    // A picture of one value is a flat map or no map at all.
    let varies = shape.spread[..3].iter().any(|&s| s > 0.02);
    if stored.colors() == 1 || (shape.gray && varies && !is_given_as_pair && !shape.is_dxt5nm()) {
        let reason = "the picture is gray; a normal map has at least two different channels (is it the depth map?)";
        return Err(Error::decode(&stored.file, reason));
    }
    Ok(())
}

/// Mean of | |n| − 1 |, each capped at 1 so that a few wild pixels do not decide.
fn length_error(reading: &TexelReading, texels: &[[f32; 4]]) -> f32 {
    let errors =
        texels.iter().map(|&t| (reading.vector(t).length() - 1.0).abs()).filter(|e| e.is_finite());
    let (sum, count) = errors.fold((0.0f64, 0u32), |(s, n), e| (s + f64::from(e.min(1.0)), n + 1));
    if count == 0 { 1.0 } else { (sum / f64::from(count)) as f32 }
}

/// Whether a file's alpha is no coverage but the x of normals (DXT5nm).
pub fn has_x_in_alpha(stored: &StoredMap) -> bool {
    if stored.channels.len() != 4 || stored.step.is_none() {
        return false;
    }
    let step = (stored.size.area() / 20_000).max(1);
    let texels: Vec<[f32; 4]> =
        (0..stored.size.area()).step_by(step).map(|i| stored.texel(i)).collect();
    TexelStats::of(stored, &texels).is_dxt5nm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::source::{MapSource, SurfaceSource};
    use crate::{Budget, Files, maps};
    use image::{ImageFormat, Rgb, RgbImage};
    use std::path::PathBuf;

    const SIDE: u32 = 128;

    struct OneMap(Vec<u8>);

    impl Files for OneMap {
        fn read(&self, _: &str, _: &Budget) -> Result<Vec<u8>> {
            Ok(self.0.clone())
        }

        fn path(&self, name: &str) -> PathBuf {
            name.into()
        }
    }

    /// The normal of waves of some lengths, as steep as that.
    fn wave(x: f32, y: f32, steep: f32) -> Vec3 {
        let slope = |k: f32| {
            let (u, v) = ((k * (x + 0.3 * y)).cos(), 0.6 * (k * (0.7 * y - 0.4 * x)).cos());
            (u - 0.4 * v, 0.3 * u + 0.7 * v)
        };
        let all = [0.05, 0.17, 0.41].map(slope);
        let (p, q) = all.iter().fold((0.0, 0.0), |(p, q), (a, b)| (p + a, q + b));
        vec3(-p * steep, -q * steep, 1.0).normalize_or_zero()
    }

    /// The mean of the normals of a block of fine relief, as in a mipmap.
    fn mean(x: f32, y: f32, steep: f32) -> Vec3 {
        let grain = |i: u32| {
            let random = |c: u32| crate::math::hash::unit(x as u32 * 16 + i, y as u32, c) - 0.5;
            vec3(random(0), random(1), 0.0) * 0.9
        };
        let fine = |i: u32| (wave(x, y, steep) + grain(i)).normalize_or_zero();
        (0..16).map(fine).sum::<Vec3>() / 16.0
    }

    fn found(stored: impl Fn(f32, f32) -> Vec3) -> NormalEncoding {
        let texel = |x: u32, y: u32| {
            let v = stored(x as f32, y as f32);
            Rgb([v.x, v.y, v.z].map(|v| (v.max(0.0).min(1.0) * 255.0).round() as u8))
        };
        let mut bytes = std::io::Cursor::new(Vec::new());
        let image = RgbImage::from_fn(SIDE, SIDE, texel);
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        let map = MapSource { file: "n.png".into(), ..MapSource::default() };
        let source = SurfaceSource { normal: Some(map), ..SurfaceSource::default() };
        let read = maps::import(&source, &OneMap(bytes.into_inner()), &Budget::default()).unwrap();
        read.findings.normal.unwrap().encoding.unwrap()
    }

    #[test]
    fn averaged_and_noisy_maps_of_games_are_unsigned_and_full_z_is_still_found() {
        let half = vec3(0.5, 0.5, 0.5);
        for steep in [0.15, 0.3, 0.6, 1.0] {
            let unsigned = |n: Vec3| n * 0.5 + half;
            let noise = |x: f32, y: f32| {
                let of = |c: u32| crate::math::hash::unit(x as u32, y as u32, c) - 0.5;
                vec3(of(3), of(4), of(5)) * (12.0 / 255.0)
            };
            let full = |n: Vec3| vec3(n.x * 0.5 + 0.5, n.y * 0.5 + 0.5, n.z);
            let plain = found(|x, y| unsigned(wave(x, y, steep)));
            let averaged = found(|x, y| unsigned(mean(x, y, steep)));
            let short = found(|x, y| unsigned(wave(x, y, steep) * 0.96));
            let noisy = found(|x, y| unsigned(wave(x, y, steep)) + noise(x, y));
            let found = [plain, averaged, short, noisy, found(|x, y| full(wave(x, y, steep)))];
            use NormalEncoding::{FullZ, Unsigned};
            assert_eq!(found, [Unsigned, Unsigned, Unsigned, Unsigned, FullZ], "steep {steep}");
        }
    }
}
