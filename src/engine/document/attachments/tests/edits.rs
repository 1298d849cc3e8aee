//! Edits of parts, of their layers and of the canvas: what lies on parts stays on them.

use super::*;

#[test]
fn outlines_follow_their_layers_names_and_a_layer_on_its_own_part_inflates_once() {
    let outlined = Part::of_layer("body", "paint", Default::default());
    let flat = Document { layers: vec![Arc::new(on_body(paint()))], ..Document::empty(SIZE) };
    let shaped = flat.with_part(outlined);
    let id = shaped.layers[0].id;
    let moved = shifted(&shaped, BY);
    let (a, b) = (shaped.surface.as_ref().unwrap(), moved.surface.as_ref().unwrap());
    for (x, y) in (40..120).flat_map(|y| (50..150).map(move |x| (x, y))) {
        assert_eq!(
            a.coverage(x, y),
            b.coverage(x + BY.0 as usize, y + BY.1 as usize),
            "the part stands where its paint is"
        );
    }
    let renamed = moved.with_layer(id, |layer| layer.name = "Body".into()).unwrap();
    let named = renamed.reshaped();
    assert!(Arc::ptr_eq(named.surface.as_ref().unwrap(), b), "it is the same outline");
    assert!(named.with_part_at("body", 0).unwrap().surface.is_some());
}

#[test]
fn an_attachment_to_no_part_is_refused_and_lifted_in_another_document() {
    let stray = document(vec![Layer { on: Some(Attachment::on("nose")), ..paint() }]);
    assert_eq!(
        stray.fits(None).unwrap_err(),
        "“paint”: is attached to “nose”, but there is no such part."
    );
    let moved = shifted(&document(vec![on_body(paint())]), BY);
    let other = Document::empty(SIZE)
        .with_inserted(Layer::clone(&moved.layers[0]), LayerSlot::top_level(0))
        .unwrap();
    assert!(other.layers[0].on.is_none() && other.fits(None) == Ok(()));
    assert!(other.map_of(other.layers[0].id).unwrap().point(vec2(1.0, 2.0)) == vec2(38.0, 24.0));
}

#[test]
fn what_a_moved_part_changes_is_reported() {
    let layers = vec![
        Layer { clip_to_surface: false, ..on_body(paint()) },
        Layer { clip_to_surface: false, ..on_body(strokes("s", &path(), NORMAL)) },
    ];
    let before = document(layers);
    let id = before.layers[1].id;
    for after in [
        shifted(&before, (3, 0)),
        before.with_layer_on(id, None).unwrap(),
        before.without_part("body").unwrap(),
        shifted(&before, BY).with_transform_applied(id).unwrap(),
    ] {
        let (old, new) = (
            flatten(&before, &Progress::default()).unwrap(),
            flatten(&after, &Progress::default()).unwrap(),
        );
        let told = diff(&before, &after);
        let differs =
            |at: &TileAt| old.tile(*at).map(|t| t.bytes()) != new.tile(*at).map(|t| t.bytes());
        let missed: Vec<TileAt> =
            TileAt::covering(SIZE.rect()).filter(differs).filter(|at| !told.contains(at)).collect();
        assert!(missed.is_empty(), "{missed:?}");
    }
}

#[test]
fn on_a_larger_canvas_everything_lies_on_its_part_as_before() {
    let before = shifted(
        &document(vec![on_body(strokes("s", &path(), NORMAL)), on_body(gradient())]),
        (30, 10),
    );
    let twice = before.scaled(2.0).unwrap();
    let id = before.layers[0].id;
    let (a, b) = (before.map_of(id).unwrap(), twice.map_of(id).unwrap());
    assert!(b.point(vec2(80.0, 60.0)).distance(a.point(vec2(40.0, 30.0)) * 2.0) < 1e-3);
    assert!(picture(&before).iter().any(|v| *v > 0) && twice.fits(None) == Ok(()));
}
