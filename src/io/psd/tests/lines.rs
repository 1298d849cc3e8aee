//! Lines around shapes whose pixels the file does not hold, and shapes that are filled by newer
//! blocks.

use super::foreign::{open, pixel, rectangle};
use super::made::*;
use crate::document::Content;
use crate::project::ProjectContents;

const GROUND: [u8; 4] = [100, 100, 100, 255];
const FILL: [u8; 4] = [200, 10, 20, 255];
const LINE: [u8; 4] = [0, 0, 250, 255];

/// A square from 2 to 6 of 8 pixels with a line of `width` pixels or points.
fn shape_with_line(position: &str, width: Vec<u8>, more: &[(&str, Vec<u8>)]) -> ProjectContents {
    let fill = descriptor(&[("Clr ", rgb([200, 10, 20]))]);
    let mut said = vec![
        ("strokeEnabled", flag(true)),
        ("strokeStyleLineWidth", width),
        ("strokeStyleLineAlignment", choice("strokeStyleLineAlignment", position)),
        ("strokeStyleContent", objc(&[("Clr ", rgb([0, 0, 250]))])),
    ];
    said.extend_from_slice(more);
    let mask = rectangle([0.25, 0.25, 0.75, 0.75]);
    let blocks = vec![(b"SoCo", fill), (b"vmsk", mask), (b"vstk", descriptor(&said))];
    let mut made = plain(8, 8, [100; 3]);
    made.layers.as_mut().unwrap().push(empty("shape", blocks));
    // White, so that it is not compared.
    made.merged = vec![vec![255; 64]; 3];
    open(&made)
}

fn px(width: f64) -> Vec<u8> {
    [b"UntF#Pxl".as_slice(), &width.to_be_bytes()].concat()
}

fn points(width: f64) -> Vec<u8> {
    [b"UntF#Pnt".as_slice(), &width.to_be_bytes()].concat()
}

/// The pixels at 1, 2, 3 and 4 in the middle of the left side.
fn left_side(opened: &ProjectContents) -> [[u8; 4]; 4] {
    [1, 2, 3, 4].map(|x| pixel(&opened.document, x, 3))
}

#[test]
fn a_line_lies_within_around_or_on_the_edge_of_its_shape() {
    let inside = shape_with_line("strokeStyleAlignInside", px(1.0), &[]);
    assert_eq!(left_side(&inside), [GROUND, LINE, FILL, FILL]);
    let Content::Group(group) = &inside.document.layers[1].content else { panic!("a group") };
    assert!(group.layers.iter().all(|layer| matches!(layer.content, Content::Fill(_))));
    assert!(
        inside.notes[0].contains("the line of a path here lies half inside"),
        "{:?}",
        inside.notes
    );
    let outside = shape_with_line("strokeStyleAlignOutside", px(1.0), &[]);
    assert_eq!(left_side(&outside), [LINE, FILL, FILL, FILL]);
    let center = shape_with_line("strokeStyleAlignCenter", px(2.0), &[]);
    assert_eq!(left_side(&center), [LINE, LINE, FILL, FILL]);
    let inch = shape_with_line(
        "strokeStyleAlignInside",
        points(36.0),
        &[("strokeStyleResolution", double(4.0))],
    );
    assert_eq!(left_side(&inch), [GROUND, LINE, LINE, LINE], "half an inch of 4 pixels");
}

#[test]
fn a_line_may_have_dashes_and_be_alone() {
    let dashes = [("strokeStyleLineDashSet", list(&[px(2.0), px(2.0)]))];
    let dashed = shape_with_line("strokeStyleAlignInside", px(1.0), &dashes);
    let side = [2, 3, 4, 5].map(|x| pixel(&dashed.document, x, 2));
    // The next side begins with a dash.
    assert_eq!(side, [LINE, LINE, FILL, LINE]);
    let alone = shape_with_line("strokeStyleAlignInside", px(1.0), &[("fillEnabled", flag(false))]);
    assert_eq!(left_side(&alone), [GROUND, LINE, GROUND, GROUND]);
}

#[test]
fn a_line_that_cannot_be_drawn_is_noted() {
    let tiny = [("strokeStyleLineDashSet", list(&[px(1e-6), px(1e-6)]))];
    let left_out = shape_with_line("strokeStyleAlignInside", px(1.0), &tiny);
    assert!(
        left_out.notes.iter().any(|note| note.contains("the line around its shape is left out"))
    );
    assert_eq!(left_side(&left_out), [GROUND, FILL, FILL, FILL]);
}

#[test]
fn a_shape_of_newer_blocks_is_a_path() {
    let fill = [b"SoCo".to_vec(), descriptor(&[("Clr ", rgb([200, 10, 20]))])].concat();
    let mask = rectangle([0.25, 0.25, 0.75, 0.75]);
    let mut made = plain(8, 8, [100; 3]);
    let shape = empty("shape", vec![(b"vscg", fill), (b"vsms", mask)]);
    made.layers.as_mut().unwrap().push(shape);
    made.merged = vec![vec![255; 64]; 3];
    let opened = open(&made);
    assert!(matches!(opened.document.layers[1].content, Content::Image(_)));
    assert_eq!(left_side(&opened), [GROUND, FILL, FILL, FILL]);
}
