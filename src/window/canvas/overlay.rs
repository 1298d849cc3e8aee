//! Views of the surface over the picture, drawn on a thread of their own: one over all of it, and
//! the anchors' weights in a corner (SF fig. 9). Floor 7. Not here: the views (`document::view`).

use super::marks::anchor_color;
use crate::document::view::{SurfaceView, draw};
use crate::document::{Content, Document, Layer};
use crate::jobs;
use crate::language::tr;
use crate::raster::Picture;
use crate::session::Session;
use crate::{Error, Result};
use eframe::egui::{
    self, Align2, Color32, ColorImage, FontId, Painter, Rect, Stroke, StrokeKind, TextureHandle,
    TextureOptions, pos2, vec2,
};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

/// The inputs of a view that can change.
#[derive(Clone)]
struct ViewInputs {
    view: SurfaceView,
    document: Document,
    /// For the view of a layer.
    layer: Option<Arc<Layer>>,
}

impl ViewInputs {
    fn of(session: &Session, view: SurfaceView) -> Option<Self> {
        let layer = session.layer().cloned().filter(|_| view.is_of_layer());
        Some(Self { view, document: session.shown_document()?.clone(), layer })
    }

    fn is_same(&self, other: &ViewInputs) -> bool {
        let layers = [&self.layer, &other.layer].map(|layer| layer.as_ref().map(Arc::as_ptr));
        self.view == other.view
            && layers[0] == layers[1]
            && self.document.scene().is_same(&other.document.scene())
    }

    fn picture(&self) -> Option<Picture> {
        draw(&self.document, self.layer.as_deref(), self.view, &Default::default()).ok()
    }

    /// The same, no side longer than this.
    fn small(self, side_px: f32) -> Option<Picture> {
        let layers = self.layer.iter().cloned().collect();
        let alone = Document { layers, ..self.document };
        let document = alone.scaled((side_px / alone.size.longer_side()).min(1.0)).ok()?;
        let layer = document.layers.first().cloned();
        Self { document, layer, view: self.view }.picture()
    }
}

/// The view that was drawn last, and the one in progress.
#[derive(Default)]
struct DrawnView {
    of: Option<ViewInputs>,
    coming: Option<Receiver<Option<Picture>>>,
    texture: Option<TextureHandle>,
}

impl DrawnView {
    /// The requested view, or the previous one until it is drawn.
    fn texture(
        &mut self,
        ctx: &egui::Context,
        wanted: ViewInputs,
        make: fn(ViewInputs) -> Option<Picture>,
    ) -> Result<Option<&TextureHandle>> {
        if self.coming.is_none() && !self.of.as_ref().is_some_and(|of| of.is_same(&wanted)) {
            self.of = Some(wanted.clone());
            let (sender, coming) = channel();
            self.coming = Some(coming);
            let waker = ctx.clone();
            jobs::spawn("view of the surface", move || {
                // The window may be closed by then.
                let _ = sender.send(make(wanted));
                waker.request_repaint();
            })?;
        }
        if let Some(done) = self.coming.as_ref().and_then(|coming| coming.try_recv().ok()) {
            self.coming = None;
            self.texture =
                done.and_then(|picture| load_texture(ctx, "view of the surface", &picture));
            ctx.request_repaint();
        }
        Ok(self.texture.as_ref())
    }
}

/// The view over all of the picture.
#[derive(Default)]
pub struct Overlay {
    drawn: DrawnView,
}

impl Overlay {
    /// The requested view, once it is drawn.
    pub fn texture(
        &mut self,
        ctx: &egui::Context,
        session: &Session,
    ) -> Result<Option<egui::TextureId>> {
        let view = session.overlay.as_deref().and_then(SurfaceView::from_name);
        let Some(shows) = view.and_then(|view| ViewInputs::of(session, view)) else {
            return Ok(None);
        };
        let make: fn(ViewInputs) -> Option<Picture> = |shows| shows.picture();
        Ok(self.drawn.texture(ctx, shows, make)?.map(TextureHandle::id))
    }
}

/// How the anchors of the selected image share the surface, small, in a corner, each in its color
/// (SF fig. 9).
#[derive(Default)]
pub struct Insets {
    drawn: DrawnView,
    pub trouble: Option<Error>,
}

/// The longer side of the inset, points.
const INSET_PT: f32 = 150.0;

impl Insets {
    /// Draws them if there are several anchors.
    pub fn draw(&mut self, ctx: &egui::Context, session: &Session, painter: &Painter) {
        let anchors = session.layer().map_or(0, |layer| match &layer.content {
            Content::Image(live) => live.params().bend.anchors.len(),
            _ => 0,
        });
        if anchors < 2 {
            return;
        }
        let Some(shows) = ViewInputs::of(session, SurfaceView::Weights) else { return };
        let make: fn(ViewInputs) -> Option<Picture> = |shows| shows.small(2.0 * INSET_PT);
        match self.drawn.texture(ctx, shows, make) {
            Ok(Some(texture)) => inset(painter, texture, anchors),
            Ok(None) => {}
            Err(error) => self.trouble = Some(error),
        }
    }
}

fn inset(painter: &Painter, texture: &TextureHandle, anchors: usize) {
    let size = texture.size_vec2();
    let side = size * (INSET_PT / size.max_elem());
    let corner = painter.clip_rect().left_bottom() + vec2(12.0, -12.0 - side.y);
    let rect = Rect::from_min_size(corner, side);
    painter.rect_filled(rect.expand(1.0), 3.0, Color32::from_black_alpha(170));
    painter.image(
        texture.id(),
        rect,
        Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)),
        Color32::WHITE,
    );
    painter.rect_stroke(
        rect,
        3.0,
        Stroke::new(1.0, Color32::from_black_alpha(120)),
        StrokeKind::Outside,
    );
    let name = painter.text(
        rect.left_top() + vec2(5.0, 3.0),
        Align2::LEFT_TOP,
        tr("Weights"),
        FontId::proportional(10.5),
        Color32::WHITE,
    );
    for i in 0..anchors.min(12) {
        let at = pos2(name.right() + 9.0 + 10.0 * i as f32, name.center().y);
        painter.circle(at, 3.5, anchor_color(i), Stroke::new(1.0, Color32::WHITE));
    }
}

/// A picture as a texture, shrunk to a size that any driver takes.
pub fn load_texture(ctx: &egui::Context, name: &str, picture: &Picture) -> Option<TextureHandle> {
    const LARGEST: u32 = 2048;
    let longer = picture.size.width.max(picture.size.height);
    let step = longer.div_ceil(LARGEST).max(1) as usize;
    let (width, height) = (picture.size.width as usize / step, picture.size.height as usize / step);
    let texel = |x: usize, y: usize| match &picture.texels {
        crate::raster::picture::Texels::Srgb8(texels) => {
            texels[y * picture.size.width as usize + x]
        }
        crate::raster::picture::Texels::Linear(_) => {
            let encode = |v: f32| crate::math::srgb::quantize(crate::math::srgb::encode(v));
            let [r, g, b, a] = picture.linear_at(x, y);
            [encode(r), encode(g), encode(b), crate::math::srgb::quantize(a)]
        }
    };
    if width == 0 || height == 0 {
        return None;
    }
    let pixels = (0..width * height).map(|i| {
        let [r, g, b, a] = texel(i % width * step, i / width * step);
        Color32::from_rgba_unmultiplied(r, g, b, a)
    });
    Some(ctx.load_texture(
        name,
        ColorImage::new([width, height], pixels.collect()),
        TextureOptions::LINEAR,
    ))
}
