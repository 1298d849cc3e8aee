//! A document's surface follows from its parts and layers.

use super::*;
use crate::document::{Content, Document, Layer, PixelLayer};
use crate::math::{Mat2, Size};
use crate::raster::TileGrid;
use crate::shape::{Body, SculptTool};

const SIZE: Size = Size::new(160, 120);

/// A layer with discs of flat colors, anti-aliased by counting.
fn discs(name: &str, discs: &[(Vec2, f32, [u8; 3])]) -> Layer {
    let mut rgba = vec![0u8; SIZE.area() * 4];
    for (i, pixel) in rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let corner = vec2((i % SIZE.width as usize) as f32, (i / SIZE.width as usize) as f32);
        let mut sum = [0.0f32; 4];
        for k in 0..16 {
            let p = corner + vec2((k % 4) as f32 + 0.5, (k / 4) as f32 + 0.5) / 4.0;
            if let Some((_, _, color)) = discs.iter().rev().find(|(c, r, _)| p.distance(*c) < *r) {
                (0..3).for_each(|c| sum[c] += f32::from(color[c]));
                sum[3] += 1.0;
            }
        }
        if sum[3] > 0.0 {
            (0..3).for_each(|c| pixel[c] = (sum[c] / sum[3]).round() as u8);
            pixel[3] = (sum[3] / 16.0 * 255.0).round() as u8;
        }
    }
    let tiles =
        TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0);
    Layer::new(name, Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }))
}

fn document(layers: Vec<Layer>) -> Document {
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(SIZE) }
}

fn inflated_part(id: &str, layer: &str) -> Arc<Part> {
    Arc::new(Part::of_layer(id, layer, Inflation::default()))
}

#[test]
fn a_layer_gets_a_shape_and_loses_it_with_its_parts() {
    let flat = document(vec![discs("Ink", &[(vec2(80.0, 60.0), 40.0, [200, 90, 40])])]);
    let shaped = flat.with_parts(vec![inflated_part("a", "Ink")]);
    let surface = shaped.surface.as_ref().unwrap();
    assert!(surface.normal(80, 60).z > 0.999 && surface.normal(45, 60).x < -0.7);
    assert!((surface.depth_range_px() - 40.0).abs() < 3.0, "{} px deep", surface.depth_range_px());
    assert!(shaped.with_parts(Vec::new()).surface.is_none());
    assert!(flat.with_parts(vec![inflated_part("a", "no such layer")]).surface.is_none());
}

#[test]
fn the_part_follows_its_layer_and_what_did_not_change_is_kept() {
    let flat = document(vec![
        discs("A", &[(vec2(50.0, 60.0), 30.0, [200, 90, 40])]),
        discs("B", &[(vec2(110.0, 60.0), 30.0, [20, 90, 40])]),
    ]);
    let shaped = flat.with_parts(vec![inflated_part("a", "A"), inflated_part("b", "B")]);
    assert!(Arc::ptr_eq(
        shaped.surface.as_ref().unwrap(),
        shaped.reshaped().surface.as_ref().unwrap()
    ));
    // A layer's name and opacity change no shape.
    let dimmed =
        shaped.with_layer(shaped.layers[0].id, |layer| layer.opacity = 0.3).unwrap().reshaped();
    assert!(Arc::ptr_eq(shaped.surface.as_ref().unwrap(), dimmed.surface.as_ref().unwrap()));
    let other = discs("B", &[(vec2(110.0, 60.0), 15.0, [20, 90, 40])]);
    let painted = shaped
        .with_layer(shaped.layers[1].id, |layer| layer.content = other.content)
        .unwrap()
        .reshaped();
    let surface = painted.surface.as_ref().unwrap();
    assert_eq!((surface.coverage(90, 60), surface.coverage(110, 60)), (0, 255));
    assert!(surface.normal(100, 60).x < -0.5);
}

