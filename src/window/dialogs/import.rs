//! The import dialog: choose the maps, check their detected conventions and their look under a
//! light, and correct them before the first stroke. Floor 7. Not here: reading the maps, on another
//! thread (`io::maps`).

mod findings;
mod ways;

use super::{DialogAnswer, buttons, set_width};
use crate::Result;
use crate::advice::with_advice;
use crate::canvas::load_texture;
use crate::document::SurfaceSource;
use crate::document::source::{MapSource, MaskSource, Near, NormalEncoding};
use crate::file_purpose::FilePurpose;
use crate::io::maps::{self, ImportedSurface};
use crate::io::platform;
use crate::language::{tr, tr_message};
use crate::raster::Picture;
use crate::session::storage::{self, OpenedFile};
use crate::tr;
use crate::widgets::{check_box, choice_row, set_accessible_name, tr_sentence};
use eframe::egui::{
    self, Color32, Context, RichText, ScrollArea, Sense, StrokeKind, TextureHandle, Ui, pos2, vec2,
};
use std::path::{Path, PathBuf};
use ways::{FLIPS, ReadingWay, SIDES, light_surface, xor};

/// The dialog's state.
#[derive(Default)]
pub struct ImportDialog {
    source: SurfaceSource,
    /// The source that was read last.
    read: Option<SurfaceSource>,
    is_reading: bool,
    found: Option<Result<maps::ImportedSurface>>,
    /// The finished picture next to the maps, the name of its layer, and whether the document
    /// begins with it.
    picture: Option<(String, Picture)>,
    takes_picture: bool,
    /// Whether the user confirmed that a file which looks like no normal map is one.
    is_sure: bool,
    /// The surface lit in each of the ways to choose from, in the order of [`ImportDialog::ways`].
    lit: Vec<TextureHandle>,
    /// Which of them is chosen.
    clicked: usize,
    /// The file that they show, and which of its axes were flipped when first detected: the ways
    /// keep their positions while the user tries them.
    first: Option<(String, [bool; 2])>,
    becomes: MapsBecome,
}

/// What is made of the maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum MapsBecome {
    #[default]
    Document,
    /// The maps of the document in front.
    ItsMaps,
    /// A part of the shape of the document in front.
    ItsPart,
}

impl ImportDialog {
    /// Opens the dialog with the known files.
    pub fn of(source: SurfaceSource) -> Self {
        Self { source, ..Self::default() }
    }

    /// Opens the dialog to replace the maps of a document, showing the present ones.
    pub fn replacing(source: Option<&SurfaceSource>) -> Self {
        // Maps from inside a project have no file to read again.
        let is_there = |source: &&SurfaceSource| {
            let normal = source.normal.as_ref().map(|map| &map.file);
            let file = normal.or(source.depth.as_ref().map(|map| &map.file));
            file.is_some_and(|file| platform::is_file(Path::new(file)))
        };
        let becomes = MapsBecome::ItsMaps;
        Self {
            source: source.filter(is_there).cloned().unwrap_or_default(),
            becomes,
            ..Self::default()
        }
    }

    /// Opens the dialog for a part of the document in front.
    pub fn for_part() -> Self {
        Self { becomes: MapsBecome::ItsPart, ..Self::default() }
    }

    /// A file was chosen for one of the maps.
    pub fn take_file(&mut self, purpose: FilePurpose, file: PathBuf) {
        let file = file.to_string_lossy().into_owned();
        self.is_sure &= matches!(purpose, FilePurpose::DepthMap | FilePurpose::MaskMap);
        match purpose {
            FilePurpose::DepthMap => {
                self.source.depth = Some(MapSource { file, ..MapSource::default() })
            }
            FilePurpose::MaskMap => {
                self.source.mask = Some(MaskSource::File { file, channel: None, invert: false })
            }
            // The first file adds the maps that belong to it.
            _ if self.source == SurfaceSource::default() => {
                self.source = storage::maps_beside(Path::new(&file), storage::FileUse::Normals);
            }
            _ => self.source.normal = Some(MapSource { file, ..MapSource::default() }),
        }
    }

