//! Shapes from the command line: what becomes of a drawing, and what is said about one that has no
//! shape.

use crate::cli::{Desk, PHOTO, refused, rilievo, said};
use std::process::Output;

/// The story of a blot that is given a shape.
pub const SHAPED_BLOT: &str = r##"{"in":"file","do":"new","width":180,"height":140,"background":"#ffffff"}
{"in":"layer","do":"add","kind":"paint"}
{"in":"hand","do":"preset","name":"hard-round"}
{"in":"hand","do":"size","to":50}
{"in":"pointer","do":"press","tool":"brush","pen":[60,60],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[110,80]]}
{"in":"pointer","do":"release"}
{"in":"part","do":"shape","layer":"1","preset":"pillow","flats":false}"##;

/// `rilievo shape FILE -o maps …`
fn shape(desk: &Desk, file: &str, more: &[&str]) -> Output {
    let mut command = rilievo(&["shape"]);
    command.arg(desk.path(file)).arg("-o").arg(desk.path("maps")).args(more).output().unwrap()
}

#[test]
fn a_shape_has_a_part_for_each_color_or_place_and_tells_what_has_none() {
    let desk = Desk::with(PHOTO);
    let picture = image::RgbaImage::from_fn(800, 600, |x, y| {
        let within =
            |cx: f32, cy: f32, r: f32| (x as f32 + 0.5 - cx).hypot(y as f32 + 0.5 - cy) < r;
        let eyes = [(300.0, 240.0, 40.0), (500.0, 240.0, 48.0), (400.0, 440.0, 3.4)];
        let is_eye = eyes.into_iter().any(|(cx, cy, r)| within(cx, cy, r));
        image::Rgba(match is_eye {
            true => [250, 250, 250, 255],
            false if within(400.0, 300.0, 240.0) => [230, 170, 90, 255],
            false => [0; 4],
        })
    });
    picture.save(desk.path("face.png")).unwrap();
    let parts = |more: &[&str], folder: &str| {
        let (face, out) = (desk.path("face.png"), desk.path(folder));
        let mut command = rilievo(&["shape"]);
        let output = command
            .arg(&face)
            .arg("--flats")
            .arg(&face)
            .arg("-o")
            .arg(&out)
            .args(more)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", said(&output));
        let ids = image::open(out.join("face_id.png")).unwrap().into_luma16();
        let known: std::collections::BTreeSet<u16> = ids.pixels().map(|id| id.0[0]).collect();
        (known.len() - 1, said(&output))
    };
    assert_eq!(parts(&[], "colors"), (2, String::new()));
    let (count, told) = parts(&["--areas"], "areas");
    assert_eq!(count, 3);
    assert!(told.contains("face.png: One area is left without a part"), "{told}");
    let alone = rilievo(&["shape", "face.png", "--areas", "-o", "maps"]).output().unwrap();
    assert_eq!(alone.status.code(), Some(2), "--areas is of flats: {}", said(&alone));
}

#[test]
fn a_drawing_of_one_color_or_of_nothing_is_refused_for_what_it_is() {
    let desk = Desk::with(PHOTO);
    let pictures = [
        ("red", [200, 30, 30, 255]),
        ("paper", [255; 4]),
        ("nothing", [0; 4]),
        ("faint", [255, 0, 0, 9]),
    ];
    for (name, color) in pictures {
        let file = format!("{name}.png");
        image::RgbaImage::from_pixel(64, 48, image::Rgba(color)).save(desk.path(&file)).unwrap();
        let why = if color[3] == 255 {
            "it has one color all over"
        } else {
            "nothing in it is opaque enough"
        };
        refused(&shape(&desk, &file, &[]), &[&file, why]);
        let flats = desk.path(&file);
        for more in [&["--areas"][..], &[]] {
            let more = [&["--flats", flats.to_str().unwrap()][..], more].concat();
            refused(&shape(&desk, &file, &more), &[&file, why]);
        }
    }
}

