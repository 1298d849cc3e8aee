//! The fossil: an ammonite in its stone, as heights over the picture plane and the color of each
//! place. Not here: how it is photographed and measured (`photometry`).

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::noise::{cells, fbm2};
use crate::sdf::{smooth_max, smooth_step, v};

/// By how much the shell grows in a turn.
const GROWTH: f64 = 1.9;
/// Ribs of a turn.
const RIBS: f64 = 34.0;
/// The shell's largest radius, and where its mouth points.
const RADIUS: f64 = 0.8;
const MOUTH: f64 = -0.5;
const MIDDLE: DVec2 = DVec2::new(-0.02, 0.03);

/// What there is at a place of the picture plane.
#[derive(Clone, Copy)]
pub struct Place {
    /// Height toward the viewer; none beside the stone.
    pub height: Option<f64>,
    /// Share of light that is scattered back, linear.
    pub albedo: DVec3,
    /// 0 dull stone … 1 the polish of the shell.
    pub gloss: f64,
}

/// A place on the shell, rolled out.
struct OnShell {
    /// The angle along the spiral, from the mouth: 0 or less.
    turn: f64,
    /// −1 the inner seam … 1 the outer one.
    across: f64,
    /// The radius of the outer seam.
    outer: f64,
}

/// The logarithmic spiral at a place, where the shell covers it.
fn on_shell(p: DVec2) -> Option<OnShell> {
    let (radius, angle) = ((p - MIDDLE).length().max(1e-4), (p - MIDDLE).to_angle() - MOUTH);
    let angle = -(-angle).rem_euclid(TAU);
    let turns = ((radius / RADIUS).ln() / GROWTH.ln() - angle / TAU).ceil();
    let turn = angle + TAU * turns;
    let outer = RADIUS * GROWTH.powf(turn / TAU);
    let across = 2.0 * ((radius / outer).ln() / GROWTH.ln() + 1.0) - 1.0;
    (turns <= 0.0).then_some(OnShell { turn, across, outer })
}

impl OnShell {
    /// Height above the stone's face.
    fn height(&self, worn: f64) -> f64 {
        let w = self.across;
        let tube = (1.0 - w.abs().powf(2.4)).max(0.0).powf(0.62);
        // Ribs bend toward the mouth, and each parts in two on the outer half.
        let phase = RIBS * self.turn + 2.4 * w * w + 0.7 * w;
        let crest = |phase: f64| (0.5 + 0.5 * phase.cos()).powf(1.4);
        let ribs = crest(phase) + (crest(2.0 * phase) - crest(phase)) * smooth_step(0.1, 0.5, w);
        let fade = smooth_step(0.03, 0.16, self.outer) * (1.0 - w.powi(4));
        let mouth = smooth_step(0.0, -0.16, self.turn);
        self.outer * (0.31 * tube + (0.052 - 0.03 * worn) * ribs * fade) * mouth
    }
}

/// The fossil at a place.
pub fn fossil(p: DVec2) -> Place {
    let rough = fbm2(p * 3.1, 5, 0, 61);
    let grain = fbm2(p * 34.0, 3, 0, 67);
    let angle = p.to_angle();
    let outline = DVec2::from_angle(angle) * 1.3;
    let edge = 0.97
        + 0.035 * (2.0 * angle + 0.6).sin()
        + 0.06 * fbm2(outline + DVec2::splat(9.0), 4, 0, 71);
    let out = p.length() / edge;
    if out >= 1.0 {
        return Place { height: None, albedo: DVec3::ZERO, gloss: 0.0 };
    }
    let chips = cells(p * 7.0 + DVec2::splat(0.35 * rough), 0, 0.9, 73);
    let face = 0.055 * rough + 0.03 * (chips.tag - 0.5) + 0.03 * chips.nearest + 0.01 * grain;
    let worn = smooth_step(-0.1, 0.5, fbm2(p * 2.3 + DVec2::splat(4.0), 4, 0, 79));
    let (shell, on) = match on_shell(p) {
        Some(on) => (on.height(worn) - 0.035 + 0.012 * rough + 0.0035 * grain, Some(on)),
        None => (f64::NEG_INFINITY, None),
    };
    let is_shell = smooth_step(-0.01, 0.02, shell - face);
    let dome = 0.34 * (1.0 - out.powi(5)).max(0.0).sqrt();
    let height = dome + if shell.is_finite() { smooth_max(face, shell, 0.02) } else { face };
    // Dirt lies in the seams; iron has stained the stone.
    let seam = on.as_ref().map_or(0.0, |on| smooth_step(0.55, 1.0, on.across.abs()));
    let stone = v(0.36, 0.33, 0.28).lerp(v(0.42, 0.27, 0.15), smooth_step(0.0, 0.6, rough));
    let nacre = v(0.46, 0.33, 0.21).lerp(v(0.2, 0.15, 0.11), 0.8 * seam + 0.35 * worn);
    let albedo = stone.lerp(nacre, is_shell) * (1.0 + 0.22 * grain);
    Place { height: Some(height), albedo, gloss: is_shell * (1.0 - 0.6 * worn) }
}
