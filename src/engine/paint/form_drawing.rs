//! Drawings by the form: strokes of a brush along the lines that a surface has. Floor 3. Here: what
//! such a drawing is, and its strokes, which are made once for a scene; `hand` is how a hand follows
//! a line, `brush_coverage` how wide strokes become, `sources` what it reads of other
//! layers, `inked` what ink draws already. Not here: where the lines are
//! (`surface::form_lines`), how strokes look (`stroke`).

mod brush_coverage;
mod hand;
mod hatched;
mod inked;
mod sources;

#[cfg(test)]
mod tests;

pub use hand::DrawingHand;
pub use inked::InkOnCanvas;
pub use sources::{
    ColorPicture, DrawingSources, FoundSources, ReadLayers, TonePicture, ToneSource,
};

use super::brush::Brush;
use super::dynamics::{Curve, Dynamics, Input, Property};
use super::scene::Scene;
use super::stroke::Stroke;
use crate::math::Vec3;
use crate::math::srgb::Color;
use crate::surface::Surface;
use crate::surface::form_lines::{FormLines, LineSettings};
use crate::surface::hatching::HatchSettings;
use hand::LightOnLines;
use std::sync::{Arc, Mutex, PoisonError};

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FormPattern {
    /// Lines where an illustrator puts them.
    Lines(LineSettings),
    /// Hatching along the form, its tone by a light.
    Hatching(HatchSettings),
}

/// A drawing by the form: it follows its surface.
#[derive(Clone, PartialEq)]
pub struct FormDrawing {
    /// What is drawn.
    pub pattern: FormPattern,
    /// How a hand follows its lines.
    pub hand: DrawingHand,
    /// The brush of every line.
    pub brush: Brush,
    /// Its color.
    pub color: Color,
    /// Which other layers it reads, by name.
    pub sources: DrawingSources,
    /// What those layers hold now.
    pub found: FoundSources,
    /// Its strokes on the scene that they were last made for.
    pub made: MadeStrokes,
}

impl FormDrawing {
    /// The color of ink.
    pub const INK: Color = Color { r: 0x15, g: 0x15, b: 0x1a, a: 255 };

    /// A pattern in ink, as it begins.
    pub fn new(pattern: FormPattern) -> Self {
        let (hand, brush) = match pattern {
            FormPattern::Lines(_) => (DrawingHand::DEFAULT, Self::pen()),
            FormPattern::Hatching(_) => {
                (DrawingHand { taper: 8.0, ..DrawingHand::DEFAULT }, Self::burin())
            }
        };
        Self {
            pattern,
            hand,
            brush,
            color: Self::INK,
            sources: DrawingSources::default(),
            found: FoundSources::default(),
            made: MadeStrokes::default(),
        }
    }

    /// The pen that lines begin with: a nib that pressure widens, black at once.
    pub fn pen() -> Brush {
        let dynamics = Dynamics::none().with(Property::Size, Input::Pressure, Curve::Share(0.9));
        Brush { size: 4.0, hardness: 0.85, spacing: 0.2, dynamics, ..Brush::default() }
    }

    /// The tool that hatching begins with: its width is its pressure.
    pub fn burin() -> Brush {
        let dynamics = Dynamics::none().with(Property::Size, Input::Pressure, Curve::Share(1.0));
        Brush { size: 5.0, hardness: 0.85, spacing: 0.2, dynamics, ..Brush::default() }
    }

    /// What is asked of it, if it is hatching.
    pub fn hatching(&self) -> Option<&HatchSettings> {
        match &self.pattern {
            FormPattern::Lines(_) => None,
            FormPattern::Hatching(hatch) => Some(hatch),
        }
    }

    /// Toward its light, camera space (y up), any length.
    pub fn light(&self) -> Vec3 {
        match &self.pattern {
            FormPattern::Lines(lines) => lines.light,
            FormPattern::Hatching(hatch) => hatch.light,
        }
    }

    /// The same, to be changed.
    pub fn light_mut(&mut self) -> &mut Vec3 {
        match &mut self.pattern {
            FormPattern::Lines(lines) => &mut lines.light,
            FormPattern::Hatching(hatch) => &mut hatch.light,
        }
    }

    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let pattern = match &self.pattern {
            FormPattern::Lines(lines) => FormPattern::Lines(lines.scaled(factor)),
            FormPattern::Hatching(hatch) => FormPattern::Hatching(hatch.scaled(factor)),
        };
        let (hand, brush) = (self.hand.scaled(factor), self.brush.scaled(factor));
        let found = self.found.scaled(factor);
        let (sources, made) = (self.sources.clone(), MadeStrokes::default());
        Self { pattern, hand, brush, color: self.color, sources, found, made }
    }

    /// Its strokes on a scene, the lowest first; none without a surface. Those of a far side are
    /// those of the scene in front.
    pub fn strokes(&self, scene: &Scene) -> Arc<[Arc<Stroke>]> {
        let front = scene.front();
        if let Some(known) = self.made.on(&front) {
            return known;
        }
        let strokes: Arc<[Arc<Stroke>]> = self.draw(&front).into();
        self.made.keep(&front, &strokes);
        strokes
    }

    /// Its lines on a surface, without those that ink or a hand draws already.
    pub fn lines(&self, surface: &Surface, settings: &LineSettings) -> Arc<FormLines> {
        let colors = self.found.colors.as_ref().map(|picture| &picture.colors);
        let all = surface.form_lines_on(settings, colors);
        if self.found.ink.is_empty() {
            all
        } else {
            self.found.ink.leave_out(&all, settings).into()
        }
    }

    fn draw(&self, scene: &Scene) -> Vec<Arc<Stroke>> {
        let Some(surface) = scene.surface.as_deref() else { return Vec::new() };
        match &self.pattern {
            FormPattern::Lines(settings) => {
                let light = LightOnLines { surface, light: settings.light };
                let lines = self.lines(surface, settings);
                lines.lines.iter().map(|line| self.hand.stroke(self, line, &light)).collect()
            }
            FormPattern::Hatching(settings) => hatched::strokes(self, surface, settings),
        }
    }
}

/// Strokes that were made for a scene. A clone has none, and all count as equal: they follow from
/// what is around them.
#[derive(Default)]
pub struct MadeStrokes(Mutex<Option<SceneStrokes>>);

/// A scene, and the strokes on it.
type SceneStrokes = (Scene, Arc<[Arc<Stroke>]>);

impl Clone for MadeStrokes {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for MadeStrokes {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl MadeStrokes {
    fn lock(&self) -> std::sync::MutexGuard<'_, Option<SceneStrokes>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn on(&self, scene: &Scene) -> Option<Arc<[Arc<Stroke>]>> {
        let known = self.lock();
        known.as_ref().filter(|(on, _)| on.is_same(scene)).map(|(_, strokes)| strokes.clone())
    }

    fn keep(&self, scene: &Scene, strokes: &Arc<[Arc<Stroke>]>) {
        *self.lock() = Some((scene.clone(), strokes.clone()));
    }

    /// Those that were last made, whatever for.
    pub fn last(&self) -> Option<Arc<[Arc<Stroke>]>> {
        self.lock().as_ref().map(|(_, strokes)| strokes.clone())
    }

    /// Drops them: they can be made again.
    pub fn clear(&self) {
        *self.lock() = None;
    }
}
