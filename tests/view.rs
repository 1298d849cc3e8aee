//! `rilievo view` as its users meet it: pictures of maps and recipes, and sentences where there is
//! nothing to show.

use super::program::program;
use image::{DynamicImage, Rgb, Rgba};
use std::fs;
use std::path::PathBuf;
use std::process::Output;
use tempfile::TempDir;

/// A folder with the maps of a ball (`ball_n.png`, `ball_depth.png`, `ball_mask.png`) and a recipe
/// with a gradient over it (`r.json`).
struct Desk(TempDir);

const SIDE: u32 = 96;

const RECIPE: &str = r##"{
    "surface": { "normal": { "file": "ball_n.png", "convention": "opengl" }, "depth": { "file": "ball_depth.png",
      "near": "low" } },
    "layers": [{ "name": "ground", "kind": "fill", "color": "#204060" },
               { "name": "ramp", "kind": "gradient", "from": [30.5, 48.5], "to": [66.5, 48.5],
                 "stops": [[0, "#000000"], [1, "#ffffff"]], "operator": { "kind": "normal", "alpha": 0.4 } }] }"##;

impl Desk {
    fn new() -> Self {
        let desk = Desk(tempfile::tempdir().unwrap());
        let sphere = |x: u32, y: u32| {
            let at = |i: u32| (i as f32 + 0.5 - SIDE as f32 / 2.0) / 36.0;
            let (x, y) = (at(x), -at(y));
            let z2 = 1.0 - x * x - y * y;
            (z2 > 0.0).then(|| [x, y, z2.sqrt()])
        };
        let word = |v: f32| (v * 65535.0).round() as u16;
        let normals = image::ImageBuffer::from_fn(SIDE, SIDE, |x, y| {
            Rgb(sphere(x, y)
                .map_or([word(0.5), word(0.5), 65535], |n| n.map(|c| word(c * 0.5 + 0.5))))
        });
        DynamicImage::ImageRgb16(normals).save(desk.path("ball_n.png")).unwrap();
        let depth = image::ImageBuffer::from_fn(SIDE, SIDE, |x, y| {
            image::Luma([sphere(x, y).map_or(65535, |n| word(0.9 * (1.0 - n[2])))])
        });
        DynamicImage::ImageLuma16(depth).save(desk.path("ball_depth.png")).unwrap();
        let mask = image::ImageBuffer::from_fn(SIDE, SIDE, |x, y| {
            image::Luma([if sphere(x, y).is_some() { 255u8 } else { 0 }])
        });
        mask.save(desk.path("ball_mask.png")).unwrap();
        fs::write(desk.path("r.json"), RECIPE).unwrap();
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// `rilievo view FILES -o OUT …`
    fn view(&self, files: &[&str], out: &str, more: &[&str]) -> Output {
        let mut command = program();
        command.args(["view", "--force"]).args(files.iter().map(|f| self.path(f)));
        command.arg("-o").arg(self.path(out)).args(more).output().unwrap()
    }

    fn shown(&self, files: &[&str], more: &[&str]) -> image::RgbaImage {
        let output = self.view(files, "out.png", more);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        image::open(self.path("out.png")).unwrap().to_rgba8()
    }
}

/// Exit code 1 and one sentence with all of these words.
fn refused(output: &Output, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.trim_end().lines().count(), 1, "{said}");
    words.iter().for_each(|word| assert!(said.contains(word), "{said}\n  lacks {word}"));
}

const MAPS: [&str; 2] = ["ball_n.png", "ball_depth.png"];

#[test]
fn loose_maps_are_told_apart_by_their_names() {
    let desk = Desk::new();
    let Rgba([r, g, b, a]) = *desk.shown(&MAPS, &["--show", "normals"]).get_pixel(48, 14);
    assert!(r.abs_diff(128) < 8 && g > 240 && b < 200 && a == 255, "{r} {g} {b} {a}");
    assert!(desk.shown(&MAPS, &["--show", "depth"]).get_pixel(48, 48).0[0] < 5);
    let mask = desk.shown(&[MAPS[0], MAPS[1], "ball_mask.png"], &["--show", "mask"]);
    assert_eq!([mask.get_pixel(2, 2).0[0], mask.get_pixel(48, 48).0[0]], [0, 255]);
}

#[test]
fn a_convex_ball_is_blue_and_the_scale_says_how_soon() {
    let desk = Desk::new();
    let center = |scale: &str| {
        let shown =
            desk.shown(&MAPS, &["--show", "curvature", "--curvature-scale", scale, "--blur", "0"]);
        shown.get_pixel(48, 48).0
    };
    let ([r0, _, b0, _], [r1, _, b1, _]) = (center("0"), center("60"));
    assert!(r0 > b0 && b1 > r1, "yellow at no scale, blue at a large one");
}

