//! What the window has to say until it is dismissed: each message belongs to the document that was
//! in front, or to none. Floor 7.

use super::icons::{Icon, quiet_button};
use super::widgets::set_accessible_name;
use crate::language::{tr, tr_message};
use eframe::egui::{Align, Area, Context, Frame, Id, Layout, Order, Rect, ScrollArea, Vec2, pos2};

/// A message, and the key of the open document that it belongs to.
struct Message {
    text: String,
    document: Option<usize>,
}

/// All of them, the oldest first.
#[derive(Default)]
pub struct Messages {
    all: Vec<Message>,
    /// The document in front.
    front: Option<usize>,
}

/// The greatest width of a message, and its distance from the edge of the canvas, points.
const WIDTH_PT: f32 = 560.0;
const INSET_PT: f32 = 10.0;

impl Messages {
    /// New messages belong to this document from now on; those of documents that are closed are
    /// gone.
    pub fn front_is(&mut self, front: Option<usize>, open: impl Fn(usize) -> bool) {
        self.front = front;
        self.all.retain(|message| message.document.is_none_or(&open));
    }

    pub fn push(&mut self, text: String) {
        self.all.push(Message { text, document: self.front });
    }

    pub fn extend(&mut self, texts: impl IntoIterator<Item = String>) {
        texts.into_iter().for_each(|text| self.push(text));
    }

    /// Whether it is shown now.
    pub fn contains(&self, text: &str) -> bool {
        self.shown_messages().any(|message| message.text == text)
    }

    /// Those of the document in front, and of none.
    fn shown_messages(&self) -> impl Iterator<Item = &Message> {
        let front = self.front;
        self.all.iter().filter(move |message| message.is_shown(front))
    }

    /// Shows them below the upper edge of the canvas, which does not move.
    pub fn show(&mut self, ctx: &Context, canvas: Rect) {
        let count = self.shown_messages().count();
        if count == 0 {
            return;
        }
        let front = self.front;
        let (mut read, mut all_read) = (None, false);
        let width = WIDTH_PT.min(canvas.width() - 4.0 * INSET_PT).max(120.0);
        let corner = pos2(canvas.center().x - 0.5 * width, canvas.top() + INSET_PT);
        let area = Area::new(Id::unique("messages")).order(Order::Foreground).fixed_pos(corner);
        area.show(ctx, |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_width(width);
                let list = ScrollArea::vertical().max_height(canvas.height() * 0.25);
                list.auto_shrink([false, true]).show(ui, |ui| {
                    let shown = self.all.iter().enumerate();
                    for (i, message) in shown.filter(|(_, message)| message.is_shown(front)) {
                        let layout = Layout::right_to_left(Align::Min);
                        let room = Vec2::new(ui.available_width(), 0.0);
                        ui.allocate_ui_with_layout(room, layout, |ui| {
                            let close = quiet_button(ui, Icon::Close, "Dismiss", true, 20.0);
                            if close.on_hover_text(tr("Dismiss")).clicked() {
                                read = Some(i);
                            }
                            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                                ui.colored_label(
                                    ui.visuals().warn_fg_color,
                                    tr_message(&message.text),
                                );
                            });
                        });
                    }
                });
                if count > 2 {
                    let button = ui.button(tr("Dismiss all"));
                    set_accessible_name(&button, tr("Dismiss all"));
                    all_read = button.clicked();
                }
            });
        });
        read.map(|i| self.all.remove(i));
        if all_read {
            self.all.retain(|message| !message.is_shown(front));
        }
    }
}

impl Message {
    fn is_shown(&self, front: Option<usize>) -> bool {
        self.document.is_none() || self.document == front
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_belongs_to_its_document() {
        let mut messages = Messages::default();
        messages.push("of the program".into());
        messages.front_is(Some(3), |_| true);
        messages.push("of the third".into());
        let told = |messages: &Messages| -> Vec<String> {
            messages.shown_messages().map(|message| message.text.clone()).collect()
        };
        assert_eq!(told(&messages), ["of the program", "of the third"]);
        messages.front_is(Some(4), |_| true);
        assert_eq!(told(&messages), ["of the program"]);
        assert!(!messages.contains("of the third"));
        messages.front_is(Some(3), |_| true);
        assert_eq!(told(&messages).len(), 2);
        messages.front_is(None, |open| open != 3);
        messages.front_is(Some(3), |_| true);
        assert_eq!(told(&messages), ["of the program"], "it was closed meanwhile");
    }
}
