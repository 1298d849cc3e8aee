//! What a layer holds, and the trait that every kind of layer implements. Floor 4. Each kind has a
//! file that implements `LayerKind`, so that composing, walking and comparing layers name no kinds.
//! Not here: rendering marks (`paint`, `shading`).

mod adjustment;
mod fill;
mod filter;
mod form_drawing;
mod from;
mod gradient;
mod group;
mod image;
mod ink;
mod normals;
mod pixels;
mod radiance_scaling;
mod shading;
pub(in crate::document) mod strokes;

pub use group::Group;
pub use ink::{InkLayer, InkSource, ShownInk};
pub use pixels::PixelLayer;
pub use strokes::StrokeList;

use super::adjustment::{Adjustment, Reach};
use super::live::Live;
use super::map::LayerMap;
use super::marks::Marks;
use super::normals::NormalLayer;
use super::scale::CanvasScale;
use super::tile_content::TileContent;
use crate::Result;
use crate::document::Progress;
use crate::document::far_side::{FarScene, FarTile};
use crate::document::memory_use::MemoryCount;
use crate::math::{Rect, Vec2, srgb::Color};
use crate::paint::{FormDrawing, Gradient, LiveAdjustment, LiveFilter, PlacedImage, Scene};
use crate::raster::{Picture, TileAt};
use crate::shading::{RadianceScaling, Shading};
use crate::surface::Bend;

/// What a layer holds. Live content keeps its parameters and the tiles rendered from them.
#[derive(Clone)]
#[expect(
    clippy::large_enum_variant,
    reason = "one stands in each layer, and layers stand behind `Arc`"
)]
pub enum Content {
    /// One color everywhere.
    Fill(Color),
    /// Pixels to paint on.
    Pixels(PixelLayer),
    /// A picture, bent over the surface.
    Image(Live<PlacedImage>),
    /// A color ramp, bent over the surface.
    Gradient(Live<Gradient>),
    /// Strokes that stay editable.
    Strokes(Live<StrokeList>),
    /// Strokes along lines of the surface.
    FormDrawing(Live<FormDrawing>),
    /// The surface lit.
    Shading(Live<Shading>),
    /// What lies beneath, brighter or darker by the curvature.
    RadianceScaling(RadianceScaling),
    /// What lies beneath, its colors adjusted.
    Adjustment(LiveAdjustment),
    /// What lies beneath, filtered.
    Filter(LiveFilter),
    /// Detail for the surface that layers above see.
    Normals(NormalLayer),
    /// The ink of a drawing beneath, unlit.
    Ink(InkLayer),
    /// Layers.
    Group(Group),
}

