//! Shape layers as live paths, and live paths as shape layers.

use super::foreign::{open, pixel, rectangle};
use super::made::*;
use super::*;
use crate::document::{LayerMask, LayerTransform, Live, TransformShape};
use crate::math::srgb::Color;
use crate::math::{Vec2, vec2};
use crate::paint::{
    Figure, FigureKind, LivePath, PathCap, PathJoin, PathNode, PathRule, PlacedImage, Subpath,
};
use crate::psd::parse::parse;
use crate::raster::{Plane, Resampling};

const RED: Color = Color::rgb(200, 10, 20);
const BLUE: Color = Color::rgb(0, 0, 250);

fn path_of(layer: &Layer) -> Option<&LivePath> {
    match &layer.content {
        Content::Image(live) => live.params().source.path().map(|path| &**path),
        _ => None,
    }
}

/// A layer that is a path, or what the file is said to hold instead.
fn path_in(opened: &ProjectContents, layer: usize) -> &LivePath {
    let layer = &opened.document.layers[layer];
    path_of(layer).unwrap_or_else(|| panic!("no path: {:?}", opened.notes))
}

/// A path of the format: how it meets those before, the rule, whether it is open, and its knots with
/// the handle before and behind each, px of 40.
type Drawn = (i16, u16, bool, Vec<[Vec2; 3]>);

fn square(way: i16, low: f32, high: f32) -> Drawn {
    let corners = [vec2(low, low), vec2(high, low), vec2(high, high), vec2(low, high)];
    (way, 1, false, corners.map(|p| [p; 3]).to_vec())
}

fn vector_mask(paths: &[Drawn]) -> Vec<u8> {
    let mut out = [3u32.to_be_bytes(), [0; 4]].concat();
    for (way, rule, is_open, knots) in paths {
        let start = out.len();
        out.extend(if *is_open { [0, 3] } else { [0, 0] });
        out.extend((knots.len() as u16).to_be_bytes());
        out.extend(way.to_be_bytes());
        out.extend(rule.to_be_bytes());
        out.resize(start + 26, 0);
        for knot in knots {
            out.extend(if *is_open { [0, 5] } else { [0, 2] });
            let fixed = |v: f32| ((v / 40.0 * 16_777_216.0) as i32).to_be_bytes();
            knot.iter().for_each(|p| out.extend([fixed(p.y), fixed(p.x)].concat()));
        }
    }
    out
}

/// A line of `width` px and what else is said of it.
fn line(position: &str, width: f64, more: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let width = [b"UntF#Pxl".as_slice(), &width.to_be_bytes()].concat();
    let mut said = vec![
        ("strokeEnabled", flag(true)),
        ("strokeStyleLineWidth", width),
        ("strokeStyleLineAlignment", choice("strokeStyleLineAlignment", position)),
        ("strokeStyleContent", objc(&[("Clr ", rgb([0, 0, 250]))])),
    ];
    said.extend_from_slice(more);
    descriptor(&said)
}

const CENTER: &str = "strokeStyleAlignCenter";

