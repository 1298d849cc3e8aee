//! Whether a file can hold a document: every number in its range, and no more of anything than
//! readers accept. An edit beyond these limits is refused at once, so that whatever can be set can
//! be saved and opened. Floor 4. The ranges are those of the types that hold the numbers; readers
//! use the same ones.

mod light;
mod marks;
mod selections;

use super::TransformShape;
use super::{
    Assistant, Attachment, Content, DerivedMask, DetailSource, Document, Layer, LayerMask,
    LayerTransform, MaskKind, Part, PixelLayer, SelectionList,
};
use crate::math::range::{at_most, check_range};
use crate::math::{COORDINATE, Size};
use crate::memory::free_bytes;
use crate::raster::{Picture, Resampling, TILE};
use crate::shading::FeatureScale;
use std::collections::HashSet;
use std::sync::Arc;

/// `Ok` if it fits, else why not: a sentence without its end.
type Fit = Result<(), String>;

impl Document {
    /// Layers, those in groups too.
    pub const MOST_LAYERS: usize = 10_000;
    /// Groups around a layer.
    pub const DEEPEST: usize = 50;
    /// Pen samples: days of painting.
    pub const MOST_SAMPLES: usize = 32_000_000;
    /// Values of its description, an object counting as eight; each takes some eighty bytes while
    /// it is read.
    pub const MOST_VALUES: usize = 4_000_000;

    /// Refuses what files cannot hold, in a sentence that names the layer, and parts whose surface
    /// could not be made, since too little memory is free for it. Layers that `before`
    /// holds unchanged are only counted, so that an opened document can be edited whatever it
    /// holds.
    pub fn fits(&self, before: Option<&Document>) -> Result<(), String> {
        let mut known = HashSet::new();
        if let Some(before) = before {
            each(&before.layers, 0, &mut |layer, _| known.extend([Arc::as_ptr(layer)]));
        }
        let mut total = Total::default();
        let mut fit = Ok(());
        each(&self.layers, 0, &mut |layer, depth| {
            total.add(layer, depth);
            if fit.is_ok() && !known.contains(&Arc::as_ptr(layer)) {
                let was = before.and_then(|before| before.layer(layer.id));
                fit = layer_fits(layer, was.map(|was| &**was), self.size)
                    .map_err(|why| name_layer(layer, &why));
            }
        });
        self.parts.list.iter().for_each(|part| total.add_part(part));
        total.values += selections::A_SELECTION * SelectionList::of(self).all().len();
        total.values += marks::A_COLOR * self.palette.colors.len();
        let attachments = || self.attachments_fit();
        let values = || total.fits().map_err(|why| format!("{why}."));
        fit.and_then(|()| self.aids_fit())
            .and_then(|()| selections::fit(self, before))
            .and_then(|()| self.surface_fits())
            .and_then(|()| self.parts_fit(before))
            .and_then(|()| attachments())
            .and_then(|()| values())
            .and_then(|()| self.shape_fits())
    }
}

impl Document {
    fn aids_fit(&self) -> Fit {
        self.guides
            .fits()
            .and_then(|()| Assistant::all_fit(&self.assistants))
            .and_then(|()| self.symmetry.fits())
            .and_then(|()| self.palette.fits())
            .map_err(|why| format!("{why}."))
    }

    fn surface_fits(&self) -> Fit {
        self.surface_source
            .as_ref()
            .map_or(Ok(()), |source| source.fits().map_err(|why| format!("Surface: {why}.")))
    }

    /// Whether its surface was made, or can be.
    fn shape_fits(&self) -> Fit {
        self.shape_fits_in(free_bytes()).map_err(|why| format!("Too large: {why}."))
    }

