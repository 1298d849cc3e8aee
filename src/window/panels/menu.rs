//! The menu bar and the documents' tabs.
//! Floor 7.

mod keys;

pub use keys::MenuKeys;

use crate::commands::{MENUS, MenuCommand};
use crate::file_pictures::FilePictures;
use crate::icons::{Icon, add_sized_button};
use crate::keymap::key_text;
use crate::language::tr;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::{FileAction, SelectionAction};
use crate::session::{Action, Session};
use crate::settings::Settings;
use crate::titles::{marked_title, title_of};
use crate::tr;
use crate::widgets::{set_accessible_name, tab};
use eframe::egui::load::SizedTexture;
use eframe::egui::{self, Button, Image, Ui, vec2};
use std::path::PathBuf;

/// What the menus keep from frame to frame.
#[derive(Default)]
pub struct MenuState {
    pub keys: MenuKeys,
    pub pictures: FilePictures,
}

/// The menus, made from the commands.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    settings: &Settings,
    menu: &mut MenuState,
    requests: &mut UiRequests,
) {
    egui::MenuBar::new().ui(ui, |ui| {
        for (title, commands) in MENUS {
            let MenuState { keys, pictures } = &mut *menu;
            let button = ui.menu_button(tr(title), |ui| {
                ui.set_min_width(220.0);
                // A low window scrolls the menu.
                let room = ui.ctx().content_rect().bottom() - ui.cursor().top() - 12.0;
                egui::ScrollArea::vertical().max_height(room).min_scrolled_height(room).show(
                    ui,
                    |ui| {
                        for command in commands {
                            entry(ui, session, settings, command, requests);
                            match command.name {
                                "Open…" => recent_files(ui, &settings.recent, pictures, requests),
                                "Keep selection…" => show_kept_selections(ui, session, requests),
                                _ => {}
                            }
                        }
                    },
                );
            });
            keys.show(&button.response);
        }
    });
}

fn entry(
    ui: &mut Ui,
    session: &Session,
    settings: &Settings,
    command: &'static MenuCommand,
    requests: &mut UiRequests,
) {
    if command.is_line() {
        return drop(ui.separator());
    }
    if command.is_menu() {
        let each = |ui: &mut Ui| {
            command.within.iter().for_each(|row| entry(ui, session, settings, row, requests))
        };
        return drop(ui.menu_button(tr(command.name), each));
    }
    let is_on = command.is_on.is_some_and(|is_on| is_on(session, &settings.layout));
    let mut button = Button::selectable(is_on, tr(command.name));
    if let Some(keys) = settings.keymap.first(command) {
        button = button.shortcut_text(key_text(ui.ctx(), keys));
    }
    let response = ui.add_enabled((command.can)(session), button);
    if response.on_hover_text(tr(command.hint)).clicked() {
        (command.run)(session, requests);
        ui.close();
    }
}

/// The side of a recent file's picture, points.
const PICTURE_PT: f32 = 28.0;

fn recent_files(
    ui: &mut Ui,
    recent: &[PathBuf],
    pictures: &mut FilePictures,
    requests: &mut UiRequests,
) {
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button(tr("Open recent"), |ui| {
            for file in recent {
                let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let button = match pictures.of(ui.ctx(), file) {
                    Some(texture) => {
                        let size = texture.size_vec2();
                        let size = size * (PICTURE_PT / size.max_elem().max(1.0));
                        let picture = Image::from_texture(SizedTexture::new(texture.id(), size));
                        Button::image_and_text(picture.fit_to_exact_size(size), &name)
                    }
                    None => Button::new(&name),
                };
                let response = ui.add(button.min_size(vec2(0.0, PICTURE_PT + 2.0)));
                set_accessible_name(&response, &name);
                if response.on_hover_text(file.display().to_string()).clicked() {
                    requests.request(WindowRequest::Open(file.clone()));
                    ui.close();
                }
            }
        });
    });
}

/// The selections that the document keeps.
fn show_kept_selections(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let kept = session.active().map_or(&[][..], |open| &open.document().selections);
    ui.add_enabled_ui(!kept.is_empty(), |ui| {
        ui.menu_button(tr("Select kept"), |ui| {
            for name in kept.iter().map(|kept| kept.name.clone()) {
                if ui.button(&name).clicked() {
                    let how = session.tools.select.combine;
                    requests.act(Action::Selection(SelectionAction::Take { name, how }));
                    ui.close();
                }
            }
        });
    });
}

/// One tab per document, with a dot if there are unsaved changes.
pub fn tabs(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (index, open) in session.open_documents.iter().enumerate() {
            let is_front = index == session.current;
            let title = marked_title(open);
            let path = open
                .file
                .as_ref()
                .map_or_else(|| tr("Not saved yet").to_owned(), |file| file.display().to_string());
            let response = tab(ui, None, &title, true, is_front).on_hover_text(path);
            if response.clicked() {
                requests.act(Action::File(FileAction::Show { index }));
            }
            let name = tr!("Close {title}", title = title_of(open));
            let close = add_sized_button(ui, Icon::Close, &name, false, 18.0);
            if close.clicked() || response.middle_clicked() {
                requests.request(WindowRequest::Close(index));
            }
            ui.add_space(8.0);
        }
    });
}
