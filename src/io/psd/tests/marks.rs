//! Guides and labels, to other programs and from them.

use super::made::{Made, colored_layer, plain};
use super::*;
use crate::document::LayerLabel;

/// Layers of every label, and guides between pixels.
fn marked_document() -> Document {
    let mut document = Document::empty(Size::new(64, 32));
    document.layers = (LayerLabel::ALL.iter())
        .map(|(label, name)| {
            let layer = Layer::new(*name, Content::Fill(crate::math::srgb::Color::BLACK));
            Arc::new(Layer { label: *label, clip_to_surface: false, ..layer })
        })
        .collect();
    document.guides = Guides { vertical: vec![10.3, -4.0], horizontal: vec![7.5] }.into();
    document
}

fn labels(document: &Document) -> Vec<LayerLabel> {
    document.layers.iter().map(|layer| layer.label).collect()
}

#[test]
fn our_guides_and_labels_come_back_to_the_last_digit() {
    let document = marked_document();
    let back = read_back(&write_bytes(&document)).document;
    assert_eq!((labels(&back), &back.guides), (labels(&document), &document.guides));
}

#[test]
fn other_programs_find_guides_and_labels() {
    let back = read_back(&without_ours(&write_bytes(&marked_document()))).document;
    let expected: Vec<LayerLabel> = labels(&marked_document())
        .into_iter()
        .map(|label| if label == LayerLabel::Brown { LayerLabel::Orange } else { label })
        .collect();
    assert_eq!(labels(&back), expected);
    assert_eq!(*back.guides, Guides { vertical: vec![10.3125, -4.0], horizontal: vec![7.5] });
}

#[test]
fn guides_that_another_program_moved_are_believed_and_the_layers_stay_live() {
    let document = Document { guides: marked_document().guides, ..everything(32) };
    let mut bytes = write_bytes(&document);
    let place = 240i32.to_be_bytes();
    let at = bytes.windows(5).position(|w| w[..4] == place && w[4] == 1).unwrap();
    bytes[at..at + 4].copy_from_slice(&320i32.to_be_bytes());
    let back = read_back(&bytes).document;
    assert_eq!(back.guides.horizontal, [10.0]);
    assert_same(&document, &Document { guides: document.guides.clone(), ..back });
}

#[test]
fn labels_and_guides_of_photoshop_are_read_and_too_many_told() {
    let label = |number: u8| vec![0, number, 0, 0, 0, 0, 0, 0];
    let mut ground = colored_layer("ground", 4, 4, [100; 3]);
    ground.blocks.push((b"lclr", label(6)));
    let guide = |at: i32, is_level: u8| [&at.to_be_bytes()[..], &[is_level]].concat();
    let head = |count: u32| [1u32, 576, 576, count].map(u32::to_be_bytes).concat();
    let guides = [head(3), guide(64, 0), guide(48, 1), guide(i32::MAX, 0)].concat();
    let read = |guides: Vec<u8>| {
        let resources = vec![(1032, guides)];
        let layers = Some(vec![ground.clone()]);
        read_back(&Made { resources, layers, ..plain(4, 4, [100; 3]) }.bytes())
    };
    let found = read(guides);
    assert_eq!(labels(&found.document), [LayerLabel::Purple]);
    assert_eq!(*found.document.guides, Guides { vertical: vec![2.0], horizontal: vec![1.5] });
    assert_eq!(
        found.notes,
        ["1 of its guides are left out: there are too many, or they are too far away"]
    );
    // A count that the file does not hold, and another version.
    assert_eq!(read([head(u32::MAX), guide(32, 1)].concat()).document.guides.horizontal, [1.0]);
    assert!(read([2u32, 0, 0, 1].map(u32::to_be_bytes).concat()).document.guides.is_empty());
}