    /// Whether every attachment is the canvas or one of the parts.
    fn attachments_fit(&self) -> Result<(), String> {
        let known = |attachment: &Attachment| match attachment.part() {
            Some(id) if self.parts.part(id).is_none() => {
                Err(format!("is attached to “{id}”, but there is no such part"))
            }
            _ => Ok(()),
        };
        let of_strokes = |layer: &Layer| match &layer.content {
            Content::Strokes(live) if layer.content.has_attachments() => {
                live.params().strokes.iter().try_for_each(|stroke| {
                    let Some(attachment) = stroke.attachment() else { return Ok(()) };
                    known(&attachment.frame)?;
                    let shape = TransformShape::Matrix(attachment.own);
                    LayerTransform { shape, filter: Resampling::default() }.fits()
                })
            }
            _ => Ok(()),
        };
        self.walk().into_iter().try_for_each(|(_, layer)| {
            let fit = layer.on.as_ref().map_or(Ok(()), known).and_then(|()| of_strokes(layer));
            fit.map_err(|why| name_layer(layer, &why))
        })
    }
}

/// Every layer with the number of groups around it.
fn each<'d>(layers: &'d [Arc<Layer>], depth: usize, visit: &mut dyn FnMut(&'d Arc<Layer>, usize)) {
    for layer in layers {
        visit(layer, depth);
        if let Content::Group(group) = &layer.content {
            each(&group.layers, depth + 1, visit);
        }
    }
}

fn name_layer(layer: &Layer, why: &str) -> String {
    const SHOWN: usize = 60;
    let name: String = layer.name.chars().take(SHOWN).collect();
    format!("“{name}”: {why}.")
}

/// The most values that a block of liquify takes.
const A_BLOCK: usize = 150;

/// Totals over all layers.
#[derive(Default)]
struct Total {
    layers: usize,
    deepest: usize,
    samples: usize,
    values: usize,
}

impl Total {
    /// More than any layer takes without its lists.
    const A_LAYER: usize = 200;

    fn add(&mut self, layer: &Layer, depth: usize) {
        self.layers += 1;
        // An empty group adds no depth.
        self.deepest = self.deepest.max(depth);
        self.values += Self::A_LAYER + marks::effect_values(layer);
        self.values +=
            layer.liquify.as_ref().map_or(0, |liquify| A_BLOCK * liquify.blocks().count());
        self.values += layer
            .transform
            .as_ref()
            .and_then(|own| own.mesh())
            .map_or(0, |mesh| 10 * mesh.points().len());
        match &layer.content {
            Content::Image(live) => {
                let crate::surface::Bend { anchors, pieces, .. } = &live.params().bend;
                self.values += marks::AN_ANCHOR * (anchors.len() + pieces.len());
                let path = live.params().source.path();
                self.values += path.map_or(0, |path| marks::path_values(path));
            }
            Content::Gradient(live) => {
                let crate::paint::Gradient { stops, pieces, .. } = live.params();
                self.values += marks::A_STOP * stops.len() + marks::AN_ANCHOR * pieces.len();
            }
            Content::Strokes(live) => {
                let (samples, values) = marks::count_values(&live.params().strokes);
                (self.samples, self.values) = (self.samples + samples, self.values + values);
            }
            Content::Shading(live) => {
                let shading = live.params();
                self.values += light::A_LIGHT * shading.lights.len()
                    + light::A_SCALE * shading.features.scales.len();
            }
            Content::RadianceScaling(scaling) => {
                self.values += light::A_SCALE * scaling.features.scales.len()
            }
            Content::Adjustment(live) => self.values += marks::adjustment_values(live.params()),
            Content::FormDrawing(live) => {
                self.values += marks::form_drawing_values(live.params());
            }
            Content::Fill(_)
            | Content::Filter(_)
            | Content::Pixels(_)
            | Content::Normals(_)
            | Content::Ink(_)
            | Content::Group(_) => {}
        }
    }

    fn add_part(&mut self, part: &Part) {
        let (samples, values) = part.count_values();
        (self.samples, self.values) = (self.samples + samples, self.values + values);
    }

    fn fits(&self) -> Fit {
        at_most("Layers", self.layers, Document::MOST_LAYERS)?;
        at_most("Groups around a layer", self.deepest, Document::DEEPEST)?;
        at_most("Readings of the pen in the drawing", self.samples, Document::MOST_SAMPLES)?;
        if self.values > Document::MOST_VALUES {
            let what = "strokes, anchors, lights and parts";
            return Err(format!(
                "The drawing would have more {what} than a file can hold: turn some into pixels"
            ));
        }
        Ok(())
    }
}

