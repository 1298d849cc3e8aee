//! The field above the layers that shows only those of a name, a kind or a label. Floor 7. Its
//! content belongs to the window, not to the document.

use super::color_of;
use crate::document::{Content, Document, Layer, LayerId, LayerLabel};
use crate::icons::{BUTTON_PT, Icon, icon_button};
use crate::language::tr;
use crate::panels::words::translate_within;
use crate::session::Session;
use crate::tr;
use crate::widgets::{sentence, set_accessible_name};
use eframe::egui::{self, Button, Id, RichText, TextEdit, Ui};
use std::sync::Arc;

/// The search; an empty one finds all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerFilter {
    /// A part of the name, in any case.
    pub text: String,
    /// A kind by its name.
    pub kind: Option<&'static str>,
    pub label: Option<LayerLabel>,
}

/// A row of the list: a layer, and how many groups are around it.
pub type ListedLayer<'d> = (&'d Arc<Layer>, usize);

impl LayerFilter {
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    fn is_match(&self, layer: &Layer) -> bool {
        layer.name.to_lowercase().contains(&self.text.to_lowercase())
            && self.kind.is_none_or(|kind| layer.content.label() == kind)
            && self.label.is_none_or(|label| layer.label == label)
    }

    /// The rows, the topmost first: the layers found, with the groups around them, or all that no
    /// folded group hides.
    pub fn list_rows<'d>(
        &self,
        document: &'d Document,
        is_folded: impl Fn(LayerId) -> bool,
    ) -> Vec<ListedLayer<'d>> {
        let mut rows = Vec::new();
        self.list(&document.layers, 0, &is_folded, &mut rows);
        rows
    }

    fn list<'d>(
        &self,
        layers: &'d [Arc<Layer>],
        depth: usize,
        is_folded: &impl Fn(LayerId) -> bool,
        rows: &mut Vec<ListedLayer<'d>>,
    ) {
        for layer in layers.iter().rev() {
            let mut inner = Vec::new();
            let group = layer.content.group().filter(|_| !self.is_empty() || !is_folded(layer.id));
            if let Some(group) = group {
                self.list(&group.layers, depth + 1, is_folded, &mut inner);
            }
            if !inner.is_empty() || self.is_match(layer) {
                rows.push((layer, depth));
                rows.append(&mut inner);
            }
        }
    }
}

/// The filter as it was last set.
pub fn current(ui: &Ui) -> LayerFilter {
    ui.data(|data| data.get_temp(id()).unwrap_or_default())
}

fn id() -> Id {
    Id::unique("layer filter")
}

/// The field, and a menu of kinds and labels, in a row; Escape in the field clears both.
pub fn show(ui: &mut Ui, session: &Session) {
    let Some(document) = session.shown_document() else { return };
    let mut filter = current(ui);
    let buttons = if filter.is_empty() { 1.0 } else { 2.0 };
    let name = tr("Filter layers");
    let field = TextEdit::singleline(&mut filter.text)
        .hint_text(name)
        .desired_width(ui.available_width() - buttons * (BUTTON_PT + 2.0) - 10.0);
    let field = ui.add(field);
    set_accessible_name(&field, name);
    if field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        filter = LayerFilter::default();
    }
    let is_narrowed = filter.kind.is_some() || filter.label.is_some();
    let menu = icon_button(ui, Icon::Dots, "Kinds of layers", is_narrowed);
    egui::Popup::menu(&menu).show(|ui| kinds(ui, document, &mut filter));
    menu.on_hover_text(tr("Shows only layers of a kind or a label"));
    if !filter.is_empty() {
        let hint = "Shows all layers again (Escape)";
        if icon_button(ui, Icon::Close, "Show all layers", false).on_hover_text(tr(hint)).clicked()
        {
            filter = LayerFilter::default();
        }
    }
    ui.data_mut(|data| data.insert_temp(id(), filter));
}

/// Those that the document has.
fn kinds(ui: &mut Ui, document: &Document, filter: &mut LayerFilter) {
    let all = document.walk();
    let mut kinds: Vec<&'static str> =
        all.iter().map(|(_, layer)| label_of(&layer.content)).collect();
    kinds.sort_unstable_by_key(|kind| (tr(kind), *kind));
    kinds.dedup();
    if ui
        .add(Button::selectable(filter.kind.is_none() && filter.label.is_none(), tr("all kinds")))
        .clicked()
    {
        (filter.kind, filter.label) = (None, None);
        ui.close();
    }
    for kind in kinds {
        if ui.add(Button::selectable(filter.kind == Some(kind), tr(kind))).clicked() {
            (filter.kind, filter.label) = (Some(kind), None);
            ui.close();
        }
    }
    for (label, name) in LayerLabel::ALL {
        let Some(color) =
            color_of(label).filter(|_| all.iter().any(|(_, layer)| layer.label == label))
        else {
            continue;
        };
        let text = RichText::new(tr!("{color} label", color = translate_within(&sentence(name))));
        let text = text.color(color);
        if ui.add(Button::selectable(filter.label == Some(label), text)).clicked() {
            (filter.kind, filter.label) = (None, Some(label));
            ui.close();
        }
    }
}

fn label_of(content: &Content) -> &'static str {
    content.label()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Group;
    use crate::math::{Size, srgb::Color};

    #[test]
    fn layers_are_found_by_name_kind_and_label_with_the_groups_around_them() {
        let fill =
            |name: &str, label| Layer { label, ..Layer::new(name, Content::Fill(Color::BLACK)) };
        let layers =
            [fill("Ink", LayerLabel::Red), fill("Sky", LayerLabel::None)].map(Arc::new).to_vec();
        let group = Layer::new("People", Content::Group(Group { layers, pass_through: false }));
        let all = vec![Arc::new(fill("Think", LayerLabel::None)), Arc::new(group)];
        let document = Document { layers: all, ..Document::empty(Size::new(4, 4)) };
        let told = |filter: LayerFilter, folded: bool| {
            let rows = filter.list_rows(&document, |_| folded);
            rows.iter()
                .map(|(layer, depth)| format!("{}{}", depth, layer.name))
                .collect::<Vec<_>>()
                .join(" ")
        };
        let plain = LayerFilter::default;
        assert_eq!(told(plain(), false), "0People 1Sky 1Ink 0Think");
        assert_eq!(told(plain(), true), "0People 0Think");
        assert_eq!(
            told(LayerFilter { text: "INK".into(), ..plain() }, true),
            "0People 1Ink 0Think"
        );
        assert_eq!(
            told(LayerFilter { label: Some(LayerLabel::Red), ..plain() }, false),
            "0People 1Ink"
        );
        let kind = Some(document.layers[1].content.label());
        assert_eq!(told(LayerFilter { kind, ..plain() }, false), "0People");
    }
}