#[test]
fn paint_that_changes_one_outline_leaves_the_forms_of_the_others() {
    let [orange, green, white] = [[200, 90, 40], [20, 90, 40], [240, 240, 230]];
    let (left, right) = ((vec2(50.0, 60.0), 30.0, orange), (vec2(118.0, 60.0), 25.0, green));
    let drawn = |more: &[(Vec2, f32, [u8; 3])]| discs("Flats", &[&[left, right], more].concat());
    let of = |id: &str, [r, g, b]: [u8; 3]| {
        let color = Some(Color { r, g, b, a: 255 }.into());
        let outline = OutlineSource::Layer { layer: "Flats".into(), color };
        Arc::new(Part::new(id, PartKind::Inflate { outline, inflation: Inflation::default() }))
    };
    let shaped = document(vec![drawn(&[])]).with_parts(vec![of("a", orange), of("b", green)]);
    let painted = |more: &[(Vec2, f32, [u8; 3])]| {
        let id = shaped.layers[0].id;
        shaped
            .with_layer(id, |layer| layer.content = drawn(more).content.clone())
            .unwrap()
            .reshaped()
    };
    let form = |document: &Document, id: &str| document.last_area(id).unwrap().1;
    let before = ["a", "b"].map(|id| form(&shaped, id));
    // A spot too small for a part changes nothing at all.
    let spot = painted(&[(vec2(50.0, 60.0), 1.5, white)]);
    assert!(Arc::ptr_eq(spot.surface.as_ref().unwrap(), shaped.surface.as_ref().unwrap()));
    assert!(Arc::ptr_eq(&before[0], &form(&spot, "a")));
    let larger = painted(&[(vec2(118.0, 60.0), 28.0, green)]);
    assert!(
        Arc::ptr_eq(&before[0], &form(&larger, "a"))
            && !Arc::ptr_eq(&before[1], &form(&larger, "b"))
    );
    let anew = larger.with_parts(Vec::new()).with_parts(larger.parts.list.clone());
    assert_eq!(
        anew.surface.unwrap().coverage_plane().values(),
        larger.surface.unwrap().coverage_plane().values()
    );
}

