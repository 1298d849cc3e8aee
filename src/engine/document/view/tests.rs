use super::*;
use crate::document::{Content, Layer, Live};
use crate::math::{Size, Vec3, srgb::Color, vec2, vec3};
use crate::paint::gradient::GradientStop;
use crate::paint::{Adjust, Gradient, ImageFilter, PictureSource, PlacedImage};
use crate::raster::Outside;
use crate::raster::picture::Texels;
use crate::surface::{Maps, Operator};
use std::sync::Arc;

/// A ball of radius 60 px in the middle, with a gradient layer called "ramp".
fn ball() -> Document {
    let size = Size::new(160, 160);
    let normals = Plane::from_fn(size, |x, y| {
        let (x, y) = ((x as f32 - 79.5) / 60.0, (79.5 - y as f32) / 60.0);
        let z2 = 1.0 - x * x - y * y;
        if z2 > 0.0 { vec3(x, y, z2.sqrt()) } else { Vec3::ZERO }
    });
    let depth = normals.map(|n| 1.0 - n.z);
    let coverage = normals.map(|n| if n == Vec3::ZERO { 0 } else { 255 });
    let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
    let stop = |t, color| GradientStop { t, color };
    let gradient = Gradient {
        from: vec2(50.5, 80.5),
        to: vec2(110.5, 80.5),
        stops: vec![stop(0.0, Color::BLACK), stop(1.0, Color::WHITE)],
        operator: Operator::Normal { alpha: 0.5, beta: 1.0, detail: 0.0 },
        filter: ImageFilter::Bilinear,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    let layer = Layer::new("ramp", Content::Gradient(Live::new(gradient)));
    Document {
        surface: Some(Arc::new(surface)),
        layers: vec![Arc::new(layer)],
        ..Document::empty(size)
    }
}

fn pixel(picture: &Picture, x: usize, y: usize) -> [u8; 4] {
    let Texels::Srgb8(texels) = &picture.texels else { panic!("views are encoded bytes") };
    texels[y * picture.size.width as usize + x]
}

fn render(view: SurfaceView) -> Picture {
    draw(&ball(), None, view, &ViewOptions::default()).unwrap()
}

#[test]
fn every_view_has_a_name_of_its_own_and_a_picture_of_the_canvas() {
    for (view, name) in SurfaceView::ALL {
        assert_eq!(SurfaceView::from_name(name), Some(view));
        assert_eq!(view.name(), name);
        if !view.is_of_nothing() && view != SurfaceView::Unwrapped {
            assert_eq!(render(view).size, Size::new(160, 160), "{name}");
        }
    }
    assert_eq!(
        available(&ball(), None).len(),
        SurfaceView::ALL.len() - 2,
        "all but those that stand alone"
    );
}

#[test]
fn the_top_of_a_ball_shows_green_in_the_normals_and_is_near_in_the_middle() {
    let [r, g, ..] = pixel(&render(SurfaceView::Normals), 79, 25);
    assert!(g > 230 && r.abs_diff(128) < 6, "{r} {g}");
    assert!(pixel(&render(SurfaceView::Depth), 80, 80)[0] < 5);
    assert!(pixel(&render(SurfaceView::Depth), 80, 136)[0] > 130);
    assert_eq!(pixel(&render(SurfaceView::Normals), 3, 3)[3], 0);
    assert_eq!(pixel(&render(SurfaceView::Mask), 3, 3), [0, 0, 0, 255]);
}

#[test]
fn a_ball_is_convex_blue_and_light_and_lit_from_the_upper_left() {
    let options = ViewOptions { curvature_scale_px: 60.0, ..ViewOptions::default() };
    let [r, _, b, _] =
        pixel(&draw(&ball(), None, SurfaceView::Curvature, &options).unwrap(), 80, 80);
    assert!(b > r, "{r} {b}");
    assert!(
        pixel(&draw(&ball(), None, SurfaceView::CurvatureGray, &options).unwrap(), 80, 80)[0] > 200
    );
    let lit = render(SurfaceView::Lit);
    assert!(pixel(&lit, 55, 50)[0] > pixel(&lit, 105, 110)[0]);
}

#[test]
fn each_anchor_has_the_color_of_what_it_holds() {
    let weights = render(SurfaceView::Weights);
    let ([r0, _, b0, _], [_, g1, b1, _]) = (pixel(&weights, 30, 80), pixel(&weights, 130, 80));
    assert!(b0 > r0 && g1 > b1, "the first anchor is blue, the second green");
}

#[test]
fn what_cannot_be_shown_says_why() {
    let empty = Document::empty(Size::new(8, 8));
    let options = ViewOptions::default();
    assert_eq!(
        draw(&empty, None, SurfaceView::Depth, &options).err(),
        Some(ViewUnavailable::NoSurface)
    );
    assert_eq!(
        draw(&empty, None, SurfaceView::Weights, &options).err(),
        Some(ViewUnavailable::NoAnchoredLayer)
    );
    let fill = Layer::new("ground", Content::Fill(Color::BLACK));
    let refused =
        draw(&ball(), Some(&fill), SurfaceView::Weights, &options).err().map(|e| e.to_string());
    assert_eq!(
        refused.as_deref(),
        Some("the layer “ground” has no anchors; image and gradient layers have them")
    );
    assert!(available(&empty, None).is_empty());
}

#[test]
fn a_sheet_holds_every_picture_in_order() {
    let pictures = [
        render(SurfaceView::Mask),
        render(SurfaceView::Normals),
        render(SurfaceView::Depth),
        render(SurfaceView::Lit),
        render(SurfaceView::Mask),
    ];
    let sheet = sheet(&pictures).unwrap();
    assert_eq!(sheet.size, Size::new(4 * 168 + 8, 2 * 168 + 8));
    assert_eq!(pixel(&sheet, 8 + 80, 8 + 80), [255; 4]);
    assert_eq!(pixel(&sheet, 8 + 80, 8 + 168 + 80), [255; 4]);
    assert!(super::sheet(&[]).is_none());
}

/// The document with the picture of its planes as its only layer.
fn lay_back(document: &Document, seen: &UnwrappedPicture, filter: ImageFilter) -> Document {
    let source = PictureSource::new("plane.png".into(), seen.picture().unwrap(), Adjust::default());
    let image = PlacedImage {
        source,
        placement: seen.placement,
        outside: Outside::None,
        bend: seen.bend.clone(),
        filter,
        frame: Default::default(),
    };
    let layers = vec![Arc::new(Layer::new("print", Content::Image(Live::new(image))))];
    Document { layers, ..document.clone() }
}

/// The mean and the largest difference of two paintings inside the surface, of 255.
fn differences(a: &Document, b: &Document) -> (f64, u8) {
    let [a_pixels, b_pixels] =
        [a, b].map(|d| crate::document::flatten(d, &Progress::default()).unwrap());
    let surface = a.surface.as_deref().unwrap();
    let (mut sum, mut count, mut most) = (0.0, 0.0, 0);
    for (x, y) in (0..a.size.height).flat_map(|y| (0..a.size.width).map(move |x| (x, y))) {
        if surface.coverage(x as usize, y as usize) == 255 {
            let (a, b) = (a_pixels.pixel(x as i32, y as i32), b_pixels.pixel(x as i32, y as i32));
            for c in 0..4 {
                sum += f64::from(a[c].abs_diff(b[c]));
                count += 1.0;
                most = most.max(a[c].abs_diff(b[c]));
            }
        }
    }
    (sum / count, most)
}

#[test]
fn a_picture_of_the_unwrapped_plane_lies_on_the_surface_as_what_it_was_taken_from() {
    let document = ball();
    for scale in [1, 2, 4] {
        let seen = render_unwrapped(
            &document,
            None,
            UnwrapOptions { scale, ..Default::default() },
            &Progress::default(),
        );
        let seen = seen.unwrap();
        assert!(
            seen.size.width > 150 * scale,
            "a ball of 120 px is longer along its surface: {}",
            seen.size
        );
        for filter in [ImageFilter::Bilinear, ImageFilter::Antialias] {
            let (mean, most) = differences(&document, &lay_back(&document, &seen, filter));
            assert!(
                mean < 2.0,
                "scale {scale}, {filter:?}: {mean} of 255 in the mean, {most} at most"
            );
        }
    }
}
