//! Ways to blend that only files of other programs have: knockout, clipping apart, effects that are
//! part of the fill, and values that are blended as such.

use super::foreign::{open, pixel, rectangle};
use super::made::*;

/// A divider of a group: 3 ends it at the bottom, 1 is its head.
fn divider(kind: u32, blend: &[u8; 4]) -> MadeLayer {
    let data = [&kind.to_be_bytes()[..], b"8BIM", blend].concat();
    MadeLayer { blend: *blend, ..empty("group", vec![(b"lsct", data)]) }
}

/// The file of some layers, which are not compared with its picture.
fn file(layers: Vec<MadeLayer>) -> Made {
    let mut made = plain(4, 4, [0; 3]);
    made.layers = Some(layers);
    // Saved without a picture of its own.
    made.resources = vec![(1057, [&[0, 0, 0, 1, 0][..], &[0; 8], &[0, 0, 0, 1]].concat())];
    made
}

fn gray(name: &'static str, tone: u8) -> MadeLayer {
    colored_layer(name, 4, 4, [tone; 3])
}

#[test]
fn what_knocks_out_lies_on_what_is_beneath_its_group() {
    let mut top = MadeLayer { blend: *b"mul ", ..colored_layer("top", 2, 4, [128; 3]) };
    top.rect = [0, 2, 4, 4];
    for (knockout, right) in [(0, 50), (1, 100)] {
        top.blocks = vec![(b"knko", vec![knockout, 0, 0, 0])];
        let group = [divider(3, b"norm"), gray("low", 100), top.clone(), divider(1, b"pass")];
        let back = open(&file([&[gray("ground", 200)], &group[..]].concat()));
        assert_eq!(pixel(&back.document, 0, 0), [100, 100, 100, 255]);
        assert_eq!(pixel(&back.document, 3, 3), [right, right, right, 255]);
        assert!(back.notes.iter().all(|note| !note.contains("left out")), "{:?}", back.notes);
    }
}

#[test]
fn layers_that_are_clipped_apart_lie_on_what_is_beneath_their_base() {
    for (together, shown) in [(1, 89), (0, 150)] {
        let mut base = MadeLayer { blend: *b"mul ", ..gray("base", 128) };
        base.blocks = vec![(b"clbl", vec![together, 0, 0, 0])];
        let clipped = MadeLayer { blend: *b"lddg", is_clipped: true, ..gray("clipped", 100) };
        let back = open(&file(vec![gray("ground", 100), base, clipped]));
        assert_eq!(pixel(&back.document, 1, 1), [shown, shown, shown, 255]);
        assert_eq!(back.document.layers.len(), 3);
    }
}

/// The difference of two layers in a group that passes through, on the left half of the ground.
fn passing_group(alpha: u8) -> Vec<MadeLayer> {
    let mut within = MadeLayer { blend: *b"diff", ..colored_layer("in", 2, 4, [50; 3]) };
    within.rect = [0, 0, 4, 2];
    within.channels.push((-1, vec![alpha; 8]));
    vec![gray("ground", 200), divider(3, b"norm"), within, divider(1, b"pass")]
}

#[test]
fn what_is_clipped_to_a_group_that_passes_through_lies_on_what_that_lets_through() {
    let said = "blended with all that its group lets through";
    let clipped = MadeLayer { blend: *b"lddg", is_clipped: true, ..gray("clipped", 30) };
    let shown = |layers: Vec<MadeLayer>| {
        let back = open(&file(layers));
        let is_told = back.notes.iter().any(|note| note.contains(said));
        ([0, 3].map(|x| pixel(&back.document, x, 1)[0]), is_told)
    };
    let with = |alpha, top: &MadeLayer| [passing_group(alpha), vec![top.clone()]].concat();
    assert_eq!(shown(with(255, &clipped)), ([180, 200], false));
    // Where a layer covers in part, nothing here is the same.
    assert!(shown(with(100, &clipped)).1);
    // What shows nothing changes nothing.
    let nothing = MadeLayer { is_clipped: true, ..empty("nothing", Vec::new()) };
    assert_eq!(shown(with(100, &nothing)), ([180, 200], false));
}

#[test]
fn layers_of_a_profile_that_blend_otherwise_keep_its_values() {
    let icc = moxcms::ColorProfile::new_adobe_rgb().encode().unwrap();
    let layers = vec![
        colored_layer("ground", 4, 4, [200, 100, 50]),
        MadeLayer { blend: *b"diff", ..colored_layer("top", 4, 4, [100, 200, 250]) },
    ];
    let merged = [100, 100, 200].map(|v| vec![v; 16]).to_vec();
    let resources = vec![(1039, icc)];
    let made = Made { layers: Some(layers), merged, resources, ..plain(4, 4, [0; 3]) };
    let back = open(&made);
    let names: Vec<&str> = back.document.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["ground", "top", "Color profile"]);
    let alone = open(&Made { layers: None, ..made });
    let [shown, exact] = [&back, &alone].map(|opened| pixel(&opened.document, 1, 1));
    let farthest = shown.iter().zip(exact).map(|(a, b)| a.abs_diff(b)).max();
    assert!(farthest <= Some(1), "{shown:?} {exact:?}");
    assert!(back.notes.iter().any(|note| note.contains("“Color profile”")), "{:?}", back.notes);
}

