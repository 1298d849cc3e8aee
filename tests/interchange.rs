//! The command line converts, never over its own input; and other programs show our files as we do.
//! Programs that are not installed are skipped, and said so.

use super::program::program;
use std::path::Path;
use std::process::{Command, Output};

fn rilievo(folder: &Path, args: &[&str]) -> Output {
    program().args(args).current_dir(folder).output().unwrap()
}

fn done(folder: &Path, args: &[&str]) -> String {
    let output = rilievo(folder, args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn said(folder: &Path, args: &[&str]) -> String {
    let output = rilievo(folder, args);
    assert_eq!(output.status.code(), Some(1), "{args:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A folder with a recipe of some layers.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let noise = |x: u32, y: u32| rilievo_engine::math::hash::mix(x * 977 + y) as u8;
    let picture = image::RgbaImage::from_fn(48, 40, |x, y| {
        image::Rgba([noise(x, y), x as u8 * 5, noise(y, x), 255 - (x % 3 * 90) as u8])
    });
    picture.save(folder.path().join("p.png")).unwrap();
    let layers = r##"{ "format": "rilievo", "canvas": { "width": 48, "height": 40 }, "layers": [
        { "name": "ground", "kind": "pixels", "file": "p.png" },
        { "name": "tint ü", "kind": "gradient", "blend": "multiply", "opacity": 0.5 },
        { "name": "g", "kind": "group", "blend": "screen", "opacity": 0.5, "layers": [
            { "name": "in", "kind": "pixels", "file": "p.png", "x": 20, "y": -9 } ] } ] }"##;
    std::fs::write(folder.path().join("a.json"), layers).unwrap();
    folder
}

/// The greatest difference of two pictures, a channel, premultiplied.
fn worst(a: &Path, b: &Path) -> f32 {
    let load = |path: &Path| {
        image::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgba8()
    };
    let (a, b) = (load(a), load(b));
    assert_eq!(a.dimensions(), b.dimensions());
    let of = |p: &image::Rgba<u8>, c: usize| {
        f32::from(p[c]) * if c < 3 { f32::from(p[3]) / 255.0 } else { 1.0 }
    };
    let pairs = a.pixels().zip(b.pixels());
    pairs
        .flat_map(|(p, q)| (0..4).map(|c| (of(p, c) - of(q, c)).abs()).collect::<Vec<_>>())
        .fold(0.0, f32::max)
}

#[test]
fn every_format_keeps_the_picture() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    done(folder.path(), &["convert", "a.json", "ours.png"]);
    done(folder.path(), &["convert", "a.json", "a.ora"]);
    done(folder.path(), &["convert", "a.ora", "a.psd"]);
    done(folder.path(), &["convert", "a.psd", "b.ora"]);
    assert_eq!(
        std::fs::read(at("a.ora")).unwrap(),
        std::fs::read(at("b.ora")).unwrap(),
        "through a .psd and back"
    );
    for (name, most) in
        [("a.ora", 0.0), ("a.psd", 0.0), ("c.tif", 0.0), ("c.webp", 0.0), ("c.exr", 2.0)]
    {
        if name.starts_with('c') {
            done(folder.path(), &["convert", "a.ora", name]);
        }
        done(folder.path(), &["convert", name, "again.png", "--force"]);
        assert!(worst(&at("ours.png"), &at("again.png")) <= most, "{name}");
    }
    done(folder.path(), &["render", "a.ora", "-o", "rendered.png"]);
    assert_eq!(worst(&at("ours.png"), &at("rendered.png")), 0.0);
    done(folder.path(), &["convert", "a.ora", "deep.png", "--bits", "16", "--dpi", "300"]);
    assert_eq!(image::open(at("deep.png")).unwrap().color(), image::ColorType::Rgba16);
    done(folder.path(), &["render", "a.ora", "-o", "deep.tif", "--bits", "16"]);
    assert_eq!(image::open(at("deep.tif")).unwrap().color(), image::ColorType::Rgba16);
    done(folder.path(), &["render", "a.ora", "-o", "half.exr"]);
    done(folder.path(), &["render", "a.ora", "-o", "whole.exr", "--bits", "32"]);
    let told = |name: &str| done(folder.path(), &["info", "--json", name]);
    assert!(told("half.exr") != told("whole.exr"), "{}", told("whole.exr"));
    for wrong in [["a.exr", "8"], ["a.png", "32"], ["a.jpg", "16"]] {
        let said = said(folder.path(), &["render", "a.ora", "-o", wrong[0], "--bits", wrong[1]]);
        assert!(said.contains("bits a channel, not"), "{said}");
    }
    done(folder.path(), &["convert", "a.ora", "fine.png", "--layers", "--bits", "16"]);
    assert_eq!(image::open(at("fine-01-tint-ü.png")).unwrap().color(), image::ColorType::Rgba16);
    done(folder.path(), &["convert", "a.ora", "half.png", "--scale", "0.5"]);
    assert_eq!(image::image_dimensions(at("half.png")).unwrap(), (24, 20));
    done(folder.path(), &["convert", "a.ora", "each.png", "--layers"]);
    assert!(at("each-00-ground.png").exists() && at("each-01-tint-ü.png").exists());
}

