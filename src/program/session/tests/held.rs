//! Whatever a panel, an action or a replay can set is saved and opened as it is, or refused in words; nothing becomes
//! pixels.

use super::*;
use crate::document::{Content, DetailSource, Group, Layer, Live, NormalLayer, StrokeList};
use crate::io::{Budget, project};
use crate::math::{Size, vec2};
use crate::paint::{Adjust, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement};
use crate::raster::{Outside, Picture, Plane};
use crate::shading::{Environment, Model, RadianceScaling, Shading};
use crate::surface::{Maps, NoiseRelief, Surface};
use proptest::prelude::*;
use std::sync::Arc;

/// One layer of every kind on a dome, by their places.
pub(super) fn everything() -> Document {
    let size = Size::new(48, 40);
    let normals =
        Plane::from_fn(size, |x, y| vec2(x as f32 / 48.0 - 0.5, 0.5 - y as f32 / 40.0).extend(0.8).normalize());
    let (depth, coverage) = (Plane::from_fn(size, |x, _| x as f32 / 48.0), Plane::filled(size, 255));
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
    };
    let environment = Some(Environment::new("sky.png".into(), picture));
    let shading = Shading { environment, occlusion_radius_px: 4.0, ..Shading::new(Model::Phong) };
    let grain = DetailSource::Grain(NoiseRelief::default());
    let normals =
        NormalLayer { source: grain, placement, outside: Outside::Repeat, strength: 0.5, frame: Default::default() };
    let contents = [
        Content::Fill(Color::BLACK),
        Content::Image(Live::new(image)),
        Content::Gradient(Live::new(gradient)),
        Content::Strokes(Live::new(StrokeList::default())),
        Content::Shading(Live::new(shading)),
        Content::RadianceScaling(RadianceScaling::default()),
        Content::Normals(normals),
        Content::Pixels(crate::document::PixelLayer { file: String::new(), x: 0, y: 0, tiles: Default::default() }),
        Content::Group(Group::default()),
    ];
    let layers = contents.into_iter().map(|content| Arc::new(Layer::new(content.kind_name(), content))).collect();
    Document { surface: Some(Arc::new(surface)), layers, ..Document::empty(size) }
}

