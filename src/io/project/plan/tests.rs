//! Plans as text: which items other programs see, hidden ones, clipped ones and stacks.

use super::*;
use crate::math::{Size, srgb::Color};
use crate::project::sample::soft_surface;
use crate::shading::RadianceScaling;

fn fill(name: &str) -> Layer {
    Layer::new(name, Content::Fill(Color::BLACK))
}

fn group(name: &str, pass_through: bool, layers: Vec<Layer>) -> Layer {
    let layers = layers.into_iter().map(Arc::new).collect();
    Layer::new(name, Content::Group(Group { layers, pass_through }))
}

fn describe_plan(layers: Vec<Layer>) -> String {
    let layers = layers.into_iter().map(Arc::new).collect();
    let document = Document { layers, ..Document::empty(Size::new(8, 8)) };
    text(&plan(&document, FormatSupport::OPENRASTER))
}

/// Names; hidden ones behind a minus, clipped ones behind an arrow, composed ones with a star,
/// stacks with what they hold.
fn text(items: &[PlanItem]) -> String {
    let one = |item: &PlanItem| {
        let what = match &item.shows {
            ItemContent::Nothing(_) => "0".into(),
            ItemContent::Layer(_) => String::new(),
            ItemContent::Composed { layers, .. } => format!("*{}", layers.len()),
            ItemContent::Stack { isolated, items } => {
                format!("{}[{}]", if *isolated { "" } else { "through" }, text(items))
            }
        };
        let sign = format!(
            "{}{}",
            if item.visible { "" } else { "-" },
            if item.clipped { "^" } else { "" }
        );
        format!("{sign}{}{what}", item.name.replace(" (parts)", "~"))
    };
    items.iter().map(one).collect::<Vec<_>>().join(" ")
}

#[test]
fn plain_layers_and_groups_are_shown_as_they_are() {
    let layers =
        vec![fill("a"), group("g", false, vec![fill("b")]), group("p", true, vec![fill("c")])];
    assert_eq!(describe_plan(layers), "a g[b] pthrough[c]");
}

#[test]
fn clipped_layers_are_composed_and_kept_hidden_beside() {
    let clipped = Layer { clip_below: true, ..fill("c") };
    assert_eq!(describe_plan(vec![fill("a"), fill("b"), clipped.clone()]), "a b[-b~[b c] b*2]");
    let hidden = Layer { visible: false, ..fill("b") };
    assert_eq!(describe_plan(vec![hidden, clipped.clone()]), "-b -c", "clipped to what is hidden");
    assert_eq!(describe_plan(vec![clipped]), "-c", "clipped to nothing");
}

#[test]
fn where_a_format_says_clipping_the_hidden_layers_are_clipped() {
    let planned = |blend, visible| {
        let clipped = Layer { clip_below: true, blend, visible, ..fill("c") };
        let layers = [fill("a"), fill("b"), clipped].map(Arc::new).to_vec();
        let document = Document { layers, ..Document::empty(Size::new(8, 8)) };
        text(&plan(&document, FormatSupport::PHOTOSHOP))
    };
    assert_eq!(planned(BlendMode::Screen, true), "a -b~[b ^c] b*2");
    assert_eq!(planned(BlendMode::Plus, true), "a -b~[b c] b*2", "a mode without a word");
    assert_eq!(planned(BlendMode::Screen, false), "a b -^c", "nothing is seen that is clipped");
}

#[test]
fn layers_that_keep_to_a_soft_edge_stand_in_a_group_whose_mask_it_is() {
    let soft = soft_surface(Size::new(8, 8));
    let free = || Layer { clip_to_surface: false, ..fill("free") };
    let planned = |layers: Vec<Layer>, words| {
        let layers = layers.into_iter().map(Arc::new).collect();
        let surface = Some(soft.clone());
        text(&plan(&Document { layers, surface, ..Document::empty(Size::new(8, 8)) }, words))
    };
    let stack = || vec![free(), fill("a"), group("g", false, vec![fill("b")]), free(), fill("c")];
    let found = planned(stack(), FormatSupport::PHOTOSHOP);
    assert_eq!(
        found, "free On the surfacethrough[a g[b]] free c",
        "one picture alone brings its own edge"
    );
    assert_eq!(
        planned(stack(), FormatSupport::OPENRASTER),
        "free a g[b] free c",
        "without masks each brings it"
    );
    let inner = planned(
        vec![group("g", false, vec![fill("a"), fill("b"), free()])],
        FormatSupport::PHOTOSHOP,
    );
    assert_eq!(inner, "g[On the surfacethrough[a b] free]", "in a group of both kinds");
    let hidden = Layer { visible: false, ..fill("b") };
    assert_eq!(planned(vec![fill("a"), hidden], FormatSupport::PHOTOSHOP), "a -b");
}

