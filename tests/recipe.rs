//! Recipes: every kind of layer read with its defaults, refused with the path of what is wrong, and
//! written back.

mod former;
mod mutations;
mod refusals;

use rilievo::document::{DerivedMask, MaskKind};
use rilievo::files::Files;
use rilievo::files::recipe::{self, RecipeSource};
use rilievo::math::vec2;
use rilievo::paint::{ImageFilter, Tip};
use rilievo::raster::Outside;
use rilievo::surface::Weights;
use rilievo::{Anchor, BlendMode, Budget, Color, Content, Document, Error, Operator, Result, Size};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Files in memory, as a project's zip will hold them; counts how often one is read.
#[derive(Default)]
struct InMemory {
    files: HashMap<&'static str, Vec<u8>>,
    reads: AtomicUsize,
}

impl Files for InMemory {
    fn read(&self, name: &str, _: &Budget) -> Result<Vec<u8>> {
        self.reads.fetch_add(1, Ordering::Relaxed);
        let missing = || Error::io(name, std::io::Error::from(std::io::ErrorKind::NotFound));
        self.files.get(name).cloned().ok_or_else(missing)
    }

    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}

/// A PNG of one color.
fn png(width: u32, height: u32, rgba: [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_pixel(width, height, image::Rgba(rgba));
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn files() -> InMemory {
    let files = [
        ("p.png", png(10, 6, [9, 8, 7, 255])),
        ("m.png", png(32, 16, [255; 4])),
        ("broken.png", vec![1, 2, 3]),
    ];
    InMemory { files: files.into(), ..InMemory::default() }
}

fn read_with(files: &InMemory, recipe: &Value, budget: &Budget) -> Result<Document> {
    let text = recipe.to_string();
    recipe::read(
        text.as_bytes(),
        RecipeSource { file: Path::new("r.json"), files, budget, onto: None },
    )
}

fn read(recipe: &Value) -> Result<Document> {
    read_with(&files(), recipe, &Budget::default())
}

fn with_layers(layers: Value) -> Value {
    json!({ "canvas": { "width": 32, "height": 16 }, "layers": layers })
}

fn only_layer(layer: Value) -> rilievo::Layer {
    let document = read(&with_layers(json!([layer]))).unwrap_or_else(|e| panic!("{e}"));
    (*document.layers[0]).clone()
}

/// The sentence that refuses a document.
fn said(recipe: &Value) -> String {
    read(recipe).err().unwrap_or_else(|| panic!("read without complaint: {recipe}")).to_string()
}

/// The sentence that refuses a document of one layer.
fn said_of(layer: Value) -> String {
    said(&with_layers(json!([layer])))
}

#[test]
fn what_is_not_said_takes_its_default() {
    let layer = only_layer(json!({ "kind": "fill" }));
    assert!(layer.visible && layer.clip_to_surface && !layer.clip_below && !layer.blend_linear);
    assert_eq!((layer.opacity, layer.blend, layer.name.as_str()), (1.0, BlendMode::Normal, ""));
    assert!(matches!(layer.content, Content::Fill(Color::BLACK)));

    let Content::Image(image) =
        only_layer(json!({ "kind": "image", "source": { "file": "p.png" } })).content
    else {
        panic!("an image layer");
    };
    let image = image.params();
    assert_eq!((image.outside, image.filter), (Outside::Mirror, ImageFilter::Antialias));
    assert_eq!((image.placement.center, image.placement.scale), (vec2(16.0, 8.0), 1.0));
    assert_eq!((image.bend.operator, image.bend.anchors.len()), (Operator::None, 0));
    assert_eq!(image.bend.weights, Weights::Shepard { power: 2.0 });

    let Content::Gradient(gradient) = only_layer(json!({ "kind": "gradient" })).content else {
        panic!("a gradient layer");
    };
    assert_eq!((gradient.params().from, gradient.params().to), (vec2(0.0, 8.0), vec2(32.0, 8.0)));
    assert_eq!(gradient.params().stops.len(), 2);
}

#[test]
fn an_operator_without_anchors_is_pinned_at_the_center_of_the_placement() {
    let anchors = |anchors: Value| {
        let mut layer = json!({ "kind": "image", "source": { "file": "p.png" }, "operator": { "kind": "normal" },
            "placement": { "center": [3, 4] } });
        if !anchors.is_null() {
            layer["anchors"] = anchors;
        }
        let Content::Image(image) = only_layer(layer).content else { panic!("an image layer") };
        image.params().bend.anchors.clone()
    };
    assert_eq!(anchors(Value::Null), [Anchor::pin(vec2(3.0, 4.0))]);
    assert_eq!(anchors(json!([])), []);
    let dragged = anchors(json!([{ "at": [1, 2], "source": [5, 6] }, { "at": [7, 8] }]));
    assert_eq!(
        dragged,
        [Anchor { at: vec2(1.0, 2.0), source: vec2(5.0, 6.0) }, Anchor::pin(vec2(7.0, 8.0))]
    );
}

#[test]
fn strokes_read_their_samples_brush_and_preset() {
    let Content::Strokes(strokes) = only_layer(json!({ "kind": "strokes", "strokes": [
        { "color": "#ff0000", "samples": [[1, 2], [3, 4, 0.5], [5, 6, 0.25, 10, -20, 1.5]] },
        { "brush": { "preset": "highlight-satin", "size": 33 } },
        { "brush": { "tip": { "file": "p.png" }, "dynamics": { "size": { "pressure": 1 } } },
          "operator": { "kind": "depth" } }
    ] }))
    .content
    else {
        panic!("a stroke layer");
    };
    let strokes = &strokes.params().strokes;
    let samples = strokes[0].samples();
    assert_eq!((samples[0].pressure, samples[1].pressure), (1.0, 0.5));
    assert_eq!((samples[2].tilt, samples[2].time_secs), (vec2(10.0, -20.0), 1.5));
    assert_eq!(strokes[0].brush().size, 80.0);
    assert_eq!(strokes[1].brush().size, 33.0);
    assert!(matches!(strokes[1].operator(), Operator::Normal { .. }), "the preset's own operator");
    assert!(matches!(strokes[2].brush().tip, Tip::Picture(_)));
    assert_eq!(strokes[2].brush().dynamics.pressure_share(rilievo::paint::Property::Size), 1.0);
    assert_eq!(strokes[2].operator(), Operator::Depth { gamma: 1.0 });
}

#[test]
fn masks_read_with_their_defaults() {
    let mask = |mask: Value| only_layer(json!({ "kind": "fill", "mask": mask })).mask.unwrap();
    assert!(matches!(mask(json!({ "file": "m.png" })).kind, MaskKind::File { .. }));
    let fresnel = mask(json!({ "kind": "fresnel", "invert": true }));
    assert!(
        fresnel.invert
            && matches!(
                fresnel.kind,
                MaskKind::Derived(DerivedMask::Fresnel { f0: 0.04, power: 5.0 })
            )
    );
    let curvature = mask(json!({ "kind": "curvature" })).kind;
    assert!(matches!(curvature, MaskKind::Derived(DerivedMask::CURVATURE)));
    assert!(matches!(
        mask(json!({ "kind": "depth", "from": 1, "to": 0.5 })).kind,
        MaskKind::Derived(DerivedMask::Depth { from: 1.0, to: 0.5 })
    ));
}

/// One document with every kind of layer and every field away from its default.
fn everything() -> Value {
    let placement = json!({ "center": [10.5, 3], "scale": 0.75, "rotation": -30 });
    let source = json!({ "file": "p.png", "blur": 2, "exposure": -1, "hue": 20, "saturation": 0.5, "brightness": 1.1,
        "contrast": 0.9 });
    let term =
        json!({ "color": "#102030", "weight": 0.4, "scaling": { "alpha": 0.3, "gamma": 2 } });
    with_layers(json!([
        { "name": "ground", "kind": "fill", "visible": false, "opacity": 0.3, "blend": "color-dodge",
          "blend_space": "linear",
          "clip_below": true, "lock": "alpha", "clip_to_surface": false, "mask": { "file": "m.png", "invert": true },
          "color": "#12345678" },
        { "name": "paint", "kind": "pixels", "mask": { "kind": "fresnel", "f0": 0.1, "power": 3 }, "file": "p.png",
          "x": -3, "y": 4 },
        { "name": "photo", "kind": "image", "mask": { "kind": "curvature", "scale": 2, "blur": 1, "from": 0.5,
          "to": -0.5 },
          "source": source, "placement": placement, "outside": "none",
          "operator": { "kind": "normal", "alpha": -0.25, "beta": 3, "detail": 0.1 },
          "anchors": [{ "at": [1, 2], "source": [3.25, 4] }, { "at": [5, 6] }], "weights": { "power": 3 },
            "filter": "bilinear" },
        { "name": "unpinned", "kind": "image", "source": { "file": "p.png" }, "operator": { "kind": "reflection",
          "alpha": 1,
          "detail": 0.5 }, "anchors": [] },
        { "name": "print", "kind": "image", "source": { "file": "p.png" },
          "operator": { "kind": "surface", "amount": 0.5, "smooth": 3 }, "anchors": [{ "at": [1, 2] }],
          "pieces": [{ "at": [3, 4], "move": [-5, 6.5], "scale": 2, "rotation": -30 }, { "at": [7, 8] }] },
        { "name": "ramp", "kind": "gradient", "mask": { "kind": "depth", "from": 0.25, "to": 0.75 }, "from": [1, 2],
          "to": [3, 4],
          "stops": [[0, "#000000"], [0.3, "#ff000080"], [1, "#ffffff"]], "operator": { "kind": "depth", "gamma": 2.5 },
          "filter": "bilinear" },
        { "name": "print of a ramp", "kind": "gradient", "from": [1, 2], "to": [3, 4], "stops": [[0, "#000000"]],
          "operator": { "kind": "surface", "amount": 0.5, "smooth": 3 },
          "pieces": [{ "at": [3, 4], "move": [-5, 6.5], "scale": 2, "rotation": -30 }, { "at": [7, 8] }] },
        { "name": "marks", "kind": "strokes", "strokes": [
          { "brush": { "size": 20, "hardness": 0.1, "opacity": 0.9, "flow": 0.8, "spacing": 0.2, "rotation": 15,
            "softness": 0.3,
            "tip": { "file": "p.png" }, "dynamics": { "size": { "pressure": 0.5 }, "flow": { "pressure": 0 } } },
            "operator": { "kind": "normal" }, "color": "#abcdef", "samples": [[1, 2], [3, 4, 0.5], [5, 6, 1, 10, -20,
              1.5]] }] },
        { "name": "lit", "kind": "shading", "model": "toon",
          "lights": [{ "kind": "directional", "direction": [0, 0, 1], "color": "#ff0000", "intensity": 2 },
                     { "kind": "point", "position": [1, 2, 30] }],
          "ambient": term, "diffuse": term, "specular": { "weight": 0.5, "shininess": 10 },
          "lambda": 0.5, "curvature_scale": 2, "blur": 1, "reference": 0.8,
          "bands": 6, "exponent": 0.25, "nu": 10, "nv": 20,
          "environment": { "file": "p.png", "projection": "angular", "rotation": 90, "exposure": 1 },
          "sphere": { "file": "p.png" }, "sphere_concave": { "file": "p.png" }, "index": 1.33, "occlusion_radius": 12,
          "bounces": 3 },
        { "name": "painted light", "kind": "shading", "model": "painter",
          "shadows": { "on": false, "strength": 0.5, "softness": 0.3, "reach": 90, "ground": 0.25,
            "color": "#102030", "rays": 12 },
          "painter": { "beneath": true, "wrap": 0.25, "warmth": -1, "fill": 2, "bounce": 0.5, "around": 3, "edge": 1.5,
            "rim": 4, "contact": 2, "contact_size": 30, "contact_floor": 0.5, "exposure": 1.25,
            "fill_color": "#0000ff", "bounce_color": "#ff0000", "rim_color": "#00ff00" } },
        { "name": "shape", "kind": "radiance-scaling", "alpha": 0.5, "gamma_convex": 3, "gamma_concave": 1,
          "lambda": -1,
          "scales": [{ "curvature_scale": 2, "weight": 2 }, { "blur": 3 }], "light": [1, 0, 0], "reference": 0.5,
          "keep_mean": true },
        { "name": "grain", "kind": "normals", "source": { "file": "p.png" }, "convention": "directx",
          "placement": placement, "outside": "clamp",
          "strength": 2 },
        { "name": "brushed", "kind": "normals", "strength": 0.5,
          "source": { "noise": { "size": 8, "octaves": 2, "roughness": 0.25, "stretch": 20, "seed": 7 } } },
        { "name": "set", "kind": "group", "pass_through": true, "layers": [{ "name": "inner", "kind": "fill",
          "color": "#000000" }] }
    ]))
}

#[test]
fn every_field_of_every_kind_is_written_as_it_was_read() {
    let recipe = everything();
    let written = recipe::write(&read(&recipe).unwrap_or_else(|e| panic!("{e}")));
    for (read, written) in
        recipe["layers"].as_array().unwrap().iter().zip(written["layers"].as_array().unwrap())
    {
        assert_eq!(
            without_float_spelling(read),
            without_float_spelling(written),
            "{}",
            read["name"]
        );
    }
    assert_eq!(recipe["canvas"], written["canvas"]);
}

/// 2 and 2.0 are the same number.
fn without_float_spelling(value: &Value) -> Value {
    match value {
        Value::Number(n) => json!(n.as_f64()),
        Value::Array(items) => items.iter().map(without_float_spelling).collect(),
        Value::Object(map) => {
            map.iter().map(|(k, v)| (k.clone(), without_float_spelling(v))).collect()
        }
        other => other.clone(),
    }
}

#[test]
fn what_is_default_is_not_written() {
    let layers = json!([{ "kind": "image", "source": { "file": "p.png" }, "operator": { "kind": "depth" } },
        { "kind": "shading" }, { "kind": "radiance-scaling" }]);
    let written = recipe::write(&read(&with_layers(layers)).unwrap());
    let expected = json!([{ "kind": "image", "source": { "file": "p.png" }, "operator": { "kind": "depth" } },
        { "kind": "shading", "model": "phong" }, { "kind": "radiance-scaling" }]);
    assert_eq!(written["layers"], expected);
}

#[test]
fn the_same_file_is_read_once() {
    let files = files();
    let image = json!({ "kind": "image", "source": { "file": "p.png" } });
    let pixels = json!({ "kind": "pixels", "file": "p.png", "x": 2 });
    let document =
        read_with(&files, &with_layers(json!([image, image, pixels])), &Budget::default()).unwrap();
    assert_eq!(files.reads.load(Ordering::Relaxed), 1);
    let (Content::Image(a), Content::Image(b)) =
        (&document.layers[0].content, &document.layers[1].content)
    else {
        panic!("image layers");
    };
    assert!(std::sync::Arc::ptr_eq(&a.params().source.texture(), &b.params().source.texture()));
}

#[test]
fn documents_beyond_the_budget_are_refused() {
    let says = |budget: Budget, layers: Value, wanted: &str| {
        let said =
            read_with(&files(), &with_layers(layers), &budget).err().expect(wanted).to_string();
        assert!(said.contains("too large") && said.contains(wanted), "{said}");
    };
    let small = Budget {
        layers: 2,
        group_depth: 1,
        anchors: 1,
        samples: 1,
        document_px: 100,
        ..Budget::default()
    };
    let fill = json!({ "kind": "fill" });
    let image = |anchors: Value| json!({ "kind": "image", "source": { "file": "p.png" }, "anchors": anchors });
    says(
        small,
        json!([fill, { "kind": "group", "layers": [fill] }]),
        "layers[1].layers has 1 items",
    );
    says(
        small,
        json!([{ "kind": "group", "layers": [{ "kind": "group" }] }]),
        "layers[0].layers[0] is nested",
    );
    says(
        small,
        json!([image(json!([{ "at": [1, 2] }, { "at": [1, 2] }]))]),
        "layers[0].anchors has 2 items",
    );
    says(
        small,
        json!([{ "kind": "strokes", "strokes": [{ "samples": [[1, 2], [1, 2]] }] }]),
        "samples has more than 1 readings",
    );
    let few = Budget { document_px: 50, ..Budget::default() };
    says(few, json!([{ "kind": "pixels", "file": "p.png" }]), "more than 50 pixels together");
}

#[test]
fn thirty_two_groups_within_each_other_fit() {
    let innermost =
        json!({ "kind": "image", "source": { "file": "p.png" }, "anchors": [{ "at": [1, 2] }] });
    let nested = (0..32).fold(innermost, |inner, _| json!({ "kind": "group", "layers": [inner] }));
    assert!(read(&with_layers(json!([nested]))).is_ok());
}

#[test]
fn the_surface_is_written_as_it_was_read() {
    let surface = json!({
        "normal": { "file": "n.exr", "channel": "ViewLayer.Normal", "convention": { "encoding": "signed",
          "channels": "bgr",
            "srgb": true, "flip_x": true, "flip_y": false, "flip_z": true, "space": "world",
            "world_to_camera": [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]], "snap_flat": true,
              "smooth_steps": false } },
        "depth": { "file": "z.exr", "channel": "ViewLayer.Depth.Z", "near": "high", "encoding": "ray-distance",
          "fov": 45.0,
            "background": [0.0, 65504.0], "range_px": 100.0, "smooth_steps": true },
        "mask": { "file": "m.png", "channel": "R", "invert": true }
    });
    let node = rilievo_io::json::JsonNode::root(Path::new("r.json"), &surface);
    let written =
        recipe::surface::write(&recipe::surface::read(&node).unwrap().unwrap()).into_value();
    assert_eq!(without_float_spelling(&written), without_float_spelling(&surface));
}

#[test]
fn a_canvas_keeps_its_size_whatever_the_layers() {
    let document = read(&everything()).unwrap();
    assert_eq!(document.size, Size::new(32, 16));
    assert!(document.surface.is_none());
}

/// The examples of the pages must work, except the maps, which another test covers.
#[test]
fn every_recipe_in_the_documentation_reads() {
    struct AnyPicture;
    impl Files for AnyPicture {
        fn read(&self, _: &str, _: &Budget) -> Result<Vec<u8>> {
            Ok(png(4, 4, [255; 4]))
        }

        fn path(&self, name: &str) -> PathBuf {
            name.into()
        }
    }
    let mut read = 0;
    for page in ["README.md", "docs/RECIPES.md"] {
        let text =
            std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(page)).unwrap();
        for block in text.split("```json\n").skip(1).map(|rest| rest.split("```").next().unwrap()) {
            let mut recipe: Value =
                serde_json::from_str(block).unwrap_or_else(|e| panic!("{page}: {e}"));
            recipe.as_object_mut().unwrap().remove("surface");
            recipe["canvas"] = json!({ "width": 8, "height": 8 });
            let source = RecipeSource {
                file: Path::new(page),
                files: &AnyPicture,
                budget: &Budget::default(),
                onto: None,
            };
            recipe::read(recipe.to_string().as_bytes(), source).unwrap_or_else(|e| panic!("{e}"));
            read += 1;
        }
    }
    assert!(read >= 2);
}

#[test]
fn every_brush_preset_is_listed_in_the_documentation() {
    let page =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/RECIPES.md"))
            .unwrap();
    for name in recipe::preset_names() {
        assert!(page.contains(&format!("`{name}`")), "{name}");
    }
}
