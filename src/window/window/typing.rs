//! Keys that are pressed while the window is busy: they are neither lost nor taken by something
//! that they were not meant for. Floor 7. Not here: what keys do (`keys`).
//!
//! | pressed | goes |
//! |---|---|
//! | with others within a frame, over the canvas | one in each of the next frames, in their order |
//! | over the canvas, during an edit that blocks others | to the same document, once the edit is over |
//! | into a text field, during such an edit | into the field; what it sets is done once the edit is over |
//! | after a command that opens a dialog, before the dialog is there | into the dialog |
//! | on, after the text field is gone | nowhere, until a pause or a click |
//! | into a text field, while a job opens something | into the field; what was opened comes in front afterwards |

use super::MainWindow;
use crate::document::{Document, LayerId};
use crate::jobs::JobResult;
use crate::keys;
use crate::language::tr;
use crate::requests::UiRequests;
use crate::session::{Action, OpenDocument};
use eframe::egui::{Context, Event, Id, InputState, Key};
use std::collections::VecDeque;

/// What waits until the window is no longer busy.
#[derive(Default)]
pub(super) struct BusyInput {
    /// Keys and texts, in their order.
    typed: VecDeque<Event>,
    /// What they were typed for.
    meant: TypedFor,
    /// The frames since a dialog was asked for or came, as long as it may not be ready.
    is_new_for: Option<u8>,
    /// The user went on in the window instead of waiting for a dialog.
    went_on: bool,
    /// What text fields set, with the document in front, by its key, and its layers.
    actions: Vec<(Action, usize, Vec<LayerId>)>,
    /// A text field of a panel has the keyboard, and nothing that the user did ends that.
    is_typing: bool,
    /// What had the keyboard in a dialog: it may seem to have it for a moment after the dialog is
    /// closed.
    of_dialog: Option<Id>,
    /// The field that was being typed in is gone: until when, in seconds of the window, its text
    /// goes nowhere.
    gone_until: Option<f64>,
    /// What came while a text was being typed.
    results: Vec<JobResult<MainWindow>>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum TypedFor {
    /// The document in front, by its key.
    Canvas(Option<usize>),
    /// Whatever is in front.
    Window,
    #[default]
    Dialog,
}

/// Who pauses so long while typing has seen that the field is gone.
const PAUSE_SECS: f64 = 1.0;
/// Frames until a dialog that has a text field has it ready.
const READY_FRAMES: u8 = 4;

impl BusyInput {
    /// Keeps what is typed in this frame.
    fn hold(&mut self, ctx: &Context) {
        let is_typed = |event: &Event| match event {
            // Escape ends what keeps the window busy.
            Event::Key { key, .. } => *key != Key::Escape,
            event => matches!(event, Event::Text(_) | Event::Paste(_)),
        };
        ctx.input_mut(|input| {
            self.typed.extend(input.events.iter().filter(|event| is_typed(event)).cloned());
            input.events.retain(|event| !is_typed(event));
        });
    }

    /// Gives back all that was typed.
    fn give(&mut self, ctx: &Context) {
        if !self.typed.is_empty() {
            // What is typed now comes after it.
            self.hold(ctx);
            ctx.input_mut(|input| input.events.extend(self.typed.drain(..)));
        }
    }

    /// Gives back the next key that was pressed, with what belongs to it: the one after it may mean
    /// what it makes.
    fn give_next(&mut self, ctx: &Context) {
        if self.typed.is_empty() {
            return;
        }
        self.hold(ctx);
        let next =
            self.typed.iter().skip(1).position(is_press).map_or(self.typed.len(), |at| at + 1);
        ctx.input_mut(|input| input.events.extend(self.typed.drain(..next)));
        ctx.request_repaint();
    }

    /// Keeps several keys that were pressed within one frame, as a slow one has them: they are given
    /// one by one.
    fn hold_several(&mut self, ctx: &Context) {
        let presses =
            ctx.input(|input| input.events.iter().filter(|event| is_press(event)).count());
        if presses > 1 && !ctx.egui_wants_keyboard_input() {
            self.meant = TypedFor::Window;
            self.hold(ctx);
        }
    }

    /// Drops what is typed on after a field is gone, such as that of a layer that an edit merged
    /// away; until a pause, or a click. Returns whether it did.
    fn drop_rest(&mut self, ctx: &Context) -> bool {
        let ended = |input: &InputState| {
            let keys = [Key::Enter, Key::Escape, Key::Tab];
            input.pointer.any_pressed() || keys.into_iter().any(|key| input.key_pressed(key))
        };
        let (is_ended, now) = ctx.input(|input| (ended(input), input.time));
        let of_panel =
            ctx.text_edit_focused() && ctx.memory(|memory| memory.focused()) != self.of_dialog;
        let was_typing = std::mem::replace(&mut self.is_typing, of_panel && !is_ended);
        if was_typing && !ctx.text_edit_focused() {
            self.gone_until = Some(now + PAUSE_SECS);
        }
        if is_ended || ctx.text_edit_focused() || self.gone_until.is_none_or(|until| now > until) {
            self.gone_until = None;
            return false;
        }
        let held = self.typed.len();
        self.hold(ctx);
        if self.typed.len() > held {
            self.typed.truncate(held);
            self.gone_until = Some(now + PAUSE_SECS);
        }
        true
    }