/// What a layer is in its stack: all that composing, planning and walking need to know about a
/// kind.
#[derive(Clone, Copy)]
pub enum Role<'a> {
    /// It has pixels of its own.
    Paints,
    /// It changes what is painted beneath it.
    Adjusts(&'a dyn Adjustment),
    /// It changes the surface that layers above it see.
    Shapes(&'a NormalLayer),
    /// It holds layers.
    Groups(&'a Group),
}

/// Gives a file its name elsewhere: called with the name of a picture, and the picture.
pub type NameFile<'a> = dyn FnMut(&str, &Picture) -> Result<String> + 'a;

/// What each kind of layer implements. The defaults are those of a live mark that covers the
/// canvas.
trait LayerKind {
    /// Its name in documents.
    fn name(&self) -> &'static str;
    /// Its name in the window.
    fn label(&self) -> &'static str;
    fn role(&self) -> Role<'_> {
        Role::Paints
    }

    /// Renders one tile, or finds it rendered.
    fn render_tile(&self, _scene: &Scene, _at: TileAt) -> TileContent {
        TileContent::Nothing
    }

    /// What the other sides of a tile's contour pixels see of it.
    fn render_far_side_tile(&self, _scene: &FarScene) -> TileContent {
        TileContent::Nothing
    }

    /// What it is rendered from, if it is live.
    fn marks(&self) -> Option<&dyn Marks> {
        None
    }

    /// Computes now what many tiles would otherwise compute at the same time.
    /// Ends soon once it is canceled.
    fn warm(&self, _scene: &Scene, _progress: &Progress) {}

    /// The same for what is seen behind contours.
    fn warm_far_side(&self, far: &Scene, progress: &Progress) {
        self.warm(far, progress);
    }

    /// On a canvas of another size.
    fn scaled(&self, scale: &CanvasScale) -> Content;
    /// The same on a canvas of another aspect, where that stretches it more than its numbers can
    /// express; `None` if they can, and for what is resampled. Its transform expresses the rest.
    fn stretched(&self, _scale: &CanvasScale) -> Option<Content> {
        None
    }

    /// The same for a moment while the user drags, cheaper to render; `None` if it is the same
    /// then.
    fn draft(&self) -> Option<Content> {
        None
    }

    /// Elsewhere on the canvas; `None` for what has no place.
    fn moved(&self, _by: Vec2) -> Option<Content> {
        None
    }

    /// As it lies on the canvas, its frame taken there by `map`; `None` for what has no place.
    /// `last`: other content, and what became of it under the same map.
    fn on_canvas(&self, _map: &LayerMap, _last: Option<(&Content, &Content)>) -> Option<Content> {
        None
    }

    /// Whether it moves with the shape that it lies on: light does not, nor what is the same
    /// everywhere.
    fn is_tied_to_shape(&self) -> bool {
        true
    }

    /// Whether it shows something where no surface is, even if it is clipped to the surface.
    fn is_shown_off_surface(&self) -> bool {
        false
    }

    /// Whether marks of it have attachments of their own.
    fn has_attachments(&self) -> bool {
        false
    }

    /// Without what was painted; `None` for what is not painted on.
    fn without_paint(&self) -> Option<Content> {
        None
    }

    /// Operator, anchors and weights, if it is bent as a whole.
    fn bend(&self) -> Option<Bend> {
        None
    }

    /// The files that it names.
    fn files(&self) -> Vec<&str> {
        Vec::new()
    }

    /// With its pictures under other names; `None` if it names none. A paint layer's pixels are not
    /// among them.
    fn with_files(&self, _name: &mut NameFile) -> Result<Option<Content>> {
        Ok(None)
    }

    /// What it lacks but needs to be painted: the field, and why.
    fn lacks(&self) -> Option<(&'static str, String)> {
        None
    }

    /// Where it can be seen; `scene`: what it sees, if that is the same before and after an edit.
    fn visible_area(&self, _scene: Option<&Scene>) -> VisibleArea {
        VisibleArea::Canvas
    }

    /// Where it may look different from `old`, of the same kind; `scene`: what both see.
    fn difference_from(&self, old: &Content, scene: &dyn Fn() -> Scene) -> Changed;
    /// Counts what it holds, as [`MemoryCount::add`] does.
    fn count(&self, _count: &mut MemoryCount, _keeps: bool) {}
}

/// Where a layer can be seen.
pub(in crate::document) enum VisibleArea {
    Nowhere,
    Canvas,
    Rects(Vec<Rect>),
    Tiles(Vec<TileAt>),
}

/// Where two versions of a layer may differ.
pub(in crate::document) enum Changed {
    Nowhere,
    /// Wherever either can be seen.
    Wholly,
    Tiles(Vec<TileAt>),
}

impl Changed {
    fn wholly_if(is_other: bool) -> Self {
        if is_other { Changed::Wholly } else { Changed::Nowhere }
    }

    /// For live content that is either the very same or another.
    fn of_live<T>(new: &Live<T>, old: Option<&Live<T>>) -> Self {
        Self::wholly_if(old.is_none_or(|old| !new.ptr_eq(old)))
    }
}

impl Content {
    fn kind(&self) -> &dyn LayerKind {
        match self {
            Content::Fill(fill) => fill,
            Content::Pixels(pixels) => pixels,
            Content::Image(image) => image,
            Content::Gradient(gradient) => gradient,
            Content::Strokes(strokes) => strokes,
            Content::FormDrawing(drawing) => drawing,
            Content::Shading(shading) => shading,
            Content::RadianceScaling(scaling) => scaling,
            Content::Adjustment(adjustment) => adjustment,
            Content::Filter(filter) => filter,
            Content::Normals(normals) => normals,
            Content::Ink(lines) => lines,
            Content::Group(group) => group,
        }
    }

    /// The name of its kind in documents.
    pub fn kind_name(&self) -> &'static str {
        self.kind().name()
    }

    /// The name of its kind in the window.
    pub fn label(&self) -> &'static str {
        self.kind().label()
    }

    /// What it is in its stack.
    pub fn role(&self) -> Role<'_> {
        self.kind().role()
    }

    /// It has pixels of its own.
    pub fn has_pixels(&self) -> bool {
        matches!(self.role(), Role::Paints)
    }

    /// It changes the surface for layers above.
    pub fn is_shaping_surface(&self) -> bool {
        matches!(self.role(), Role::Shapes(_))
    }

    /// Whether a layer of it can be displaced: what shapes the surface or adjusts the picture
    /// beneath shows nothing of its own.
    pub fn can_be_warped(&self) -> bool {
        matches!(self.role(), Role::Paints | Role::Groups(_))
    }

    /// It moves with the shape that it lies on.
    pub(in crate::document) fn is_tied_to_shape(&self) -> bool {
        self.kind().is_tied_to_shape()
    }

    /// It shows something where no surface is, even if it is clipped to the surface.
    pub fn is_shown_off_surface(&self) -> bool {
        self.kind().is_shown_off_surface()
    }

    /// The group that it is, if it is one.
    pub fn group(&self) -> Option<&Group> {
        match self {
            Content::Group(group) => Some(group),
            _ => None,
        }
    }

    /// As [`Content::group`], to change it.
    pub fn group_mut(&mut self) -> Option<&mut Group> {
        match self {
            Content::Group(group) => Some(group),
            _ => None,
        }
    }

    /// The same content elsewhere on the canvas; what has no place stays as it is.
    pub fn moved(&self, by: Vec2) -> Content {
        self.kind().moved(by).unwrap_or_else(|| self.clone())
    }

    /// The same content, its frame moved by a map.
    ///
    /// * `last`: other content of the layer and the result under this map: what did not change is
    ///   not made again.
    pub fn on_canvas(&self, map: &LayerMap, last: Option<(&Content, &Content)>) -> Content {
        match last {
            Some((own, seen)) if self.is_identical(own) => seen.clone(),
            _ => self.kind().on_canvas(map, last).unwrap_or_else(|| self.clone()),
        }
    }

    /// Whether marks of it have attachments that differ from the layer's.
    pub fn has_attachments(&self) -> bool {
        self.kind().has_attachments()
    }

    /// The same kind without what was painted; `None` for what is not painted on.
    pub fn without_paint(&self) -> Option<Content> {
        self.kind().without_paint()
    }

    /// Operator, anchors and weights, if it is bent as a whole.
    pub fn bend(&self) -> Option<Bend> {
        self.kind().bend()
    }

    /// The files that it names.
    pub fn files(&self) -> Vec<&str> {
        self.kind().files()
    }

    /// The same content with its pictures under other names.
    pub fn with_files(&self, name: &mut NameFile) -> Result<Content> {
        Ok(self.kind().with_files(name)?.unwrap_or_else(|| self.clone()))
    }

    /// What it lacks but needs to be painted: the field, and why.
    pub fn lacks(&self) -> Option<(&'static str, String)> {
        self.kind().lacks()
    }

    pub(in crate::document) fn render_tile(&self, scene: &Scene, at: TileAt) -> TileContent {
        self.kind().render_tile(scene, at)
    }

    pub(in crate::document) fn render_far_side_tile(&self, scene: &FarScene) -> TileContent {
        self.kind().render_far_side_tile(scene)
    }

    /// What it is rendered from without rounding to bytes; `None` for what is not live.
    pub(in crate::document) fn marks(&self) -> Option<&dyn Marks> {
        self.kind().marks()
    }

    pub(in crate::document) fn warm(&self, scene: &Scene, progress: &Progress) {
        self.kind().warm(scene, progress);
    }

    pub(in crate::document) fn warm_far_side(&self, far: &Scene, progress: &Progress) {
        self.kind().warm_far_side(far, progress);
    }

    pub(in crate::document) fn scaled(&self, scale: &CanvasScale) -> Content {
        self.kind().scaled(scale)
    }

    pub(in crate::document) fn stretched(&self, scale: &CanvasScale) -> Option<Content> {
        self.kind().stretched(scale)
    }

    pub(in crate::document) fn drafted(&self) -> Option<Content> {
        self.kind().draft()
    }

    pub(in crate::document) fn visible_area(&self, scene: Option<&Scene>) -> VisibleArea {
        self.kind().visible_area(scene)
    }

    /// Whether it is the very same value in memory, or the same number.
    pub(in crate::document) fn is_identical(&self, other: &Content) -> bool {
        match (self, other) {
            (Content::Image(a), Content::Image(b)) => a.ptr_eq(b),
            (Content::Gradient(a), Content::Gradient(b)) => a.ptr_eq(b),
            (Content::Strokes(a), Content::Strokes(b)) => a.ptr_eq(b),
            (Content::FormDrawing(a), Content::FormDrawing(b)) => a.ptr_eq(b),
            (Content::Shading(a), Content::Shading(b)) => a.ptr_eq(b),
            (Content::Pixels(a), Content::Pixels(b)) => a.tiles.ptr_eq(&b.tiles),
            (Content::Normals(a), Content::Normals(b)) => a == b,
            (Content::Fill(a), Content::Fill(b)) => a == b,
            (Content::Ink(a), Content::Ink(b)) => a.is_identical(b),
            (Content::RadianceScaling(a), Content::RadianceScaling(b)) => a == b,
            (Content::Adjustment(a), Content::Adjustment(b)) => a == b,
            (Content::Filter(a), Content::Filter(b)) => a == b,
            _ => false,
        }
    }

    pub(in crate::document) fn difference_from(
        &self,
        old: &Content,
        scene: &dyn Fn() -> Scene,
    ) -> Changed {
        self.kind().difference_from(old, scene)
    }

    pub(in crate::document) fn count(&self, count: &mut MemoryCount, keeps: bool) {
        self.kind().count(count, keeps);
    }

    /// The filter that it is, if it reads what lies around a pixel beneath it.
    pub(in crate::document) fn filter(&self) -> Option<&LiveFilter> {
        match self.role() {
            Role::Adjusts(adjustment) => adjustment.filter(),
            _ => None,
        }
    }

    /// Its appearance depends on the whole picture beneath it.
    pub(in crate::document) fn is_composed_of_beneath(&self) -> bool {
        matches!(self.role(), Role::Adjusts(adjustment) if adjustment.reach() == Reach::Picture)
    }
}
