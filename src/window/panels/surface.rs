//! The surface: its maps and what is derived from them, shown over the picture. Floor 7.

use crate::document::view::{SurfaceView, available};
use crate::language::tr;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::ViewAction;
use crate::session::{Action, Session};
use crate::tr;
use crate::widgets::{NumberField, title, tr_sentence};
use eframe::egui::{Button, Ui};

pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let Some(document) = session.shown_document() else {
        ui.weak(tr("No document is open."));
        return;
    };
    let Some(surface) = &document.surface else {
        ui.label(tr("This document has no surface: marks stay flat."));
        if ui
            .button(tr("Give it a shape…"))
            .on_hover_text(tr("Of what the drawing covers"))
            .clicked()
        {
            requests.request(WindowRequest::ShapeDialog);
        }
        if ui
            .button(tr("Add maps…"))
            .on_hover_text(tr("Normals, depth or both, from files"))
            .clicked()
        {
            requests.request(WindowRequest::ReplaceMapsDialog);
        }
        return;
    };
    title(ui, "Shown over the picture");
    let is_off = session.overlay.is_none();
    ui.horizontal_wrapped(|ui| {
        if ui.add(Button::selectable(is_off, tr("Nothing"))).clicked() {
            requests.act(Action::View(ViewAction::Overlay { view: None }));
        }
        let views = available(document, session.layer().map(|layer| &**layer));
        for &view in &views {
            let is_on = session.overlay.as_deref() == Some(view.name());
            if ui
                .add(Button::selectable(is_on, tr_sentence(view.name())))
                .on_hover_text(tr(describe(view)))
                .clicked()
            {
                requests.act(Action::View(ViewAction::Overlay { view: Some(view.name().into()) }));
            }
        }
    });
    let hint =
        "The picture sways by its depth, as if you moved your head; any key or click stops it";
    if ui.button(tr("Wobble")).on_hover_text(tr(hint)).clicked() {
        requests.request(WindowRequest::Wobble);
    }
    if !is_off {
        let number = NumberField::new("Opacity", 0.0..=1.0, "Of the view over the picture");
        if let Some(changed) = number.row(ui, session.overlay_opacity) {
            requests.act(Action::View(ViewAction::OverlayOpacity { to: changed.to }));
        }
    }
    title(ui, "Maps");
    if let Some(source) = &document.surface_source {
        let name = |file: &str| file.rsplit(['/', '\\']).next().unwrap_or(file).to_owned();
        let derived = || tr("derived from the other").to_owned();
        let normals = source.normal.as_ref().map_or_else(derived, |map| name(&map.file));
        let depth = source.depth.as_ref().map_or_else(derived, |map| name(&map.file));
        ui.label(tr!("Normals: {file}", file = normals));
        ui.label(tr!("Depth: {file}", file = depth));
    }
    let depth = format!("{:.0}", surface.depth_range_px());
    ui.weak(tr!("{size} pixels, {depth} px deep", size = surface.size(), depth));
    ui.horizontal_wrapped(|ui| {
        let hint = "Live layers bend over the new shape: the same painting on another object or in \
             another pose";
        if ui.button(tr("Replace maps…")).on_hover_text(tr(hint)).clicked() {
            requests.request(WindowRequest::ReplaceMapsDialog);
        }
        if ui.button(tr("New from maps…")).clicked() {
            requests.request(WindowRequest::OpenMapsDialog);
        }
    });
}

fn describe(view: SurfaceView) -> &'static str {
    match view {
        SurfaceView::Normals => "Red to the right, green up, blue toward you",
        SurfaceView::Depth => "Black near, white far",
        SurfaceView::Mask => "White where the surface is",
        SurfaceView::Objects => "A color for each object, separated by depth jumps",
        SurfaceView::Curvature => "Convex blue, concave red, flat yellow",
        SurfaceView::CurvatureGray => "Convex light, concave dark",
        SurfaceView::Directions => "Lines along the direction that curves most",
        SurfaceView::Weights => "How the anchors of the selected layer share the surface",
        SurfaceView::FlowDepth => "How a texture on the surface is compressed",
        SurfaceView::FlowNormals => "How a reflection is compressed",
        SurfaceView::Unwrapped => "The painting on the unwrapped surface",
        SurfaceView::FlowOperator => "How the selected layer's bending compresses its image",
        SurfaceView::Scaling => {
            "Bring out form: how much light of each brightness is raised on convex parts and \
             lowered on concave ones"
        }
        SurfaceView::Clay => "Unpainted, in even light: the form alone",
        SurfaceView::Contours => {
            "Lines of equal depth, as on a map: where they are close the surface is steep"
        }
        SurfaceView::Lit => {
            "The surface and a ball under one light: if they agree, the maps are read correctly"
        }
    }
}
