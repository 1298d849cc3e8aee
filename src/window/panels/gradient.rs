//! What new gradients are like, and a menu of ramps that shows them. Floor 7.

use crate::language::tr;
use crate::math::srgb::Color;
use crate::paint::{GradientStop, RampColors, RampStyle};
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::theme::color32;
use crate::tools::gradient::GradientSettings;
use crate::tr;
use crate::widgets::{check, choice};
use eframe::egui::{
    self, Color32, Mesh, Painter, Rect, Response, Role, Sense, Shape, StrokeKind, TextStyle, Ui,
    WidgetInfo, pos2, vec2,
};

/// The tool's options, in a bar.
pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let settings = session.tools.gradient;
    let own = [session.tools.color, session.tools.second_color];
    let mut push = |to: Option<GradientSettings>| {
        requests.actions.extend(to.map(|gradient| Action::Hand(HandAction::Gradient { gradient })))
    };
    let colors = ramp_menu(ui, settings.colors, own);
    push(colors.map(|colors| GradientSettings { colors, ..settings }));
    let style = choice(ui, "Style", settings.style, &RampStyle::LABELS);
    push(style.map(|style| GradientSettings { style, ..settings }));
    let reverse = check(ui, "Reverse", "The ramp runs the other way", settings.reverse);
    push(reverse.map(|reverse| GradientSettings { reverse, ..settings }));
    let hint = "New gradients are layers whose ends can be moved; otherwise they go into the selected paint layer";
    let live = check(ui, "Live", hint, settings.live);
    push(live.map(|live| GradientSettings { live, ..settings }));
    ui.weak(tr(session.tool.hint()));
}

/// A button with a ramp that opens a menu of all ramps.
fn ramp_menu(ui: &mut Ui, now: RampColors, own: [Color; 2]) -> Option<RampColors> {
    let shown = now.stops(own[0], own[1]);
    let (button, chosen) = menu(ui, "Ramp", &shown, own, Some(now));
    button.on_hover_text(tr!("Ramp: {ramp}", ramp = tr(now.label())));
    chosen
}

/// The same for stops; its own colors are those of their ends.
pub fn stops_menu(ui: &mut Ui, stops: &[GradientStop]) -> Option<Vec<GradientStop>> {
    let own = [stops.first()?.color, stops.last()?.color];
    let (button, chosen) = menu(ui, "Ramps", stops, own, None);
    button.on_hover_text(tr("Takes the stops of a ramp that comes with the program"));
    chosen.map(|colors| colors.stops(own[0], own[1]))
}

fn menu(
    ui: &mut Ui,
    label: &str,
    shown: &[GradientStop],
    own: [Color; 2],
    now: Option<RampColors>,
) -> (Response, Option<RampColors>) {
    let size = vec2(72.0, ui.spacing().interact_size.y - 4.0);
    let button = ramp_button(ui, label, shown, size);
    let popup = egui::Popup::menu(&button).show(|ui| {
        let row = |&(colors, _): &(RampColors, &str)| {
            ramp_row(ui, colors, own, Some(colors) == now).clicked().then_some(colors)
        };
        let chosen = RampColors::ALL.iter().filter_map(row).last();
        if chosen.is_some() {
            ui.close();
        }
        chosen
    });
    (button, popup.and_then(|shown| shown.inner))
}

/// A line of the menu: the ramp and its name.
fn ramp_row(ui: &mut Ui, colors: RampColors, own: [Color; 2], is_on: bool) -> Response {
    let (rect, response) =
        ui.allocate_exact_size(vec2(230.0, ui.spacing().interact_size.y), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr(colors.label())));
    let visuals = ui.style().interact_selectable(&response, is_on);
    if is_on || response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 3.0, visuals.weak_bg_fill);
    }
    let bar = Rect::from_min_size(rect.min + vec2(4.0, 4.0), vec2(72.0, rect.height() - 8.0));
    draw_ramp(ui.painter(), bar, &colors.stops(own[0], own[1]));
    let text = ui.painter().layout_no_wrap(
        tr(colors.label()).into(),
        TextStyle::Button.resolve(ui.style()),
        visuals.text_color(),
    );
    let at = rect.left_center() + vec2(86.0, -0.5 * text.size().y);
    ui.painter().galley(at, text, visuals.text_color());
    response.on_hover_text(tr(colors.hint()))
}

fn ramp_button(ui: &mut Ui, label: &str, stops: &[GradientStop], size: egui::Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr(label)));
    draw_ramp(ui.painter(), rect, stops);
    let stroke = ui.style().interact(&response).fg_stroke;
    ui.painter().rect_stroke(rect, 2.0, stroke, StrokeKind::Inside);
    response
}

/// A ramp from left to right, over squares where it is transparent.
pub fn draw_ramp(painter: &Painter, rect: Rect, stops: &[GradientStop]) {
    let side = rect.height() / 2.0;
    let painter = painter.with_clip_rect(painter.clip_rect().intersect(rect));
    painter.rect_filled(rect, 0.0, Color32::WHITE);
    for i in 0..(rect.width() / side).ceil() as usize {
        let at = rect.min + vec2(i as f32 * side, (i % 2) as f32 * side);
        painter.rect_filled(Rect::from_min_size(at, vec2(side, side)), 0.0, Color32::LIGHT_GRAY);
    }
    let mut mesh = Mesh::default();
    let (Some(first), Some(last)) = (stops.first(), stops.last()) else { return };
    let ends = [GradientStop { t: 0.0, ..*first }, GradientStop { t: 1.0, ..*last }];
    for stop in ends[..1].iter().chain(stops).chain(&ends[1..]) {
        let x = rect.min.x + stop.t * rect.width();
        let color = color32(stop.color);
        mesh.colored_vertex(pos2(x, rect.min.y), color);
        mesh.colored_vertex(pos2(x, rect.max.y), color);
    }
    for i in (2..mesh.vertices.len() as u32).step_by(2) {
        mesh.add_triangle(i - 2, i - 1, i);
        mesh.add_triangle(i - 1, i, i + 1);
    }
    painter.add(Shape::mesh(mesh));
}