    /// Whether a dialog came a moment ago, whose text field is not ready.
    fn is_awaiting_field(&mut self, ctx: &Context) -> bool {
        let Some(frames) =
            self.is_new_for.filter(|frames| *frames < READY_FRAMES && !ctx.text_edit_focused())
        else {
            self.is_new_for = None;
            return false;
        };
        self.is_new_for = Some(frames + 1);
        true
    }
}

/// A key was pressed, and not held until it repeated.
fn is_press(event: &Event) -> bool {
    matches!(event, Event::Key { pressed: true, repeat: false, .. })
}

impl MainWindow {
    /// Hears the keys of a frame, before anything is laid out.
    pub(super) fn hear_keys(&mut self, ctx: &Context, requests: &mut UiRequests) {
        if !self.dialogs.is_empty() {
            (self.busy.is_typing, self.busy.of_dialog) =
                (false, ctx.memory(|memory| memory.focused()));
            return match self.busy.is_awaiting_field(ctx) {
                true => self.busy.hold(ctx),
                false => self.busy.give(ctx),
            };
        }
        if self.busy.drop_rest(ctx) {
            return;
        }
        let front = self.session.active().map(|open| open.key);
        if self.jobs.is_awaiting_dialog() {
            self.busy.went_on |= ctx.input(|input| input.pointer.any_pressed());
            if !self.busy.went_on && !ctx.text_edit_focused() {
                self.busy.meant = TypedFor::Dialog;
                return self.busy.hold(ctx);
            }
        }
        (self.busy.went_on, self.busy.is_new_for) =
            (self.busy.went_on && self.jobs.is_awaiting_dialog(), None);
        if self.jobs.editing().is_some() {
            if !ctx.egui_wants_keyboard_input() {
                self.busy.meant = TypedFor::Canvas(front);
                self.busy.hold(ctx);
            }
            return;
        }
        // The dialog did not come, or another document did.
        if ![TypedFor::Canvas(front), TypedFor::Window].contains(&self.busy.meant) {
            self.busy.typed.clear();
        }
        self.busy.hold_several(ctx);
        self.busy.give_next(ctx);
        if self.settings.preferences.alt_opens_menus {
            self.menu.keys.hear_letter(ctx, &self.settings.keymap);
        }
        keys::listen(ctx, &self.session, &self.settings.keymap, requests);
    }

    /// Whether keys in other windows than this one are done at once: behind a dialog and during an
    /// edit they are not.
    pub(super) fn is_free_for_keys(&self) -> bool {
        self.dialogs.is_empty() && !self.jobs.is_awaiting_dialog() && self.jobs.editing().is_none()
    }

    /// After the requests of a frame: whether a dialog came, or will.
    pub(super) fn expect_dialog(&mut self, dialogs_before: usize) {
        if self.jobs.is_awaiting_dialog() || self.dialogs.len() > dialogs_before {
            self.busy.is_new_for = Some(0);
        }
    }

    /// During an edit the document can be viewed but not changed. What is set meanwhile waits;
    /// strokes are not begun. Returns whether the action is done with.
    pub(super) fn hold_action(&mut self, action: &Action) -> bool {
        if self.jobs.editing().is_none() || matches!(action, Action::View(_)) {
            return false;
        }
        if let (Some(open), false) = (self.session.active(), matches!(action, Action::Pointer(_))) {
            self.busy.actions.push((action.clone(), open.key, layers(open.document())));
        }
        true
    }

    /// Does what waited, once no edit is under way.
    pub(super) fn do_held(&mut self, requests: &mut UiRequests) {
        if self.jobs.editing().is_some() {
            return;
        }
        for (action, key, meant) in std::mem::take(&mut self.busy.actions) {
            // Actions name layers by their places.
            let is_meant =
                |open: &OpenDocument| open.key == key && layers(open.document()) == meant;
            match self.session.active().is_some_and(is_meant) {
                true => requests.act(action),
                false => self.jobs.say(
                    tr("A setting from the meantime was dropped, since the layers have changed.")
                        .into(),
                ),
            }
        }
    }

    /// What was meant for an edit that was canceled is dropped with it.
    pub(super) fn forget_held(&mut self) {
        self.busy.typed.clear();
        self.busy.actions.clear();
    }

    /// The results of jobs that may be shown now: while a text is being typed in a panel, nothing
    /// comes in front of it.
    pub(super) fn results(&mut self, ctx: &Context) -> Vec<JobResult<Self>> {
        let mut results = std::mem::take(&mut self.busy.results);
        results.extend(self.jobs.take_results());
        if ctx.text_edit_focused() && self.dialogs.is_empty() {
            let (later, now) = results.into_iter().partition(|result| result.comes_in_front);
            self.busy.results = later;
            return now;
        }
        results
    }
}

/// The layers of a document in their places.
fn layers(document: &Document) -> Vec<LayerId> {
    document.walk().iter().map(|(_, layer)| layer.id).collect()
}
