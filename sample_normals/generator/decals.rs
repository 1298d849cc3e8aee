//! Pictures with transparency: a star, a leaf, and the shadow of a window with a twig.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use image::RgbaImage;

use crate::noise::{fbm2, hash};
use crate::painting::{painted, srgb};
use crate::sdf::{segment2, smooth_step};

/// An enameled star in a gold ring, on a transparent ground.
pub fn star() -> RgbaImage {
    const SIDE: u32 = 384;
    painted((SIDE, SIDE), 3, |p| {
        let q = (p / f64::from(SIDE) * 2.0 - DVec2::ONE) * DVec2::new(1.0, -1.0);
        let r = q.length();
        let sector = TAU / 5.0;
        let angle = q.x.atan2(q.y);
        let nearest = angle - (angle / sector).round() * sector;
        let folded = DVec2::new((nearest.sin() * r).abs(), nearest.cos() * r);
        // The edge runs from the tip to the inner corner.
        let (tip, notch) = (DVec2::new(0.0, 0.7), DVec2::from_angle(PI / 2.0 - sector / 2.0) * 0.3);
        let edge = notch - tip;
        let inside = -edge.perp_dot(folded - tip) / edge.length();
        let lit = 0.65 + 0.5 * (q.dot(DVec2::new(-0.5, 0.8)));
        let facet = if nearest > 0.0 { 0.72 } else { 1.12 };
        let gold = srgb(0xf2c14e) * lit;
        let enamel = srgb(0x1d3f8a) * (0.75 + 0.5 * smooth_step(0.9, 0.1, r));
        let ring = (r - 0.88).abs();
        let rays = 1.0 + 0.1 * (40.0 * angle).sin() * smooth_step(0.1, 0.8, r);
        let mut color = enamel * rays;
        color = color.lerp(
            srgb(0xfff3cf) * 0.95,
            smooth_step(-0.03, -0.02, -inside.abs()) * smooth_step(0.8, 0.7, r),
        );
        color = if inside > 0.0 { gold * facet } else { color };
        color = color.lerp(
            srgb(0xf6d27a) * (1.15 - 60.0 * (ring - 0.02).powi(2)) * lit,
            smooth_step(0.062, 0.055, ring),
        );
        color.extend(smooth_step(0.945, 0.935, r))
    })
}

/// A maple-like leaf in autumn colors, on a transparent ground.
pub fn leaf() -> RgbaImage {
    const SIDE: u32 = 352;
    const LOBES: [[f64; 3]; 5] = [
        [90.0, 0.86, 0.2],
        [40.0, 0.72, 0.17],
        [140.0, 0.72, 0.17],
        [-8.0, 0.5, 0.13],
        [188.0, 0.5, 0.13],
    ];
    let foot = DVec2::new(0.0, -0.28);
    painted((SIDE, SIDE), 3, move |p| {
        let q =
            (p / f64::from(SIDE) * 2.0 - DVec2::new(1.0, 1.06)) * DVec2::new(0.78, -0.78) - foot;
        let mut blade = q.length() - 0.2;
        let mut vein = f64::INFINITY;
        for [degrees, reach, width] in LOBES {
            let axis = DVec2::from_angle(degrees.to_radians());
            let (along, across) = (q.dot(axis) / reach, axis.perp_dot(q).abs());
            let teeth = 0.028
                * ((along * 26.0 - 5.0 * across).sin() + 0.6 * (along * 61.0).sin())
                * smooth_step(0.3, 0.6, along);
            let profile = width
                * (1.9
                    * along.clamp(0.0, 1.0).powf(0.7)
                    * (1.0 - along.clamp(0.0, 1.0)).powf(0.55))
                + teeth * (1.0 - along).max(0.0);
            blade = blade.min(if (0.0..1.0).contains(&along) { across - profile } else { 1.0 });
            vein = vein.min(segment2(q, DVec2::ZERO, axis * reach * 0.93) + 0.012 * along.max(0.0));
            let side = (along - 0.75 * across) * 11.0;
            let rib = ((side - side.round()).abs() / 11.0 * reach) + 0.008 + 0.05 * across;
            vein = if across < profile { vein.min(rib) } else { vein };
        }
        let stalk = segment2(q, DVec2::ZERO, DVec2::new(0.06, -0.55)) - 0.016;
        let cloud = fbm2(q * 3.0 + DVec2::splat(9.0), 5, 0, 3);
        let color = srgb(0xb8331f)
            .lerp(srgb(0xe8962e), smooth_step(-0.4, 0.5, cloud))
            .lerp(srgb(0x8c9a34), 0.6 * smooth_step(0.5, 0.0, q.length()));
        let color = color * (1.0 + 0.25 * fbm2(q * 24.0, 3, 0, 9));
        let color = color.lerp(srgb(0xf7dc98), 0.75 * smooth_step(0.017, 0.006, vein));
        let color = if stalk < 0.0 && blade > 0.0 { srgb(0x8a4a2a) } else { color };
        color.extend(smooth_step(0.004, -0.004, blade.min(stalk)))
    })
}

/// The light a window throws, with the shadow of a branch: white where it is lit.
pub fn window() -> RgbaImage {
    const SIDE: u32 = 448;
    painted((SIDE, SIDE), 3, |p| {
        let q = p / f64::from(SIDE) * 2.0 - DVec2::ONE;
        // Slanted like afternoon light, and softer the farther the shadow's edge is thrown.
        let slanted = DVec2::new(q.x + 0.22 * q.y, q.y);
        let soft = 0.014 + 0.014 * (q.y + 1.0);
        let panes = pane(slanted, soft);
        let branch = smooth_step(-soft, soft * 1.6, twig_shadow(slanted));
        DVec3::splat(panes * (0.12 + 0.88 * branch)).extend(1.0)
    })
}

/// Two columns of three panes with an arched top, their edges blurred over `soft`.
fn pane(q: DVec2, soft: f64) -> f64 {
    let arch = if q.y < -0.2 {
        0.74 - (DVec2::new(q.x, (q.y + 0.2) * 1.1)).length()
    } else {
        0.74 - q.x.abs()
    };
    let frame = arch.min(0.86 - q.y);
    let post = q.x.abs() - 0.035;
    let bars = [-0.2, 0.34].iter().map(|y| (q.y - y).abs() - 0.028).fold(f64::INFINITY, f64::min);
    smooth_step(-soft, soft, frame.min(post).min(bars))
}

/// Positive outside the shadow of a twig with leaves.
fn twig_shadow(q: DVec2) -> f64 {
    let curve = |t: f64| DVec2::new(0.95 - 1.25 * t, -0.85 + 0.9 * t + 0.35 * t * t);
    let mut best = f64::INFINITY;
    for i in 0..16 {
        let t = f64::from(i) / 16.0;
        let (a, b) = (curve(t), curve(t + 1.0 / 16.0));
        best = best.min(segment2(q, a, b) - 0.016 * (1.1 - t));
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let heading = (b - a).to_angle() + side * (0.75 + 0.25 * hash(i.into(), 1, 4));
        let d = DVec2::from_angle(-heading).rotate(q - a);
        let length = 0.15 + 0.08 * hash(i.into(), 2, 4);
        let along = (d.x / length).clamp(0.0, 1.0);
        let width = 0.3 * length * (PI * along.powf(0.8)).sin();
        let leaf = if (0.0..length).contains(&d.x) { d.y.abs() - width } else { 1.0 };
        best = best.min(leaf);
    }
    best
}
