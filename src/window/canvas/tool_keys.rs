//! Keys that are meant for what a tool has begun: a path, a lasso, a frame to crop to. Floor 7.

use super::{crop, path_handles};
use crate::session::actions::SelectionAction;
use crate::session::{Action, Session};
use eframe::egui::{Key, Ui};

/// Reads them.
pub fn listen(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    path_handles::keys(ui, session, actions);
    lasso_keys(ui, session, actions);
    crop::keys(ui, session, actions);
}

/// Enter closes a lasso of clicks, Escape cancels it.
fn lasso_keys(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    if session.tools.lasso.is_empty()
        || session.is_drawing()
        || ui.ctx().egui_wants_keyboard_input()
    {
        return;
    }
    if ui.input(|input| input.key_pressed(Key::Enter)) {
        actions.push(Action::Selection(SelectionAction::CloseLasso {}));
    } else if ui.input(|input| input.key_pressed(Key::Escape)) {
        actions.push(Action::Selection(SelectionAction::DropLasso {}));
    }
}
