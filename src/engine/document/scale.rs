//! Scales a document to another resolution: for a quick preview, or for a larger print of live
//! layers. Floor 4. Live layers change their coordinates and stay as sharp as the new canvas;
//! pixels, masks and maps are resampled.

mod reducer;
mod selections;

pub use reducer::{DocumentReducer, ReducedSurface, SurfaceReduction};

use super::layer::scale::CanvasScale;
use super::{Document, Part, Parts};
use crate::math::Size;
use crate::raster::Resampling;
use crate::surface::SurfaceError;
use std::sync::Arc;

impl Document {
    /// The same picture on a canvas `factor` times as large, its sides rounded. Layers keep their
    /// ids.
    ///
    /// `factor`: finite and `> 0`, else the document is returned unchanged. The caller must check
    /// that the result fits the memory. Fails if nothing is left of a surface thinner than the new
    /// pixels.
    pub fn scaled(&self, factor: f32) -> Result<Document, SurfaceError> {
        let Some(scale) = CanvasScale::of(self.size, factor) else { return Ok(self.clone()) };
        let surface = self.surface.as_ref().map(|s| s.scaled(scale.to)).transpose()?;
        let layers = scale.layers(&self.layers);
        let guides = Arc::new(self.guides.scaled(scale.per_axis));
        let assistants = Arc::new(
            self.assistants.iter().map(|assistant| assistant.scaled(scale.per_axis)).collect(),
        );
        let scaled = Document {
            size: scale.to,
            surface,
            layers,
            guides,
            assistants,
            symmetry: self.symmetry.scaled(scale.per_axis),
            ..scale.scale_selections(self)
        };
        let shaped = if self.parts.is_empty() { scaled } else { scale.parts(self, scaled)? };
        Ok(shaped.with_selections_found())
    }
}

impl Document {
    /// The same picture on a canvas of `to`'s size, its paint sampled for good; the aspect may be
    /// another one. Live layers change their numbers, images their transforms where the aspect
    /// changes. Layers keep their ids.
    ///
    /// The caller must check that the result fits the memory. Fails if nothing is left of a surface
    /// thinner than the new pixels.
    pub fn resampled(&self, to: Size, filter: Resampling) -> Result<Document, SurfaceError> {
        let Some(scale) = CanvasScale::onto(self.size, to, filter) else { return Ok(self.clone()) };
        let maps =
            self.maps_surface().map(|maps| maps.transformed(to, &scale.map())).transpose()?;
        let source = self.surface_source.as_ref().zip(maps.as_ref());
        let scaled = Document {
            size: to,
            surface_source: source.map(|(source, maps)| Arc::new(source.placed_as(maps))),
            surface: maps,
            parts: Arc::default(),
            layers: scale.layers(&self.layers),
            guides: Arc::new(self.guides.scaled(scale.per_axis)),
            assistants: Arc::new(
                self.assistants.iter().map(|own| own.scaled(scale.per_axis)).collect(),
            ),
            symmetry: self.symmetry.scaled(scale.per_axis),
            ..scale.scale_selections(self)
        };
        let part = |part: &Arc<Part>| scale.part(part);
        let shaped = match self.parts.is_empty() {
            true => scaled,
            false => scaled.with_parts(self.parts.list.iter().map(part).collect()),
        };
        Ok(shaped.with_selections_found())
    }
}

impl CanvasScale {
    /// Parts with their lengths scaled, and the surface that they make on the new canvas.
    fn parts(&self, old: &Document, new: Document) -> Result<Document, SurfaceError> {
        let list = old.parts.list.iter().map(|part| self.part(part)).collect();
        let maps =
            old.maps_surface().map(|maps| maps.stretched(self.to).map(Arc::new)).transpose()?;
        let bare = Document {
            surface: maps,
            parts: Arc::new(Parts::pointing_on(old.surface.clone())),
            ..new
        };
        Ok(bare.with_parts(list))
    }

    fn part(&self, part: &Part) -> Arc<Part> {
        Arc::new(part.scaled(self.per_axis, self.length, |plane| self.plane(plane)))
    }
}

#[cfg(test)]
mod tests;
