//! Stories of strokes that stay on the part that they begin on.

use super::{open, shown_document, snowman, tell};
use crate::document::{Progress, flatten};
use crate::session::Session;

/// How many pixels of the body a stroke changes that begins on the head and goes down.
fn paint_streak(session: &mut Session) -> usize {
    let seen = |session: &Session| flatten(shown_document(session), &Progress::default()).unwrap();
    let before = seen(session);
    for line in [
        r##"{"in":"hand","do":"color","color":"#ffffff"}"##,
        r#"{"in":"hand","do":"size","to":10}"#,
        r#"{"in":"pointer","do":"press","tool":"brush","pen":[48,36],"px_per_pt":1}"#,
        r#"{"in":"pointer","do":"drag","pens":[[48,70],[48,100]]}"#,
        r#"{"in":"pointer","do":"release"}"#,
    ] {
        tell(session, line);
    }
    let after = seen(session);
    assert!(after.pixel(48, 40) != before.pixel(48, 40), "painted where it begins");
    let body = (66..110).flat_map(|y| (40..56).map(move |x| (x, y)));
    body.filter(|(x, y)| after.pixel(*x, *y) != before.pixel(*x, *y)).count()
}

#[test]
fn a_stroke_stays_on_the_part_it_begins_on_unless_it_may_cross() {
    let mut session = open(snowman(false));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}"#);
    assert_eq!(paint_streak(&mut session), 0);
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    tell(&mut session, r#"{"in":"hand","do":"across parts","on":true}"#);
    assert!(paint_streak(&mut session) > 100);
}

#[test]
fn sculpting_is_as_high_for_the_picture_on_every_canvas() {
    use crate::math::Size;
    use crate::tools::ShapeSettings;
    let first = ShapeSettings::default();
    let small = ShapeSettings::for_canvas(Size::new(320, 400));
    assert_eq!((small.size, small.height), (first.size, first.height));
    let large = ShapeSettings::for_canvas(Size::new(900, 1200));
    assert_eq!((large.size, large.height), (2.0 * first.size, 2.0 * first.height));
}
