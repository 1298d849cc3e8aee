//! Shading layers, and the pictures that they are made of.

use super::{Story, choose, command, drop_files, layers, press, session, until, window};
use egui_kittest::kittest::Queryable;
use rilievo::Content;

#[test]
fn every_shading_model_is_made_from_the_menu_and_shows_its_properties() {
    let mut harness = window();
    press(&mut harness, "Properties");
    for (name, shows) in [
        ("New soft plastic layer", "Add light at a point"),
        ("New painter's light layer", "Turning edge"),
        ("New painter's light layer", "Mood: Sunset"),
        ("New toon layer", "Tones"),
        ("New velvet layer", "Flatness"),
        ("New brushed metal layer", "Choose environment"),
        ("New painted ball layer", "Choose painted ball for hollows"),
        ("New mirror layer", "Choose environment"),
        ("New mirror layer", "Bounces"),
        ("New glass layer", "Index"),
        ("New layer lit by an environment", "Distance"),
        ("New ambient occlusion layer", "Distance"),
    ] {
        command(&mut harness, name);
        assert!(
            matches!(session(&harness).layer().unwrap().content, Content::Shading(_)),
            "{name}"
        );
        assert!(harness.query_all_by_label(shows).count() > 0, "{name} shows {shows}");
    }
    command(&mut harness, "New detail normals");
    assert!(harness.query_all_by_label("Roughness").count() > 0);
}

#[test]
fn every_look_is_offered_within_the_window_and_dresses_the_drawing() {
    let mut harness = window();
    let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/sample_normals/moonlight.json");
    drop_files(&mut harness, &[sample.as_ref()]);
    until(&mut harness, |harness| session(harness).shown_document().unwrap().surface.is_some());
    let (before, names) = (layers(&harness).len(), ["Oil sketch", "Gold", "Moonlight"]);
    command(&mut harness, "Looks…");
    let whole = harness.ctx.content_rect();
    let places = names.map(|name| harness.get_by_label(&format!("Look: {name}")).rect());
    for place in places {
        assert!(place.left() >= whole.left() && place.right() <= whole.right(), "{place:?}");
    }
    assert!(places[0].top() < places[1].top(), "the looks stand in rows");
    press(&mut harness, "Look: Oil sketch");
    assert_eq!(layers(&harness).len(), before + 1);
    assert_eq!(session(&harness).layer().unwrap().name, "Oil sketch");
}

fn environment(harness: &Story) -> Option<String> {
    match &session(harness).layer().unwrap().content {
        Content::Shading(live) => {
            live.params().environment.as_ref().map(|environment| environment.file.clone())
        }
        _ => None,
    }
}

#[test]
fn pictures_and_maps_are_read_beside_the_window_and_put_where_they_belong() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sky.png");
    let picture =
        image::RgbImage::from_fn(64, 32, |x, y| image::Rgb([(x * 4) as u8, (y * 8) as u8, 20]));
    picture.save(&file).unwrap();
    let mut harness = window();
    command(&mut harness, "New mirror layer");
    press(&mut harness, "Properties");
    press(&mut harness, "Choose environment");
    choose(&mut harness, &file);
    until(&mut harness, |harness| environment(harness).is_some_and(|file| file == "sky.png"));
    press(&mut harness, "Remove");
    assert_eq!(environment(&harness), None);
    drop_files(&mut harness, &[&file]);
    until(&mut harness, |harness| layers(harness).contains(&"sky".to_owned()));
}