    /// Maps were read; those requested by another dialog, or replaced by a new choice since, are
    /// ignored.
    pub fn take(&mut self, ctx: &Context, read: MapsRead) {
        let MapsRead { source, found, picture } = read;
        if self.read.as_ref() != Some(&source) {
            return;
        }
        (self.is_reading, self.takes_picture) = (false, picture.is_some());
        self.picture = picture;
        // A flat border counts as background unless the user decides otherwise; then all is read
        // again.
        let is_first = self.found.is_none() && self.source.mask.is_none();
        if is_first && found.as_ref().is_ok_and(|import| import.findings.flat_border > 0.0) {
            self.source.mask = Some(MaskSource::Flat);
        }
        self.clicked = 0;
        self.lit.clear();
        if let Ok(import) = &found {
            let now = self.flipped_axes(&import.findings);
            let file = self.shown_file().unwrap_or_default().to_owned();
            let first = match self.first.take() {
                Some(known) if known.0 == file => known.1,
                _ => now,
            };
            self.first = Some((file, first));
            let chosen = xor(now, first);
            self.clicked = self.ways().iter().position(|(_, flips)| *flips == chosen).unwrap_or(0);
            let shown = |flips: [bool; 2]| light_surface(&import.surface, xor(flips, chosen));
            let pictures = self
                .ways()
                .iter()
                .filter_map(|&(name, flips)| load_texture(ctx, name, &shown(flips)?));
            self.lit = pictures.collect();
        }
        self.found = Some(found);
    }