/// A file of 40 px with a shape that has no pixels, and with blocks besides its paths and its fill.
fn shape(paths: &[Drawn], more: Vec<(&'static [u8; 4], Vec<u8>)>) -> ProjectContents {
    let fill = descriptor(&[("Clr ", rgb([200, 10, 20]))]);
    let mut blocks = vec![(b"SoCo", fill), (b"vmsk", vector_mask(paths))];
    blocks.extend(more);
    let mut made = plain(40, 40, [100; 3]);
    made.layers.as_mut().unwrap().push(empty("shape", blocks));
    // White, so that it is not compared.
    made.merged = vec![vec![255; 1600]; 3];
    open(&made)
}

#[test]
fn a_shape_is_a_path_with_its_knots_and_its_color() {
    let bent = vec![
        [vec2(5.0, 20.0), vec2(5.0, 10.0), vec2(5.0, 2.0)],
        [vec2(30.0, 2.0), vec2(30.0, 10.0), vec2(30.0, 10.0)],
        [vec2(30.0, 30.0); 3],
    ];
    for is_open in [false, true] {
        let opened = shape(&[(1, 1, is_open, bent.clone())], Vec::new());
        let path = path_in(&opened, 1);
        assert_eq!((path.fill, path.rule, path.outline), (Some(RED), PathRule::EvenOdd, 0.0));
        let lines = path.subpaths();
        let [line] = &lines[..] else { panic!("{lines:?}") };
        assert_eq!((line.closed, line.nodes.len()), (!is_open, 3));
        let node = line.nodes[0];
        let apart =
            [node.at - vec2(5.0, 10.0), node.before - vec2(0.0, 10.0), node.after + vec2(0.0, 8.0)];
        assert!(apart.iter().all(|v| v.length() < 1e-4), "{node:?}");
        assert_eq!([line.nodes[1].after, line.nodes[2].before], [Vec2::ZERO; 2]);
        assert_eq!(pixel(&opened.document, 25, 14), [200, 10, 20, 255]);
        assert_eq!(pixel(&opened.document, 35, 30), [100, 100, 100, 255]);
        assert!(!opened.document.layers[1].clip_to_surface);
    }
}

#[test]
fn shapes_that_are_combined_are_one_path_where_one_says_it() {
    // What each shows at 3, 13, 25 and 35 on the diagonal, and by which rule.
    let cases: [(&[Drawn], [bool; 4], Option<PathRule>); 8] = [
        (
            &[square(1, 2.0, 20.0), square(-1, 10.0, 30.0)],
            [true, false, true, false],
            Some(PathRule::EvenOdd),
        ),
        (
            &[square(1, 2.0, 20.0), square(0, 10.0, 30.0)],
            [true, false, true, false],
            Some(PathRule::EvenOdd),
        ),
        (
            &[square(1, 2.0, 20.0), square(1, 10.0, 30.0)],
            [true, true, true, false],
            Some(PathRule::Nonzero),
        ),
        (
            &[square(1, 2.0, 30.0), square(2, 10.0, 20.0)],
            [true, false, true, false],
            Some(PathRule::EvenOdd),
        ),
        (
            &[square(1, 2.0, 8.0), square(1, 20.0, 30.0)],
            [true, false, true, false],
            Some(PathRule::EvenOdd),
        ),
        (&[square(3, 2.0, 20.0)], [true, true, false, false], Some(PathRule::EvenOdd)),
        (&[square(1, 2.0, 20.0), square(3, 10.0, 30.0)], [false, true, false, false], None),
        (&[square(2, 10.0, 20.0)], [true, false, true, true], None),
    ];
    for (i, (paths, shows, rule)) in cases.into_iter().enumerate() {
        let opened = shape(paths, Vec::new());
        let shown = [3, 13, 25, 35].map(|at| pixel(&opened.document, at, at)[0] == 200);
        assert_eq!(shown, shows, "{i}: {:?}", opened.notes);
        let found = path_of(&opened.document.layers[1]).map(|path| path.rule);
        assert_eq!(found, rule, "{i}");
        let is_noted = opened.notes.iter().any(|note| note.contains("it is no live path"));
        assert_eq!(is_noted, rule.is_none(), "{i}: {:?}", opened.notes);
    }
    let star = Figure { kind: FigureKind::Star, to: vec2(40.0, 40.0), ..Figure::DEFAULT };
    let crossed =
        star.subpaths()[0].nodes.iter().step_by(2).map(|node| node.at).collect::<Vec<_>>();
    let crossed = [0, 2, 4, 1, 3].map(|i| [crossed[i]; 3]).to_vec();
    for (rule, middle) in [(1, 100), (2, 200)] {
        let opened = shape(&[(1, rule, false, crossed.clone())], Vec::new());
        assert_eq!(path_in(&opened, 1).rule == PathRule::Nonzero, rule == 2);
        assert_eq!(pixel(&opened.document, 20, 20)[0], middle, "what the line runs around twice");
    }
}

#[test]
fn the_line_of_a_shape_is_the_outline_of_its_path() {
    let said = [
        ("strokeStyleLineCapType", choice("strokeStyleLineCapType", "strokeStyleRoundCap")),
        ("strokeStyleLineJoinType", choice("strokeStyleLineJoinType", "strokeStyleBevelJoin")),
        ("strokeStyleLineDashSet", list(&[double(2.0), double(1.5)])),
        ("strokeStyleOpacity", percent(50.0)),
        ("fillEnabled", flag(false)),
    ];
    let opened = shape(&[square(1, 5.0, 35.0)], vec![(b"vstk", line(CENTER, 4.0, &said))]);
    let path = path_in(&opened, 1);
    let meant = LivePath {
        rule: PathRule::EvenOdd,
        outline: 4.0,
        outline_color: Color { a: 128, ..BLUE },
        cap: PathCap::Round,
        join: PathJoin::Bevel,
        dashes: vec![8.0, 6.0],
        ..LivePath::new(path.subpaths().into_owned())
    };
    assert_eq!(path, &meant);
    assert!(!opened.notes.iter().any(|note| note.contains("shape")), "{:?}", opened.notes);
}

#[test]
fn a_line_that_no_path_has_stays_beside_its_shape_and_is_named() {
    let sharp = vec![[vec2(5.0, 5.0); 3], [vec2(35.0, 8.0); 3], [vec2(5.0, 11.0); 3]];
    let cases: [(Vec<u8>, Drawn, &str); 5] = [
        (line("strokeStyleAlignInside", 2.0, &[]), square(1, 5.0, 35.0), "half inside of its edge"),
        (line("strokeStyleAlignOutside", 2.0, &[]), square(1, 5.0, 35.0), "half inside"),
        (line(CENTER, 2.0, &[]), (1, 1, false, sharp), "cut at other corners"),
        (
            line(CENTER, 2.0, &[("strokeStyleBlendMode", choice("BlnM", "Mltp"))]),
            square(1, 5.0, 35.0),
            "is blended as the path is",
        ),
        (
            line(
                CENTER,
                2.0,
                &[
                    ("strokeStyleLineDashSet", list(&[double(2.0)])),
                    ("strokeStyleLineDashOffset", double(1.0)),
                ],
            ),
            square(1, 5.0, 35.0),
            "begins within one",
        ),
    ];
    for (said, drawn, why) in cases {
        let opened = shape(&[drawn], vec![(b"vstk", said)]);
        let Content::Group(group) = &opened.document.layers[1].content else { panic!("{why}") };
        assert_eq!(group.layers.len(), 2, "the fill and the line");
        assert!(opened.notes.iter().any(|note| note.contains(why)), "{:?}", opened.notes);
    }
}

#[test]
fn a_shape_whose_pixels_are_others_keeps_them() {
    let fill = || descriptor(&[("Clr ", rgb([200, 10, 20]))]);
    let with_pixels = |alphas: Vec<u8>, color: [u8; 3]| {
        let mut layer = colored_layer("shape", 4, 4, color);
        layer.channels.push((-1, alphas));
        layer.blocks = vec![(b"SoCo", fill()), (b"vmsk", rectangle([0.25, 0.0, 1.0, 1.0]))];
        let mut made = plain(4, 4, [100; 3]);
        made.layers.as_mut().unwrap().push(layer);
        made.merged = vec![vec![255; 16]; 3];
        open(&made)
    };
    let same = with_pixels([0, 255, 255, 255].repeat(4), [200, 10, 20]);
    assert!(path_of(&same.document.layers[1]).is_some(), "{:?}", same.notes);
    let mut hole = [0, 255, 255, 255].repeat(4);
    hole[6] = 250;
    for (alphas, color) in [(hole, [200, 10, 20]), ([0, 255, 255, 255].repeat(4), [210, 10, 20])] {
        let other = with_pixels(alphas, color);
        assert!(path_of(&other.document.layers[1]).is_none());
        let note = "“shape”: it is no live path: its pixels are not those of its paths";
        assert!(other.notes.iter().any(|said| said == note), "{:?}", other.notes);
    }
}

#[test]
fn pixels_of_shapes_are_kept_where_live_ones_look_otherwise() {
    let fill = descriptor(&[("Clr ", rgb([200, 10, 20]))]);
    // The edge lies in the middle of the third column, and the file covers more of it.
    let mut layer = colored_layer("shape", 4, 4, [200, 10, 20]);
    layer.channels.push((-1, [0, 255, 148, 0].repeat(4)));
    layer.blocks = vec![(b"SoCo", fill), (b"vmsk", rectangle([0.25, 0.0, 0.625, 1.0]))];
    let mut made = plain(4, 4, [100; 3]);
    made.layers.as_mut().unwrap().push(layer);
    let row = |color: u8, edge: u8| [100, color, edge, 100].repeat(4);
    for (edge, is_live) in [([158, 48, 54], false), ([150, 55, 60], true)] {
        made.merged = vec![row(200, edge[0]), row(10, edge[1]), row(20, edge[2])];
        let opened = open(&made);
        let layer = &opened.document.layers[1];
        assert_eq!(path_of(layer).is_some(), is_live, "{:?}", opened.notes);
        let became = opened.notes.iter().any(|note| note.contains("its shapes became pixels"));
        assert_eq!((became, opened.document.layers.len()), (!is_live, 2), "{:?}", opened.notes);
        assert_eq!(pixel(&opened.document, 2, 1)[..3], edge);
    }
}

#[test]
fn a_painted_mask_stays_a_mask_beside_the_path() {
    let fill = descriptor(&[("Clr ", rgb([200, 10, 20]))]);
    let mut layer =
        empty("shape", vec![(b"SoCo", fill), (b"vmsk", rectangle([0.0, 0.0, 0.5, 1.0]))]);
    layer.mask_data = [[0u32, 0, 4, 4].map(u32::to_be_bytes).concat(), vec![0; 4]].concat();
    layer.channels = vec![(-2, [[255; 8], [0; 8]].concat())];
    let mut made = plain(4, 4, [100; 3]);
    made.layers.as_mut().unwrap().push(layer);
    made.merged = vec![vec![255; 16]; 3];
    let opened = open(&made);
    assert!(
        opened.document.layers[1].mask.is_some() && path_of(&opened.document.layers[1]).is_some()
    );
    let reds = [(0, 0), (1, 1), (2, 0), (0, 3)].map(|(x, y)| pixel(&opened.document, x, y)[0]);
    assert_eq!(reds, [200, 200, 100, 100]);
}

const SIZE: Size = Size::new(120, 90);

fn figure(kind: FigureKind) -> Figure {
    Figure { kind, from: vec2(12.3, 10.6), to: vec2(100.0, 80.2), corner: 6.0, ..Figure::DEFAULT }
}

fn layer(name: &str, path: LivePath) -> Layer {
    let image = PlacedImage::of_path(SIZE, path);
    Layer { clip_to_surface: false, ..Layer::new(name, Content::Image(Live::new(image))) }
}

fn document(layers: Vec<Layer>) -> Document {
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(SIZE) }
}

