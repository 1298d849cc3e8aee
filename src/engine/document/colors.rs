//! Every color that a document stores, in one walk: paint, fills, ramps, words, paths, strokes and
//! their tips, light and what it falls on, effects, adjustments, filters, parts, the palette.
//! Floor 4. Here: where colors are. Not here: what becomes of them ([`ColorMap`]; profiles are `io`'s).
//!
//! Numbers that act on colors are no colors: curves, weights and look-up tables stay.

use super::{Content, Document, Layer, Live, OutlineSource, Part, PixelLayer, StrokeList};
use crate::math::ColorProfile;
use crate::math::srgb::Color;
use crate::paint::adjustment::{
    ColorTable, NumberParameter, ParameterName, ParameterVisitor, ToneCurve,
};
use crate::paint::effect::EffectPattern;
use crate::paint::{
    Brush, ColorPalette, FormDrawing, Gradient, GradientStop, LayerEffect, LiveAdjustment,
    LiveFilter, LivePath, NamedColor, PictureOrigin, PictureSource, PlacedImage, Stroke, Text,
};
use crate::raster::{Picture, TileGrid};
use crate::shading::{Environment, LitSphere, Shading};
use std::collections::HashMap;
use std::sync::Arc;

/// What becomes of the colors of a document.
pub trait ColorMap {
    /// A color, such as that of a fill.
    fn color(&mut self, color: Color) -> Color;
    /// Paint.
    fn tiles(&mut self, tiles: &TileGrid) -> TileGrid;
    /// A picture of colors: one that is placed, an environment, a lit sphere, a brush's tip.
    fn picture(&mut self, picture: &Picture) -> Picture;
}

impl Document {
    /// The document with each of its colors replaced, in another profile; for
    /// [`Document::reshaped`]. Each layer is another one in memory, so that nothing which was
    /// cached with it stays.
    pub fn with_colors_mapped(&self, profile: ColorProfile, map: &mut dyn ColorMap) -> Document {
        let mut walk = ColorWalk { map, pictures: HashMap::new(), sources: HashMap::new() };
        let layers = walk.layers(&self.layers);
        let palette = Arc::new(walk.palette(&self.palette));
        let list = self.parts.list.iter().map(|part| walk.part(part)).collect();
        let next = Document { profile, layers, palette, ..self.clone() };
        if self.parts.is_empty() { next } else { next.with_parts_unshaped(list) }
    }
}

struct ColorWalk<'m> {
    map: &'m mut dyn ColorMap,
    /// Those that were visited, by their place, with what became of them: they stay shared.
    pictures: HashMap<usize, (Picture, Picture)>,
    sources: HashMap<usize, (PictureSource, PictureSource)>,
}

