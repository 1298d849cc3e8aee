//! Brushes for a canvas of another size: scales all their lengths, and nothing else. Floor 3. Each
//! type names all its fields here, so that a new one has to say whether it is a length.

use super::brush::{Brush, Stabilizer};
use super::brush_options::StylusFilter;
use super::grain::BrushGrain;

impl Brush {
    /// The same brush for a canvas `factor` times as large, `factor > 0` and finite: its strokes,
    /// their samples scaled too, look the same there. Lengths in px are multiplied; ratios, angles,
    /// times and seeds do not change.
    pub fn scaled(&self, factor: f32) -> Self {
        let Self {
            size,
            hardness,
            opacity,
            flow,
            spacing,
            spacing_on,
            overlap,
            falloff,
            rate,
            rotation,
            facing,
            ..
        } = *self;
        let Self {
            softness,
            scatter,
            spread,
            size_jitter,
            offset,
            jitter,
            blend,
            erases,
            keeps_alpha,
            ..
        } = *self;
        let Self {
            bounded,
            reach,
            mode,
            pickup,
            stabilizer,
            stabilizer_on,
            stylus,
            cycle,
            seed,
            ..
        } = *self;
        Self {
            size: size * factor,
            hardness,
            opacity,
            flow,
            spacing,
            spacing_on,
            overlap,
            falloff,
            rate,
            rotation,
            facing,
            softness,
            scatter,
            spread,
            size_jitter,
            offset,
            jitter,
            blend,
            erases,
            keeps_alpha,
            bounded,
            reach,
            mode,
            pickup,
            tip: self.tip.clone(),
            grain: self.grain.as_ref().map(|grain| grain.scaled(factor)),
            // Of ratios alone.
            dual: self.dual.clone(),
            stabilizer: stabilizer.scaled(factor),
            stabilizer_on,
            stylus: stylus.scaled(factor),
            cycle,
            dynamics: self.dynamics.clone(),
            seed,
        }
    }
}

impl Stabilizer {
    /// For a canvas `factor > 0` times as large.
    pub fn scaled(self, factor: f32) -> Self {
        match self {
            Stabilizer::None => Stabilizer::None,
            Stabilizer::String { length_px } => {
                Stabilizer::String { length_px: length_px * factor }
            }
            // The same decay over a path that is this much longer.
            Stabilizer::Average { weight } => {
                Stabilizer::Average { weight: weight.max(0.0).powf(1.0 / factor) }
            }
            // Time is the same on every canvas.
            Stabilizer::Lag { secs } => Stabilizer::Lag { secs },
        }
    }
}

impl StylusFilter {
    /// For a canvas `factor > 0` times as large.
    pub fn scaled(self, factor: f32) -> Self {
        let Self {
            tremor,
            lag_dabs,
            lead_secs,
            direction_px,
            pace_secs,
            slow_pace_secs,
            pace_px,
            custom_dabs,
        } = self;
        Self {
            tremor,
            lag_dabs,
            lead_secs,
            direction_px: direction_px * factor,
            pace_secs,
            slow_pace_secs,
            pace_px: pace_px * factor,
            custom_dabs,
        }
    }
}

impl BrushGrain {
    /// For a canvas `factor > 0` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let Self { source, size_px, rotation, strength, levels, lies } = self.clone();
        Self { source, size_px: size_px * factor, rotation, strength, levels, lies }
    }
}
