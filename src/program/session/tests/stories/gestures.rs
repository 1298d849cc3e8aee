//! Draws what the pen does with each tool: clicks, drags, and strokes of real length.

use super::dice::{Dice, Roll};
use crate::math::{Vec2, vec2};
use crate::paint::Sample;
use crate::session::actions::{Action, CanvasAction, PathAction, PointerAction, SelectionAction};
use crate::tools::{ModifierKeys, PenSample, ToolKind};

/// Samples of a long stroke.
const LONG: usize = 200;

impl Roll for PenSample {
    fn roll(dice: &mut Dice) -> Self {
        PenSample::at(dice.place())
    }
}

/// What the hand does with a tool. A new tool belongs here.
pub fn gesture(dice: &mut Dice, tool: ToolKind) -> Vec<Action> {
    let size = dice.facts.size;
    let somewhere = dice.place();
    let corners = [
        (0.0, 0.0),
        (1.0, 0.0),
        (1.0, 1.0),
        (0.0, 1.0),
        (0.5, 0.0),
        (1.0, 0.5),
        (0.5, 1.1),
        (0.5, 0.5),
    ];
    let handle = dice.one_of(&corners.map(|(x, y)| vec2(x, y) * size));
    match tool {
        ToolKind::Brush | ToolKind::Eraser | ToolKind::Sculpt | ToolKind::Liquify => {
            stroke(dice, tool, somewhere)
        }
        ToolKind::Fill
        | ToolKind::Eyedropper
        | ToolKind::Hand
        | ToolKind::Zoom
        | ToolKind::Text => click(dice, tool, somewhere),
        ToolKind::Wand | ToolKind::SurfaceWand | ToolKind::Touch => {
            if dice.is(60) {
                click(dice, tool, somewhere)
            } else {
                drag(dice, tool, somewhere)
            }
        }
        ToolKind::Path => path_nodes(dice, tool),
        ToolKind::Gradient
        | ToolKind::Figure
        | ToolKind::Panels
        | ToolKind::Image
        | ToolKind::Anchors
        | ToolKind::Move
        | ToolKind::Assistants
        | ToolKind::Shape
        | ToolKind::SelectRectangle
        | ToolKind::SelectEllipse => drag(dice, tool, somewhere),
        ToolKind::Strokes => {
            if dice.is(50) {
                click(dice, tool, somewhere)
            } else {
                drag(dice, tool, somewhere)
            }
        }
        ToolKind::Transform => drag(dice, tool, handle),
        ToolKind::Crop => {
            let mut actions = drag(dice, tool, handle);
            let frame = [
                dice.value("crop", "x0"),
                dice.value("crop", "y0"),
                dice.value("crop", "x1"),
                dice.value("crop", "y1"),
            ];
            let [x0, y0, x1, y1] = frame;
            actions.push(Action::Canvas(CanvasAction::Crop {
                to: crate::math::Rect { x0, y0, x1, y1 },
            }));
            actions
        }
        ToolKind::Lasso if dice.is(50) => {
            let mut actions: Vec<Action> = (0..3)
                .flat_map(|_| {
                    let at = dice.place();
                    click(dice, tool, at)
                })
                .collect();
            actions.push(Action::Selection(SelectionAction::CloseLasso {}));
            actions
        }
        ToolKind::Lasso => stroke(dice, tool, somewhere),
    }
}

/// A few nodes of a path, clicked and dragged; some of them taken back.
fn path_nodes(dice: &mut Dice, tool: ToolKind) -> Vec<Action> {
    let mut actions = Vec::new();
    for _ in 0..1 + dice.below(4) {
        let at = dice.place();
        actions.extend(if dice.is(60) { click(dice, tool, at) } else { drag(dice, tool, at) });
        if dice.is(15) {
            actions.push(Action::Path(PathAction::Back {}));
        }
    }
    if dice.is(50) {
        actions.push(Action::Path(PathAction::End {}));
    }
    actions
}

fn keys(dice: &mut Dice) -> ModifierKeys {
    let mut held = || dice.is(12);
    ModifierKeys { shift: held(), ctrl: held(), alt: held() }
}

fn press(dice: &mut Dice, tool: ToolKind, at: Vec2, keys: ModifierKeys) -> Action {
    let pen =
        PenSample { sample: Sample { pressure: dice.within(0.1, 1.0), ..Sample::at(at) }, keys };
    let px_per_pt = dice.one_of(&[1.0, 1.0, 0.5, 3.0]);
    Action::Pointer(PointerAction::Press { tool, pen, px_per_pt })
}

fn lift(dice: &mut Dice) -> Action {
    Action::Pointer(if dice.is(96) { PointerAction::Release {} } else { PointerAction::Cancel {} })
}

fn click(dice: &mut Dice, tool: ToolKind, at: Vec2) -> Vec<Action> {
    let keys = keys(dice);
    vec![press(dice, tool, at, keys), lift(dice)]
}

fn drag(dice: &mut Dice, tool: ToolKind, from: Vec2) -> Vec<Action> {
    let keys = keys(dice);
    let to = if dice.is(50) {
        dice.place()
    } else {
        from + vec2(dice.within(-15.0, 15.0), dice.within(-15.0, 15.0))
    };
    let pens = [0.5, 1.0].map(|t| PenSample { sample: Sample::at(from.lerp(to, t)), keys });
    vec![
        press(dice, tool, from, keys),
        Action::Pointer(PointerAction::Drag { pens: pens.to_vec() }),
        lift(dice),
    ]
}

/// A curve of a few samples, or of many as a pen gives them.
fn stroke(dice: &mut Dice, tool: ToolKind, from: Vec2) -> Vec<Action> {
    let keys = keys(dice);
    let count = if dice.is(25) { LONG } else { 2 + dice.below(9) };
    let (over, to) = (dice.place(), dice.place());
    let sways = dice.within(0.0, 6.0);
    let sample = |i: usize| {
        let t = (i + 1) as f32 / count as f32;
        let at = from.lerp(over, t).lerp(over.lerp(to, t), t)
            + vec2((40.0 * t).sin(), (31.0 * t).cos()) * sways * t;
        let at = (at * 256.0).round() / 256.0;
        let pressure = (0.2 + 0.8 * (6.0 * t).sin().abs()).min(1.0);
        PenSample { sample: Sample { at, pressure, tilt: vec2(10.0 * t, 0.0), time_secs: t }, keys }
    };
    let pens: Vec<PenSample> = (0..count).map(sample).collect();
    // Drags come in batches, a frame's each.
    let batches = pens
        .chunks(7 + dice.below(60))
        .map(|pens| Action::Pointer(PointerAction::Drag { pens: pens.to_vec() }));
    let mut actions = vec![press(dice, tool, from, keys)];
    actions.extend(batches);
    actions.push(lift(dice));
    actions
}
