//! *What's new*: the few things of each version that a painter would want to know. The whole list is
//! the changelog. Floor 7.

use super::{DialogAnswer, close, set_width};
use crate::language::tr;
use crate::tr;
use crate::widgets::{list, title};
use eframe::egui::{RichText, Ui};

/// What a version brought.
struct VersionNews {
    version: &'static str,
    /// Each with the words that begin it, which name the matter.
    rows: &'static [(&'static str, &'static str)],
}

/// The newest version first.
const NEWS: &[VersionNews] = &[
    VersionNews {
        version: "0.2.0",
        rows: &[
            (
                "A shape from a drawing",
                "Give a cut-out drawing a shape: one part, or one for each flat color. Puff, tilt, touch \
                 and sculpt it.",
            ),
            (
                "A painter's light",
                "Key, fill, bounce, rim and cast shadows in six moods; the lamp is dragged on the canvas. \
                 Ink stays ink.",
            ),
            (
                "Materials and looks",
                "Skin, gold, glass and ten others with one click on a part; twenty looks for the whole drawing.",
            ),
            (
                "Lines and hatching by the form",
                "Outlines, creases, shadow edges and hatching that any brush draws, and that follow the shape.",
            ),
            (
                "Text, paths and comics",
                "Text that bends, figures and Bézier paths that stay sharp, speech balloons, panels, halftone.",
            ),
            (
                "Adjustments, filters, effects",
                "Sixteen adjustments, nineteen filters and ten layer effects, live, and read from \
                 Photoshop files and written to them.",
            ),
            (
                "Selections and transforms",
                "With edges that snap to the shape, warps and liquify that keep the surface beneath.",
            ),
            (
                "Brushes of other programs",
                "Brushes and bundles of Krita, MyPaint and Photoshop, with textures and second tips.",
            ),
            (
                "For work",
                "References over the canvas, a second view, proofs by ICC profile, palettes, export with presets.",
            ),
            (
                "Everywhere",
                "Linux, Windows, macOS and the browser, in six languages. After a crash your work comes back.",
            ),
        ],
    },
    VersionNews {
        version: "0.1.0",
        rows: &[(
            "Brushes that know the shape",
            "Dabs, gradients and photos bend over normals and depth: as texture, as reflection, as a mirror.",
        )],
    },
];

/// The greatest height of the list, points.
const LIST_PT: f32 = 520.0;

pub fn show(ui: &mut Ui) -> DialogAnswer {
    set_width(ui, 480.0);
    ui.heading(tr("What's new"));
    list(ui, LIST_PT).show(ui, |ui| {
        for news in NEWS {
            title(ui, &tr!("Version {version}", version = news.version));
            for (matter, words) in news.rows {
                ui.add_space(4.0);
                ui.label(RichText::new(tr(matter)).strong());
                ui.label(tr(words));
            }
        }
    });
    close(ui)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_version_is_this_one() {
        assert_eq!(NEWS[0].version, env!("CARGO_PKG_VERSION"), "what is new in it?");
    }
}
