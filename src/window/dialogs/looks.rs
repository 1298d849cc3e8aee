//! The looks that come with the program, each on the user's own drawing. Floor 7.

use super::{DialogAnswer, close, set_width};
use crate::io::recipe::LiveLook;
use crate::language::tr;
use crate::look_pictures::{LookPictures, in_looks};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::LayerAction;
use crate::session::{Action, Session};
use crate::tr;
use crate::widgets::set_accessible_name;
use eframe::egui::{self, ScrollArea, Ui, vec2};

/// The longer side of a picture, points.
const SHOWN_PT: f32 = 112.0;
/// Pictures side by side.
const IN_A_ROW: usize = 5;

pub struct LooksDialog {
    looks: Vec<LiveLook>,
    pictures: LookPictures,
}

impl LooksDialog {
    pub fn new(ctx: &egui::Context) -> Self {
        Self {
            looks: LiveLook::all().collect(),
            pictures: LookPictures::new(ctx.clone(), in_looks),
        }
    }

    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        requests: &mut UiRequests,
    ) -> DialogAnswer {
        set_width(ui, 640.0);
        ui.heading(tr("Looks"));
        ui.weak(tr("A look is a group of live layers, which you can change afterwards."));
        if let Some(open) = session.active() {
            self.pictures.follow(ui.ctx(), open.document());
        }
        if let Some(error) = self.pictures.trouble.take() {
            requests.request(WindowRequest::Say(error.to_string()));
        }
        let mut chosen = None;
        let height = ui.ctx().content_rect().height() * 0.6;
        ScrollArea::vertical().max_height(height).show(ui, |ui| {
            for row in self.looks.chunks(IN_A_ROW) {
                ui.horizontal_top(|ui| {
                    for look in row {
                        if self.is_clicked(ui, look) {
                            chosen = Some(look.key);
                        }
                    }
                });
            }
        });
        match chosen {
            Some(key) => {
                requests.act(Action::Layer(LayerAction::Look { name: key.to_owned() }));
                DialogAnswer::Close
            }
            None => close(ui),
        }
    }

    /// A look as a button; whether it was clicked.
    fn is_clicked(&self, ui: &mut Ui, look: &LiveLook) -> bool {
        let clicked = ui.vertical(|ui| {
            ui.set_width(SHOWN_PT + 8.0);
            let response = match self.pictures.picture(look.key) {
                Some((texture, size)) => {
                    let shown = size * (SHOWN_PT / size.max_elem().max(1.0));
                    ui.add(egui::Button::image(egui::load::SizedTexture::new(texture, shown)))
                }
                // The same button to egui, as large: no click is lost while its picture arrives.
                None => {
                    let side = vec2(SHOWN_PT, SHOWN_PT) + 2.0 * ui.spacing().button_padding;
                    ui.add(egui::Button::new("…").min_size(side))
                }
            };
            let response = response.on_hover_text(tr(&look.about));
            set_accessible_name(&response, &tr!("Look: {name}", name = tr(&look.name)));
            ui.small(tr(&look.name));
            response.clicked()
        });
        clicked.inner
    }
}
