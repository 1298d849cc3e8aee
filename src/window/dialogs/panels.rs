//! Divides a page, a selection or the shape of a path in panels of a comic, with a sketch of them.
//! Floor 7.

use super::{DialogAnswer, buttons, set_width};
use crate::language::{tr, tr_message};
use crate::math::{Vec2, vec2};
use crate::paint::{Figure, PanelSettings};
use crate::panels::comic::{show_look, show_numbers};
use crate::requests::UiRequests;
use crate::session::actions::PanelAction;
use crate::session::{Action, LayerPath, Session};
use crate::tools::path::{self, along};
use crate::tr;
use eframe::egui::{Color32, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, pos2, vec2 as size_of};

/// The sketch of the page at most, points.
const SKETCH_PT: f32 = 180.0;

pub struct PanelsDialog {
    settings: PanelSettings,
    /// The path that becomes panels.
    layer: Option<LayerPath>,
    /// The page, px.
    page: Vec2,
    /// What is divided, without the margin: the page's own, or the box of something else.
    within: Option<[Vec2; 2]>,
}

impl PanelsDialog {
    /// For the document in front, if there is one.
    pub fn new(session: &Session) -> Option<Self> {
        let open = session.active()?;
        let document = open.document();
        let page = vec2(document.size.width as f32, document.size.height as f32);
        let on_path = session.layer().filter(|layer| path::of_layer(layer).is_some());
        // A panel's own frame is no shape to be divided: it is cut.
        let on_path = on_path.filter(|layer| !layer.is_frame());
        let lines = on_path.and_then(|layer| along::lines_on_canvas(document, layer.id));
        let selected =
            document.active_coverage().map(|c| c.covered_rect()).filter(|r| !r.is_empty());
        let within = match (&lines, selected) {
            (Some(lines), _) => {
                let points = || lines.iter().flat_map(|line| line.nodes.iter().map(|node| node.at));
                let low = points().fold(page, |low, p| low.min(p));
                Some([low, points().fold(Vec2::ZERO, |high, p| high.max(p))])
            }
            (None, Some(r)) => {
                Some([vec2(r.x0 as f32, r.y0 as f32), vec2(r.x1 as f32, r.y1 as f32)])
            }
            (None, None) => None,
        };
        let layer = lines.and_then(|_| session.layer_path());
        Some(Self { settings: session.tools.panels, layer, page, within })
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        set_width(ui, 380.0);
        ui.heading(tr("Comic panels"));
        ui.label(tr(match (&self.layer, self.within) {
            (Some(_), _) => "The shape of the selected path becomes panels.",
            (None, Some(_)) => "The box around the selection becomes panels.",
            (None, None) => "The page becomes panels.",
        }));
        let divided = self.find_panels();
        self.sketch(ui, divided.as_deref().unwrap_or_default());
        let all: Vec<&str> = PanelSettings::SETTINGS.iter().map(|setting| setting.name).collect();
        let is_shown = |name: &&str| *name != "margin" || self.within.is_none();
        let names: Vec<&str> = all.into_iter().filter(is_shown).collect();
        show_numbers(&mut self.settings, &names, |field, value| {
            field.row(ui, value).map(|changed| changed.to)
        });
        show_look(ui, &mut self.settings);
        if let Err(why) = &divided {
            ui.weak(tr!("There are no panels: {why}.", why = tr_message(why)));
        }
        match buttons(ui, "Create", divided.is_ok()) {
            Some(true) => {
                let (panels, layer) = (self.settings.clamp_to_ranges(), self.layer.clone());
                requests.act(Action::Panel(PanelAction::Settings { panels }));
                requests.act(Action::Panel(PanelAction::Divide { layer }));
                DialogAnswer::Close
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }

    /// The panels as rectangles; or why there are none.
    fn find_panels(&self) -> Result<Vec<Figure>, String> {
        let settings = self.settings.clamp_to_ranges();
        match self.within {
            Some(within) => PanelSettings { margin: 0.0, ..settings }.divide_rectangle(within),
            None => settings.divide_rectangle([Vec2::ZERO, self.page]),
        }
    }

    fn sketch(&self, ui: &mut Ui, panels: &[Figure]) {
        let scale = SKETCH_PT / self.page.max_element().max(1.0);
        let wanted = size_of(ui.available_width(), scale * self.page.y);
        let (area, _) = ui.allocate_exact_size(wanted, Sense::hover());
        let corner = pos2(area.center().x - 0.5 * scale * self.page.x, area.top());
        let at = |p: Vec2| -> Pos2 { corner + size_of(scale * p.x, scale * p.y) };
        let painter = ui.painter_at(area);
        painter.rect_filled(Rect::from_min_max(at(Vec2::ZERO), at(self.page)), 0.0, Color32::WHITE);
        let line = Stroke::new((scale * self.settings.border).max(1.0), Color32::BLACK);
        for panel in panels {
            let rect = Rect::from_min_max(at(panel.from), at(panel.to));
            painter.rect_stroke(rect, 0.0, line, StrokeKind::Middle);
        }
    }
}