/// Numbers at and beyond the ends of every range there is.
const NUMBERS: [f32; 22] = [
    0.0, -0.0, 1.0, -1.0, 0.5, 0.25, 2.0, 1e-6, 1e-3, 20.0, 60.0, 90.0, 200.0, 300.0, -300.0, 1024.5, 5000.0, 3e4, 1e6,
    -2e6, 1e30, -1e30,
];
/// Edits with `#` for a number and `%` for a whole one; the property of a layer, or an action.
const PROPERTIES: [&str; 46] = [
    r#"{"do":"mask","mask":{"kind":"shine","at":[5,#],"tolerance":#,"softness":#,"contiguous":false}}"#,
    r#"{"do":"opacity","to":#}"#,
    r#"{"do":"linear","on":true}"#,
    r#"{"do":"clip","on":true}"#,
    r#"{"do":"clip to surface","on":false}"#,
    r#"{"do":"visible","on":false}"#,
    r#"{"do":"lock","lock":"alpha"}"#,
    r#"{"do":"label","label":"orange"}"#,
    r#"{"do":"pass through","on":true}"#,
    r#"{"do":"blend","mode":"exclusion"}"#,
    r##"{"do":"fill","color":"#10203040"}"##,
    r#"{"do":"operator","operator":{"kind":"depth","gamma":#}}"#,
    r#"{"do":"operator","operator":{"kind":"normal","alpha":#,"beta":#,"detail":0.5}}"#,
    r#"{"do":"operator","operator":{"kind":"reflection","alpha":0.5,"detail":#}}"#,
    r#"{"do":"anchors","anchors":[{"at":[#,2],"source":[3,#]},{"at":[5,6],"source":[7,8]}]}"#,
    r#"{"do":"anchors","anchors":[]}"#,
    r#"{"do":"pieces","pieces":[{"at":[#,2],"move":[3,#],"scale":2,"rotation":#}]}"#,
    r#"{"do":"power","to":#}"#,
    r#"{"do":"transform","transform":{"matrix":[0.75,0.5,-0.25,0.5,12.5,-3],"filter":"sharp"}}"#,
    r#"{"do":"transform","transform":{"quad":[[0.25,1],[40,3],[38,29.5],[2,30.125]]}}"#,
    r#"{"do":"transform","transform":null}"#,
    r#"{"do":"placement","placement":{"center":[#,5],"scale":1,"rotation":#}}"#,
    r#"{"do":"placement","placement":{"center":[4,5],"scale":#,"rotation":30}}"#,
    r#"{"do":"outside","outside":"clamp"}"#,
    r#"{"do":"filter","filter":"bilinear"}"#,
    r#"{"do":"adjust","adjust":{"blur":0,"exposure":#,"hue":#,"saturation":1,"brightness":#,"contrast":1}}"#,
    r#"{"do":"adjust","adjust":{"blur":#,"exposure":0,"hue":0,"saturation":#,"brightness":1,"contrast":#}}"#,
    r##"{"do":"stops","stops":[[#,"#102030"],[#,"#ffffff80"]]}"##,
    r#"{"do":"ends","from":[#,1],"to":[2,#]}"#,
    r#"{"do":"mask","mask":{"kind":"fresnel","f0":#,"power":#}}"#,
    r#"{"do":"mask","mask":{"kind":"curvature","scale":4,"blur":#,"from":0.25,"to":#}}"#,
    r#"{"do":"mask","mask":{"kind":"curvature","scale":#,"blur":0,"from":#,"to":0.5}}"#,
    r#"{"do":"mask","mask":{"kind":"depth","from":#,"to":#}}"#,
    r#"{"do":"mask inverted","on":true}"#,
    r#"{"do":"environment","projection":"angular","rotation":#,"exposure":#}"#,
    r#"{"do":"occlusion","to":#}"#,
    r#"{"do":"grain","grain":{"size":#,"octaves":%,"roughness":#,"stretch":#,"seed":%}}"#,
    r##"{"do":"lights","lights":[{"kind":"directional","direction":[#,0,#],"color":"#ffffff","intensity":1}]}"##,
    r##"{"do":"lights","lights":[{"kind":"point","position":[#,0,#],"color":"#ffffff","intensity":#}]}"##,
    r##"{"do":"diffuse","term":{"color":"#c08060","weight":#,
        "scaling":{"alpha":#,"gamma_convex":#,"gamma_concave":1}}}"##,
    r#"{"do":"shininess","to":#}"#,
    r#"{"do":"anisotropy","nu":#,"nv":#}"#,
    r#"{"do":"features","features":{"scales":[{"curvature_scale":#,"blur":#,"weight":#}],"lambda":#}}"#,
    r#"{"do":"scaling","scaling":{"alpha":#,"gamma_convex":#,"gamma_concave":#}}"#,
    r#"{"do":"reference","reference":#}"#,
    r#"{"do":"strength","to":#}"#,
];
const OTHERS: [&str; 66] = [
    r#"{"in":"guide","do":"set","guides":{"vertical":[#,3.5],"horizontal":[#]}}"#,
    r#"{"in":"guide","do":"assistants","assistants":[{"kind":"ellipse","points":[[1,2],[#,4],[5,#]]}]}"#,
    r#"{"in":"guide","do":"clear"}"#,
    r#"{"in":"hand","do":"axes","center":[#,#],"turn":#}"#,
    r#"{"in":"selection","do":"all"}"#,
    r#"{"in":"selection","do":"region","region":{"kind":"direction","at":[20.5,#],"tolerance":#,"softness":#,
        "contiguous":true},"how":"replace"}"#,
    r#"{"in":"selection","do":"region","region":{"kind":"depth","at":[#,8.5],"tolerance":#,"softness":0,
        "contiguous":false},"how":"add"}"#,
    r#"{"in":"selection","do":"change","change":"feather","px":#}"#,
    r#"{"in":"selection","do":"change","change":"shrink","px":#}"#,
    r#"{"in":"selection","do":"move","by":[#,#]}"#,
    r#"{"in":"selection","do":"invert"}"#,
    r#"{"in":"selection","do":"keep","name":"a"}"#,
    r#"{"in":"selection","do":"to mask","layer":"0"}"#,
    r#"{"in":"clipboard","do":"layer via","cut":true}"#,
    r#"{"in":"clipboard","do":"cut"}"#,
    r#"{"in":"clipboard","do":"paste"}"#,
    r#"{"do":"model","model":"ashikhmin"}"#,
    r#"{"do":"model","model":"toon"}"#,
    r#"{"do":"bands","to":%}"#,
    r#"{"do":"exponent","to":#}"#,
    r#"{"do":"index","to":#}"#,
    r#"{"do":"scaling light","light":[#,#,0]}"#,
    r#"{"do":"keep mean","on":true}"#,
    r#"{"do":"without","part":"environment"}"#,
    r#"{"do":"name","name":"a\"\u0000\u001b[31m\n<é𝄞 "}"#,
    r#"{"in":"hand","do":"size","to":#}"#,
    r#"{"in":"hand","do":"spacing","to":#}"#,
    r#"{"in":"hand","do":"rotation","to":#}"#,
    r#"{"in":"hand","do":"softness","to":#}"#,
    r#"{"in":"hand","do":"pressure","size":#,"flow":#}"#,
    r#"{"in":"hand","do":"operator","operator":{"kind":"normal","alpha":#,"beta":1,"detail":0}}"#,
    r#"{"in":"hand","do":"mark","mark":{"kind":"smudge","length":#}}"#,
    r#"{"in":"hand","do":"mark","mark":{"kind":"paint"}}"#,
    r#"{"in":"hand","do":"preset","name":"watercolour-wash"}"#,
    r#"{"in":"hand","do":"preset","name":"oil-bristle"}"#,
    r#"{"in":"hand","do":"brush","brush":{"tip":{"kind":"noise","cells":%},
        "scatter":#,"stabilizer":{"string":#},"jitter":{"hue":20}}}"#,
    r#"{"in":"hand","do":"symmetry","symmetry":3}"#,
    r#"{"in":"stroke","do":"move","layer":"3","strokes":[0],"by":[#,#]}"#,
    r#"{"in":"stroke","do":"restyle","layer":"3","strokes":[0],"to":{"do":"spacing","to":#},"done":true}"#,
    r#"{"in":"stroke","do":"restyle","layer":"3","strokes":[0],"to":{"do":"rotation","to":#},"done":true}"#,
    r#"{"in":"stroke","do":"restyle","layer":"3","strokes":[0],"to":{"do":"brush"},"done":true}"#,
    r#"{"in":"stroke","do":"duplicate","layer":"3","strokes":[0]}"#,
    r#"{"in":"layer","do":"duplicate","layer":"3"}"#,
    r#"{"in":"layer","do":"group","layer":"2"}"#,
    STROKE,
    STROKE,
    r#"{"in":"part","do":"shape","layer":"2","preset":"coin","flats":false}"#,
    r#"{"in":"part","do":"shape","layer":"3","preset":"relief","flats":true}"#,
    r#"{"in":"part","do":"add","kind":"torus"}"#,
    r#"{"in":"part","do":"add","kind":"box"}"#,
    r#"{"in":"part","do":"add","kind":"bevel"}"#,
    r#"{"in":"part","do":"add","kind":"inflate selection"}"#,
    r#"{"in":"part","do":"add","kind":"lathe"}"#,
    r#"{"in":"part","do":"add","kind":"sweep"}"#,
    r#"{"in":"part","do":"add","kind":"sculpt"}"#,
    r#"{"in":"part","do":"order","part":"part-1","index":%}"#,
    r#"{"in":"part","do":"duplicate","part":"part-1"}"#,
    r#"{"in":"part","do":"delete","part":"part-2"}"#,
    r#"{"in":"part","do":"visible","part":"part-1","on":false}"#,
    r#"{"in":"part","do":"set","part":{"id":"part-1","kind":"primitive","shape":"cone","center":[#,9],"radius":#,
        "turn":[#,#,0],"tilt":[#,#],"raise":#,"combine":"union","smooth":#},"done":true}"#,
    r#"{"in":"part","do":"set","part":{"id":"part-1","name":"é","kind":"inflate","outline":{"path":[[4,#],[40,4],
        [20,30]]},"puff":#,"profile":#,"rim":#,"matrix":[1,0,0,1,#,#]},"done":true}"#,
    r#"{"in":"part","do":"set","part":{"id":"part-2","kind":"bevel","outline":{"layer":"fill"},"width":#,"height":#,
        "curve":[[0,#],[1,#]]},"done":true}"#,
    r#"{"in":"part","do":"set","part":{"id":"part-2","kind":"touches","on":"part-1","touches":[{"at":[9,#],
        "radius":#,"normal":[#,0,1],"reach":#}]},"done":true}"#,
    r#"{"in":"part","do":"set","part":{"id":"part-2","kind":"sculpt","on":"part-1","strokes":[{"tool":"crease",
        "size":#,"hardness":#,"strength":#,"samples":[[4,#],[20,20,#]]}]},"done":true}"#,
    r#"{"in":"part","do":"settings","shape":{"tool":"pinch","size":#,"hardness":#,"height":#,"share":#,
        "normal":[#,#,#],"radius":#,"reach":#}}"#,
    SCULPT,
];
const SCULPT: &str = "{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"sculpt\",\"pen\":[24,20,#],\"px_per_pt\":1}\n\
    {\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[17.123,#,0.3],[30,31.7,0.7]]}\n\
    {\"in\":\"pointer\",\"do\":\"release\"}\n\
    {\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"touch\",\"pen\":[24,20,#],\"px_per_pt\":1}\n\
    {\"in\":\"pointer\",\"do\":\"release\"}";
const STROKE: &str = "{\"in\":\"layer\",\"do\":\"select\",\"layer\":\"3\"}\n\
    {\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"brush\",\"pen\":[5,6,#,#,20,0],\"px_per_pt\":1}\n\
    {\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[17.123,#,0.3,1,2,0.25],[30,31.7,0.7,-3,4,#]]}\n\
    {\"in\":\"pointer\",\"do\":\"release\"}";

/// A line of a replay, its numbers filled in.
fn edit() -> impl Strategy<Value = String> {
    let numbers = prop::collection::vec(prop::sample::select(NUMBERS.to_vec()), 8);
    let all: Vec<&str> = PROPERTIES.into_iter().chain(OTHERS).collect();
    (prop::sample::select(all), 0..9usize, numbers).prop_map(|(template, layer, numbers)| {
        let mut numbers = numbers.into_iter().cycle();
        let template = match template.starts_with("{\"in\"") {
            true => template.to_owned(),
            false => format!(r#"{{"in":"layer","do":"set","layer":"{layer}","to":{template},"done":true}}"#),
        };
        let mut line = String::new();
        for c in template.chars() {
            match c {
                // A colour begins with the sign too, within its quotes.
                '#' if !line.ends_with('"') => line += &numbers.next().unwrap_or_default().to_string(),
                '%' => line += &(numbers.next().unwrap_or_default().abs().min(1e6) as u32).to_string(),
                // A long one stands here on two lines, a stroke on several.
                '\n' if !template.contains("pointer") => {}
                c => line.push(c),
            }
        }
        line
    })
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
            let is_kept_out = !is_told || line.contains("pointer") || is_same(&before, document);
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
    let set =
        |layer: usize, to: &str| format!(r#"{{"in":"layer","do":"set","layer":"{layer}","to":{to},"done":true}}"#);
    assert_eq!(
        said(&set(1, r#"{"do":"placement","placement":{"center":[1,1],"scale":0,"rotation":0}}"#)),
        "“image”: the scale is 0; it must be between 0.0001 and 10000. Nothing was changed."
    );
    assert!(
        said(&set(0, r#"{"do":"mask","mask":{"kind":"depth","from":0.5,"to":2}}"#)).contains("must be between 0 and 1")
    );
    let long = format!(r#"{{"do":"name","name":"{}"}}"#, "x".repeat(1_001));
    assert!(said(&set(0, &long)).contains("letters of the name would be 1001; there may be 1000"));
}
#[test]
fn groups_within_groups_are_refused_when_a_file_could_not_hold_them() {
    let mut session = told(r##"{"in":"file","do":"new","width":8,"height":8,"background":"#ffffff"}"##);
    for _ in 0..Document::DEEPEST + 3 {
        let path = vec!["0"; 1 + depth(&session)].join(".");
        session.replay(Path::new("story"), &format!(r#"{{"in":"layer","do":"group","layer":"{path}"}}"#)).unwrap();
    }
    assert_eq!(depth(&session), Document::DEEPEST);
    assert_eq!(session.notes.len(), 3);
    assert!(session.notes[0].contains("Groups around a layer would be 51; there may be 50"), "{}", session.notes[0]);
}
/// How many groups stand around the deepest layer.
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
    assert!(samples.iter().all(|sample| *sample == sample.settled()));
    assert_eq!(samples[1].at.x, (17.123f32 * 256.0).round() / 256.0);
}
