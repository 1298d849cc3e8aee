//! The program as its users meet it: the real binary, its pictures, its exit codes and its
//! sentences.

use super::program::program;
use rilievo_program::language::Language;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// A folder with a recipe and the files it names.
pub struct Desk(TempDir);

impl Desk {
    pub fn with(recipe: &str) -> Self {
        let desk = Desk(tempfile::tempdir().unwrap());
        fs::write(desk.path("r.json"), recipe).unwrap();
        let photo = image::RgbaImage::from_fn(100, 70, |x, y| {
            image::Rgba([
                (x * 2) as u8,
                (y * 3) as u8,
                ((x * y) % 256) as u8,
                if x < 10 { 0 } else { 255 },
            ])
        });
        photo.save(desk.path("photo.png")).unwrap();
        desk
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// `rilievo render r.json -o OUT …`
    pub fn render(&self, out: &str, more: &[&str]) -> Output {
        let mut command = rilievo(&["render"]);
        command.arg(self.path("r.json")).arg("-o").arg(self.path(out)).args(more);
        command.output().unwrap()
    }

    fn rendered(&self, out: &str, more: &[&str]) -> image::DynamicImage {
        let output = self.render(out, more);
        assert!(output.status.success(), "{}", said(&output));
        image::open(self.path(out)).unwrap()
    }
}

pub fn rilievo(args: &[&str]) -> Command {
    let mut command = program();
    command.args(args);
    command
}

pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Exit code 1 and one sentence with all of these words.
pub fn refused(output: &Output, words: &[&str]) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("rilievo: ") && said.trim_end().lines().count() == 1, "{said}");
    for word in words {
        assert!(said.contains(word), "{said}\n  lacks {word}");
    }
}

pub const PHOTO: &str = r#"{ "canvas": { "width": 100, "height": 70 },
    "layers": [{ "name": "photo", "kind": "image", "source": { "file": "photo.png" }, "filter": "bilinear" }] }"#;

const MANY: &str = r##"{ "canvas": { "width": 300, "height": 200 }, "layers": [
    { "kind": "fill", "color": "#336699" },
    { "name": "ramp", "kind": "gradient", "blend": "overlay", "from": [20, 30], "to": [250, 190],
      "stops": [[0, "#ff000040"], [0.5, "#00ff00"], [1, "#0000ff"]] },
    { "kind": "group", "opacity": 0.7, "layers": [
      { "kind": "image", "source": { "file": "photo.png" }, "blend": "multiply", "placement": { "scale": 0.6,
        "rotation": 20 } },
      { "kind": "strokes", "strokes": [{ "color": "#ffffff", "samples": [[20, 20], [280, 180]] }] }] }] }"##;

#[test]
fn an_image_of_the_canvas_size_read_by_one_tap_is_the_file() {
    let desk = Desk::with(PHOTO);
    let (picture, photo) =
        (desk.rendered("out.png", &[]).to_rgba8(), image::open(desk.path("photo.png")).unwrap());
    for (a, b) in picture.pixels().zip(photo.to_rgba8().pixels()) {
        assert!(a == b || (a[3] == 0 && b[3] == 0), "{a:?} {b:?}");
    }
}

#[test]
fn the_same_bytes_come_out_every_time_and_with_any_number_of_threads() {
    let desk = Desk::with(MANY);
    for format in ["png", "exr"] {
        let name = |i: usize| format!("{i}.{format}");
        for (i, threads) in ["1", "1", "2", "3"].iter().enumerate() {
            assert!(desk.render(&name(i), &["--threads", threads]).status.success());
        }
        let by_environment = rilievo(&["render"])
            .arg(desk.path("r.json"))
            .arg("-o")
            .arg(desk.path(&name(4)))
            .env("RAYON_NUM_THREADS", "1")
            .output()
            .unwrap();
        assert!(by_environment.status.success());
        let bytes: Vec<_> = (0..5).map(|i| fs::read(desk.path(&name(i))).unwrap()).collect();
        assert!(bytes.iter().all(|b| *b == bytes[0]), "{format}");
    }
}

