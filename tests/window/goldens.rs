//! What panels, options of tools and dialogs offer: every control with its role, its name and its
//! value, in the order in which a screen reader visits them, compared with text files in
//! `tests/window/goldens`. `UPDATE_GOLDEN=1 cargo test --features window-tests --test program
//! window::goldens` accepts what has changed.

use super::{Story, choose, command, key, press, session, steps, until, window, window_of};
use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::{Key, Modifiers, Rect};
use egui_kittest::Node;
use egui_kittest::kittest::{NodeT, Queryable};
use rilievo_program::tools::ToolKind;
use rilievo_window::MainWindow;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The panels above the layers.
const PANELS: [&str; 7] =
    ["Color", "Brushes", "Palettes", "Properties", "Surface", "History", "Navigator"];

/// Commands that make a layer, whose properties are then shown.
const LAYERS: [&str; 32] = [
    "New paint layer",
    "New stroke layer",
    "New form lines",
    "New hatching",
    "New fill layer",
    "New gradient layer",
    "New radiance scaling",
    "New detail normals",
    "New group",
    "New Phong layer",
    "New painter's light layer",
    "New toon layer",
    "New sub-Lambertian layer",
    "New Ashikhmin layer",
    "New lit-sphere layer",
    "New mirror layer",
    "New glass layer",
    "New layer lit by an environment",
    "New ambient occlusion layer",
    "New levels layer",
    "New curves layer",
    "New brightness/contrast layer",
    "New exposure layer",
    "New hue/saturation layer",
    "New color balance layer",
    "New black & white layer",
    "New photo filter layer",
    "New channel mixer layer",
    "New selective color layer",
    "New gradient map layer",
    "New posterize layer",
    "New vibrance layer",
];

/// Commands that open a dialog, and the files that show what it offers.
const DIALOGS: [(&str, &str); 14] = [
    ("New…", "new"),
    ("Canvas size…", "canvas-size"),
    ("Image size…", "image-size"),
    ("Turn canvas…", "turn-canvas"),
    ("Export…", "export"),
    ("Export maps…", "export-maps"),
    ("Export unwrapped…", "export-unwrapped"),
    ("Looks…", "looks"),
    ("Materials…", "materials"),
    ("Levels…", "levels"),
    ("Curves…", "curves"),
    ("Feather selection…", "feather"),
    ("Grid and snapping…", "grid"),
    ("Panels…", "panels"),
];

/// The text of a control: its role, its name, and what it holds. `None`: it only groups others.
fn described(node: &Node) -> Option<String> {
    let control = node.accesskit_node();
    let (label, value) = (control.label().unwrap_or_default(), control.value().unwrap_or_default());
    let is_only_group = matches!(
        control.role(),
        Role::Unknown | Role::GenericContainer | Role::Window | Role::Pane | Role::Dialog
    );
    let is_empty = label.is_empty() && value.is_empty();
    let is_no_control = matches!(control.role(), Role::TextRun | Role::ScrollBar | Role::Splitter);
    if is_no_control || (is_only_group && is_empty) {
        return None;
    }
    let mut text = format!("{:?}", control.role());
    if !label.is_empty() {
        text += &format!(" “{label}”");
    }
    if !value.is_empty() && value != label {
        text += &format!(" = “{value}”");
    }
    if let Some(number) = control.numeric_value() {
        // As many digits as a single-precision number has, so that no noise is compared.
        text += &format!(" {}", (number * 1e4).round() / 1e4);
    }
    match control.toggled() {
        Some(Toggled::True) => text += " on",
        Some(Toggled::False) => text += " off",
        Some(Toggled::Mixed) => text += " mixed",
        None => {}
    }
    if control.is_disabled() {
        text += " disabled";
    }
    Some(text.replace('\n', "⏎"))
}

