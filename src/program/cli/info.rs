//! `rilievo info`: describes files, which of them belong together, and their detected conventions.
//! Floor 7.
//!
//! With `--json`, one object (stable: fields may be added, never renamed):
//!
//! ```json
//! { "format": "rilievo-info", "version": 1,
//!   "brushes": [ { "file": "set.abr", "kind": "Photoshop brushes",
//!                  "brushes": [ { "name": "Chalk", "tip": "picture", "size": 64, "spacing": 0.25,
//!                                 "pictures": [[64, 40]], "notes": [] } ] } ],
//!   "documents": [ { "file": "pot.ora", "kind": "project", "width": 512, "height": 512, "surface": true,
//!                    "whole": true, "layers": [ { "path": "layers[0]", "name": "ground", "kind": "fill",
//!                    "visible": true, "opacity": 1, "blend": "normal" } ], "notes": [] } ],
//!   "files": [ { "file": "pot_n.png", "format": "PNG", "width": 512, "height": 512, "bits": 8,
//!                "channels": ["r", "g", "b"], "role": "normal", "notes": [] },
//!              { "file": "g.exr", "format": "EXR", …, "compression": "zip block compression",
//!                "layers": [ { "name": "N", "channels": [ { "name": "N.X", "kind": "half" }, … ] } ] },
//!              { "file": "broken.png", "error": "broken.png: cannot be read: …" } ],
//!   "surfaces": [ { "name": "pot", "files": ["pot_n.png", "pot_d.png"], "width": 512, "height": 512, "covered": 0.61,
//!                   "depth_range_px": 220.5, "depth_at_0_and_1": [1.0, 2.3],
//!                   "found": { "normal.flip_y": { "value": "true", "confidence": 0.99, "how": "found" }, … },
//!                   "surface": { "normal": { "file": "pot_n.png", "convention": { … } }, … },
//!                   "notes": [ "…" ] } ] }
//! ```
//!
//! `role` is normal, depth, mask, layers (an EXR of several) or picture. `how` is given, found or
//! assumed. `surface` can be pasted into a recipe: it states what was detected.

mod brushes;
mod documents;

use super::{LimitArgs, print, print_lines, with_advice};
use crate::document::source::{MapSource, MaskSource, SurfaceSource};
use crate::io::inspect::{FileDescription, describe};
use crate::io::maps::{self, Findings, ImportedSurface, pairs};
use crate::io::open::FileKind;
use crate::io::{Files, UserFiles, open, recipe};
use crate::{Error, Result};
use brushes::BrushReport;
use documents::DocumentReport;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Describe files: documents with their layers, and pictures with how they would be read as maps
#[derive(clap::Args)]
pub struct InfoArgs {
    /// Projects, recipes, normal maps, depth maps, masks, EXR files, pictures
    #[arg(required = true, value_name = "FILES")]
    files: Vec<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    limits: LimitArgs,
}

/// Describes every file that can be read; then fails with the sentence of the first that cannot.
pub fn run(args: &InfoArgs) -> Result<()> {
    args.limits.install(|| {
        let budget = args.limits.budget();
        let mut report = InfoReport::default();
        let mut given = UserFiles::default();
        for path in &args.files {
            let name = given.add(path);
            let bytes = given.read(&name, &budget);
            if let Some(found) =
                bytes.as_ref().ok().and_then(|bytes| BrushReport::of(&name, path, bytes, &budget))
            {
                report.brushes.push(found);
                continue;
            }
            if bytes.as_ref().is_ok_and(|bytes| FileKind::of(bytes) != FileKind::Picture) {
                report.documents.push(DocumentReport { name, opened: open(path, &budget) });
                continue;
            }
            let described = bytes.and_then(|bytes| describe(path, &bytes, &budget));
            report.files.push(PictureReport { name, path: path.clone(), described });
        }
        for source in report.sources() {
            let import = maps::import(&source.source, &given, &budget);
            report.surfaces.push(SurfaceReport { source, import });
        }
        if args.json {
            print(&report.json())?
        } else {
            print_lines(&report.text())?
        }
        report.first_error().map_or(Ok(()), Err)
    })
}

#[derive(Default)]
struct InfoReport {
    brushes: Vec<BrushReport>,
    documents: Vec<DocumentReport>,
    files: Vec<PictureReport>,
    surfaces: Vec<SurfaceReport>,
}

struct PictureReport {
    name: String,
    path: PathBuf,
    described: Result<FileDescription>,
}

/// Maps that make a surface.
struct MapFiles {
    name: String,
    files: Vec<String>,
    source: SurfaceSource,
}

struct SurfaceReport {
    source: MapFiles,
    import: Result<ImportedSurface>,
}

