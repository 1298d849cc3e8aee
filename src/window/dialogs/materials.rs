//! The materials that come with the program, each on a ball in the color of the part that gets it.
//! A material that was clicked is held: the part under the pointer is shown in it, and a click gives
//! it to the part. Floor 7.

use super::{DialogAnswer, close, set_width};
use crate::document::Document;
use crate::document::parts::forms::visible_place;
use crate::io::recipe::PartMaterial;
use crate::language::tr;
use crate::look_pictures::{LookPictures, in_materials};
use crate::math::Vec2;
use crate::math::srgb::Color;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::LayerAction;
use crate::session::drawing::color_at;
use crate::session::{Action, OpenDocument, Session};
use crate::tr;
use crate::widgets::set_accessible_name;
use eframe::egui::{self, ComboBox, ScrollArea, Ui, vec2};

/// The side of a ball, points.
const SHOWN_PT: f32 = 76.0;
/// Balls side by side.
const IN_A_ROW: usize = 3;
/// The color of balls that stand for all parts.
const CLAY: Color = Color::rgb(0xc8, 0x80, 0x58);

/// What gets a material.
#[derive(Clone, PartialEq)]
enum Target {
    /// Each part that is clicked in the drawing.
    Clicked,
    Part(String),
    /// What is selected, or everything.
    All,
}

impl Target {
    /// What a document is first asked for.
    fn of(document: &Document) -> Self {
        let has_parts = !document.parts.list.is_empty();
        if has_parts && document.active_selection.is_none() { Self::Clicked } else { Self::All }
    }

    /// Its name in the language of the window.
    fn name(&self, document: &Document) -> String {
        match self {
            Self::Clicked => tr("The part that you click").to_owned(),
            Self::Part(id) => document.parts.part(id).map_or(id.clone(), |part| part.name.clone()),
            Self::All if document.active_selection.is_some() => tr("What is selected").to_owned(),
            Self::All => tr("Everything").to_owned(),
        }
    }
}

/// A material on a part, or on all.
type MaterialOn = (&'static str, Option<String>);

pub struct MaterialsDialog {
    materials: Vec<PartMaterial>,
    pictures: LookPictures,
    target: Target,
    /// The part that was chosen before: balls under the pointer are shown on it.
    part: Option<String>,
    /// The material that parts get that are clicked.
    held: Option<&'static str>,
    /// The ball under the pointer.
    hovered: Option<&'static str>,
    /// Of which part, if any, the balls have the color.
    colored: Option<Option<String>>,
    /// What is shown.
    shown: Option<MaterialOn>,
    ctx: egui::Context,
}

impl MaterialsDialog {
    /// `part`: the one that is chosen.
    pub fn new(ctx: &egui::Context, session: &Session, part: Option<String>) -> Self {
        let target = session.active().map_or(Target::All, |open| Target::of(open.document()));
        Self {
            materials: PartMaterial::all().collect(),
            pictures: LookPictures::new(ctx.clone(), in_materials),
            target,
            part,
            held: None,
            hovered: None,
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
        set_width(ui, IN_A_ROW as f32 * (SHOWN_PT + 20.0));
        ui.heading(tr("Materials"));
        ui.weak(tr(
            "A material is a group of live layers on a part, which you can change afterwards.",
        ));
        if let Some(open) = session.active() {
            self.choose_target(ui, open.document());
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
        self.hovered = hovered;
        match (chosen, self.target.clone()) {
            (Some(key), Target::Clicked) => self.held = Some(key),
            (Some(key), target) => {
                requests.act(give(&(key, part_of(target)), true));
                return DialogAnswer::Close;
            }
            (None, _) => {}
        }
        if self.held.is_some() {
            ui.label(tr("Click a part of the drawing."));
        }
        close(ui)
    }

    /// Shows the material that a ball or a part under the pointer asks for. Returns whether a click
    /// was for the part.
    ///
    /// * `at`: the place of the pointer on the canvas, if it is beside the dialog.
    pub fn follow(
        &mut self,
        at: Option<Vec2>,
        is_clicked: bool,
        session: &Session,
        requests: &mut UiRequests,
    ) -> bool {
        let document = session.active().map(OpenDocument::document);
        let under = at.zip(document).and_then(|(at, document)| document.part_at(at));
        let under = under.map(|part| part.id.clone()).filter(|_| self.target != Target::All);
        let wanted = match (self.hovered, self.held, &under) {
            (Some(key), _, _) => Some((key, self.part_shown())),
            (None, Some(key), Some(part)) => Some((key, Some(part.clone()))),
            _ => None,
        };
        match (under, self.held) {
            (Some(part), Some(key)) if is_clicked => {
                self.shown = None;
                requests.act(give(&(key, Some(part)), true));
                return true;
            }
            (Some(part), None) if is_clicked => {
                self.target = Target::Part(part);
                return true;
            }
            _ => {}
        }
        if wanted != self.shown {
            requests.act(match &wanted {
                Some(given) => give(given, false),
                None => Action::Layer(LayerAction::Unadjust {}),
            });
            self.shown = wanted;
        }
        false
    }

    /// Forgets what is shown.
    pub fn forget(&self, requests: &mut UiRequests) {
        if self.shown.is_some() {
            requests.act(Action::Layer(LayerAction::Unadjust {}));
        }
    }

    /// The part that a ball under the pointer is shown on.
    fn part_shown(&self) -> Option<String> {
        match &self.target {
            Target::Clicked => self.part.clone(),
            target => part_of(target.clone()),
        }
    }

    fn choose_target(&mut self, ui: &mut Ui, document: &Document) {
        let parts = document.parts.list.iter().rev().map(|part| Target::Part(part.id.clone()));
        let clicked = (!document.parts.list.is_empty()).then_some(Target::Clicked);
        let choices: Vec<Target> = clicked.into_iter().chain([Target::All]).chain(parts).collect();
        let name = self.target.name(document);
        let shown = ComboBox::from_label(tr("Part")).selected_text(name).show_ui(ui, |ui| {
            for choice in choices {
                let name = choice.name(document);
                ui.selectable_value(&mut self.target, choice, name);
            }
        });
        set_accessible_name(&shown.response, tr("Part"));
    }

    /// Balls take the color that the part has.
    fn color_balls(&mut self, document: &Document) {
        let part = self.part_shown();
        if self.colored.as_ref() != Some(&part) {
            let place = part.as_ref().and_then(|part| visible_place(document, part));
            let color = place.and_then(|at| color_at(document, at)).unwrap_or(CLAY);
            self.colored = Some(part);
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
                    let picture = egui::load::SizedTexture::new(texture, size);
                    ui.add(egui::Button::image(picture).selected(self.held == Some(material.key)))
                }
                // The same button to egui, as large: no click is lost while its picture arrives.
                None => {
                    let side = vec2(SHOWN_PT, SHOWN_PT) + 2.0 * ui.spacing().button_padding;
                    ui.add(egui::Button::new("…").min_size(side))
                }
            };
            let response = response.on_hover_text(tr(&material.about));
            set_accessible_name(&response, &tr!("Material: {name}", name = tr(&material.name)));
            ui.small(tr(&material.name));
            response
        });
        shown.inner
    }
}

fn part_of(target: Target) -> Option<String> {
    match target {
        Target::Part(part) => Some(part),
        Target::Clicked | Target::All => None,
    }
}

fn give((key, part): &MaterialOn, done: bool) -> Action {
    Action::Layer(LayerAction::Material { name: (*key).to_owned(), part: part.clone(), done })
}