#[test]
fn every_format_shows_the_same_picture() {
    let desk = Desk::with(MANY);
    let png = desk.rendered("a.png", &[]).to_rgb8();
    assert_eq!(desk.rendered("a.webp", &[]).to_rgb8(), png);
    let jpeg = desk.rendered("a.jpg", &["--quality", "100", "--background", "#ffffff"]).to_rgb8();
    let difference: u64 = jpeg.iter().zip(png.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    assert!(difference / (png.len() as u64) < 3, "{difference}");
    assert!(desk.render("a.exr", &[]).status.success());
}

#[test]
fn one_layer_alone_stands_on_nothing_or_on_a_background() {
    let desk = Desk::with(PHOTO);
    assert_eq!(desk.rendered("a.png", &["--layer", "photo"]).to_rgba8().get_pixel(3, 3)[3], 0);
    let on_red = desk.rendered("b.png", &["--background", "#ff0000"]).to_rgba8();
    assert_eq!(on_red.get_pixel(3, 3).0, [255, 0, 0, 255]);
    refused(
        &desk.render("c.png", &["--layer", "foto"]),
        &["--layer", "no layer is called “foto”", "“photo”"],
    );
}

/// The normal map of a sphere that touches the four sides, transparent around it.
fn save_sphere(path: &Path, side: u32) {
    let half = side as f32 / 2.0;
    let sphere = image::RgbaImage::from_fn(side, side, |x, y| {
        let (nx, ny) = ((x as f32 + 0.5) / half - 1.0, 1.0 - (y as f32 + 0.5) / half);
        let r2 = nx * nx + ny * ny;
        let byte = |n: f32| ((n + 1.0) * 127.5).round() as u8;
        let alpha = if r2 < 1.0 { 255 } else { 0 };
        image::Rgba([byte(nx), byte(ny), byte((1.0 - r2).max(0.0).sqrt()), alpha])
    });
    sphere.save(path).unwrap();
}

const ON_A_SPHERE: &str = r##"{ "surface": { "normal": { "file": "sphere.png" } }, "layers": [
    { "kind": "fill", "color": "#808080" },
    { "kind": "image", "source": { "file": "photo.png" }, "operator": { "kind": "normal", "alpha": 0.8 } }] }"##;

#[test]
fn the_canvas_takes_the_size_of_the_map_and_paint_stays_on_the_surface() {
    let desk = Desk::with(ON_A_SPHERE);
    save_sphere(&desk.path("sphere.png"), 48);
    let picture = desk.rendered("a.png", &[]).to_rgba8();
    assert_eq!(picture.dimensions(), (48, 48));
    assert_eq!((picture.get_pixel(0, 0)[3], picture.get_pixel(24, 24)[3]), (0, 255));
    let flat = Desk::with(&ON_A_SPHERE.replace("normal\", \"alpha\": 0.8", "none\""));
    save_sphere(&flat.path("sphere.png"), 48);
    assert_ne!(flat.rendered("a.png", &[]).to_rgba8(), picture, "the operator bends");
}