#[test]
fn the_input_is_never_written_over_and_says_why() {
    let folder = folder();
    done(folder.path(), &["convert", "a.json", "a.ora"]);
    let before = std::fs::read(folder.path().join("a.ora")).unwrap();
    for to in ["a.ora", "./a.ora"] {
        assert!(
            said(folder.path(), &["convert", "a.ora", to])
                .contains("an open document was made from it")
        );
    }
    assert!(said(folder.path(), &["convert", "a.ora", "a.gif"]).contains(".png"));
    assert!(said(folder.path(), &["convert", "no.ora", "b.ora"]).contains("no.ora"));
    assert_eq!(std::fs::read(folder.path().join("a.ora")).unwrap(), before);
}

#[test]
fn info_lists_the_layers_of_documents() {
    let folder = folder();
    for name in ["a.ora", "a.psd"] {
        done(folder.path(), &["convert", "a.json", name]);
        let json: serde_json::Value =
            serde_json::from_str(&done(folder.path(), &["info", "--json", name])).unwrap();
        let document = &json["documents"][0];
        assert_eq!(
            (document["width"].as_u64(), document["whole"].as_bool()),
            (Some(48), Some(true))
        );
        let kinds: Vec<_> = document["layers"]
            .as_array()
            .unwrap()
            .iter()
            .map(|l| l["kind"].as_str().unwrap())
            .collect();
        assert_eq!(kinds, ["pixels", "gradient", "pixels", "group"]);
        assert!(
            done(folder.path(), &["info", name]).contains("“tint ü”: gradient, multiply, 50 %")
        );
    }
}

/// Runs another program on our file; returns its result, or `None` with a message if the program is
/// missing.
fn other(folder: &Path, program: &str, args: &[&str], made: &str) -> Option<std::path::PathBuf> {
    let run = Command::new(program).args(args).current_dir(folder).output();
    let made = folder.join(made);
    if run.is_err() || !made.exists() {
        eprintln!("skipped: {program} is not installed, or cannot run here");
        return None;
    }
    Some(made)
}

#[test]
fn krita_shows_our_projects_as_we_do() {
    let folder = folder();
    // Krita 5.1 takes every group of a Photoshop file for wholly opaque.
    let recipe = std::fs::read_to_string(folder.path().join("a.json")).unwrap();
    std::fs::write(
        folder.path().join("a.json"),
        recipe.replace(r#""screen", "opacity": 0.5"#, r#""screen""#),
    )
    .unwrap();
    done(folder.path(), &["convert", "a.json", "ours.png"]);
    for name in ["a.ora", "a.psd"] {
        done(folder.path(), &["convert", "a.json", name]);
        let args =
            ["-a", "timeout", "120", "krita", "--export", "--export-filename", "krita.png", name];
        let Some(made) = other(folder.path(), "xvfb-run", &args, "krita.png") else { return };
        let off = worst(&folder.path().join("ours.png"), &made);
        assert!(off <= 3.0, "{name}: {off}");
        std::fs::remove_file(made).unwrap();
    }
}

#[test]
fn psd_tools_reads_our_layers_as_we_do() {
    let folder = folder();
    done(folder.path(), &["convert", "a.json", "ours.png"]);
    done(folder.path(), &["convert", "a.json", "a.psd"]);
    let script = "import sys\nfrom psd_tools import PSDImage\np = PSDImage.open('a.psd')\n\
        names = [l.name for l in p.descendants()]\nassert names == ['ground', 'tint ü', 'g', 'in'], names\n\
        assert p[1].blend_mode.name == 'MULTIPLY' and p[1].opacity == 128\n\
        p.composite(force=True).save('made.png')";
    let Some(made) = other(folder.path(), "python3", &["-c", script], "made.png") else { return };
    let off = worst(&folder.path().join("ours.png"), &made);
    assert!(off <= 3.0, "{off}");
}

#[test]
fn image_magick_reads_our_merged_picture() {
    let folder = folder();
    done(folder.path(), &["convert", "a.json", "ours.png"]);
    done(folder.path(), &["convert", "a.json", "a.psd"]);
    let Some(made) = other(folder.path(), "convert", &["a.psd[0]", "PNG32:made.png"], "made.png")
    else {
        return;
    };
    let off = worst(&folder.path().join("ours.png"), &made);
    assert!(off <= 2.0, "{off}");
}

#[test]
fn gimp_shows_our_photoshop_files_as_we_do() {
    let folder = folder();
    done(folder.path(), &["convert", "a.json", "ours.png"]);
    done(folder.path(), &["convert", "a.json", "a.psd"]);
    let script = r#"(let* ((image (car (gimp-file-load RUN-NONINTERACTIVE "a.psd" "a.psd")))
        (shown (car (gimp-image-merge-visible-layers image CLIP-TO-IMAGE))))
        (file-png-save RUN-NONINTERACTIVE image shown "gimp.png" "gimp.png" 0 9 0 0 0 0 0))"#;
    let args = ["-i", "-d", "-f", "-s", "-b", script, "-b", "(gimp-quit 0)"];
    let Some(made) = other(folder.path(), "gimp-console", &args, "gimp.png") else { return };
    let off = worst(&folder.path().join("ours.png"), &made);
    assert!(off <= 3.0, "{off}");
}
