//! The recovery dialog, shown once at the start: lost drawings can be recovered, deleted, or left
//! for later. Floor 7.

use super::{DialogAnswer, set_width};
use crate::io::platform::SystemTime;
use crate::io::recovery::LostSession;
use crate::language::{tr, tr_message};
use crate::tr;
use crate::widgets::list;
use eframe::egui::{RichText, Ui};
use std::time::Duration;

pub struct RecoveryDialog {
    /// Oldest first, each with whether its deletion was already confirmed once.
    lost: Vec<(LostSession, bool)>,
}

impl RecoveryDialog {
    pub fn new(lost: Vec<LostSession>) -> Self {
        Self { lost: lost.into_iter().map(|lost| (lost, false)).collect() }
    }

    pub fn is_empty(&self) -> bool {
        self.lost.is_empty()
    }

    /// Closing it leaves everything for the next start.
    pub fn show(&mut self, ui: &mut Ui) -> DialogAnswer {
        set_width(ui, 460.0);
        ui.heading(tr("Recover unsaved drawings?"));
        ui.label(tr("Rilievo ended unexpectedly. What is recovered opens as a new drawing; no file is replaced."));
        let (mut recover, mut delete) = (None, None);
        list(ui, 320.0).show(ui, |ui| {
            for (i, (lost, is_asked)) in self.lost.iter_mut().enumerate() {
                ui.separator();
                let title = match &*lost.title {
                    "" => tr("Unnamed").into(),
                    title => tr_message(title),
                };
                ui.label(RichText::new(&*title).strong());
                ui.label(describe(lost));
                ui.horizontal(|ui| {
                    if ui.button(tr!("Recover {title}", title)).clicked() {
                        recover = Some(i);
                    }
                    let word = if *is_asked { tr("Delete permanently") } else { tr("Delete…") };
                    if ui.button(word).clicked() {
                        delete = Some(i).filter(|_| *is_asked);
                        *is_asked = true;
                    }
                });
            }
        });
        ui.separator();
        let mut answer = DialogAnswer::Open;
        ui.horizontal(|ui| {
            let can = self.lost.iter().any(|(lost, _)| !lost.has_failed);
            // Enter recovers, as long as no button of the dialog has the focus.
            let enter = ui.input(|i| i.key_pressed(eframe::egui::Key::Enter))
                && ui.memory(|m| m.focused().is_none());
            if ui.add_enabled(can, eframe::egui::Button::new(tr("Recover all"))).clicked()
                || (can && enter)
            {
                answer = DialogAnswer::Recover(
                    self.lost.extract_if(.., |(lost, _)| !lost.has_failed).map(first).collect(),
                );
            }
            if ui.button(tr("Later")).clicked() {
                answer = DialogAnswer::Close;
            }
        });
        if let Some(i) = recover {
            return DialogAnswer::Recover(vec![self.lost.remove(i).0]);
        }
        delete.map_or(answer, |i| DialogAnswer::Delete(self.lost.remove(i).0))
    }
}

fn first((lost, _): (LostSession, bool)) -> LostSession {
    lost
}

/// When the session began, its file, and a warning if recovery failed before.
fn describe(lost: &LostSession) -> String {
    let age = lost.start_time().and_then(|begun| SystemTime::now().duration_since(begun).ok());
    let begun = age.map(|age| tr!("Started {age} ago", age = format_age(age)));
    let place = lost.file.as_ref().map_or_else(
        || tr("never saved").into(),
        |file| tr!("last saved as {file}", file = file.display()),
    );
    let failed = lost.has_failed.then(|| tr("recovering it failed before").into());
    begun.into_iter().chain([place]).chain(failed).collect::<Vec<String>>().join(" · ")
}

/// A time in the largest unit it fills.
fn format_age(time: Duration) -> String {
    const MINUTE: u64 = 60;
    const HOUR: u64 = 60 * MINUTE;
    let secs = time.as_secs();
    match secs {
        0..120 => tr!("{count} seconds", count = secs),
        120..7200 => tr!("{count} minutes", count = secs / MINUTE),
        7200..172_800 => tr!("{count} hours", count = secs / HOUR),
        _ => tr!("{count} days", count = secs / (24 * HOUR)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_spoken_in_the_largest_unit_they_fill() {
        let said =
            [0, 119, 120, 7199, 7200, 172_800].map(|secs| format_age(Duration::from_secs(secs)));
        assert_eq!(
            said,
            ["0 seconds", "119 seconds", "2 minutes", "119 minutes", "2 hours", "2 days"]
        );
    }
}
