//! What `rilievo info` says about brushes of other programs: how they are imported, and what is
//! lost. Floor 7.

use crate::Result;
use crate::cli::with_advice;
use crate::io::Budget;
use crate::io::brush::{self, BrushFormat, ImportedBrush, NeighborFiles};
use crate::paint::grain::{BrushGrain, GrainSource};
use crate::paint::{Brush, DualBrush, DualSettings, PictureSource, Tip};
use serde_json::{Value, json};
use std::path::Path;

/// A file of brushes, or one that should be.
pub struct BrushReport {
    name: String,
    kind: BrushFormat,
    pub read: Result<Vec<ImportedBrush>>,
}

impl BrushReport {
    /// `None` where the file is of another kind.
    pub fn of(name: &str, path: &Path, bytes: &[u8], budget: &Budget) -> Option<Self> {
        let kind = BrushFormat::of(path, bytes)?;
        let read = brush::read(path, bytes, &NeighborFiles::of(path), budget);
        Some(Self { name: name.to_owned(), kind, read })
    }

    pub fn json(&self) -> Value {
        let brushes = match &self.read {
            Ok(brushes) => brushes,
            Err(e) => return json!({ "file": self.name, "error": with_advice(e) }),
        };
        let one = |ImportedBrush { name, brush, notes }: &ImportedBrush| {
            json!({
                "name": name, "tip": tip(&brush.tip), "size": brush.size, "spacing": brush.spacing, "notes": notes,
                "dual": brush.dual.as_deref().map(second_tip),
                "pictures": brush.pictures().map(|p| [p.picture.size.width, p.picture.size.height]).collect::<Vec<_>>(),
            })
        };
        json!({ "file": self.name, "kind": self.kind.name(), "brushes": brushes.iter().map(one).collect::<Vec<_>>() })
    }

    pub fn text(&self) -> String {
        let brushes = match &self.read {
            Ok(brushes) => brushes,
            Err(e) => return format!("{}\n", with_advice(e)),
        };
        let mut out = format!(
            "{}: {}, {}\n",
            self.name,
            self.kind.name(),
            count_text(brushes.len(), "brush", "brushes")
        );
        for ImportedBrush { name, brush, notes } in brushes {
            out += &format!("  {name}: {}\n", looks(brush));
            notes.iter().for_each(|note| out += &format!("    {note}\n"));
        }
        out
    }
}

fn second_tip(dual: &DualBrush) -> Value {
    json!({ "tip": tip(&dual.tip), "mode": dual.settings.mode.name() })
}

fn looks(brush: &Brush) -> String {
    let drives = brush.dynamics.drives().len();
    let size = |source: &PictureSource| format!(" of {} px", source.picture.size);
    let pictures = brush.tip.pictures();
    let first = pictures.first().map(size).unwrap_or_default();
    let several = match pictures.len() {
        0 | 1 => String::new(),
        count => format!(", {}", count_text(count, "picture", "pictures")),
    };
    let grain = match &brush.grain {
        Some(BrushGrain { source: GrainSource::Picture(source), .. }) => {
            format!(", with a texture{}", size(source))
        }
        _ => String::new(),
    };
    let second = match &brush.dual {
        Some(dual) => {
            let DualSettings { size, mode, .. } = dual.settings;
            let (second, mode) = (tip(&dual.tip), mode.label().to_lowercase());
            format!(", with a second tip by “{mode}”: {second}, {:.0} % as large", 100.0 * size)
        }
        None => String::new(),
    };
    format!(
        "{}{first}{several}, {:.4} px across, a dab every {:.0} % of it, {}{grain}{second}",
        tip(&brush.tip),
        (brush.size * 10.0).round() / 10.0,
        brush.spacing * 100.0,
        count_text(drives, "curve", "curves"),
    )
}

fn count_text(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

fn tip(tip: &Tip) -> &'static str {
    match tip {
        Tip::Round => "round",
        Tip::Ellipse { .. } => "ellipse",
        Tip::Square { .. } => "square",
        Tip::Bristles(_) => "bristles",
        Tip::Noise(_) => "noise",
        Tip::Picture(_) => "picture",
        Tip::Hose(_) => "hose",
    }
}
