//! New layers of every kind, as they begin.
//! Floor 6.

use super::steps::EditStep;
use crate::document::{
    Content, DetailSource, Document, Group, Layer, LayerSlot, Live, NormalLayer, PixelLayer,
    StrokeList,
};
use crate::math::{Size, srgb::Color, vec2};
use crate::paint::{FormDrawing, FormPattern, Gradient, Placement, RampStyle};
use crate::raster::{BlendMode, Outside};
use crate::session::replay::names;
use crate::shading::{Model, RadianceScaling, Shading};
use crate::surface::form_lines::LineSettings;
use crate::surface::hatching::{HatchSettings, HatchWay};
use crate::surface::{NoiseRelief, Operator};
use crate::tools::ToolSettings;
use crate::tools::gradient::GradientSettings;

rilievo_engine::named! {
    /// Kinds of new layers.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum NewLayer {
        Paint = "paint" => "Paint layer",
        Strokes = "strokes" => "Stroke layer",
        Lines = "lines" => "Form lines",
        Hatching = "hatching" => "Hatching",
        Fill = "fill" => "Fill layer",
        Gradient = "gradient" => "Gradient layer",
        Shading = "shading" => "Shading layer",
        RadianceScaling = "radiance scaling" => "Bring out form",
        Normals = "normals" => "Detail normals",
        Group = "group" => "Group",
    }
}

names!(NewLayer);

/// A new layer that would cover the canvas covers only the selection, by a mask.
pub(super) fn selecting(document: &Document, layer: Layer) -> Layer {
    let covers = !matches!(
        layer.content,
        Content::Pixels(_) | Content::Strokes(_) | Content::Group(_) | Content::Normals(_)
    );
    Layer { mask: if covers { document.selection_as_mask() } else { None }, ..layer }
}

/// A shading layer of a model. The painter's light is on the picture beneath, if there is one; toon
/// darkens it.
pub(super) fn lit_layer(model: Model, document: &Document) -> Layer {
    let mut shading = Shading::fitting(model, document.size);
    let is_painted =
        document.walk().iter().any(|(_, layer)| layer.visible && layer.content.has_pixels());
    shading.painter.beneath = model == Model::Painter && is_painted;
    let name = document.free_layer_name(model.label());
    let mut layer = Layer::new(name, Content::Shading(Live::new(shading)));
    if model == Model::Toon {
        layer.blend = BlendMode::Multiply;
    }
    layer
}

/// A drawing by the form in lengths that suit a canvas.
fn make_drawing(pattern: FormPattern, size: Size) -> Content {
    Content::FormDrawing(Live::new(FormDrawing::new(pattern).scaled(on_canvas(size))))
}

/// Hatching along the strokes of the stroke layer that it names, or form lines that leave out what
/// those draw again, or those of a new one above it, which is selected.
pub(super) fn add_guides(document: &Document, layer: &Layer) -> Option<EditStep> {
    let Content::FormDrawing(live) = &layer.content else { return None };
    let mut drawing = live.params().clone();
    let sources = &mut drawing.sources;
    let (name, begins_as, label) = match &mut drawing.pattern {
        FormPattern::Hatching(hatch) => {
            hatch.way = HatchWay::Guides;
            (&mut sources.guides, "Guide strokes", "Draw guide strokes")
        }
        FormPattern::Lines(_) => (&mut sources.redrawn, "Redrawn lines", "Redraw lines"),
    };
    let named = document.layer_named(name);
    let known = named.filter(|layer| matches!(layer.content, Content::Strokes(_)));
    let (document, id) = match known {
        Some(known) => (document.clone(), known.id),
        None => {
            *name = document.free_layer_name(begins_as);
            let strokes = Content::Strokes(Live::new(StrokeList::default()));
            let new = Layer { clip_to_surface: false, ..Layer::new(name.clone(), strokes) };
            let place = document.place_of(layer.id)?;
            let (id, above) = (new.id, LayerSlot { index: place.index + 1, ..place });
            (document.with_inserted(new, above)?, id)
        }
    };
    let content = Content::FormDrawing(Live::new(drawing));
    let next = document.with_layer(layer.id, |layer| layer.content = content)?;
    Some((label, next, vec![id]))
}

/// What lengths of a canvas of 1024 px are multiplied by on another: finer ones would not be seen,
/// nor coarser ones look drawn.
fn on_canvas(size: Size) -> f32 {
    (size.longer_side() / 1024.0).max(0.5).min(8.0)
}

/// What new layers take from the settings of tools.
pub(super) struct NewLayerSettings {
    colors: [Color; 2],
    gradient: GradientSettings,
    operator: Operator,
}

impl Default for NewLayerSettings {
    fn default() -> Self {
        Self::of(&ToolSettings::default())
    }
}

impl NewLayerSettings {
    pub fn of(tools: &ToolSettings) -> Self {
        let colors = [tools.color, tools.second_color];
        Self { colors, gradient: tools.gradient, operator: tools.operator }
    }

    /// A gradient from above to below, or from the middle outward.
    fn gradient(&self, size: Size) -> Gradient {
        let (middle, reach) = (size.center(), vec2(0.0, 0.35 * size.height as f32));
        let is_straight = self.gradient.style == RampStyle::Linear;
        let from = if is_straight { middle - reach } else { middle };
        let gradient = self.gradient.gradient(from, middle + reach, self.colors);
        gradient.with_operator(self.operator)
    }
}

pub(super) fn make_layer(
    kind: NewLayer,
    document: &Document,
    settings: &NewLayerSettings,
) -> Layer {
    let size = document.size;
    let (name, content) = match kind {
        NewLayer::Paint => ("Paint", Content::Pixels(PixelLayer::default())),
        NewLayer::Strokes => ("Strokes", Content::Strokes(Live::new(StrokeList::default()))),
        NewLayer::Lines => {
            ("Form lines", make_drawing(FormPattern::Lines(LineSettings::BESIDE_INK), size))
        }
        NewLayer::Hatching => {
            ("Hatching", make_drawing(FormPattern::Hatching(HatchSettings::DEFAULT), size))
        }
        NewLayer::Fill => ("Fill", Content::Fill(settings.colors[0])),
        NewLayer::Gradient => ("Gradient", Content::Gradient(Live::new(settings.gradient(size)))),
        NewLayer::Shading => ("Shading", Content::Shading(Live::new(Shading::new(Model::Phong)))),
        NewLayer::RadianceScaling => {
            ("Bring out form", Content::RadianceScaling(RadianceScaling::default()))
        }
        NewLayer::Normals => {
            let normals = NormalLayer {
                source: DetailSource::Grain(NoiseRelief::default()),
                placement: Placement { center: size.center(), scale: 1.0, rotation: 0.0 },
                outside: Outside::Repeat,
                strength: 0.5,
                frame: Default::default(),
            };
            ("Detail normals", Content::Normals(normals))
        }
        NewLayer::Group => ("Group", Content::Group(Group::default())),
    };
    Layer::new(document.free_layer_name(name), content)
}