fn layer_fits(layer: &Layer, was: Option<&Layer>, canvas: Size) -> Fit {
    if was.is_none_or(|was| was.name != layer.name) {
        at_most("letters of the name", layer.name.chars().count(), Layer::LONGEST_NAME)?;
    }
    check_range("opacity", layer.opacity, &Layer::OPACITY)?;
    marks::effects(layer)?;
    layer.mask.as_ref().map_or(Ok(()), |mask| mask_fits(mask, canvas))?;
    layer.transform.as_ref().map_or(Ok(()), |transform| transform.fits())?;
    if layer.is_warped() && !layer.content.can_be_warped() {
        return Err("shows nothing of its own, so a mesh or liquify cannot displace it".into());
    }
    match &layer.content {
        // The numbers of adjustments and filters are held where they are made.
        Content::Fill(_) | Content::Ink(_) | Content::Group(_) => Ok(()),
        Content::Adjustment(_) | Content::Filter(_) => Ok(()),
        Content::Pixels(pixels) => pixels_fit(pixels, canvas),
        Content::Image(live) => marks::image(live.params()),
        Content::Gradient(live) => marks::gradient(live.params()),
        Content::Strokes(live) => {
            let old = was.map(|was| &was.content);
            let old =
                if let Some(Content::Strokes(old)) = old { &old.params().strokes[..] } else { &[] };
            marks::strokes(old, &live.params().strokes)
        }
        Content::FormDrawing(live) => marks::form_drawing(live.params()),
        Content::Shading(live) => light::shading(live.params()),
        Content::RadianceScaling(scaling) => light::radiance_scaling(scaling),
        Content::Normals(normals) => {
            check_range("the strength", normals.strength, &super::NormalLayer::STRENGTH)?;
            marks::placement(&normals.placement)?;
            match &normals.source {
                DetailSource::Map { picture, .. } => marks::adjust(&picture.adjust),
                DetailSource::Grain(grain) => marks::relief(grain),
            }
        }
    }
}

fn mask_fits(mask: &LayerMask, canvas: Size) -> Fit {
    let ramp = |from, to, range| {
        check_range("where the mask is 0", from, range).and(check_range(
            "where the mask is 1",
            to,
            range,
        ))
    };
    match &mask.kind {
        MaskKind::File { coverage, .. } if coverage.size() != canvas => {
            Err(format!("the mask has {} pixels, the canvas {canvas}", coverage.size()))
        }
        MaskKind::File { .. } => Ok(()),
        MaskKind::Derived(DerivedMask::Fresnel { f0, power }) => {
            check_range("the mask's least", *f0, &DerivedMask::F0)?;
            check_range("the mask's power", *power, &DerivedMask::POWER)
        }
        MaskKind::Derived(DerivedMask::Curvature { scale, blur, from, to }) => {
            check_range("the mask's width", *scale, &FeatureScale::CURVATURE_PX)?;
            check_range("the mask's blur", *blur, &FeatureScale::BLUR_PX)?;
            ramp(*from, *to, &DerivedMask::KAPPA)
        }
        MaskKind::Derived(DerivedMask::Depth { from, to }) => ramp(*from, *to, &DerivedMask::DEPTH),
        MaskKind::Derived(DerivedMask::Region(region)) => selections::region(region),
    }
}

/// A file holds the rectangle around all pixels.
fn pixels_fit(pixels: &PixelLayer, canvas: Size) -> Fit {
    let rect = pixels.tiles.bounds();
    if rect.is_empty() {
        return Ok(());
    }
    [rect.x0, rect.y0, rect.x1, rect.y1]
        .iter()
        .try_for_each(|v| check_range("a pixel's place", *v as f32, &COORDINATE))?;
    // The rectangle is that of whole tiles: the pixels' own is smaller by less than one on each
    // side.
    let inner = |long: usize| long.saturating_sub(2 * (TILE - 1)).max(1);
    let (width, height) = (inner(rect.width()), inner(rect.height()));
    let side = (Picture::LONGEST_SIDE_PX).max(canvas.width).max(canvas.height) as usize;
    if width.max(height) > side || width * height > Picture::MOST_PX.max(canvas.area()) {
        return Err(format!(
            "its pixels would cover {width} × {height} px, more than a picture can hold"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
