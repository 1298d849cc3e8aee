//! The examples of the library: each is a page, and draws what it says.

#[allow(dead_code, reason = "its `main` is not called here")]
#[path = "../examples/bend_gradient.rs"]
mod bend_gradient;
#[allow(dead_code, reason = "its `main` is not called here")]
#[path = "../examples/light_warping.rs"]
mod light_warping;
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
use rilievo::math::{vec2, vec3};
use rilievo::raster::{Picture, Plane};
use rilievo::shading::{Environment, Model, Shading};
use rilievo::{Document, Layer, Maps, Size, Surface};
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

/// A bump on a plane, under a sky of one color on the viewer's side and another behind.
fn bump_under(front: f32, behind: f32) -> Document {
    let normal = |x: usize, y: usize| {
        let p = (vec2(x as f32, y as f32) - 31.5) / 9.0;
        let slope = p * (-0.5 * p.length_squared()).exp();
        vec3(slope.x, -slope.y, 1.0).normalize()
    };
    let surface = Surface::new(Maps::from_normals(Plane::from_fn(Size::new(64, 64), normal)));
    // The middle of a latitude-longitude map is the side of the viewer.
    let texel = |i: usize| {
        let light = if (16..48).contains(&(i % 64)) { front } else { behind };
        [light, light, light, 1.0]
    };
    let sky = Picture::linear(Size::new(64, 32), (0..64 * 32).map(texel).collect()).unwrap();
    let mut matt = Shading::new(Model::DiffuseEnvironment);
    matt.environment = Some(Environment::new("sky".into(), sky));
    matt.features.scales[0].curvature_scale_px = 30.0;
    Document::over(surface.unwrap()).with_top(Layer::new("Matt", matt))
}

#[test]
fn light_warping_draws_lights_to_the_viewer_where_the_surface_is_convex() {
    let light = |front, behind| {
        let document = bump_under(front, behind);
        let picture = drawn(|file| light_warping::draw(&document, "Matt", file).unwrap());
        [rgb(&picture, 2, 2)[0], rgb(&picture, 32, 32)[0]]
    };
    // The same light from everywhere stays the same, however it is bent.
    let [plane, top] = light(0.5, 0.5);
    assert!(plane.abs_diff(188) <= 2 && top.abs_diff(188) <= 2, "{plane} and {top} of 188");
    // A top shows more of what lies behind the surface: brighter or darker, as that is.
    let [[plane, top], [plane_lit, top_lit]] = [light(0.5, 0.1), light(0.1, 0.5)];
    assert!(top + 6 < plane, "{top} on the bump, {plane} on the plane");
    assert!(top_lit > plane_lit + 6, "{top_lit} on the bump, {plane_lit} on the plane");
}

#[test]
fn the_warp_of_a_light_is_undone_by_its_reciprocal_and_keeps_all_solid_angles() {
    let (u, bend) = (vec2(0.6, 0.8), [1.7, 0.7]);
    let count = 4000;
    let mut sum = 0.0;
    for i in 0..count {
        let z = 1.0 - (2.0 * i as f32 + 1.0) / count as f32;
        let turn = 2.399_963 * i as f32;
        let l = ((1.0 - z * z).sqrt() * vec2(turn.cos(), turn.sin())).extend(z);
        let (shown, growth) = light_warping::warp(l, u, bend);
        let (back, shrink) = light_warping::warp(shown, u, bend.map(f32::recip));
        assert!(shown.is_normalized() && (z < -0.99 || back.distance(l) < 1e-3), "{l} {back}");
        assert!(z < -0.99 || (growth * shrink - 1.0).abs() < 1e-2, "{growth} {shrink}");
        sum += growth / count as f32;
    }
    assert!((sum - 1.0).abs() < 0.01, "{sum} of the whole sphere");
    assert_eq!(light_warping::lambda(9.0, 0.0), 1.0);
    let product = light_warping::lambda(9.0, 0.2) * light_warping::lambda(9.0, -0.2);
    assert!((product - 1.0).abs() < 1e-5, "{product}");
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