/// What a reader makes of a document that knows nothing of this program's own part of the file; its
/// picture differs by `most`.
fn read_by_others(document: &Document, most: u8) -> ProjectContents {
    let bytes = without_ours(&write_bytes(document));
    let read = read_back(&bytes);
    let apart = worst(document, &read.document);
    assert!(apart <= most, "{apart} {:?}", read.notes);
    read
}

#[test]
fn figures_are_shapes_for_other_programs_and_come_back_as_paths() {
    let outlined = |path: LivePath| LivePath {
        outline: 3.7,
        outline_color: Color { a: 200, ..BLUE },
        join: PathJoin::Round,
        ..path
    };
    for (kind, label) in FigureKind::LABELS {
        let filled = LivePath::new(figure(kind)).with_fill(RED);
        let dashed = LivePath {
            cap: PathCap::Square,
            dashes: vec![7.3, 2.1, 1.0],
            ..outlined(LivePath::new(figure(kind)))
        };
        let looks = [filled.clone(), outlined(filled), dashed];
        for (i, path) in looks.into_iter().enumerate() {
            let is_blank = kind == FigureKind::Line && i == 0;
            let read = read_by_others(&document(vec![layer(label, path.clone())]), 2);
            let Some(found) = path_of(&read.document.layers[0]) else {
                assert!(is_blank, "{label} {i}: {:?}", read.notes);
                continue;
            };
            let nodes = |path: &LivePath| -> Vec<Vec2> {
                path.subpaths().iter().flat_map(|line| line.nodes.iter().map(|n| n.at)).collect()
            };
            let (own, found_nodes) = (nodes(&path), nodes(found));
            assert_eq!(own.len(), found_nodes.len(), "{label} {i}");
            assert!(
                own.iter().zip(&found_nodes).all(|(a, b)| a.distance(*b) < 1e-3),
                "{label} {i}"
            );
            let look = |p: &LivePath| (p.fill, p.rule, p.outline, p.outline_color, p.cap, p.join);
            assert_eq!(look(found), look(&path), "{label} {i}");
            assert_eq!(found.dashes.len(), 2 * path.dashes.len(), "an odd number counts twice");
            assert!(found.dashes.iter().zip(&path.dashes).all(|(a, b)| a == b));
        }
    }
}