#[test]
fn effects_within_may_be_part_of_what_is_filled() {
    let overlay = objc(&[
        ("enab", flag(true)),
        ("Md  ", choice("BlnM", "Nrml")),
        ("Opct", percent(100.0)),
        ("Clr ", rgb([255, 255, 255])),
    ]);
    let effects = [&[0; 4][..], &descriptor(&[("masterFXSwitch", flag(true)), ("SoFi", overlay)])];
    for (is_part, shown) in [(0, 255), (1, 128)] {
        let mut layer = gray("layer", 90);
        layer.blocks = vec![
            (b"lfx2", effects.concat()),
            (b"iOpa", vec![128, 0, 0, 0]),
            (b"infx", vec![is_part, 0, 0, 0]),
        ];
        let back = open(&file(vec![gray("ground", 0), layer]));
        assert_eq!(pixel(&back.document, 2, 2), [shown, shown, shown, 255]);
    }
}

#[test]
fn transparency_that_others_ignore_is_told_where_there_are_others() {
    let said = "ignore its transparency";
    let mut base = gray("base", 128);
    base.blocks = vec![(b"tsly", vec![0; 4])];
    let alone = open(&file(vec![base.clone()]));
    assert!(alone.notes.iter().all(|note| !note.contains(said)), "{:?}", alone.notes);
    let clipped = MadeLayer { is_clipped: true, ..gray("clipped", 100) };
    let notes = open(&file(vec![base, clipped])).notes;
    assert!(notes[0].contains("“base”") && notes[0].contains(said), "{notes:?}");
}

#[test]
fn inks_that_are_blended_otherwise_become_what_they_look_like() {
    let layer = |name, light: [u8; 4], blend: &[u8; 4]| MadeLayer {
        channels: (0..4).map(|c| (c as i16, vec![light[c]; 16])).collect(),
        blend: *blend,
        ..colored_layer(name, 4, 4, [0; 3])
    };
    let layers = vec![
        layer("ground", [0, 255, 255, 255], b"norm"),
        layer("top", [255, 255, 255, 100], b"diff"),
    ];
    // Of each ink the difference: all of cyan, magenta and yellow let through 255, 0, 0.
    let merged = [255, 0, 0, 155].map(|v| vec![v; 16]).to_vec();
    let made = Made { mode: 4, layers: Some(layers), merged, ..plain(4, 4, [0; 3]) };
    let back = open(&made);
    assert_eq!(pixel(&back.document, 1, 1), [155, 0, 0, 255]);
    let names: Vec<&str> = back.document.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["ground", "top"]);
    assert!(back.notes[1].contains("“top”: other programs blend the values"), "{:?}", back.notes);
}

/// A shape of the whole canvas with a red line of one pixel inside, whose pixels are in the file.
fn lined_shape(blocks: Vec<(&'static [u8; 4], Vec<u8>)>) -> MadeLayer {
    let line = descriptor(&[
        ("strokeEnabled", flag(true)),
        ("fillEnabled", flag(true)),
        ("strokeStyleLineWidth", [b"UntF#Pxl".as_slice(), &1f64.to_be_bytes()].concat()),
        ("strokeStyleLineAlignment", choice("a", "strokeStyleAlignInside")),
        ("strokeStyleContent", objc(&[("Clr ", rgb([255, 0, 0]))])),
    ]);
    let fill = descriptor(&[("Clr ", rgb([0, 0, 0]))]);
    let own = vec![(b"vstk", line), (b"SoCo", fill)];
    MadeLayer { blocks: own.into_iter().chain(blocks).collect(), ..gray("shape", 0) }
}

#[test]
fn the_line_of_a_shape_lies_on_what_is_clipped_to_the_shape() {
    let clipped = || MadeLayer { is_clipped: true, ..gray("clipped", 100) };
    let mask = (b"vmsk", rectangle([0.0, 0.0, 1.0, 1.0]));
    let back = open(&file(vec![lined_shape(vec![mask]), clipped()]));
    assert_eq!(pixel(&back.document, 0, 1), [255, 0, 0, 255]);
    assert_eq!(pixel(&back.document, 1, 1), [100, 100, 100, 255]);
    assert_eq!(back.document.layers.len(), 1, "a group of all three");
    let unknown = open(&file(vec![lined_shape(Vec::new()), clipped()]));
    assert_eq!(pixel(&unknown.document, 0, 1), [100, 100, 100, 255]);
}