#[test]
fn colors_become_parts_and_what_bulges_into_another_lies_in_front() {
    let (body, eye, ear) = ([200, 120, 60], [250, 250, 250], [120, 60, 30]);
    let flats = discs(
        "Flats",
        &[
            (vec2(40.0, 30.0), 18.0, ear),
            (vec2(80.0, 65.0), 45.0, body),
            (vec2(95.0, 55.0), 9.0, eye),
        ],
    );
    let Content::Pixels(pixels) = &flats.content else { panic!("paint") };
    let parts = from_flats::parts_of_flats(
        &pixels.tiles,
        "Flats",
        Inflation::default(),
        from_flats::PartFor::Color,
    )
    .parts;
    let colors: Vec<String> = parts
        .iter()
        .map(|part| match part.outline() {
            Some(OutlineSource::Layer { color: Some(flat), .. }) => flat.color.to_string(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(colors, ["#783c1e", "#c8783c", "#fafafa"]);
    let shaped =
        document(vec![flats.clone()]).with_parts(parts.into_iter().map(Arc::new).collect());
    let surface = shaped.surface.as_ref().unwrap();
    assert_eq!(surface.objects().count(), 3);
    // The eye sticks out of the body, and its rim is its own.
    assert!(surface.depth(95, 55) < surface.depth(80, 65));
    assert!(surface.normal(88, 55).x < -0.4, "{}", surface.normal(88, 55));
}

#[test]
fn a_part_that_is_moved_by_whole_pixels_moves_its_surface_byte_for_byte() {
    let flat = document(vec![discs("A", &[(vec2(60.0, 50.0), 30.3, [200, 90, 40])])]);
    let still = inflated_part("a", "A");
    let moved = Part { matrix: Affine2::from_translation(vec2(21.0, 9.0)), ..Part::clone(&still) };
    let (a, b) = (flat.with_parts(vec![still]), flat.with_parts(vec![Arc::new(moved)]));
    let (a, b) = (a.surface.unwrap(), b.surface.unwrap());
    for (x, y) in (0..100).flat_map(|y| (0..130).map(move |x| (x, y))) {
        assert_eq!(a.coverage(x, y), b.coverage(x + 21, y + 9));
        if a.coverage(x, y) > 0 {
            assert_eq!(a.normal(x, y), b.normal(x + 21, y + 9), "({x}, {y})");
            assert_eq!(a.depth(x, y), b.depth(x + 21, y + 9), "({x}, {y})");
        }
    }
}

#[test]
fn every_kind_makes_a_surface() {
    let flat = document(vec![discs("A", &[(vec2(80.0, 60.0), 40.0, [200, 90, 40])])]);
    let layer = || OutlineSource::Layer { layer: "A".into(), color: None };
    let path = vec![vec2(20.0, 20.0), vec2(90.0, 25.0), vec2(60.0, 90.0)];
    let disc = flat.with_parts(vec![inflated_part("a", "A")]);
    let kinds = [
        PartKind::Inflate {
            outline: OutlineSource::Path(path),
            inflation: Inflation::PRESETS[2].0,
        },
        PartKind::Bevel { outline: layer(), bevel: Bevel::default() },
        PartKind::Primitive(Primitive::new(Body::Torus, vec2(70.0, 60.0), 30.0)),
        PartKind::Lathe { outline: layer(), axis: None, puff: 1.0 },
        PartKind::Sweep {
            balls: vec![
                Ball { at: vec2(30.0, 60.0), radius: 15.0 },
                Ball { at: vec2(120.0, 70.0), radius: 6.0 },
            ],
            puff: 1.0,
        },
    ];
    let shading = |light: Vec3| {
        let lit = |x: usize, y: usize| {
            let n = disc.surface.as_ref().unwrap().normal(x, y);
            let gray = (0.9 * n.dot(light.normalize())).max(0.0);
            if disc.surface.as_ref().unwrap().coverage(x, y) > 0 {
                crate::math::srgb::quantize(crate::math::srgb::encode(gray))
            } else {
                0
            }
        };
        let coverage = Arc::new(Plane::from_fn(SIZE, lit));
        ProfilePicture { picture: CoverageFile { file: "s.png".into(), coverage }, light }
    };
    let lights = [vec3(0.4, 0.0, 1.0), vec3(-0.3, 0.4, 1.0), vec3(0.0, -0.5, 1.0)];
    let maps = PartMaps {
        source: Arc::default(),
        files: Arc::default(),
        surface: disc.surface.clone().unwrap(),
    };
    let kinds = kinds.into_iter().chain([
        PartKind::Profiles { outline: None, shadings: lights.map(shading).to_vec() },
        PartKind::Maps(maps),
    ]);
    for kind in kinds {
        let name = kind.name();
        let shaped = flat.with_parts(vec![Arc::new(Part::new("p", kind))]);
        let surface = shaped.surface.unwrap_or_else(|| panic!("{name} has no surface"));
        assert!(surface.coverage_plane().values().contains(&255), "{name}");
        assert!(surface.normal_planes()[2].values().iter().all(|z| z.is_finite()), "{name}");
        if matches!(name, "profiles" | "maps") {
            // Both describe the same ball.
            let ball = disc.surface.as_ref().unwrap();
            for (x, y) in [(80, 60), (95, 55), (62, 70)] {
                let (a, b) = (ball.normal(x, y), surface.normal(x, y));
                assert!(a.distance(b) < 0.06, "{name} at {x}, {y}: {b} and not {a}");
            }
        }
    }
    // What lies on another part changes it.
    let touch =
        Touch { at: vec2(80.0, 60.0), radius: 4.0, normal: vec3(0.6, 0.0, 0.8), reach: 0.0 };
    let stroke = SculptStroke {
        tool: Default::default(),
        size: 20.0,
        hardness: 0.5,
        strength: 4.0,
        samples: vec![(vec2(70.0, 60.0), 1.0)],
    };
    let picture = Arc::new(Plane::from_fn(SIZE, |x, y| ((x * 31 + y * 17) % 200) as u8));
    let on = || "a".to_owned();
    let changes = [
        PartKind::Touches { on: on(), touches: vec![touch] },
        PartKind::Sculpt { on: on(), strokes: vec![stroke] },
        PartKind::Relief {
            on: on(),
            picture: CoverageFile { file: "p.png".into(), coverage: picture },
            detail: Detail::default(),
        },
        PartKind::Lines {
            on: on(),
            ink: OutlineSource::Path(vec![
                vec2(79.0, 45.0),
                vec2(81.0, 45.0),
                vec2(81.0, 75.0),
                vec2(79.0, 75.0),
            ]),
            lines: Lines::default(),
        },
    ];
    for kind in changes {
        let name = kind.name();
        let with = flat.with_parts(vec![inflated_part("a", "A"), Arc::new(Part::new("b", kind))]);
        let (before, after) = (disc.surface.as_ref().unwrap(), with.surface.unwrap());
        let changed = (60..100)
            .filter(|x| before.normal(*x, 60).distance(after.normal(*x, 60)) > 0.01)
            .count();
        assert!(changed > 5, "{name} changed {changed} of 40 pixels");
        if name == "touches" {
            assert!(
                (after.normal(80, 60) - vec3(0.6, 0.0, 0.8)).length() < 0.05,
                "{}",
                after.normal(80, 60)
            );
        }
    }
}

#[test]
fn maps_lie_beneath_all_parts() {
    let flat = document(vec![discs("A", &[(vec2(80.0, 60.0), 30.0, [200, 90, 40])])]);
    let plate = document(Vec::new()).with_parts(vec![Arc::new(Part::new(
        "plate",
        PartKind::Primitive(Primitive {
            half: vec3(70.0, 50.0, 10.0),
            ..Primitive::new(Body::Box, vec2(80.0, 60.0), 50.0)
        }),
    ))]);
    let on_maps = flat.with_maps(plate.surface.clone()).with_parts(vec![inflated_part("a", "A")]);
    let surface = on_maps.surface.as_ref().unwrap();
    assert_eq!((surface.coverage(20, 60), surface.coverage(80, 60)), (255, 255));
    assert!(surface.depth(80, 60) < surface.depth(20, 60));
    assert_eq!(surface.objects().count(), 2);
    assert!(Arc::ptr_eq(
        on_maps.with_parts(Vec::new()).surface.as_ref().unwrap(),
        plate.surface.as_ref().unwrap()
    ));
}

#[test]
fn numbers_beyond_their_range_and_ids_that_stand_twice_are_refused() {
    let flat = document(Vec::new());
    let wide = Inflation { puff: f32::NAN, ..Inflation::default() };
    let refused = |part: Part| flat.with_parts(vec![Arc::new(part)]).fits(None).unwrap_err();
    assert!(refused(Part::of_layer("a", "A", wide)).contains("puff"));
    assert!(
        refused(Part { raise: 1e9, ..Part::of_layer("a", "A", Inflation::default()) })
            .contains("raised")
    );
    assert!(
        flat.with_parts(vec![inflated_part("a", "A"), inflated_part("a", "B")])
            .fits(None)
            .unwrap_err()
            .contains("id")
    );
    assert_eq!(flat.with_parts(vec![inflated_part("a", "A")]).fits(None), Ok(()));
}

#[test]
fn maps_that_are_turned_show_the_turned_object_and_come_back_where_they_lay() {
    let ball = |at: Vec2, radius: f32| {
        let body = Primitive {
            half: vec3(radius, 0.6 * radius, radius),
            ..Primitive::new(Body::Ellipsoid, at, radius)
        };
        document(Vec::new()).with_part(Part::new("b", PartKind::Primitive(body))).surface.unwrap()
    };
    let maps = PartMaps {
        source: Arc::default(),
        files: Arc::default(),
        surface: ball(vec2(70.0, 60.0), 30.0),
    };
    let part = |matrix: Affine2| Part { matrix, ..Part::new("m", PartKind::Maps(maps.clone())) };
    let seen = |matrix| document(Vec::new()).with_part(part(matrix)).surface.unwrap();
    // By a quarter turn about the middle, and half as large again.
    let middle = vec2(70.0, 60.0);
    let turned = seen(
        Affine2::from_translation(middle)
            * Affine2::from_mat2(Mat2::from_cols_array(&[0.0, 1.5, -1.5, 0.0]))
            * Affine2::from_translation(-middle),
    );
    let was = seen(Affine2::IDENTITY);
    for (dx, dy) in [(0, 0), (12, 4), (-10, 7), (3, -9)] {
        let (x, y) = (70 + dx, 60 + dy);
        let before = was.normal(x as usize, y as usize);
        // Pixel centers: (dx + ½, dy + ½) goes to 1.5 (−dy − ½, dx + ½).
        let at = middle + 1.5 * vec2(-(dy as f32) - 0.5, dx as f32 + 0.5);
        let after = turned.normal(at.x as usize, at.y as usize);
        // Image axes turn; y of normals is up.
        let wanted = vec3(before.y, -before.x, before.z);
        assert!(after.distance(wanted) < 0.05, "({dx}, {dy}): {after} and not {wanted}");
    }
    assert!((turned.depth_range_px() / was.depth_range_px() - 1.5).abs() < 0.05);
    let moved = seen(Affine2::from_translation(vec2(21.0, -7.0)));
    assert_eq!(moved.normal(91, 53), was.normal(70, 60));
}

#[test]
fn a_share_of_the_way_stays_one_on_a_larger_canvas() {
    let stroke =
        |tool| SculptStroke { tool, size: 20.0, hardness: 0.5, strength: 0.3, samples: Vec::new() };
    let strokes = [SculptTool::Raise, SculptTool::Smooth].map(stroke).to_vec();
    let part = Part::new("s", PartKind::Sculpt { on: "a".into(), strokes });
    let PartKind::Sculpt { strokes, .. } = part.scaled(Vec2::splat(2.0), 2.0, Plane::clone).kind
    else {
        panic!()
    };
    assert_eq!(strokes.iter().map(|stroke| stroke.strength).collect::<Vec<_>>(), [0.6, 0.3]);
}
