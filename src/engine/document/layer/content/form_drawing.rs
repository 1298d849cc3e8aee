//! A drawing by the form, kept live: its lines follow the surface. Floor 4. Not here: its strokes
//! (`paint::form_drawing`), how they become a stroke layer (`document::strokes`).

use super::strokes::{warm_far_sides, warm_strokes};
use super::{CanvasScale, Changed, Content, FarScene, LayerKind, NameFile, TileContent};
use crate::Result;
use crate::document::layer::marks::{Done, Marks};
use crate::document::{Live, MemoryCount, Progress, StrokeList};
use crate::paint::{FormDrawing, FormPattern, Scene, stroke};
use crate::raster::{PlanarTile, TileAt};

impl Marks for FormDrawing {
    fn pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile> {
        stroke::render_pixels(&self.strokes(scene), scene, at)
    }

    fn render_together(&self, scene: &Scene, tiles: &[TileAt], progress: &Progress, done: &Done) {
        let strokes = self.strokes(scene).to_vec();
        StrokeList { strokes }.render_together(scene, tiles, progress, done);
    }
}

impl LayerKind for Live<FormDrawing> {
    fn name(&self) -> &'static str {
        match self.params().pattern {
            FormPattern::Lines(_) => "lines",
            FormPattern::Hatching(_) => "hatching",
        }
    }

    fn label(&self) -> &'static str {
        match self.params().pattern {
            FormPattern::Lines(_) => "Form lines",
            FormPattern::Hatching(_) => "Hatching",
        }
    }

    fn render_tile(&self, scene: &Scene, at: TileAt) -> TileContent {
        let render = || stroke::render_tile(&self.params().strokes(scene), scene, at);
        TileContent::of_tile(self.tile(scene, at, render))
    }

    fn render_far_side_tile(&self, scene: &FarScene) -> TileContent {
        self.far_side(scene, true, |scene, at| {
            stroke::render_tile(&self.params().strokes(scene), scene, at)
        })
    }

    fn marks(&self) -> Option<&dyn Marks> {
        Some(self.params())
    }

    fn warm(&self, scene: &Scene, progress: &Progress) {
        warm_strokes(self, &self.params().strokes(scene), scene, progress);
    }

    fn warm_far_side(&self, far: &Scene, progress: &Progress) {
        warm_far_sides(self, &self.params().strokes(far), far, progress);
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        Content::FormDrawing(Live::new(self.params().scaled(scale.length)))
    }

    /// It follows the surface by itself.
    fn is_tied_to_shape(&self) -> bool {
        false
    }

    /// Outlines lie half beyond what they bound.
    fn is_shown_off_surface(&self) -> bool {
        true
    }

    fn files(&self) -> Vec<&str> {
        self.params().brush.pictures().map(|source| source.file.as_str()).collect()
    }

    fn with_files(&self, name: &mut NameFile) -> Result<Option<Content>> {
        let mut next = self.params().clone();
        next.brush = next.brush.with_pictures(|source| {
            let mut source = source.clone();
            source.file = name(&source.file, &source.picture)?;
            Ok::<_, crate::Error>(source)
        })?;
        Ok(Some(Content::FormDrawing(Live::new(next))))
    }

    fn difference_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::of_live(self, if let Content::FormDrawing(old) = old { Some(old) } else { None })
    }

    fn count(&self, count: &mut MemoryCount, keeps: bool) {
        self.count_rendered(count, keeps);
        let made = &self.params().made;
        if !keeps {
            made.clear();
        }
        if let Some(tone) = &self.params().found.tone
            && count.is_new(tone)
        {
            count.add_painted(tone.bytes());
        }
        if let Some(colors) = &self.params().found.colors
            && count.is_new(colors)
        {
            count.add_painted(colors.bytes());
        }
        made.last().iter().flat_map(|made| made.iter()).for_each(|s| count.add_stroke(s));
    }
}