impl ColorWalk<'_> {
    fn layers(&mut self, layers: &[Arc<Layer>]) -> Vec<Arc<Layer>> {
        layers.iter().map(|layer| Arc::new(self.layer(layer))).collect()
    }

    fn layer(&mut self, layer: &Layer) -> Layer {
        let effects = match layer.effects.is_empty() {
            true => layer.effects.clone(),
            false => Arc::new(layer.effects.iter().map(|effect| self.effect(effect)).collect()),
        };
        let content = self.content(&layer.content);
        Layer { content, effects, cache: Default::default(), ..layer.clone() }
    }

    fn content(&mut self, content: &Content) -> Content {
        match content {
            Content::Fill(color) => Content::Fill(self.map.color(*color)),
            Content::Pixels(pixels) => {
                let tiles = self.map.tiles(&pixels.tiles);
                let file =
                    if tiles.ptr_eq(&pixels.tiles) { pixels.file.clone() } else { String::new() };
                Content::Pixels(PixelLayer { file, tiles, ..pixels.clone() })
            }
            Content::Image(live) => {
                let source = self.source(&live.params().source);
                Content::Image(Live::new(PlacedImage { source, ..live.params().clone() }))
            }
            Content::Gradient(live) => {
                let stops = self.stops(&live.params().stops);
                Content::Gradient(Live::new(Gradient { stops, ..live.params().clone() }))
            }
            Content::Strokes(live) => {
                let strokes = live.params().strokes.iter();
                let strokes = strokes.map(|stroke| Arc::new(self.stroke(stroke))).collect();
                Content::Strokes(Live::new(StrokeList { strokes }))
            }
            Content::FormDrawing(live) => {
                let drawing = live.params();
                Content::FormDrawing(Live::new(FormDrawing {
                    color: self.map.color(drawing.color),
                    brush: self.brush(&drawing.brush),
                    made: Default::default(),
                    ..drawing.clone()
                }))
            }
            Content::Shading(live) => Content::Shading(Live::new(self.shading(live.params()))),
            Content::Adjustment(adjustment) => {
                let mut params = adjustment.params().clone();
                params.visit(&mut ParameterColors(self));
                Content::Adjustment(LiveAdjustment::new(params))
            }
            Content::Filter(filter) => {
                let mut params = filter.params().clone();
                params.visit(&mut ParameterColors(self));
                Content::Filter(LiveFilter::new(params))
            }
            Content::Group(group) => {
                Content::Group(super::Group { layers: self.layers(&group.layers), ..group.clone() })
            }
            // Numbers, directions, and what follows from other layers.
            Content::RadianceScaling(_) | Content::Normals(_) | Content::Ink(_) => content.clone(),
        }
    }

    fn stops(&mut self, stops: &[GradientStop]) -> Vec<GradientStop> {
        let stop =
            |stop: &GradientStop| GradientStop { color: self.map.color(stop.color), ..*stop };
        stops.iter().map(stop).collect()
    }

    fn effect(&mut self, effect: &LayerEffect) -> LayerEffect {
        let mut next = effect.clone();
        next.stops = self.stops(&effect.stops);
        next.settings.color = self.map.color(effect.settings.color);
        next.settings.shade_color = self.map.color(effect.settings.shade_color);
        next.pattern = effect
            .pattern
            .as_ref()
            .map(|pattern| self.pattern(pattern).unwrap_or_else(|| pattern.clone()));
        next
    }

    fn pattern(&mut self, pattern: &EffectPattern) -> Option<Arc<EffectPattern>> {
        let (size, rgba) = pattern.picture();
        let picture = Picture::srgb8(size, rgba.as_chunks().0.to_vec())?;
        let crate::raster::picture::Texels::Srgb8(texels) = self.map.picture(&picture).texels
        else {
            return None;
        };
        EffectPattern::new(pattern.name(), size, texels.as_flattened().to_vec()).map(Arc::new)
    }

    fn stroke(&mut self, stroke: &Stroke) -> Stroke {
        let (brush, color) = (self.brush(stroke.brush()), self.map.color(stroke.color()));
        Stroke::new(brush, stroke.operator(), color, stroke.samples().to_vec())
            .within(stroke.selection().cloned())
            .on(stroke.attachment().cloned())
    }

    fn brush(&mut self, brush: &Brush) -> Brush {
        if brush.pictures().next().is_none() {
            return brush.clone();
        }
        let next = brush.with_pictures(|source| Ok::<_, ()>(self.source(source)));
        next.unwrap_or_else(|()| brush.clone())
    }

    fn shading(&mut self, shading: &Shading) -> Shading {
        let mut next = shading.clone();
        next.lights.iter_mut().for_each(|light| light.color = self.map.color(light.color));
        for term in [&mut next.ambient, &mut next.diffuse, &mut next.specular] {
            term.color = self.map.color(term.color);
        }
        let painter = &mut next.painter;
        let of_painter =
            [&mut painter.fill_color, &mut painter.bounce_color, &mut painter.rim_color];
        for color in of_painter.into_iter().chain([&mut next.shadows.color]) {
            *color = self.map.color(*color);
        }
        next.pixel.colors.iter_mut().for_each(|color| *color = self.map.color(*color));
        next.environment = shading.environment.as_ref().map(|environment| {
            let picture = self.picture(&environment.picture);
            let mut next = Environment::new(environment.file.clone(), picture);
            (next.projection, next.rotation) = (environment.projection, environment.rotation);
            next.exposure = environment.exposure;
            next
        });
        for sphere in [&mut next.sphere, &mut next.sphere_concave].into_iter().flatten() {
            *sphere = LitSphere::new(sphere.file.clone(), self.picture(&sphere.picture));
        }
        next
    }

    fn picture(&mut self, picture: &Picture) -> Picture {
        if let Some((_, known)) = self.pictures.get(&picture.place()) {
            return known.clone();
        }
        let next = self.map.picture(picture);
        self.pictures.insert(picture.place(), (picture.clone(), next.clone()));
        next
    }

    fn source(&mut self, source: &PictureSource) -> PictureSource {
        if let Some((_, known)) = self.sources.get(&source.place()) {
            let mut known = known.clone();
            known.file.clone_from(&source.file);
            return known;
        }
        let file = source.file.clone();
        let next = match &source.origin {
            PictureOrigin::Path(path) => {
                let mut next = PictureSource::of_path(self.path(path), source.adjust);
                next.file = file;
                next
            }
            PictureOrigin::Text(text) => {
                let picture = self.picture(&source.picture);
                let mut next = PictureSource::new(file, picture, source.adjust);
                next.origin = PictureOrigin::Text(Arc::new(self.text(text)));
                next
            }
            PictureOrigin::File => {
                PictureSource::new(file, self.picture(&source.picture), source.adjust)
            }
        };
        self.sources.insert(source.place(), (source.clone(), next.clone()));
        next
    }

    fn path(&mut self, path: &LivePath) -> LivePath {
        LivePath {
            fill: path.fill.map(|fill| self.map.color(fill)),
            outline_color: self.map.color(path.outline_color),
            ..path.clone()
        }
    }

    fn text(&mut self, text: &Text) -> Text {
        let mut next = text.clone();
        for run in &mut next.runs {
            run.style.color = self.map.color(run.style.color);
            run.style.outline_color = self.map.color(run.style.outline_color);
        }
        next
    }

    fn palette(&mut self, palette: &ColorPalette) -> ColorPalette {
        let mut next = palette.clone();
        for NamedColor { color, .. } in &mut next.colors {
            *color = self.map.color(*color);
        }
        next
    }

    /// A part that is an area of a color.
    fn part(&mut self, part: &Arc<Part>) -> Arc<Part> {
        let mut next = part.clone();
        if let Some(OutlineSource::Layer { color: Some(_), .. }) = part.outline()
            && let Some(OutlineSource::Layer { color: Some(flat), .. }) =
                Arc::make_mut(&mut next).outline_mut()
        {
            flat.color = self.map.color(flat.color);
        }
        next
    }
}

/// The colors among the parameters of an adjustment or a filter.
struct ParameterColors<'a, 'm>(&'a mut ColorWalk<'m>);

impl ParameterVisitor for ParameterColors<'_, '_> {
    fn number(&mut self, _: NumberParameter, _: &mut f32) {}

    fn flag(&mut self, _: ParameterName, _: bool, _: &mut bool) {}

    fn color(&mut self, _: ParameterName, _: Color, value: &mut Color) {
        *value = self.0.map.color(*value);
    }

    fn curve(&mut self, _: ParameterName, _: &mut ToneCurve) {}

    fn stops(&mut self, _: ParameterName, value: &mut Vec<GradientStop>) {
        *value = self.0.stops(value);
    }

    fn table(&mut self, _: ParameterName, _: &mut Option<ColorTable>) {}

    fn group(&mut self, _: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        inside(self);
    }
}
