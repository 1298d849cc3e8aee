//! SVG drawings through a session: opened, placed, saved, opened again.

use super::*;
use crate::math::Size;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="40">
    <ellipse cx="30" cy="20" rx="25" ry="15" fill="#c06030"/>
    <text x="12" y="26" font-size="16" fill="#ffffff">Rel</text></svg>"##;

#[test]
fn an_svg_opens_as_paint_is_given_a_shape_and_placed() {
    let folder = tempfile::tempdir().unwrap();
    let named = |name: &str| folder.path().join(name).to_string_lossy().replace('\\', "/");
    std::fs::write(named("drawing.svg"), DRAWING).unwrap();
    let mut session = Session::default();
    let script = format!(
        r#"{{"in":"file","do":"open","file":"{0}"}}
{{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}}
{{"in":"file","do":"place","file":"{0}","at":[30,20]}}
{{"in":"file","do":"save","file":"{1}"}}
{{"in":"file","do":"open","file":"{1}"}}"#,
        named("drawing.svg"),
        named("drawing.ora")
    );
    session.replay(Path::new("story"), &script).unwrap_or_else(|e| panic!("{e}"));
    let [made, read] = &session.open_documents[..] else { panic!("there are not two documents") };
    assert_eq!(made.document().size, Size::new(60, 40));
    assert!(made.document().surface.is_some(), "{:?}", session.notes);
    let image = |open: &OpenDocument| {
        let document = open.document();
        document.walk().into_iter().find_map(|(_, layer)| match &layer.content {
            Content::Image(live) => Some(live.params().source.picture.clone()),
            _ => None,
        })
    };
    assert!(image(made).is_some_and(|picture| picture.size.width >= 2048), "it is no image layer");
    assert!(image(made) == image(read), "the placed drawing came back changed");
}

const EMBLEM: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="240" height="240" viewBox="0 0 120 120">
    <clipPath id="half"><circle cx="60" cy="60" r="30"/></clipPath>
    <clipPath id="box"><rect x="60" y="0" width="60" height="120"/></clipPath>
    <g transform="translate(10 10)"><circle id="disc" cx="50" cy="50" r="50" fill="#c06030"/></g>
    <g clip-path="url(#half)"><rect id="bar" x="40" y="10" width="20" height="100" fill="#30c060"/></g>
    <g clip-path="url(#box)"><rect id="side" x="50" y="50" width="20" height="20" fill="#3060c0"/></g>
    <path id="line" d="M20 100 L100 100" fill="none" stroke="#101010" stroke-width="4"/></svg>"##;

fn open_svg(script: &str, svg: &str) -> (Session, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let named = |name: &str| folder.path().join(name).to_string_lossy().replace('\\', "/");
    std::fs::write(named("emblem.svg"), svg).unwrap();
    let mut session = Session::default();
    let script = script.replace("FILE", &named("emblem.svg")).replace("OUT", &named("out.ora"));
    session.replay(Path::new("story"), &script).unwrap_or_else(|e| panic!("{e}"));
    (session, folder)
}

#[test]
fn each_filled_path_of_an_svg_is_the_outline_of_a_part() {
    let script = r#"{"in":"file","do":"open","file":"FILE"}
{"in":"part","do":"shape paths","layer":"0","file":"FILE","preset":"pillow"}
{"in":"file","do":"save","file":"OUT"}
{"in":"file","do":"open","file":"OUT"}"#;
    let (session, _folder) = open_svg(script, EMBLEM);
    assert!(session.notes.is_empty(), "{:?}", session.notes);
    let [made, read] = &session.open_documents[..] else { panic!("there are not two documents") };
    let document = made.document();
    assert_eq!(document.difference(read.document()), None);
    let names: Vec<&str> = document.parts.list.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["disc", "bar", "side"]);
    let group = document.layers[0].content.group().unwrap();
    let kinds: Vec<_> =
        group.layers.iter().map(|l| (l.name.as_str(), l.content.kind_name())).collect();
    // A straight clip is in the path; a round one is the frame of a group.
    assert_eq!(kinds, [("disc", "image"), ("bar", "group"), ("side", "image"), ("line", "image")]);
    // It looks as the SVG does.
    let seen = |id: usize| {
        let shown = document.layers[0].content.group().unwrap().layers[id].id;
        crate::document::flatten_layer(document, shown, &Progress::default()).unwrap()
    };
    let bar = seen(1);
    assert_eq!([bar.pixel(100, 62)[3], bar.pixel(100, 70)[3], bar.pixel(100, 180)[3]], [0, 255, 0]);
    let side = seen(2);
    assert_eq!([side.pixel(119, 120)[3], side.pixel(120, 120)[3]], [0, 255]);
    // The disc is a half sphere, except where others lie on it.
    let surface = document.surface.as_ref().unwrap();
    let (mut sum, mut count) = (0.0, 0);
    for (x, y) in (0..240).flat_map(|y| (0..80).map(move |x| (x, y))) {
        let (dx, dy) = ((x as f32 + 0.5 - 120.0) / 100.0, (y as f32 + 0.5 - 120.0) / 100.0);
        let rest = 1.0 - dx * dx - dy * dy;
        if rest > 0.02 {
            let wanted = crate::math::vec3(dx, -dy, rest.sqrt());
            sum += surface.normal(x, y).dot(wanted).min(1.0).acos().to_degrees();
            count += 1;
        }
    }
    let mean = sum / count as f32;
    assert!(mean < 1.0, "{mean}°");
}