/// The controls for which something is true, one a line, in their order.
fn listed(harness: &Story, mut is_listed: impl FnMut(&Node) -> bool) -> String {
    let nodes = harness.root().children_recursive().filter(|node| is_listed(node));
    let lines: Vec<String> = nodes.filter_map(|node| described(&node)).collect();
    lines.join("\n") + "\n"
}

/// Where a node is; `None` for one that only groups others.
fn place(node: &Node) -> Option<Rect> {
    node.accesskit_node().bounding_box().map(|_| node.rect())
}

fn rect_of(harness: &Story, label: &str) -> Rect {
    harness.get_by_label(label).rect()
}

/// Whether a node is the tab of a panel, and not a control of the same name elsewhere.
fn is_tab(node: &Node, name: &str) -> bool {
    let control = node.accesskit_node();
    control.toggled().is_some() && control.label().is_some_and(|label| label == name)
}

/// What the panels beside the canvas offer between two tabs, or after the first.
fn between(harness: &Story, first: &str, end: Option<&str>) -> String {
    let beside = rect_of(harness, "Canvas").right();
    let (mut is_after, mut is_over) = (false, false);
    listed(harness, |node| {
        if place(node).is_none_or(|rect| rect.left() < beside) {
            return false;
        }
        is_over |= end.is_some_and(|end| is_after && is_tab(node, end));
        let is_listed = is_after && !is_over;
        is_after |= is_tab(node, first);
        is_listed
    })
}

/// What the panel in front offers.
fn front(harness: &Story) -> String {
    between(harness, "Navigator", Some("Layers"))
}

/// What the layers or the parts of the shape offer.
fn below(harness: &Story) -> String {
    between(harness, "Shape", None)
}

/// What the bar beneath the menus offers.
fn options(harness: &Story) -> String {
    let (menus, canvas) = (rect_of(harness, "File"), rect_of(harness, "Canvas"));
    let tools = harness.root().children_recursive().filter(|node| is_tab(node, "Brush"));
    let tops = tools.filter_map(|node| place(&node)).map(|rect| rect.top());
    let end = tops.fold(canvas.top(), f32::min) + 1.0;
    let is_within = |rect: Rect| rect.top() >= menus.bottom() - 1.0 && rect.bottom() <= end;
    listed(harness, |node| place(node).is_some_and(is_within))
}

/// What the dialog that is open offers; `None` if none is.
fn dialog(harness: &Story) -> Option<String> {
    let is_dialog = |node: &Node| node.accesskit_node().role() == Role::Dialog;
    let open = harness.root().children_recursive().filter(is_dialog).last()?;
    let lines: Vec<String> =
        open.children_recursive().filter_map(|node| described(&node)).collect();
    Some(lines.join("\n") + "\n")
}

/// Texts that differ from their files.
#[derive(Default)]
struct Goldens {
    faults: Vec<String>,
}

impl Goldens {
    /// Compares a text with the file of this name, or writes it if that was asked for.
    fn check(&mut self, name: &str, found: &str) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/window/goldens");
        let file = folder.join(format!("{name}.txt"));
        let stored = std::fs::read_to_string(&file).unwrap_or_default().replace('\r', "");
        if stored == found {
            return;
        }
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::create_dir_all(&folder).unwrap();
            return std::fs::write(&file, found).unwrap();
        }
        let differing = stored.lines().zip(found.lines()).zip(1..).find(|((a, b), _)| a != b);
        self.faults.push(match differing {
            Some(((was, is), line)) => format!("{name}, line {line}: was {was}, is {is}"),
            None => format!(
                "{name}: had {} lines, has {}",
                stored.lines().count(),
                found.lines().count()
            ),
        });
    }
}

impl Drop for Goldens {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            assert!(self.faults.is_empty(), "{}", self.faults.join("\n"));
        }
    }
}