impl PictureReport {
    /// The role of the file, from its name, then from its contents.
    fn role(&self) -> &'static str {
        let Ok(d) = &self.described else { return "unreadable" };
        if !d.layers.is_empty() {
            return match (d.normals.is_empty(), d.depths.is_empty()) {
                (false, false) => "layers",
                (false, true) => "normal",
                (true, false) => "depth",
                (true, true) => "picture",
            };
        }
        match pairs::part_of(&self.path).map(|(_, part)| part) {
            Some(pairs::MapPart::Normal) => "normal",
            Some(pairs::MapPart::Depth) => "depth",
            Some(pairs::MapPart::Mask) => "mask",
            None if d.looks_like_normals => "normal",
            None => "picture",
        }
    }
}

impl InfoReport {
    /// The surfaces made by these files: sets by name, then single files.
    fn sources(&self) -> Vec<MapFiles> {
        let readable: Vec<&PictureReport> =
            self.files.iter().filter(|f| f.described.is_ok()).collect();
        let paths: Vec<PathBuf> = readable.iter().map(|f| f.path.clone()).collect();
        let name_of =
            |path: &PathBuf| readable.iter().find(|f| f.path == *path).map(|f| f.name.clone());
        let sets = pairs::sets(&paths);
        let mut out: Vec<MapFiles> = Vec::new();
        for set in &sets {
            let [normal, depth, mask] =
                [&set.normal, &set.depth, &set.mask].map(|p| p.as_ref().and_then(&name_of));
            if normal.is_some() || depth.is_some() {
                out.push(MapFiles::new(&set.name, normal, depth, mask));
            }
        }
        // A single normal map and a single depth map belong together, whatever their names.
        let only = |role: &str| {
            let mut left = readable
                .iter()
                .filter(|f| f.role() == role && !out.iter().any(|s| s.files.contains(&f.name)));
            left.next().filter(|_| left.next().is_none()).map(|f| f.name.clone())
        };
        if let (Some(normal), Some(depth)) = (only("normal"), only("depth")) {
            let mask = only("mask");
            out.push(MapFiles::new("", Some(normal), Some(depth), mask));
        }
        for file in readable {
            let used = out.iter().any(|s| s.files.contains(&file.name));
            let (own, name) = (
                || Some(file.name.clone()),
                file.path.file_stem().unwrap_or_default().to_string_lossy(),
            );
            match file.role() {
                _ if used => {}
                "layers" => out.push(MapFiles::new(&name, own(), own(), None)),
                "normal" => out.push(MapFiles::new(&name, own(), None, None)),
                "depth" => out.push(MapFiles::new(&name, None, own(), None)),
                _ => {}
            }
        }
        out
    }

    fn first_error(self) -> Option<Error> {
        let brushes = self.brushes.into_iter().filter_map(|b| b.read.err());
        let documents = brushes.chain(self.documents.into_iter().filter_map(|d| d.opened.err()));
        let files = documents.chain(self.files.into_iter().filter_map(|f| f.described.err()));
        files.chain(self.surfaces.into_iter().filter_map(|s| s.import.err())).next()
    }

    fn json(&self) -> String {
        let value = json!({
            "format": "rilievo-info",
            "version": 1,
            "brushes": self.brushes.iter().map(BrushReport::json).collect::<Vec<_>>(),
            "documents": self.documents.iter().map(DocumentReport::json).collect::<Vec<_>>(),
            "files": self.files.iter().map(PictureReport::json).collect::<Vec<_>>(),
            "surfaces": self.surfaces.iter().map(SurfaceReport::json).collect::<Vec<_>>(),
        });
        format!("{value:#}\n")
    }

    fn text(&self) -> String {
        let brushes: String = self.brushes.iter().map(BrushReport::text).collect();
        let documents: String = self.documents.iter().map(DocumentReport::text).collect();
        let files: String = self.files.iter().map(PictureReport::text).collect();
        let surfaces: String = self.surfaces.iter().map(SurfaceReport::text).collect();
        brushes + &documents + &files + &surfaces
    }
}

impl MapFiles {
    fn new(
        name: &str,
        normal: Option<String>,
        depth: Option<String>,
        mask: Option<String>,
    ) -> Self {
        let mut files: Vec<String> =
            [&normal, &depth, &mask].into_iter().flatten().cloned().collect();
        files.dedup();
        fn map<C: Default>(file: String) -> MapSource<C> {
            MapSource { file, ..MapSource::default() }
        }
        let source = SurfaceSource {
            normal: normal.map(map),
            depth: depth.map(map),
            mask: mask.map(|file| MaskSource::File { file, channel: None, invert: false }),
            matrix: None,
        };
        Self { name: name.into(), files, source }
    }