#[test]
fn a_folder_gets_every_view_and_a_file_the_sheet() {
    let desk = Desk::new();
    fs::create_dir(desk.path("all")).unwrap();
    assert!(desk.view(&["r.json"], "all", &[]).status.success());
    let mut names: Vec<String> = fs::read_dir(desk.path("all"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let all = "clay contours curvature-gray curvature depth directions flow-depth flow-normals flow-operator lit mask \
               normals objects weights";
    let mut expected: Vec<String> = all.split(' ').map(|name| format!("{name}.png")).collect();
    expected.sort();
    assert_eq!(names, expected);
    let sheet = desk.shown(&["r.json"], &[]);
    assert_eq!(sheet.dimensions(), (4 * (SIDE + 8) + 8, 4 * (SIDE + 8) + 8));
}

#[test]
fn the_weights_of_a_layer_have_a_color_for_each_anchor() {
    let desk = Desk::new();
    let weights = desk.shown(&["r.json"], &["--show", "weights", "--layer", "ramp"]);
    let (Rgba([r0, _, b0, _]), Rgba([_, g1, b1, _])) =
        (*weights.get_pixel(20, 48), *weights.get_pixel(78, 48));
    assert!(b0 > r0 && g1 > b1);
}

#[test]
fn any_number_of_threads_shows_the_same() {
    let desk = Desk::new();
    let one = desk.shown(&["r.json"], &["--show", "flow-operator", "--threads", "1"]);
    let two = desk.shown(&["r.json"], &["--show", "flow-operator", "--threads", "2"]);
    assert!(one == two);
}

#[test]
fn what_cannot_be_shown_is_refused_in_a_sentence() {
    let desk = Desk::new();
    let show = |files: &[&str], more: &[&str]| desk.view(files, "out.png", more);
    refused(&show(&MAPS, &["--show", "weights"]), &["ball_n.png", "--show weights", "anchors"]);
    refused(
        &show(&["r.json"], &["--show", "weights", "--layer", "ground"]),
        &["ground", "no anchors"],
    );
    refused(&show(&["r.json"], &["--layer", "sky"]), &["--layer", "sky", "ramp"]);
    refused(&show(&["missing_n.png"], &[]), &["missing_n.png"]);
    refused(&show(&["ball_n.png", "ball_n.png"], &[]), &["same kind"]);
    refused(
        &desk.view(&MAPS, "ball_n.png", &["--show", "normals"]),
        &["ball_n.png", "an open document was made from it"],
    );
    assert_eq!(show(&MAPS, &["--show", "everything"]).status.code(), Some(2));
    assert_eq!(show(&MAPS, &["--blur", "-1"]).status.code(), Some(2));
}

#[test]
fn the_unwrapped_view_prints_the_layer_that_lays_its_picture_back() {
    let desk = Desk::new();
    let seen = desk.view(&["r.json"], "plane.png", &["--show", "unwrapped", "--scale", "2"]);
    assert!(seen.status.success(), "{}", String::from_utf8_lossy(&seen.stderr));
    let plane = image::open(desk.path("plane.png")).unwrap().to_rgba8();
    assert!(plane.width() > 2 * 90, "two pixels to one of the surface: {}", plane.width());
    let layer: serde_json::Value = serde_json::from_slice(&seen.stdout).unwrap();
    let mut recipe: serde_json::Value = serde_json::from_str(RECIPE).unwrap();
    recipe["version"] = 2.into();
    recipe["layers"] = serde_json::json!([layer]);
    fs::write(desk.path("back.json"), recipe.to_string()).unwrap();
    let rendered = |name: &str| {
        let mut command = program();
        let out = desk.path(name).with_extension("png");
        let output = command
            .args(["render", "--force"])
            .arg(desk.path(name))
            .arg("-o")
            .arg(&out)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        image::open(out).unwrap().to_rgba8()
    };
    let (before, after) = (rendered("r.json"), rendered("back.json"));
    let mask = image::open(desk.path("ball_mask.png")).unwrap().to_luma8();
    let (mut sum, mut count) = (0u32, 0);
    for (x, y, _) in mask.enumerate_pixels().filter(|(.., covered)| covered.0[0] > 0) {
        let (a, b) = (before.get_pixel(x, y).0, after.get_pixel(x, y).0);
        sum += (0..4).map(|c| u32::from(a[c].abs_diff(b[c]))).sum::<u32>();
        count += 4;
    }
    assert!(count > 4000 && sum <= 2 * count, "{sum} of 255 in {count} values");
}