#[test]
fn an_adjustment_is_composed_with_all_beneath_it_in_its_scope() {
    let adjustment = || Layer::new("r", Content::RadianceScaling(RadianceScaling::default()));
    assert_eq!(describe_plan(vec![fill("a"), adjustment(), fill("b")]), "-r~[a r0] r*2 b");
    let clipped = Layer { clip_below: true, ..fill("c") };
    assert_eq!(
        describe_plan(vec![clipped, adjustment()]),
        "-r~[-c r0] r*1",
        "clipped to nothing, it is not composed"
    );
    assert_eq!(
        describe_plan(vec![fill("a"), group("g", false, vec![fill("b"), adjustment()])]),
        "a g[-r~[b r0] r*2]",
        "an isolated group is a scope of its own"
    );
    let through = group("g", true, vec![adjustment()]);
    assert_eq!(describe_plan(vec![fill("a"), through]), "-g~[a gthrough[-r~[r0] r*1]] g*2");
}

#[test]
fn a_filter_is_composed_with_all_beneath_it_in_photoshop_too() {
    let blur = crate::paint::PictureFilter::all()[0].clone();
    let layers = vec![fill("a"), Layer::new("blur", blur), fill("b")];
    let layers = layers.into_iter().map(Arc::new).collect();
    let document = Document { layers, ..Document::empty(Size::new(8, 8)) };
    let found = text(&plan(&document, FormatSupport::PHOTOSHOP));
    assert_eq!(found, "-blur~[a blur0] blur*2 b");
}

#[test]
fn what_openraster_cannot_blend_is_composed() {
    let exclusion = Layer { blend: BlendMode::Exclusion, ..fill("e") };
    assert_eq!(describe_plan(vec![fill("a"), exclusion.clone()]), "-e~[a e] e*2");
    assert_eq!(describe_plan(vec![fill("a"), Layer { visible: false, ..exclusion }]), "a -e");
    let mask = LayerMask::new(crate::document::DerivedMask::Fresnel { f0: 0.1, power: 1.0 });
    let masked = Layer { mask: Some(mask), ..group("g", false, vec![fill("b")]) };
    assert_eq!(describe_plan(vec![fill("a"), masked]), "a g[-g~[b] g*1]");
}

#[test]
fn the_inside_of_a_frame_is_a_mask_where_there_are_masks() {
    use crate::document::Live;
    use crate::math::vec2;
    use crate::paint::{Figure, LivePath, PlacedImage};
    let size = Size::new(8, 8);
    let frame = || {
        let figure = Figure { from: vec2(2.0, 2.0), to: vec2(6.0, 6.0), ..Figure::DEFAULT };
        let path = LivePath { frames: true, ..LivePath::new(figure) };
        Layer::new("f", Content::Image(Live::new(PlacedImage::of_path(size, path))))
    };
    let planned = |layers: Vec<Layer>, passes: bool, words| {
        let layers = vec![Arc::new(group("g", passes, layers))];
        plan(&Document { layers, ..Document::empty(size) }, words)
    };
    let panel = || vec![fill("a"), fill("b"), frame(), fill("c")];
    let masked = planned(panel(), false, FormatSupport::PHOTOSHOP);
    assert_eq!(text(&masked), "g[In the frame[a b] f c]");
    let ItemContent::Stack { items, .. } = &masked[0].shows else { panic!("no group") };
    let Some(LayerMask { kind: MaskKind::File { coverage, .. }, .. }) = &items[0].mask else {
        panic!("no mask")
    };
    assert_eq!([coverage.at(1, 3), coverage.at(2, 3), coverage.at(5, 5)], [0, 255, 255]);
    let composed = planned(panel(), false, FormatSupport::OPENRASTER);
    assert_eq!(text(&composed), "g[-g~[a b f c] g*1]");
    let passing = planned(panel(), true, FormatSupport::PHOTOSHOP);
    assert_eq!(text(&passing), "-g~[gthrough[a b f c]] g*1");
    let two = [panel(), vec![frame()]].concat();
    assert_eq!(text(&planned(two, false, FormatSupport::PHOTOSHOP)), "g[-g~[a b f c f] g*1]");
}
