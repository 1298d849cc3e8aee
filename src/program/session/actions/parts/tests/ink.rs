//! Stories of drawings with ink.

use super::{open, shown_document, snowman, tell};
use crate::document::{Document, Progress, flatten};
use crate::math::Size;
use crate::raster::{Picture, TileGrid};
use crate::session::Session;
use crate::session::actions::placing::of_picture;

const INK: [f32; 3] = [30.0, 24.0, 40.0];
const SIZE: Size = Size { width: 320, height: 240 };

/// A red and a green half of a disc with soft lines of 3 px around and between them, on nothing.
fn inked_drawing() -> Document {
    let texel = |i: usize| {
        let (x, y) = ((i % 320) as f32 + 0.5, (i / 320) as f32 + 0.5);
        let away = (x - 160.0).hypot(y - 120.0);
        let share = |v: f32| v.max(0.0).min(1.0);
        let ink = share(away - 96.5).max(share(2.0 - (x - 160.2).abs()));
        let flat = if x < 160.0 { [210.0, 60.0, 50.0] } else { [60.0, 160.0, 90.0f32] };
        let mixed = |c: usize| (flat[c] * (1.0 - ink) + INK[c] * ink).round() as u8;
        [mixed(0), mixed(1), mixed(2), (255.0 * share(100.0 - away)).round() as u8]
    };
    let texels = (0..SIZE.area()).map(texel).collect();
    of_picture("disc.png", Picture::srgb8(SIZE, texels).unwrap())
}

fn render(session: &Session) -> TileGrid {
    flatten(shown_document(session), &Progress::default()).unwrap()
}

fn shape(session: &mut Session) {
    tell(session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}"#);
    assert_eq!(session.notes, Vec::<String>::new());
}

#[test]
fn a_drawing_with_ink_gets_its_lines_on_top_as_they_were_drawn() {
    let mut session = open(inked_drawing());
    let before = render(&session);
    shape(&mut session);
    let names: Vec<&str> =
        shown_document(&session).layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["disc", "Light", "Ink"]);
    let lit = render(&session);
    let mut whole = 0;
    let mut changed = 0;
    for (x, y) in (0..240).flat_map(|y| (0..320).map(move |x| (x, y))) {
        let (was, is) = (before.pixel(x, y), lit.pixel(x, y));
        let off = (0..4).map(|c| was[c].abs_diff(is[c])).max().unwrap();
        if (0..3).all(|c| f32::from(was[c]) == INK[c]) && was[3] == 255 {
            whole += 1;
            assert!(off <= 1, "{x} {y}: {is:?} for {was:?}");
        }
        changed += usize::from(off > 8);
    }
    assert!(whole > 1000 && changed > 5000, "{whole} of ink, {changed} lit");
    tell(
        &mut session,
        r#"{"in":"layer","do":"set","layer":"1","to":{"do":"visible","on":false},"done":true}"#,
    );
    let unlit = render(&session);
    for (x, y) in (0..240).flat_map(|y| (0..320).map(move |x| (x, y))) {
        let (was, is) = (before.pixel(x, y), unlit.pixel(x, y));
        assert!((0..4).all(|c| was[c].abs_diff(is[c]) <= 1), "{x} {y}: {is:?} for {was:?}");
    }
}

#[test]
fn lines_of_a_drawing_without_ink_are_refused() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"ink","layer":"0"}"#);
    assert!(session.notes[0].starts_with("No ink"), "{:?}", session.notes);
    assert_eq!(shown_document(&session).layers.len(), 1);
}

#[test]
fn a_scan_becomes_lines_on_top_of_all_layers() {
    let texel = |i: usize| {
        let gray = if (i / 320) % 60 < 4 { 50 } else { 214 + (i * 7919 % 5) as u8 };
        [gray, gray, gray, 255]
    };
    let scan = Picture::srgb8(SIZE, (0..SIZE.area()).map(texel).collect()).unwrap();
    let mut session = open(of_picture("scan.png", scan));
    tell(&mut session, r#"{"in":"layer","do":"add","kind":"paint"}"#);
    tell(&mut session, r#"{"in":"part","do":"paper","layer":"0"}"#);
    assert_eq!(session.notes, Vec::<String>::new());
    let names: Vec<&str> =
        shown_document(&session).layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names.last(), Some(&"scan"));
    let seen = render(&session);
    assert!(
        seen.pixel(100, 30)[3] == 0 && seen.pixel(100, 62)[3] > 180,
        "{:?}",
        seen.pixel(100, 62)
    );
}