#[test]
fn nodes_holes_masks_and_transforms_are_kept_for_other_programs() {
    let square =
        |a: f32, b: f32| Subpath::polygon([vec2(a, a), vec2(b, a), vec2(b, b), vec2(a, b)]);
    let mut bent = square(30.5, 50.25);
    bent.nodes[1] = PathNode::smooth(bent.nodes[1].at, vec2(9.0, 6.0));
    let lines = vec![square(10.0, 70.0), bent];
    let both = LivePath { rule: PathRule::EvenOdd, ..LivePath::new(lines) }.with_fill(RED);
    let holed = layer("holed", both.clone());
    // What is turned by a right angle is the same pixels.
    let turned = TransformShape::Matrix([0.0, 1.0, -1.0, 0.0, 100.0, 5.0]);
    let transform = Some(LayerTransform { shape: turned, filter: Resampling::default() });
    let moved = Layer { transform, ..layer("moved", LivePath { outline: 4.0, ..both.clone() }) };
    let half = Plane::from_fn(SIZE, |x, _| if x < 40 { 255 } else { 60 });
    let mask = LayerMask::new(MaskKind::File { file: String::new(), coverage: Arc::new(half) });
    let masked = Layer { mask: Some(mask), ..layer("masked", both) };
    let document = document(vec![holed, moved, masked]);
    super::foreign::attack(&without_ours(&write_bytes(&document)));
    let read = read_by_others(&document, 2);
    let found: Vec<&LivePath> = read.document.layers.iter().filter_map(|l| path_of(l)).collect();
    assert_eq!(found.len(), 3, "{:?}", read.notes);
    assert!((found[1].outline - 4.0).abs() < 1e-3, "{}", found[1].outline);
    let corner = found[1].subpaths()[0].nodes[0].at;
    assert!(corner.distance(vec2(90.0, 15.0)) < 1e-3, "{corner}");
    assert!(read.document.layers[2].mask.is_some());
    assert_eq!(found[2].subpaths().len(), 2);
    let again = read_by_others(&read.document, 2);
    let nodes = |document: &Document| -> Vec<[Vec2; 3]> {
        let paths = document.layers.iter().filter_map(|layer| path_of(layer));
        let lines = paths.flat_map(|path| path.subpaths().into_owned());
        lines.flat_map(|line| line.nodes).map(|n| [n.at, n.before, n.after]).collect()
    };
    let (first, second) = (nodes(&read.document), nodes(&again.document));
    assert_eq!(first.len(), second.len());
    let moved = first.iter().flatten().zip(second.iter().flatten());
    assert!(moved.into_iter().all(|(a, b)| a.distance(*b) < 1e-4), "nodes wander");
}