#[test]
fn a_shape_for_which_there_is_no_memory_is_refused_before_it_is_made() {
    let outline = "[[100, 100], [16000, 100], [16000, 16000], [100, 16000]]";
    let part = format!(
        r#"{{ "id": "a", "name": "A", "kind": "inflate", "outline": {{ "path": {outline} }} }}"#
    );
    let document = format!(
        r##"{{ "format": "rilievo", "version": 2, "canvas": {{ "width": 16384, "height": 16384 }},
        "surface": {{ "parts": [{part}] }}, "layers": [{{ "kind": "fill", "color": "#336699" }}] }}"##
    );
    let desk = Desk::with(&document);
    let begun = std::time::Instant::now();
    let output = desk.render("out.png", &["--max-memory", "400M"]);
    refused(
        &output,
        &[
            "r.json",
            "the shape of 1 part on 16384 × 16384 pixels takes",
            "of memory",
            "--max-memory",
        ],
    );
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
}

#[test]
fn a_part_for_which_there_is_no_memory_is_refused_where_it_is_made() {
    let desk = Desk::with(PHOTO);
    let told = |side: u32, limit: &str| {
        let save = serde_json::json!({ "in": "file", "do": "save", "file": desk.path("new.ora") });
        let story = format!(
            r##"{{"in":"file","do":"new","width":{side},"height":{side},"background":"#ffffff"}}
{{"in":"part","do":"add","kind":"sphere"}}
{{"in":"part","do":"add","kind":"touches"}}
{save}
"##
        );
        std::fs::write(desk.path("story.jsonl"), story).unwrap();
        let mut command = rilievo(&["replay", "--force", "--max-memory", limit]);
        let output = command.arg(desk.path("story.jsonl")).output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
        let info = rilievo(&["info"]).arg(desk.path("new.ora")).output().unwrap();
        (said(&output), String::from_utf8(info.stdout).unwrap())
    };
    let (said, info) = told(3000, "300M");
    assert!(
        said.contains("Too large: the shape of 1 part on 3000 × 3000 pixels takes")
            && said.contains("Nothing was changed.")
            && said.contains("No part is selected"),
        "{said}"
    );
    assert!(!info.contains("on a surface"), "{info}");
    let (said, info) = told(128, "300M");
    assert!(said.is_empty() && info.contains("on a surface"), "{said}{info}");
}

#[test]
fn a_shape_that_has_room_only_once_is_saved() {
    let sphere = |i: usize| {
        let (x, y) = (130 + i % 8 * 250, 200 + i / 8 * 400);
        format!(
            r#"{{ "id": "part-{}", "kind": "primitive", "shape": "sphere", "center": [{x}, {y}],
            "radius": 120 }}"#,
            i + 1
        )
    };
    let parts: Vec<String> = (0..40).map(sphere).collect();
    let desk = Desk::with(&format!(
        r##"{{ "format": "rilievo", "version": 2, "canvas": {{ "width": 2048, "height": 2048 }},
        "surface": {{ "parts": [{}] }}, "layers": [{{ "kind": "fill", "color": "#336699" }}] }}"##,
        parts.join(",")
    ));
    for name in ["new.ora", "new.psd"] {
        let open = serde_json::json!({ "in": "file", "do": "open", "file": desk.path("r.json") });
        let save = serde_json::json!({ "in": "file", "do": "save", "file": desk.path(name) });
        std::fs::write(desk.path("story.jsonl"), format!("{open}\n{save}\n")).unwrap();
        let mut command = rilievo(&["replay", "--force", "--max-memory", "500M"]);
        let output = command.arg(desk.path("story.jsonl")).output().unwrap();
        assert!(output.status.success(), "{name}: {}", said(&output));
        let info = rilievo(&["info"]).arg(desk.path(name)).output().unwrap();
        let info = String::from_utf8(info.stdout).unwrap();
        assert!(info.contains("on a surface"), "{name}: {info}");
    }
}
