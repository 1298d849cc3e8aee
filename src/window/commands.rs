//! The commands of the menus: one row per command, with its keys. Menus, keyboard, palette and the
//! list of shortcuts are made from the same rows. Floor 7.

mod adjustments;
mod edit;
mod effects;
mod file;
mod filters;
mod guides;
mod help;
mod image;
mod layer;
mod paint;
mod parts;
mod paths;
mod row;
mod select;
mod shading;
mod transform;
mod view;

pub use row::MenuCommand;

/// The menus and their commands.
pub const MENUS: [(&str, &[MenuCommand]); 8] = [
    ("File", file::COMMANDS),
    ("Edit", edit::COMMANDS),
    ("Image", image::COMMANDS),
    ("Select", select::COMMANDS),
    ("Layer", layer::COMMANDS),
    ("Paint", paint::COMMANDS),
    ("View", view::COMMANDS),
    ("Help", help::COMMANDS),
];
/// A menu within Layer.
pub const PARTS: &[MenuCommand] = parts::COMMANDS;
/// A menu within Edit.
pub const TRANSFORMS: &[MenuCommand] = transform::COMMANDS;
pub use transform::REMOVE_LIQUIFY;

/// Every command, menu by menu.
pub fn all() -> impl Iterator<Item = &'static MenuCommand> {
    const EVERY: [(&str, &[MenuCommand]); 8] = MENUS;
    let rows = EVERY.into_iter().flat_map(|(_, rows)| rows);
    rows.flat_map(MenuCommand::commands).filter(|command| !command.is_line())
}

/// A command by its name.
pub fn find_command(name: &str) -> Option<&'static MenuCommand> {
    all().find(|command| command.name == name)
}

#[cfg(test)]
mod tests {
    use super::row::key;
    use super::*;
    use eframe::egui::Key;
    use std::collections::HashMap;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        let (mut keys, mut names) = (HashMap::new(), HashMap::new());
        for command in all() {
            assert_eq!(names.insert(command.name, ()), None, "{} twice", command.name);
            assert!(!command.hint.is_empty(), "{} says nothing", command.name);
            for key in command.keys {
                assert_eq!(keys.insert(format!("{key:?}"), command.name), None, "{}", command.name);
            }
        }
        for (tool, _) in crate::tools::ToolKind::ALL {
            let mut letter = key(Key::from_name(&tool.key().to_string()).unwrap());
            letter.modifiers.shift |= tool.is_key_shifted();
            assert_eq!(keys.insert(format!("{letter:?}"), tool.label()), None, "{}", tool.label());
        }
    }

    #[test]
    fn the_page_of_the_window_lists_every_command() {
        let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/WINDOW.md");
        let page = std::fs::read_to_string(page).unwrap();
        let menus = page.split_once("\n| menu | commands |").unwrap().1;
        let is_listed = |name: &str| {
            menus.lines().any(|line| {
                let mut names = line.split(['|', '·']).map(|part| part.split(" **").next());
                names.any(|listed| listed.map(str::trim) == Some(name))
            })
        };
        let missing: Vec<&str> =
            all().map(|command| command.name).filter(|name| !is_listed(name)).collect();
        assert!(missing.is_empty(), "docs/WINDOW.md does not list {missing:?}");
    }
}
