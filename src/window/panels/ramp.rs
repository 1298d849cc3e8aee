//! The stops of a ramp: colors and places. Floor 7.

use super::colors;
use crate::language::tr;
use crate::math::srgb::Color;
use crate::paint::GradientStop;
use crate::tr;
use crate::widgets::{NumberField, ValueChange};
use eframe::egui::Ui;

/// Shows the stops, each with a button to remove it, and one to add another.
pub fn show(ui: &mut Ui, stops: &[GradientStop]) -> Option<ValueChange<Vec<GradientStop>>> {
    let with = |i: usize, stop: GradientStop| {
        let mut stops = stops.to_vec();
        if let Some(slot) = stops.get_mut(i) {
            *slot = stop;
        }
        sort_stops(stops)
    };
    let mut changed = None;
    for (i, stop) in stops.iter().enumerate() {
        ui.horizontal(|ui| {
            let color =
                colors::button(ui, &tr!("Color of stop {number}", number = i + 1), stop.color);
            let color = color.map(|c| c.map(|color| with(i, GradientStop { color, ..*stop })));
            let place = tr!("Position of stop {number}", number = i + 1);
            let t = NumberField::new(&place, 0.0..=1.0, "0 at the first end, 1 at the second")
                .field(ui, stop.t);
            let t = t.map(|c| c.map(|t| with(i, GradientStop { t, ..*stop })));
            if let Some(to) = color.or(t) {
                changed = Some(to);
            }
            if stops.len() > 1 && ui.small_button(tr("Remove")).clicked() {
                let mut stops = stops.to_vec();
                stops.remove(i);
                changed = Some(ValueChange { to: stops, done: true });
            }
        });
    }
    if ui.button(tr("Add stop")).clicked() {
        let mut stops = stops.to_vec();
        let color = stops.last().map_or(Color::WHITE, |stop| stop.color);
        stops.push(GradientStop { t: 0.5, color });
        changed = Some(ValueChange { to: sort_stops(stops), done: true });
    }
    changed
}

fn sort_stops(mut stops: Vec<GradientStop>) -> Vec<GradientStop> {
    stops.sort_by(|a, b| a.t.total_cmp(&b.t));
    stops
}
