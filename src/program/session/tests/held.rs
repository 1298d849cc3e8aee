//! Whatever a panel, an action or a replay can set is saved and opened unchanged, or refused with a
//! reason; nothing becomes pixels.

mod edits;

use super::*;
use crate::document::{
    Content, DetailSource, Group, InkLayer, Layer, Live, NormalLayer, StrokeList,
};
use crate::io::{Budget, project};
use crate::math::{Size, vec2};
use crate::paint::{
    Adjust, ColorAdjustment, FormDrawing, FormPattern, Gradient, GradientStop, ImageFilter,
    PictureFilter, PictureSource, PlacedImage, Placement,
};
use crate::raster::{Outside, Picture, Plane};
use crate::session::actions::Style;
use crate::session::property::Property;
use crate::shading::{Environment, Model, RadianceScaling, Shading};
use crate::surface::form_lines::LineSettings;
use crate::surface::hatching::HatchSettings;
use crate::surface::{Maps, NoiseRelief, Surface};
use edits::{NUMBERS, OTHERS, PROPERTIES, STROKE};
use proptest::prelude::*;
use std::sync::Arc;

/// One layer of every kind on a dome, by their positions.
pub(super) fn everything() -> Document {
    let size = Size::new(48, 40);
    let normals = Plane::from_fn(size, |x, y| {
        vec2(x as f32 / 48.0 - 0.5, 0.5 - y as f32 / 40.0).extend(0.8).normalize()
    });
    let (depth, coverage) = (Plane::from_fn(size, |x, _| x as f32 / 48.0), Plane::full(size, 255));
    let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
    let picture = Picture::srgb8(Size::new(2, 1), vec![[9, 90, 200, 255], [200; 4]]).unwrap();
    let placement = Placement::covering(size);
    let image = PlacedImage {
        source: PictureSource::new("p.png".into(), picture.clone(), Adjust::default()),
        placement,
        outside: Outside::Mirror,
        bend: Default::default(),
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    };
    let stops = [0.0, 1.0].map(|t| GradientStop { t, color: Color::WHITE }).to_vec();
    let gradient = Gradient {
        from: vec2(1.0, 2.0),
        to: vec2(40.0, 30.0),
        stops,
        operator: Default::default(),
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    let environment = Some(Environment::new("sky.png".into(), picture));
    let shading = Shading { environment, occlusion_radius_px: 4.0, ..Shading::new(Model::Phong) };
    let grain = DetailSource::Grain(NoiseRelief::default());
    let normals = NormalLayer {
        source: grain,
        placement,
        outside: Outside::Repeat,
        strength: 0.5,
        frame: Default::default(),
    };
    let contents = [
        Content::Fill(Color::BLACK),
        Content::Image(Live::new(image)),
        Content::Gradient(Live::new(gradient)),
        Content::Strokes(Live::new(StrokeList::default())),
        Content::Shading(Live::new(shading)),
        Content::RadianceScaling(RadianceScaling::default()),
        ColorAdjustment::all()[0].clone().into(),
        Content::Normals(normals),
        Content::Pixels(crate::document::PixelLayer {
            file: String::new(),
            x: 0,
            y: 0,
            tiles: Default::default(),
        }),
        Content::Group(Group::default()),
        Content::Ink(InkLayer::of("pixels")),
        Content::FormDrawing(Live::new(FormDrawing::new(FormPattern::Lines(
            LineSettings::DEFAULT,
        )))),
        Content::FormDrawing(Live::new(FormDrawing::new(FormPattern::Hatching(
            HatchSettings::DEFAULT,
        )))),
        PictureFilter::all()[0].clone().into(),
    ];
    let layers = contents
        .into_iter()
        .map(|content| Arc::new(Layer::new(content.kind_name(), content)))
        .collect();
    Document { surface: Some(Arc::new(surface)), layers, ..Document::empty(size) }
}

/// A line of a replay, its numbers filled in.
fn edit() -> impl Strategy<Value = String> {
    let numbers = prop::collection::vec(prop::sample::select(NUMBERS.to_vec()), 8);
    let all: Vec<&str> = PROPERTIES.iter().chain(OTHERS).copied().collect();
    (prop::sample::select(all), 0..14usize, numbers).prop_map(|(template, layer, numbers)| {
        let mut numbers = numbers.into_iter().cycle();
        let template = match template.starts_with("{\"in\"") {
            true => template.to_owned(),
            false => format!(
                r#"{{"in":"layer","do":"set","layer":"{layer}","to":{template},"done":true}}"#
            ),
        };
        let mut line = String::new();
        for c in template.chars() {
            match c {
                // A color also begins with the sign, within its quotes.
                '#' if !line.ends_with('"') => {
                    line += &numbers.next().unwrap_or_default().to_string()
                }
                '%' => {
                    line += &(numbers.next().unwrap_or_default().abs().min(1e6) as u32).to_string()
                }
                // A long one takes two lines here, a stroke several.
                '\n' if !template.contains("pointer") => {}
                c => line.push(c),
            }
        }
        line
    })
}

/// A new property or stroke style must be among the edits.
#[test]
fn every_property_and_every_style_of_strokes_is_among_what_is_set() {
    let is_among = |word: &str, list: &[&str]| {
        list.iter().any(|edit| edit.contains(&format!(r#""do":"{word}""#)))
    };
    let both: Vec<&str> = PROPERTIES.iter().chain(OTHERS).copied().collect();
    let missing: Vec<&&str> =
        Property::WORDS.iter().filter(|word| !is_among(word, &both)).collect();
    assert!(missing.is_empty(), "{missing:?}");
    let restyled: Vec<&str> =
        OTHERS.iter().copied().filter(|edit| edit.contains("restyle")).collect();
    let missing: Vec<&&str> =
        Style::WORDS.iter().filter(|word| !is_among(word, &restyled)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

fn kinds(document: &Document) -> Vec<&'static str> {
    document.walk().into_iter().map(|(_, layer)| layer.content.kind_name()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]
    #[test]
    fn whatever_can_be_set_is_saved_and_opened_as_it_is(edits in prop::collection::vec(edit(), 1..24)) {
        let mut session = Session::default();
        session.add_document(OpenDocument::new("all", everything(), None));
        for line in &edits {
            let (before, notes) = (session.active().unwrap().document().clone(), session.notes.len());
            if let Err(error) = session.replay(Path::new("story"), line) {
                panic!("{line}: {error}");
            }
            let document = session.active().unwrap().document();
            prop_assert_eq!(document.fits(None), Ok(()), "after {}", line);
            let is_told = session.notes.len() > notes;
            // A first shape is told of too: which colors have no part.
            let is_news = line.contains("pointer") || line.contains(r#""do":"shape""#);
            let is_kept_out = !is_told || is_news || is_same(&before, document);
            prop_assert!(is_kept_out, "refused, and yet changed: {}", line);
        }
        let document = session.active().unwrap().document();
        let file = Path::new("a.ora");
        let bytes = project::write(file, document, &Progress::default()).unwrap().unwrap();
        let read = project::read(file, &bytes, &Budget::default()).unwrap();
        prop_assert_eq!(&read.notes, &Vec::<String>::new());
        prop_assert_eq!(document.difference(&read.document), None);
        prop_assert_eq!(kinds(document), kinds(&read.document));
    }
}

#[test]
fn an_edit_that_no_file_could_hold_is_refused_in_words() {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("all", everything(), None));
    let before = session.active().unwrap().document().clone();
    let mut said = |line: &str| {
        session.replay(Path::new("story"), line).unwrap();
        assert!(is_same(&before, session.active().unwrap().document()), "{line}");
        session.notes.pop().unwrap_or_default()
    };
    let set = |layer: usize, to: &str| {
        format!(r#"{{"in":"layer","do":"set","layer":"{layer}","to":{to},"done":true}}"#)
    };
    assert_eq!(
        said(&set(1, r#"{"do":"placement","placement":{"center":[1,1],"scale":0,"rotation":0}}"#)),
        "“image”: the scale is 0; it must be between 0.0001 and 10000. Nothing was changed."
    );
    assert!(
        said(&set(0, r#"{"do":"mask","mask":{"kind":"depth","from":0.5,"to":2}}"#))
            .contains("must be between 0 and 1")
    );
    let long = format!(r#"{{"do":"name","name":"{}"}}"#, "x".repeat(1_001));
    assert!(
        said(&set(0, &long))
            .contains("letters of the name would be 1001; at most 1000 are allowed")
    );
}

#[test]
fn groups_within_groups_are_refused_when_a_file_could_not_hold_them() {
    let mut session =
        replay(r##"{"in":"file","do":"new","width":8,"height":8,"background":"#ffffff"}"##);
    for _ in 0..Document::DEEPEST + 3 {
        let path = vec!["0"; 1 + depth(&session)].join(".");
        session
            .replay(
                Path::new("story"),
                &format!(r#"{{"in":"layer","do":"group","layer":"{path}"}}"#),
            )
            .unwrap();
    }
    assert_eq!(depth(&session), Document::DEEPEST);
    assert_eq!(session.notes.len(), 3);
    assert!(
        session.notes[0].contains("Groups around a layer would be 51; at most 50 are allowed"),
        "{}",
        session.notes[0]
    );
}

/// How many groups are around the deepest layer.
fn depth(session: &Session) -> usize {
    let document = session.active().unwrap().document();
    document.walk().iter().map(|(path, _)| path.matches('.').count()).max().unwrap_or_default()
}

#[test]
fn what_the_hand_draws_lies_on_the_grid_of_files() {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("all", everything(), None));
    session.replay(Path::new("story"), &STROKE.replace('#', "0.123456")).unwrap();
    let document = session.active().unwrap().document();
    let strokes = document.strokes(document.layers[3].id);
    let samples = strokes[0].samples();
    assert_eq!(samples.len(), 3);
    assert!(samples.iter().all(|sample| *sample == sample.normalized()));
    assert_eq!(samples[1].at.x, (17.123f32 * 256.0).round() / 256.0);
}