/// A window with a disc in two colors, which asks whether to give it a shape.
fn drawing(folder: &TempDir) -> Story {
    let picture = image::RgbaImage::from_fn(96, 96, |x, y| {
        let inside = (x as f32 - 47.5).hypot(y as f32 - 47.5) < 40.0;
        let color = if x < 48 { [200, 60, 60] } else { [60, 90, 200] };
        image::Rgba([color[0], color[1], color[2], if inside { 255 } else { 0 }])
    });
    let file: PathBuf = folder.path().join("disc.png");
    picture.save(&file).unwrap();
    let mut harness = window_of(1.0, MainWindow::new);
    key(&mut harness, Modifiers::COMMAND, Key::O);
    choose(&mut harness, &file);
    until(&mut harness, |harness| harness.query_by_label("Only paint").is_some());
    harness
}

/// The same with a shape.
fn shaped(folder: &TempDir) -> Story {
    let mut harness = drawing(folder);
    press(&mut harness, "Give it a shape");
    let has_parts = |harness: &Story| {
        let document = session(harness).active().map(|open| open.document());
        document.is_some_and(|document| !document.parts.list.is_empty())
    };
    until(&mut harness, has_parts);
    harness
}

/// The two states in which everything is looked at: an empty canvas, and a drawing with a shape.
fn states(folder: &TempDir) -> [(&'static str, Story); 2] {
    [("plain", window()), ("shaped", shaped(folder))]
}

#[test]
fn panels_offer_what_they_offered() {
    let (folder, mut goldens) = (TempDir::new().unwrap(), Goldens::default());
    for (state, mut harness) in states(&folder) {
        for panel in PANELS {
            press_tab(&mut harness, panel);
            goldens.check(&format!("panel-{}-{state}", panel.to_lowercase()), &front(&harness));
        }
        for panel in ["Layers", "Shape"] {
            press_tab(&mut harness, panel);
            goldens.check(&format!("panel-{}-{state}", panel.to_lowercase()), &below(&harness));
        }
    }
}

fn press_tab(harness: &mut Story, panel: &str) {
    let tab = harness.root().children_recursive().find(|node| is_tab(node, panel));
    tab.unwrap_or_else(|| panic!("there is no tab {panel}")).click();
    steps(harness);
}

#[test]
fn properties_of_layers_are_what_they_were() {
    let (folder, mut goldens) = (TempDir::new().unwrap(), Goldens::default());
    let mut harness = shaped(&folder);
    press_tab(&mut harness, "Properties");
    for made in LAYERS {
        command(&mut harness, made);
        let name = made.trim_start_matches("New ").trim_end_matches(" layer").to_lowercase();
        let words: Vec<&str> = name
            .split(|c: char| !c.is_ascii_alphanumeric())
            .filter(|word| !word.is_empty())
            .collect();
        let made = session(&harness).layer().map(|layer| layer.name.clone()).unwrap();
        goldens
            .check(&format!("layer-{}", words.join("-")), &format!("{made}\n{}", front(&harness)));
        key(&mut harness, Modifiers::COMMAND, Key::Z);
    }
}

#[test]
fn options_of_tools_are_what_they_were() {
    let (folder, mut goldens) = (TempDir::new().unwrap(), Goldens::default());
    for (state, mut harness) in states(&folder) {
        for (tool, name) in ToolKind::ALL {
            harness.state_mut().as_mut().unwrap().session.tool = tool;
            steps(&mut harness);
            let name = name.replace(' ', "-");
            goldens.check(&format!("tool-{name}-{state}"), &options(&harness));
        }
    }
}

#[test]
fn dialogs_offer_what_they_offered() {
    let (folder, mut goldens) = (TempDir::new().unwrap(), Goldens::default());
    goldens.check("dialog-shape", &dialog(&drawing(&folder)).unwrap());
    for (state, mut harness) in states(&folder) {
        command(&mut harness, "Select all");
        for (name, file) in DIALOGS {
            command(&mut harness, name);
            let Some(offered) = dialog(&harness) else { continue };
            goldens.check(&format!("dialog-{file}-{state}"), &offered);
            key(&mut harness, Modifiers::NONE, Key::Escape);
            until(&mut harness, |harness| dialog(harness).is_none());
        }
    }
}