#[test]
fn what_paths_cannot_show_stays_a_picture_over_hidden_outlines() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="80" height="60">
        <linearGradient id="r"><stop stop-color="#ff0000"/>
        <stop offset="1" stop-color="#0000ff"/></linearGradient>
        <circle id="ball" cx="40" cy="30" r="25" fill="url(#r)"/></svg>"##;
    let script = r#"{"in":"file","do":"open","file":"FILE"}
{"in":"part","do":"shape paths","layer":"0","file":"FILE","preset":"tube"}"#;
    let (session, _folder) = open_svg(script, svg);
    let document = session.active().unwrap().document();
    let layers: Vec<_> = document.layers.iter().map(|l| (l.name.as_str(), l.visible)).collect();
    assert_eq!(layers[0], ("Outlines", false));
    assert_eq!(document.layers[1].content.kind_name(), "pixels");
    assert_eq!(document.parts.list.len(), 1);
    assert!(document.surface.is_some(), "{:?}", session.notes);
    // The image layer of an SVG holds its file; other layers hold none.
    let script = r##"{"in":"file","do":"new","width":160,"height":120,"background":"#ffffff"}
{"in":"part","do":"shape paths","layer":"0","preset":"pillow"}
{"in":"file","do":"place","file":"FILE","at":[80,60]}
{"in":"part","do":"shape paths","layer":"1","preset":"pillow"}"##;
    let (session, _folder) = open_svg(script, svg);
    assert_eq!(session.notes, ["This layer is no SVG drawing, so it has no paths."]);
    assert_eq!(session.active().unwrap().document().parts.list.len(), 1);
}

#[test]
fn the_ground_of_a_drawing_is_no_part_of_it() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="80" height="60">
        <rect id="ground" width="80" height="60" fill="#e0e0d0"/>
        <circle id="ball" cx="40" cy="30" r="25" fill="#c04040"/></svg>"##;
    let script = r#"{"in":"file","do":"open","file":"FILE"}
{"in":"part","do":"shape paths","layer":"0","file":"FILE","preset":"pillow"}"#;
    let (session, _folder) = open_svg(script, svg);
    let parts = |session: &Session| -> Vec<String> {
        let document = session.active().unwrap().document();
        document.parts.list.iter().map(|part| part.name.clone()).collect()
    };
    assert_eq!(parts(&session), ["ball"], "{:?}", session.notes);
    let alone = svg.replace(r##"<circle id="ball" cx="40" cy="30" r="25" fill="#c04040"/>"##, "");
    let (session, _folder) = open_svg(script, &alone);
    assert_eq!(parts(&session), ["ground"], "there is no other");
}

#[test]
fn the_outline_of_a_part_is_the_exact_area_of_its_path() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="64" height="48">
        <clipPath id="c"><path d="M4.3 3 L60 9.1 L31.4 47 Z"/></clipPath>
        <g clip-path="url(#c)"><path id="ring" fill="#c04040" fill-opacity="0.6" fill-rule="evenodd"
            d="M6.2 5.1 L57.7 3.4 L50.3 40.9 L9.9 44.6 Z M20 14.5 L33.3 16 L25.1 27.2 Z"/></g></svg>"##;
    let script = r#"{"in":"file","do":"open","file":"FILE"}
{"in":"part","do":"shape paths","layer":"0","file":"FILE","preset":"pillow"}"#;
    let (session, _folder) = open_svg(script, svg);
    let document = session.active().unwrap().document();
    let surface = document.surface.as_ref().unwrap();
    let scale = document.size.width as f32 / 64.0;
    let polygons: [&[(f32, f32)]; 3] = [
        &[(6.2, 5.1), (57.7, 3.4), (50.3, 40.9), (9.9, 44.6)],
        &[(20.0, 14.5), (33.3, 16.0), (25.1, 27.2)],
        &[(4.3, 3.0), (60.0, 9.1), (31.4, 47.0)],
    ];
    let is_within = |polygon: &[(f32, f32)], (x, y): (f32, f32)| {
        let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
        let crosses = |((ax, ay), (bx, by)): &(&(f32, f32), &(f32, f32))| {
            (*ay <= y) != (*by <= y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
        };
        sides.filter(crosses).count() % 2 == 1
    };
    let is_on_ring = |p: (f32, f32)| is_within(polygons[0], p) && !is_within(polygons[1], p);
    let is_in_clip = |p: (f32, f32)| is_within(polygons[2], p);
    let (mut most, mut edges) = (0.0f32, 0);
    for (x, y) in
        (0..document.size.height).flat_map(|y| (0..document.size.width).map(move |x| (x, y)))
    {
        let points = (0..1024).map(|i| {
            let (i, j) = ((i % 32) as f32, (i / 32) as f32);
            ((x as f32 + (i + 0.5) / 32.0) / scale, (y as f32 + (j + 0.5) / 32.0) / scale)
        });
        let points: Vec<(f32, f32)> = points.collect();
        let share = |is_inside: &dyn Fn((f32, f32)) -> bool| {
            points.iter().filter(|p| is_inside(**p)).count() as f32 / 1024.0
        };
        let is_edge = |share: f32| share > 0.0 && share < 1.0;
        // Where both have an edge in a pixel, their shares are multiplied.
        if is_edge(share(&is_on_ring)) && is_edge(share(&is_in_clip)) {
            continue;
        }
        let share = share(&|p| is_on_ring(p) && is_in_clip(p));
        let covered = f32::from(surface.coverage(x as usize, y as usize));
        most = most.max((covered - 255.0 * share).abs());
        edges += usize::from(is_edge(share));
    }
    assert!(edges > 150 && most < 6.0, "{most} of 255 at {edges} edges");
}
