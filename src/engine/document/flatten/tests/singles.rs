//! Layers drawn alone, one after the other.

use super::contours::cloth;
use super::*;
use crate::document::{Live, SingleLayers};
use crate::shading::{Model, Shading};

#[test]
fn every_layer_is_drawn_alone_as_it_is_of_the_whole_document() {
    let clay = || Layer::new("clay", Content::Shading(Live::new(Shading::new(Model::Phong))));
    let clipped = |layer: Layer| with(layer, |l| l.clip_below = true);
    let pale = |layer: Layer| with(layer, |l| l.opacity = 0.4);
    let inner = || {
        vec![
            fill("#204060"),
            cloth(vec3(0.3, 0.1, 1.0)),
            clipped(clay()),
            layer_left_of(30, "#ff8000"),
            clipped(cloth(vec3(0.0, 0.4, 1.0))),
            clipped(fill("#00ff0080")),
            clay(),
        ]
    };
    let layers = vec![
        fill("#ffffff"),
        clay(),
        clipped(cloth(vec3(-0.2, 0.2, 1.0))),
        pale(with(group(inner(), true), |l| l.mask = left_mask())),
        clipped(group(inner(), false)),
        cloth(vec3(0.2, 0.0, 1.0)),
        clipped(pale(clay())),
    ];
    let doc = Document { surface: Some(half_a_surface()), ..document(layers) };
    let singles = SingleLayers::of(&doc);
    let drawn = |document: &Document, id| {
        let tiles = flatten_layers(document, &[id], &Progress::default()).unwrap();
        tiles.to_straight_rgba(SIZE.rect())
    };
    let mut several = 0;
    for (path, layer) in doc.walk() {
        let opaque = |layer: &mut Layer| layer.opacity = 1.0;
        let whole = drawn(&doc.with_layer(layer.id, opaque).unwrap(), layer.id);
        assert!(
            drawn(&singles.isolate_layer(layer.id, opaque).unwrap(), layer.id) == whole,
            "{path}"
        );
        several += usize::from(whole.iter().any(|v| *v != 0));
    }
    assert!(several > 12, "{several} show something");
}

#[test]
fn a_fill_alone_is_one_tile_and_one_that_something_cuts_is_not() {
    let tiles = |document: &Document| {
        let grid = flatten(document, &Progress::default()).unwrap();
        let all: Vec<Arc<Tile>> = grid.iter().map(|(_, tile)| tile.clone()).collect();
        assert_eq!(all.len(), 4);
        all.iter().all(|tile| Arc::ptr_eq(tile, &all[0]))
    };
    assert!(tiles(&document(vec![fill("#2040607f")])));
    let masked = with(fill("#204060"), |l| l.mask = left_mask());
    let on = |layer: Layer| Document { surface: Some(half_a_surface()), ..document(vec![layer]) };
    assert_eq!(
        flatten(&document(vec![fill("#2040607f")]), &Progress::default()).unwrap().pixel(99, 69)[3],
        127
    );
    assert!(!tiles(&document(vec![fill("#204060"), with(fill("#ffffff"), |l| l.opacity = 0.5)])));
    let left = |document: &Document| {
        let grid = flatten(document, &Progress::default()).unwrap();
        [grid.pixel(10, 10)[3], grid.pixel(90, 10)[3]]
    };
    assert_eq!([left(&document(vec![masked])), left(&on(fill("#204060")))], [[255, 0]; 2]);
}