#[test]
fn what_no_shape_says_is_written_as_pixels() {
    let star = || LivePath::new(figure(FigureKind::Star)).with_fill(RED);
    let mut uneven = star().subpaths().into_owned();
    uneven[0].nodes[0].width = 3.0;
    let others = [
        ("faint", layer("faint", LivePath { fill: Some(Color { a: 90, ..RED }), ..star() })),
        ("uneven", layer("uneven", LivePath { outline: 3.0, ..LivePath::new(uneven) })),
    ];
    for (name, other) in others {
        let read = read_by_others(&document(vec![other]), 2);
        assert!(matches!(read.document.layers[0].content, Content::Pixels(_)), "{name}");
    }
    // Its line would lie over what is clipped to it.
    let lined = layer("lined", LivePath { outline: 6.0, ..star() });
    let over =
        Layer { clip_below: true, visible: false, ..Layer::new("over", Content::Fill(BLUE)) };
    let read = read_by_others(&document(vec![lined, over]), 2);
    assert!(matches!(read.document.layers[0].content, Content::Pixels(_)));
}

#[test]
fn a_path_that_is_saved_is_the_same_path_when_it_is_opened() {
    let path = LivePath { outline: 2.0, ..LivePath::new(figure(FigureKind::Balloon)) };
    let made = document(vec![layer("balloon", path.with_fill(RED))]);
    let bytes = write_bytes(&made);
    let read = read_back(&bytes);
    assert_eq!(made.difference(&read.document), None);
    assert!(read.notes.is_empty(), "{:?}", read.notes);
    let parsed = parse(Path::new("a.psd"), &bytes, &Budget::default()).unwrap();
    assert!(parsed.records[0].path.is_some() && !parsed.records[0].rgba.is_empty());
    for key in [b"vscg", b"vsms", b"vstk"] {
        assert!(bytes.windows(4).any(|w| w == key), "{}", String::from_utf8_lossy(key));
    }
}