    /// The possible meanings of these maps.
    fn ways(&self) -> &'static [ReadingWay] {
        if self.source.normal.is_some() { &FLIPS } else { &SIDES }
    }

    /// The file whose ways are shown.
    fn shown_file(&self) -> Option<&str> {
        let map = self.source.normal.as_ref().map(|map| &map.file);
        map.or(self.source.depth.as_ref().map(|map| &map.file)).map(String::as_str)
    }

    /// Which axes were read flipped; for depth alone, both if near is bright.
    fn flipped_axes(&self, findings: &maps::Findings) -> [bool; 2] {
        if self.source.normal.is_some() {
            let normal = findings.normal.clone().unwrap_or_default();
            return [normal.flip_x.unwrap_or(false), normal.flip_y.unwrap_or(false)];
        }
        [findings.depth.as_ref().is_some_and(|depth| depth.near == Near::High); 2]
    }

    pub fn show(&mut self, ui: &mut Ui) -> DialogAnswer {
        set_width(ui, 560.0);
        // What is done stands beside the title, so that no control moves when it ends.
        ui.horizontal(|ui| {
            ui.heading(tr(match self.becomes {
                MapsBecome::Document => "New document from maps",
                MapsBecome::ItsMaps => "Other maps for this document",
                MapsBecome::ItsPart => "Maps as a part of the shape",
            }));
            if self.is_reading {
                ui.spinner();
                ui.label(tr("Reading the maps…"));
            }
        });
        let mut ask = None;
        self.files(ui, &mut ask);
        if let Some(purpose) = ask {
            return DialogAnswer::Ask(crate::requests::WindowRequest::Choose(purpose));
        }
        let is_some = self.source.normal.is_some() || self.source.depth.is_some();
        if self.read.as_ref().is_some_and(|read| *read != self.source) {
            // What the user set for other files no longer holds; what was found about them stays
            // visible.
            self.found = self.found.take().filter(|found| found.is_ok() && is_some);
        }
        if is_some && self.read.as_ref() != Some(&self.source) {
            (self.read, self.is_reading) = (Some(self.source.clone()), true);
            return DialogAnswer::Import(Box::new(self.source.clone()));
        }
        match &self.found {
            None => {}
            Some(Err(error)) => {
                drop(ui.colored_label(ui.visuals().error_fg_color, with_advice(error)))
            }
            Some(Ok(_)) => self.show_findings(ui),
        }
        let is_doubtful = matches!(&self.found, Some(Ok(import)) if import.findings.is_doubtful());
        if is_doubtful {
            ui.colored_label(
                ui.visuals().warn_fg_color,
                tr("This does not look like a normal map: its colors are not directions."),
            );
            check_box(ui, &mut self.is_sure, "Use it as a normal map anyway");
        }
        if let Some((name, _)) = &self.picture
            && self.becomes == MapsBecome::Document
        {
            let text = tr!("Begin with the picture in the file, “{name}”", name);
            check_box(ui, &mut self.takes_picture, text);
        }
        let is_ready =
            !self.is_reading && matches!(self.found, Some(Ok(_))) && (!is_doubtful || self.is_sure);
        let yes = match self.becomes {
            MapsBecome::Document => "Create",
            MapsBecome::ItsMaps => "Replace",
            MapsBecome::ItsPart => "Add",
        };
        match buttons(ui, yes, is_ready) {
            Some(true) => self.create(),
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }

    /// The three files, each of which may be left out.
    fn files(&mut self, ui: &mut Ui, ask: &mut Option<FilePurpose>) {
        let name = |file: &str| {
            Path::new(file).file_name().unwrap_or_default().to_string_lossy().into_owned()
        };
        let mask = match &self.source.mask {
            Some(MaskSource::File { file, .. }) => Some(file.clone()),
            _ => None,
        };
        let rows = [
            (
                "Normal map",
                FilePurpose::NormalMap,
                self.source.normal.as_ref().map(|map| map.file.clone()),
            ),
            (
                "Depth map",
                FilePurpose::DepthMap,
                self.source.depth.as_ref().map(|map| map.file.clone()),
            ),
            ("Mask", FilePurpose::MaskMap, mask),
        ];
        for (label, purpose, file) in rows {
            let map = label.to_lowercase();
            let map = tr(&map);
            ui.horizontal(|ui| {
                crate::widgets::name(ui, label);
                let response = ui.button(tr("Choose…"));
                set_accessible_name(&response, &tr!("Choose {map}", map));
                if response.clicked() {
                    *ask = Some(purpose);
                }
                match &file {
                    Some(file) => {
                        ui.label(name(file)).on_hover_text(file);
                        let response = ui.small_button(tr("Leave out"));
                        set_accessible_name(&response, &tr!("Leave out {map}", map));
                        if response.clicked() {
                            match purpose {
                                FilePurpose::DepthMap => self.source.depth = None,
                                FilePurpose::MaskMap => self.source.mask = None,
                                _ => self.source.normal = None,
                            }
                        }
                    }
                    None => drop(ui.weak(tr(if purpose == FilePurpose::MaskMap {
                        "found from the maps"
                    } else {
                        "derived from the other map"
                    }))),
                }
            });
        }
    }

    /// Shows what was detected, and lets the user correct it.
    fn show_findings(&mut self, ui: &mut Ui) {
        self.pictures(ui);
        if let Some(map) = &mut self.source.normal {
            let encodings: Vec<(Option<NormalEncoding>, &str)> = std::iter::once((None, "found"))
                .chain(findings::ENCODINGS.iter().map(|&(e, words)| (Some(e), words)))
                .collect();
            if let Some(encoding) = choice_row(ui, "Numbers", map.convention.encoding, &encodings) {
                map.convention.encoding = encoding;
            }
        }
        if let Some(map) = &mut self.source.depth
            && let Some(near) = choice_row(ui, "Near is", map.convention.near, &findings::NEAR)
        {
            map.convention.near = near;
        }
        let is_flat_out = self.source.mask == Some(MaskSource::Flat);
        let has_border =
            matches!(&self.found, Some(Ok(import)) if import.findings.flat_border > 0.0);
        if (is_flat_out || has_border)
            && let Some(out) = choice_row(
                ui,
                "Flat border",
                is_flat_out,
                &[(true, "left out"), (false, "surface")],
            )
        {
            self.source.mask = out.then_some(MaskSource::Flat);
        }
        let Some(Ok(maps::ImportedSurface { surface, findings: found, .. })) = &self.found else {
            return;
        };
        let depth = format!("{:.0}", surface.depth_range_px());
        ui.weak(tr!("{size} pixels, about {depth} px deep", size = surface.size(), depth));
        ui.collapsing(tr("Detected"), |ui| {
            ScrollArea::vertical().max_height(150.0).show(ui, |ui| {
                egui::Grid::new("findings").num_columns(3).striped(true).show(ui, |ui| {
                    for choice in &found.choices {
                        let (name, words) = findings::describe(choice);
                        ui.label(tr(name));
                        ui.label(tr(&words));
                        ui.weak(format!(
                            "{}, {:.0} %",
                            tr(choice.how.name()),
                            choice.confidence * 100.0
                        ));
                        ui.end_row();
                    }
                });
                for note in &found.notes {
                    ui.label(tr_message(note));
                }
            });
        });
    }

    /// The surface lit from above left, each way; a click corrects the map.
    fn pictures(&mut self, ui: &mut Ui) {
        ui.label(tr("Lit from above left. Choose the one whose bumps stand out:"));
        let mut chosen = None;
        ui.horizontal(|ui| {
            for (i, (texture, (name, _))) in self.lit.iter().zip(self.ways()).enumerate() {
                ui.vertical(|ui| {
                    let (rect, response) =
                        ui.allocate_exact_size(vec2(124.0, 124.0), Sense::click());
                    let is_chosen = i == self.clicked;
                    response.widget_info(|| {
                        egui::WidgetInfo::selected(egui::Role::Button, true, is_chosen, tr(name))
                    });
                    let side = texture.size_vec2();
                    let scale = (rect.width() / side.x).min(rect.height() / side.y);
                    let at = egui::Rect::from_center_size(rect.center(), side * scale);
                    ui.painter().rect_filled(rect, 4.0, Color32::from_gray(0x20));
                    let uv = egui::Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                    ui.painter().image(texture.id(), at, uv, Color32::WHITE);
                    // A color that the pictures lack, since their border may be black or white.
                    let chosen_rim = egui::Stroke::new(3.0, ui.visuals().selection.bg_fill);
                    let rim = if is_chosen { chosen_rim } else { ui.visuals().window_stroke };
                    ui.painter().rect_stroke(rect, 4.0, rim, StrokeKind::Inside);
                    if response.hovered() && !is_chosen {
                        ui.painter().rect_stroke(
                            rect,
                            4.0,
                            ui.visuals().widgets.hovered.bg_stroke,
                            StrokeKind::Inside,
                        );
                    }
                    let text = RichText::new(tr_sentence(name));
                    ui.label(if is_chosen { text.strong() } else { text });
                    if response.clicked() {
                        chosen = Some(i);
                    }
                });
            }
        });
        let (Some(i), Some((_, first))) = (chosen, &self.first) else { return };
        let [x, y] = xor(*first, self.ways()[i].1);
        self.clicked = i;
        if let Some(map) = &mut self.source.normal {
            (map.convention.flip_x, map.convention.flip_y) = (Some(x), Some(y));
        } else if let Some(map) = &mut self.source.depth {
            map.convention.near = if x { Near::High } else { Near::Low };
        }
    }

    fn create(&mut self) -> DialogAnswer {
        match self.found.take() {
            Some(Ok(import)) if self.becomes == MapsBecome::ItsMaps => {
                DialogAnswer::Replaced(Box::new((self.source.clone(), import)))
            }
            Some(Ok(import)) if self.becomes == MapsBecome::ItsPart => {
                DialogAnswer::Added(Box::new((self.source.clone(), import)))
            }
            Some(Ok(import)) => {
                let opened = storage::of_import(&self.source, import);
                DialogAnswer::Imported(Box::new(
                    match self.picture.take().filter(|_| self.takes_picture) {
                        Some((name, picture)) => storage::with_picture(opened, &name, picture),
                        None => opened,
                    },
                ))
            }
            _ => DialogAnswer::Open,
        }
    }
}

/// A document made of maps, boxed: it is large.
/// Maps as they were read.
pub struct MapsRead {
    /// What was requested: a dialog that wants other maps by now ignores it.
    pub source: SurfaceSource,
    pub found: Result<ImportedSurface>,
    /// The finished picture that the same file holds, and the name of its layer.
    pub picture: Option<(String, Picture)>,
}

pub type MadeDocument = Box<OpenedFile>;