#[test]
fn a_painting_goes_onto_another_object_fitted_to_its_canvas() {
    let recipe = ON_A_SPHERE.replacen('{', r#"{ "canvas": { "width": 64, "height": 40 },"#, 1);
    let desk = Desk::with(&recipe);
    fs::create_dir(desk.path("elsewhere")).unwrap();
    let other = desk.path("elsewhere/other.png");
    save_sphere(&other, 20);
    // The recipe's own map is not even there.
    refused(&desk.render("a.png", &[]), &["surface", "sphere.png"]);
    let picture = desk.rendered("a.png", &["--normal", other.to_str().unwrap()]).to_rgba8();
    assert_eq!(picture.dimensions(), (64, 40));
    let alpha = |x, y| picture.get_pixel(x, y)[3];
    // 40 px high and centered, the sphere spans 12 … 52.
    assert_eq!((alpha(8, 20), alpha(15, 20), alpha(48, 20), alpha(55, 20)), (0, 255, 255, 0));
    refused(
        &desk.render("elsewhere/other.png", &["--normal", other.to_str().unwrap()]),
        &["an open document was made from it"],
    );
}

#[test]
fn a_scaled_picture_is_the_same_painting_at_another_size() {
    let desk = Desk::with(ON_A_SPHERE);
    save_sphere(&desk.path("sphere.png"), 128);
    let (small, large) = (desk.rendered("a.png", &["--scale", "0.5"]), desk.rendered("b.png", &[]));
    assert_eq!((small.width(), small.height()), (64, 64));
    // Red runs smoothly over the photo: a picture that is off by one pixel differs by 8 and more.
    let reduced = large.resize_exact(64, 64, image::imageops::FilterType::Triangle).to_rgba8();
    let both =
        small.to_rgba8().pixels().zip(reduced.pixels()).map(|(a, b)| (*a, *b)).collect::<Vec<_>>();
    let covered: Vec<_> = both.iter().filter(|(a, b)| a[3] == 255 && b[3] == 255).collect();
    let difference: u64 = covered.iter().map(|(a, b)| u64::from(a[0].abs_diff(b[0]))).sum();
    assert!(
        covered.len() > 2500 && difference < 3 * covered.len() as u64,
        "{difference} over {}",
        covered.len()
    );
    refused(
        &desk.render("c.png", &["--scale", "100", "--max-side", "5000"]),
        &["too large", "--max-side"],
    );
}

#[test]
fn what_is_refused_is_named_and_nothing_is_written() {
    let cases = [
        (r#"{ "canvas": "#, "c.png", vec!["r.json", "line 1 column"]),
        (
            r#"{ "layers": [], "canvas": { "width": 1 } }"#,
            "c.png",
            vec!["r.json", "canvas.height: is missing"],
        ),
        (PHOTO, "c.gif", vec!["c.gif", ".png, .exr, .jpg"]),
        (PHOTO, "no/c.png", vec!["no/c.png", "no folder"]),
        (PHOTO, "photo.png", vec!["photo.png", "an open document was made from it"]),
        (PHOTO, "c.jpg", vec!["c.jpg", "--background"]),
    ];
    for (recipe, out, words) in cases {
        let desk = Desk::with(recipe);
        let before = fs::read(desk.path("photo.png")).unwrap();
        refused(&desk.render(out, &[]), &words);
        assert_eq!(fs::read(desk.path("photo.png")).unwrap(), before);
        assert_eq!(fs::read_dir(desk.0.path()).unwrap().count(), 2, "nothing is left behind");
    }
}

#[test]
fn a_recipe_reads_nothing_outside_its_folder() {
    let desk = Desk::with(PHOTO);
    let inner = desk.path("inner");
    fs::create_dir(&inner).unwrap();
    let absolute = desk.path("photo.png").display().to_string();
    for name in ["../photo.png", absolute.as_str(), "C:/photo.png", "..\\\\photo.png", "link.png"] {
        fs::write(inner.join("r.json"), PHOTO.replace("photo.png", name)).unwrap();
        #[cfg(unix)]
        let _ = std::os::unix::fs::symlink("../photo.png", inner.join("link.png"));
        let output = rilievo(&["render"])
            .arg(inner.join("r.json"))
            .arg("-o")
            .arg(desk.path("c.png"))
            .output()
            .unwrap();
        refused(&output, &["layers[0].source.file"]);
        assert!(!desk.path("c.png").exists());
    }
}

#[test]
fn hostile_files_are_refused_without_a_panic() {
    let desk = Desk::with(PHOTO);
    let png = fs::read(desk.path("photo.png")).unwrap();
    let mut promising = png.clone();
    promising[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
    for bytes in [&png[..png.len() / 2], &promising, b"", b"\x89PNG\r\n\x1a\n", b"GIF89a"] {
        fs::write(desk.path("photo.png"), bytes).unwrap();
        refused(&desk.render("c.png", &[]), &["layers[0].source.file", "photo.png"]);
    }
    fs::remove_file(desk.path("photo.png")).unwrap();
    refused(&desk.render("c.png", &[]), &["photo.png", "No such file"]);
    fs::create_dir(desk.path("photo.png")).unwrap();
    refused(&desk.render("c.png", &[]), &["photo.png", "is a folder"]);
}

#[test]
fn a_ceiling_may_be_lowered_and_raised() {
    let desk = Desk::with(PHOTO);
    refused(&desk.render("c.png", &["--max-side", "99"]), &["too large", "--max-side"]);
    refused(&desk.render("c.png", &["--max-pixels", "6999"]), &["too large", "--max-pixels"]);
    assert!(desk.render("c.png", &["--max-side", "100", "--max-pixels", "7000"]).status.success());
}

#[test]
fn a_misuse_of_the_command_line_has_its_own_exit_code() {
    for args in [
        &["render"][..],
        &["paint"],
        &["render", "a", "-o", "b", "--quality", "0"],
        &["render", "a", "-o", "b", "--mask", "m"],
    ] {
        assert_eq!(rilievo(args).output().unwrap().status.code(), Some(2), "{args:?}");
    }
    for args in [&["--help"][..], &["--version"], &["render", "--help"]] {
        assert_eq!(rilievo(args).output().unwrap().status.code(), Some(0), "{args:?}");
    }
}

/// With a window it would open one.
#[cfg(not(feature = "gui"))]
#[test]
fn without_words_the_help_is_shown() {
    assert_eq!(rilievo(&[]).output().unwrap().status.code(), Some(0));
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let map = concat!(env!("CARGO_MANIFEST_DIR"), "/sample_normals/medal/normal.png");
    let mut child = rilievo(&["info", map]).stdout(std::process::Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
}

#[cfg(unix)]
#[test]
fn paths_need_not_be_utf8() {
    use std::os::unix::ffi::OsStrExt;
    let desk = Desk::with(PHOTO);
    let odd = desk.path("").join(std::ffi::OsStr::from_bytes(b"caf\xe9"));
    fs::create_dir(&odd).unwrap();
    for name in ["r.json", "photo.png"] {
        fs::copy(desk.path(name), odd.join(name)).unwrap();
    }
    let output = rilievo(&["render"])
        .arg(odd.join("r.json"))
        .arg("-o")
        .arg(odd.join("out.png"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", said(&output));
    assert!(Path::new(&odd.join("out.png")).exists());
}

#[test]
fn a_mirror_of_nothing_is_refused_rather_than_painted_black() {
    let document = r##"{ "canvas": { "width": 20, "height": 20 }, "layers": [
        { "kind": "fill", "color": "#336699" }, { "kind": "shading", "model": "mirror" }] }"##;
    refused(
        &Desk::with(document).render("out.png", &[]),
        &["layers[1].environment", "mirror", "is missing"],
    );
    let hidden = document.replace(r#""model""#, r#""visible": false, "model""#);
    assert!(Desk::with(&hidden).render("out.png", &[]).status.success());
}

#[test]
fn a_part_whose_place_has_another_color_is_told_when_it_is_rendered() {
    let desk = Desk::with(
        r##"{ "format": "rilievo", "version": 2, "canvas": { "width": 100, "height": 70 },
        "surface": { "parts": [{ "id": "eye", "name": "Eye", "kind": "inflate",
          "outline": { "layer": "Flats", "color": "#fafafa", "at": [20.5, 35.5] } }] },
        "layers": [{ "kind": "pixels", "name": "Flats", "file": "flats.png" }] }"##,
    );
    let flats = |cx: i32| {
        image::RgbaImage::from_fn(100, 70, |x, y| {
            match (x as i32 - cx).pow(2) + (y as i32 - 35).pow(2) < 200 {
                true => image::Rgba([250, 250, 250, 255]),
                false => image::Rgba([0; 4]),
            }
        })
    };
    for (cx, is_lost) in [(20, false), (70, true)] {
        flats(cx).save(desk.path("flats.png")).unwrap();
        let output = desk.render("out.png", &["--force"]);
        assert!(output.status.success(), "{}", said(&output));
        assert_eq!(
            said(&output).contains("“Eye” takes the area of its color that is nearest"),
            is_lost,
            "{cx}"
        );
    }
}

/// The language of the locale is for people: what programs read stays as it is.
#[test]
fn what_programs_read_is_the_same_in_every_language() {
    let desk = Desk::with(MANY);
    let output = |language: &str, args: &[&str]| {
        let mut command = rilievo(args);
        command.env_remove("RILIEVO_LANGUAGE").env("LC_ALL", language);
        command.current_dir(desk.path("")).output().unwrap()
    };
    for args in [&["info", "r.json"][..], &["info", "--json", "r.json"]] {
        let english = output("C", args);
        for language in ["de_DE.UTF-8", "fr_FR.UTF-8", "es_ES.UTF-8", "ja_JP.UTF-8", "zh_CN.UTF-8"]
        {
            let other = output(language, args);
            assert_eq!(english.stdout, other.stdout, "{language} {args:?}");
        }
    }
    let german: HashMap<_, _> = Language::German.translated_texts().collect();
    let usage = german.get("Usage:").copied().unwrap_or("Usage:");
    for args in [&["--help"][..], &["render", "-h"], &["help", "view"]] {
        let help = output("de_DE.UTF-8", args);
        assert!(String::from_utf8_lossy(&help.stdout).contains(usage), "{args:?}: {help:?}");
    }
    let german = output("de_DE.UTF-8", &["info", "nowhere.json"]);
    assert_eq!(german.status.code(), Some(1));
    assert!(said(&german).starts_with("rilievo: nowhere.json"), "{}", said(&german));
}
