//! The examples of the library: each is a page, and draws what it says.

#[allow(dead_code, reason = "its `main` is not called here")]
#[path = "../examples/bend_gradient.rs"]
mod bend_gradient;
#[allow(dead_code, reason = "its `main` is not called here")]
#[path = "../examples/paint_stroke.rs"]
mod paint_stroke;
#[allow(dead_code, reason = "its `main` is not called here")]
#[path = "../examples/render.rs"]
mod render;
#[allow(dead_code, reason = "its `main` is not called here")]
#[path = "../examples/shape_from_drawing.rs"]
mod shape_from_drawing;

use super::lines::files;
use image::RgbaImage;
use std::path::Path;

/// The picture that an example writes into a folder of its own.
fn drawn(draw: impl FnOnce(&Path)) -> RgbaImage {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("picture.png");
    draw(&file);
    image::open(&file).unwrap().into_rgba8()
}

/// The color at a pixel, without alpha.
fn rgb(picture: &RgbaImage, x: u32, y: u32) -> [i32; 3] {
    let [r, g, b, _] = picture.get_pixel(x, y).0.map(i32::from);
    [r, g, b]
}

#[test]
fn a_gradient_is_bent_over_a_ball() {
    let picture = drawn(|file| bend_gradient::bend(file).unwrap());
    assert_eq!(rgb(&picture, 4, 4), [236, 232, 224], "the ground beside the ball");
    // Bent by the knobs, the ramp changes along a line that it would not change along on a flat
    // canvas.
    let along: std::collections::HashSet<[i32; 3]> =
        (0..120).map(|i| rgb(&picture, 160 + i, 280 - i / 3)).collect();
    assert!(along.len() > 40, "{} colors", along.len());
}

#[test]
fn strokes_are_painted_on_waves_and_kept() {
    let picture = drawn(|file| paint_stroke::paint(file).unwrap());
    let is = |wanted: fn([i32; 3]) -> bool, y: std::ops::Range<u32>| {
        y.flat_map(|y| (0..512).map(move |x| (x, y)))
            .filter(|&(x, y)| wanted(rgb(&picture, x, y)))
            .count()
    };
    let red = is(|[r, g, b]| r > 2 * g && r > 2 * b, 80..280);
    let blue = is(|[r, g, b]| b > 3 * r / 2 && b > g, 240..440);
    assert!(red > 4000 && blue > 4000, "{red} red pixels and {blue} blue ones");
}

#[test]
fn a_drawing_in_flat_colors_becomes_a_lit_shape() {
    let picture = drawn(|file| shape_from_drawing::shape(file).unwrap());
    assert_eq!(picture.get_pixel(2, 2).0[3], 0, "nothing beside the drawing");
    // Lit from the upper right: one flat color is brighter there than at the lower left.
    let light = |x, y| rgb(&picture, x, y).into_iter().sum::<i32>();
    assert!(light(290, 150) > light(120, 290) + 60, "{} and {}", light(290, 150), light(120, 290));
}

#[test]
fn a_file_is_rendered_whole_and_its_top_layer_alone() {
    let folder = tempfile::tempdir().unwrap();
    let (recipe, picture) = (folder.path().join("r.json"), folder.path().join("r.png"));
    let text = r##"{ "canvas": { "width": 8, "height": 8 }, "layers": [
        { "kind": "fill", "color": "#804020" }, { "kind": "fill", "color": "#0000ff", "opacity": 0.0 } ] }"##;
    std::fs::write(&recipe, text).unwrap();
    render::render_file(&recipe, &picture).unwrap();
    let read = |file: &Path| image::open(file).unwrap().into_rgba8().get_pixel(3, 3).0;
    assert_eq!(read(&picture), [0x80, 0x40, 0x20, 255]);
    assert_eq!(read(&picture.with_extension("top.png"))[3], 0);
    // The document is never replaced by its picture.
    assert!(render::render_file(&recipe, &recipe).is_err());
}

#[test]
fn each_example_is_a_page_and_is_run_here() {
    let tests = include_str!("examples.rs");
    for path in files("examples", "rs") {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let lines = std::fs::read_to_string(&path).unwrap().lines().count();
        assert!(lines <= 60, "{name} has {lines} lines");
        assert!(tests.contains(&format!("examples/{name}")), "{name} is not run by a test");
    }
}