    /// The source with all detected conventions stated.
    fn spell_out_source(&self, findings: &Findings) -> SurfaceSource {
        let mut source = self.source.clone();
        if let (Some(map), Some(convention)) = (&mut source.normal, &findings.normal) {
            map.convention = convention.clone();
        }
        if let (Some(map), Some(convention)) = (&mut source.depth, &findings.depth) {
            map.convention = convention.clone();
        }
        source
    }
}

impl PictureReport {
    fn json(&self) -> Value {
        let d = match &self.described {
            Ok(d) => d,
            Err(e) => return json!({ "file": self.name, "error": with_advice(e) }),
        };
        let mut out = json!({
            "file": self.name, "format": d.format, "width": d.size.width, "height": d.size.height, "bits": d.bits,
            "channels": d.channels, "role": self.role(), "notes": d.warning.iter().collect::<Vec<_>>(),
        });
        if let Some(compression) = &d.compression {
            let channel = |(name, kind): &(String, &str)| json!({ "name": name, "kind": kind });
            let layers = d
                .layers
                .iter()
                .map(|l| json!({ "name": l.name, "channels": l.channels.iter().map(channel).collect::<Vec<_>>() }));
            out["compression"] = json!(compression);
            out["layers"] = layers.collect();
            out["fits_normals"] = json!(d.normals);
            out["fits_depth"] = json!(d.depths);
        }
        out
    }

    fn text(&self) -> String {
        let d = match &self.described {
            Ok(d) => d,
            Err(e) => return format!("{}\n", with_advice(e)),
        };
        let kind = match d.compression.as_deref() {
            Some(compression) => compression.to_owned(),
            None => format!("{} bits, {}", d.bits, d.channels.concat()),
        };
        let mut out =
            format!("{}: {}, {} pixels, {kind}; {}\n", self.name, d.format, d.size, self.role());
        for layer in &d.layers {
            let channels = layer
                .channels
                .iter()
                .map(|(name, kind)| format!("{name} ({kind})"))
                .collect::<Vec<_>>();
            let name = if layer.name.is_empty() { "no layer" } else { &layer.name };
            out += &format!("  {name}: {}\n", channels.join(", "));
        }
        d.warning.iter().for_each(|w| out += &format!("  {w}\n"));
        out
    }
}

impl SurfaceReport {
    fn covered_ratio(import: &ImportedSurface) -> f64 {
        let coverage = import.surface.coverage_plane().values();
        coverage.iter().map(|c| f64::from(*c)).sum::<f64>() / 255.0 / coverage.len().max(1) as f64
    }

    fn json(&self) -> Value {
        let mut out = json!({ "name": self.source.name, "files": self.source.files });
        let import = match &self.import {
            Ok(import) => import,
            Err(e) => {
                out["error"] = json!(with_advice(e));
                return out;
            }
        };
        let (size, findings) = (import.surface.size(), &import.findings);
        let found = findings.choices.iter().map(|c| {
            let confidence = (f64::from(c.confidence) * 1000.0).round() / 1000.0;
            (
                c.field.to_owned(),
                json!({ "value": c.value, "confidence": confidence, "how": c.how.name() }),
            )
        });
        out["width"] = json!(size.width);
        out["height"] = json!(size.height);
        out["covered"] = json!((Self::covered_ratio(import) * 1e4).round() / 1e4);
        out["depth_range_px"] = json!(import.surface.depth_range_px());
        out["depth_at_0_and_1"] = json!(findings.depth_range.map(|(near, far)| [near, far]));
        out["found"] = Value::Object(found.collect());
        out["surface"] =
            recipe::surface::write(&self.source.spell_out_source(findings)).into_value();
        out["notes"] = json!(findings.notes);
        out
    }

    fn text(&self) -> String {
        let name = if self.source.name.is_empty() { "surface" } else { &self.source.name };
        let import = match &self.import {
            Ok(import) => import,
            Err(e) => return format!("\n{name}: {}\n", with_advice(e)),
        };
        let mut out = format!(
            "\n{name}: a surface of {} pixels, {:.0} % covered, from {}\n",
            import.surface.size(),
            Self::covered_ratio(import) * 100.0,
            self.source.files.join(" and ")
        );
        for c in &import.findings.choices {
            out += &format!(
                "  {:<18} {:<14} {} ({:.0} %)\n",
                c.field,
                c.value,
                c.how.name(),
                c.confidence * 100.0
            );
        }
        import.findings.notes.iter().for_each(|note| out += &format!("  {note}\n"));
        out
    }
}
