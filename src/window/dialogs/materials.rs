//! The materials that come with the program, each on a ball in the color of the part that gets it.
//! The one under the pointer is shown on the part. Floor 7.

use super::{DialogAnswer, close};
use crate::document::Document;
use crate::document::parts::forms::visible_place;
use crate::io::recipe::PartMaterial;
use crate::look_pictures::{LookPictures, in_materials};
use crate::math::srgb::Color;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::LayerAction;
use crate::session::drawing::color_at;
use crate::session::{Action, Session};
use crate::widgets::set_accessible_name;
use eframe::egui::{self, ComboBox, ScrollArea, Ui, vec2};

/// The side of a ball, points.
const SHOWN_PT: f32 = 76.0;
/// Balls side by side.
const IN_A_ROW: usize = 3;
/// The color of balls that stand for all parts.
const CLAY: Color = Color::rgb(0xc8, 0x80, 0x58);

pub struct MaterialsDialog {
    materials: Vec<PartMaterial>,
    pictures: LookPictures,
    /// The part that gets it; none: what is selected, or all.
    part: Option<String>,
    /// Of which part, if any, the balls have the color.
    colored: Option<Option<String>>,
    /// What is shown on the part.
    shown: Option<&'static str>,
    ctx: egui::Context,
}

impl MaterialsDialog {
    pub fn new(ctx: &egui::Context, part: Option<String>) -> Self {
        Self {
            materials: PartMaterial::all().collect(),
            pictures: LookPictures::new(ctx.clone(), in_materials),
            part,
            colored: None,
            shown: None,
            ctx: ctx.clone(),
        }
    }

    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        requests: &mut UiRequests,
    ) -> DialogAnswer {
        ui.set_width(IN_A_ROW as f32 * (SHOWN_PT + 20.0));
        ui.heading("Materials");
        ui.weak("A material is a group of live layers on a part, which you can change afterwards.");
        if let Some(open) = session.active() {
            self.choose_part(ui, open.document());
            self.color_balls(open.document());
        }
        if let Some(error) = self.pictures.trouble.take() {
            requests.request(WindowRequest::Say(error.to_string()));
        }
        let (mut chosen, mut hovered) = (None, None);
        let height = ui.ctx().content_rect().height() * 0.6;
        ScrollArea::vertical().max_height(height).show(ui, |ui| {
            for row in self.materials.chunks(IN_A_ROW) {
                ui.horizontal_top(|ui| {
                    for material in row {
                        let response = self.button(ui, material);
                        if response.clicked() {
                            chosen = Some(material.key);
                        } else if response.hovered() {
                            hovered = Some(material.key);
                        }
                    }
                });
            }
        });
        if let Some(key) = chosen {
            requests.act(self.give(key, true));
            return DialogAnswer::Close;
        }
        if hovered != self.shown {
            self.shown = hovered;
            requests.act(match hovered {
                Some(key) => self.give(key, false),
                None => Action::Layer(LayerAction::Unadjust {}),
            });
        }
        let answer = close(ui);
        if matches!(answer, DialogAnswer::Close) && self.shown.is_some() {
            requests.act(Action::Layer(LayerAction::Unadjust {}));
        }
        answer
    }

    fn give(&self, key: &str, done: bool) -> Action {
        Action::Layer(LayerAction::Material { name: key.to_owned(), part: self.part.clone(), done })
    }

    fn choose_part(&mut self, ui: &mut Ui, document: &Document) {
        let name = |part: &Option<String>| match part {
            Some(id) => document.parts.part(id).map_or(id.clone(), |part| part.name.clone()),
            None if document.active_selection.is_some() => "What is selected".to_owned(),
            None => "Everything".to_owned(),
        };
        let ids = document.parts.list.iter().rev().map(|part| Some(part.id.clone()));
        let choices: Vec<Option<String>> = std::iter::once(None).chain(ids).collect();
        let shown =
            ComboBox::from_label("Part").selected_text(name(&self.part)).show_ui(ui, |ui| {
                for choice in choices {
                    let name = name(&choice);
                    ui.selectable_value(&mut self.part, choice, name);
                }
            });
        set_accessible_name(&shown.response, "Part");
    }

    /// Balls take the color that the part has.
    fn color_balls(&mut self, document: &Document) {
        if self.colored.as_ref() != Some(&self.part) {
            let place = self.part.as_ref().and_then(|part| visible_place(document, part));
            let color = place.and_then(|at| color_at(document, at)).unwrap_or(CLAY);
            self.colored = Some(self.part.clone());
            self.pictures = LookPictures::new(self.ctx.clone(), in_materials);
            if let Ok(ball) = PartMaterial::ball(color) {
                self.pictures.follow(&self.ctx, &ball);
            }
        }
        self.pictures.collect(&self.ctx);
    }

    /// A material as a button.
    fn button(&self, ui: &mut Ui, material: &PartMaterial) -> egui::Response {
        let shown = ui.vertical(|ui| {
            ui.set_width(SHOWN_PT + 8.0);
            let response = match self.pictures.picture(material.key) {
                Some((texture, _)) => {
                    let size = vec2(SHOWN_PT, SHOWN_PT);
                    ui.add(egui::Button::image(egui::load::SizedTexture::new(texture, size)))
                }
                None => ui.add_sized(vec2(SHOWN_PT, SHOWN_PT), egui::Button::new("…")),
            };
            let response = response.on_hover_text(&material.about);
            set_accessible_name(&response, &format!("Material: {}", material.name));
            ui.small(&material.name);
            response
        });
        shown.inner
    }
}
