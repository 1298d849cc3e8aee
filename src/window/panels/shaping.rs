//! The options of the tools that touch and sculpt the shape.
//! Floor 7.

use crate::canvas::ball;
use crate::language::tr;
use crate::math::{Vec3, vec3};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::PartAction;
use crate::session::{Action, Session};
use crate::shape::{SculptStroke, SculptTool, Touch};
use crate::tools::{ShapeSettings, ToolKind};
use crate::widgets::{NumberField, sentence, set_accessible_name};
use eframe::egui::{Button, Sense, Ui, vec2};

pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let has_parts = session.shown_document().is_some_and(|document| !document.parts.is_empty());
    if !has_parts {
        ui.weak(tr("There is no part to work on yet."));
        if ui.button(tr("Give it a shape…")).clicked() {
            requests.request(WindowRequest::ShapeDialog);
        }
        return;
    }
    let now = session.tools.shape;
    let to = match session.tool {
        ToolKind::Touch => touching(ui, now),
        ToolKind::Sculpt => sculpting(ui, now),
        tool => {
            ui.weak(tr(tool.hint()));
            None
        }
    };
    requests.actions.extend(to.map(|shape| Action::Part(PartAction::Settings { shape })));
}

/// Degrees that a direction leans to the right and up.
fn leaning(normal: Vec3) -> [f32; 2] {
    [normal.x, normal.y].map(|v| v.max(-1.0).min(1.0).asin().to_degrees())
}

/// The direction that leans this far; at most a silhouette.
fn direction_from_lean([right, up]: [f32; 2]) -> Vec3 {
    let flat =
        crate::math::vec2(right.to_radians().sin(), up.to_radians().sin()).clamp_length_max(0.999);
    vec3(flat.x, flat.y, (1.0 - flat.length_squared()).max(0.0).sqrt())
}

fn touching(ui: &mut Ui, now: ShapeSettings) -> Option<ShapeSettings> {
    let side = ui.spacing().interact_size.y + 4.0;
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::drag());
    set_accessible_name(&response, tr("Direction of touches"));
    ball(ui.painter(), rect.center(), 0.46 * side, now.normal);
    let mut to = None;
    if response.dragged() {
        // Points of a drag that leans it over.
        const POINTS: f32 = 60.0;
        let by = response.drag_delta() / POINTS;
        let flat =
            crate::math::vec2(now.normal.x + by.x, now.normal.y - by.y).clamp_length_max(0.98);
        let normal = vec3(flat.x, flat.y, (1.0 - flat.length_squared()).max(0.0).sqrt());
        to = Some(ShapeSettings { normal, ..now });
    }
    response.on_hover_text(tr(
        "The direction that touches give to the surface: drag the ball. Alt-click takes it from \
         the surface",
    ));
    let [right, up] = leaning(now.normal);
    let number = |label, hint| NumberField::new(label, -88.0..=88.0, hint).degrees();
    ui.label(tr("right"));
    let changed =
        number("Lean right", "How far it leans to the right; below 0 to the left").field(ui, right);
    to = changed.map(|c| ShapeSettings { normal: direction_from_lean([c.to, up]), ..now }).or(to);
    ui.label(tr("up"));
    let changed = number("Lean up", "How far it leans up; below 0 down").field(ui, up);
    to =
        changed.map(|c| ShapeSettings { normal: direction_from_lean([right, c.to]), ..now }).or(to);
    if ui.button(tr("Facing you")).on_hover_text(tr("Touches level the surface")).clicked() {
        to = Some(ShapeSettings { normal: Vec3::Z, ..now });
    }
    ui.add_space(6.0);
    let field = NumberField::new("Size", Touch::RADIUS, "Radius of a touch").px();
    to = field.inline(ui, now.radius, 70.0).map(|c| ShapeSettings { radius: c.to, ..now }).or(to);
    let hint = "How far a touch reaches; 0: to the rim of the part and to the next touches";
    let field = NumberField::new("Spread", Touch::REACH, hint).px();
    field.inline(ui, now.reach, 70.0).map(|c| ShapeSettings { reach: c.to, ..now }).or(to)
}

fn sculpting(ui: &mut Ui, now: ShapeSettings) -> Option<ShapeSettings> {
    let mut to = None;
    for (tool, word) in SculptTool::ALL {
        let word = sentence(word);
        let button = Button::selectable(now.tool == tool, tr(&word));
        if ui.add(button).on_hover_text(tr(describe(tool))).clicked() {
            to = Some(ShapeSettings { tool, ..now });
        }
    }
    ui.add_space(6.0);
    let field = NumberField::new(
        "Size",
        SculptStroke::SIZE,
        "Diameter of a dab ([ and ], or drag with the right button)",
    );
    to = field.px().inline(ui, now.size, 70.0).map(|c| ShapeSettings { size: c.to, ..now }).or(to);
    let field = NumberField::new(
        "Hardness",
        SculptStroke::HARDNESS,
        "How much of the dab is fully covered",
    );
    to = field
        .inline(ui, now.hardness, 50.0)
        .map(|c| ShapeSettings { hardness: c.to, ..now })
        .or(to);
    let changed = match now.tool.is_by_height() {
        true => {
            let field = NumberField::new(
                "Strength",
                SculptStroke::STRENGTH,
                "How far a dab raises or lowers",
            );
            let changed = field.pixels().logarithmic().inline(ui, now.height, 60.0);
            changed.map(|c| ShapeSettings { height: c.to, ..now })
        }
        false => {
            let field = NumberField::new("Strength", crate::math::UNIT, "How strong a dab is");
            field.inline(ui, now.share, 60.0).map(|c| ShapeSettings { share: c.to, ..now })
        }
    };
    ui.weak(tr("Weaker with less pressure"));
    changed.or(to)
}

fn describe(tool: SculptTool) -> &'static str {
    match tool {
        SculptTool::Raise => "Builds the surface up (Ctrl lowers)",
        SculptTool::Lower => "Digs into it (Ctrl raises)",
        SculptTool::Smooth => "Toward the mean of the surroundings (Shift with any tool)",
        SculptTool::Flatten => "Toward the plane under the first dab",
        SculptTool::Crease => "A sharp line inward",
        SculptTool::Pinch => "Pulls heights together toward the middle",
        SculptTool::Scrape => "Lowers only what sticks out",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_leans_as_far_as_its_numbers_say() {
        for told in [[0.0, 0.0], [30.0, -40.0], [-60.0, 10.0]] {
            let back = leaning(direction_from_lean(told));
            assert!(
                (back[0] - told[0]).abs() < 1e-3 && (back[1] - told[1]).abs() < 1e-3,
                "{told:?} {back:?}"
            );
        }
        let beyond = direction_from_lean([80.0, 80.0]);
        assert!(beyond.is_normalized() && beyond.z > 0.0);
    }
}
