//! Menus and commands by their names, for tests and recordings. Floor 7. Not here: the commands
//! (`commands`).

use super::MainWindow;
use crate::commands;
use crate::requests::UiRequests;
use eframe::egui;

impl MainWindow {
    /// The names of all commands, menu by menu.
    pub fn commands() -> impl Iterator<Item = &'static str> {
        commands::all().map(|command| command.name)
    }

    /// The menus' titles, and the rows of each: commands, and menus within the menu.
    pub fn menus() -> impl Iterator<Item = (&'static str, Vec<&'static str>)> {
        let names = |commands: &[commands::MenuCommand]| {
            commands.iter().map(|command| command.name).collect::<Vec<_>>()
        };
        let menus = commands::MENUS.map(|(title, commands)| (title, names(commands)));
        menus.into_iter().map(|(title, names)| {
            (title, names.into_iter().filter(|name| !name.is_empty()).collect())
        })
    }

    /// Runs a command by its name, as a menu would.
    pub fn command(&mut self, ctx: &egui::Context, name: &str) {
        let mut requests = UiRequests::default();
        if let Some(command) =
            commands::find_command(name).filter(|command| (command.can)(&self.session))
        {
            (command.run)(&self.session, &mut requests);
        }
        self.do_requests(ctx, requests);
    }
}
