//! Small pictures of parts: each alone in the light of one lamp.
//! Floor 7.

use crate::document::parts::{FormArea, Parts};
use crate::document::{Document, Part};
use crate::math::{Affine2, Vec3, srgb, vec3};
use crate::shape::Form;
use crate::surface::Surface;
use eframe::egui::{self, Color32, ColorImage, TextureHandle, TextureId, TextureOptions, Vec2};
use std::collections::HashMap;
use std::sync::Arc;

/// The side of a picture, px.
const SIDE: usize = 56;

/// The pictures of the document's parts, by their ids.
#[derive(Default)]
pub struct PartPictures {
    /// What these were last taken from: while it is the same, so are they.
    of: Option<(Arc<Parts>, Option<Arc<Surface>>)>,
    areas: Vec<(Arc<Part>, Arc<FormArea>)>,
    /// The map of each form to where its part is now.
    moved: Vec<Affine2>,
    painted: HashMap<String, (Arc<FormArea>, TextureHandle)>,
}

impl PartPictures {
    /// Updates the pictures to a document.
    pub fn follow(&mut self, ctx: &egui::Context, document: &Document) {
        self.areas(document);
        let areas = &self.areas;
        self.painted.retain(|id, _| areas.iter().any(|(part, _)| part.id == *id));
        for (part, area) in areas {
            let is_known =
                self.painted.get(&part.id).is_some_and(|(known, _)| Arc::ptr_eq(known, area));
            if !is_known && let Some(form) = document.form_of(&part.id) {
                let texture = ctx.load_texture(
                    format!("part {}", part.id),
                    draw_lit(&form),
                    TextureOptions::LINEAR,
                );
                self.painted.insert(part.id.clone(), (area.clone(), texture));
            }
        }
    }

    /// Where the forms of a document lie, with their parts, computed once per version of it.
    pub fn areas(&mut self, document: &Document) -> &[(Arc<Part>, Arc<FormArea>)] {
        let is_same = self.of.as_ref().is_some_and(|(parts, surface)| {
            let surfaces =
                [surface, &document.surface].map(|surface| surface.as_ref().map(Arc::as_ptr));
            Arc::ptr_eq(parts, &document.parts) && surfaces[0] == surfaces[1]
        });
        if !is_same {
            let areas = match document.is_ahead() {
                // During a drag nothing is made here.
                true => document.last_part_areas(),
                false => document
                    .part_areas()
                    .into_iter()
                    .map(|(part, area)| (part, area, Affine2::IDENTITY))
                    .collect(),
            };
            (self.areas, self.moved) =
                areas.into_iter().map(|(part, area, map)| ((part, area), map)).unzip();
            self.of = Some((document.parts.clone(), document.surface.clone()));
        }
        &self.areas
    }

    /// The map of a part's form, as it was made last, to where the part is.
    pub fn map_since(&self, id: &str) -> Affine2 {
        let at = self.areas.iter().position(|(part, _)| part.id == id);
        at.and_then(|at| self.moved.get(at)).copied().unwrap_or(Affine2::IDENTITY)
    }

    /// A picture and its size.
    pub fn picture(&self, part: &Part) -> Option<(TextureId, Vec2)> {
        let (_, texture) = self.painted.get(part.on().unwrap_or(&part.id))?;
        Some((texture.id(), texture.size_vec2()))
    }
}

/// A form under a lamp from above left, transparent around it.
fn draw_lit(form: &Form) -> ColorImage {
    let light = vec3(-0.5, 0.6, 0.62).normalize_or(Vec3::Z);
    let size = form.coverage.size();
    let scale = (SIDE as f32 / size.longer_side()).min(1.0);
    let side = |v: u32| ((v as f32 * scale).round() as usize).max(1);
    let (width, height) = (side(size.width), side(size.height));
    let texel = |i: usize| {
        let at = |v: usize, n: usize, all: u32| (((v as f32 + 0.5) / n as f32) * all as f32) as i32;
        let (x, y) = (at(i % width, width, size.width), at(i / width, height, size.height));
        let normal = form.normals.at_clamped(x, y);
        let shade = srgb::quantize(srgb::encode(0.06 + 0.8 * normal.dot(light).max(0.0)));
        Color32::from_rgba_unmultiplied(shade, shade, shade, form.coverage.at_clamped(x, y))
    };
    ColorImage::new([width, height], (0..width * height).map(texel).collect())
}
