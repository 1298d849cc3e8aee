//! What is compared with a reference picture: short recipes, each with its tolerance.
//!
//! Tolerances are steps of a byte. Blending, ramps and masks that are pictures use only sums,
//! products, quotients and roots, which every machine rounds alike: 0. The rest also uses the
//! platform's `exp`, `tan`, `pow` and the like. Their last bit differs between C libraries, so that
//! a value may be rounded to the next byte: 1. The width of SIMD and the number of threads get no
//! tolerance.

use super::compare::Place;
use super::pictures::Pictures;
use super::surfaces::{SIZE, Shape};
use image::RgbaImage;
use rilievo::files::recipe::{self, RecipeSource};
use rilievo::math::vec2;
use rilievo::paint::{ActiveRetouching, Brush, BrushMode, FigureKind, Sample, Stroke};
use rilievo::shading::Model;
use rilievo::{BlendMode, Budget, Color, Document, Operator, Progress, Size, TileGrid, flatten};
use serde_json::{Value, json};
use std::path::Path;

/// Sums, products, quotients and roots.
const EXACT: u8 = 0;
/// And functions of the platform.
pub const ROUNDED: u8 = 1;

/// The canvas of a blend mode.
const SMALL: Size = Size::new(48, 48);
/// The tiles of the sheet of blend modes. New ones go to the end, so that the others stay where
/// they are.
const BLEND_TILES: [&str; 28] = [
    "normal",
    "multiply",
    "screen",
    "overlay",
    "darken",
    "lighten",
    "color-dodge",
    "color-burn",
    "hard-light",
    "soft-light",
    "difference",
    "exclusion",
    "hue",
    "saturation",
    "color",
    "luminosity",
    "plus",
    "linear-dodge",
    "linear-burn",
    "linear-light",
    "vivid-light",
    "pin-light",
    "hard-mix",
    "darker-color",
    "lighter-color",
    "subtract",
    "divide",
    "dissolve",
];

/// One reference picture.
pub struct Case {
    /// Its name: `folder/name`.
    pub name: String,
    /// Its reference picture.
    pub place: Place,
    pub tolerance: u8,
    subject: Subject,
}

enum Subject {
    /// Layers on a canvas, and what they bend over.
    Layers(Size, Option<Shape>, Value),
    /// Brushes rubbed over painted tiles.
    Retouched(Vec<(BrushMode, [f32; 4])>),
    /// Whatever makes a picture.
    Made(Box<dyn Fn() -> RgbaImage + Send + Sync>),
}

impl Case {
    fn layers(group: &str, name: &str, tolerance: u8, shape: Shape, layers: Value) -> Self {
        let name = format!("{group}/{name}");
        Self {
            place: Place::alone(&name),
            name,
            tolerance,
            subject: Subject::Layers(SIZE, Some(shape), layers),
        }
    }

    /// A picture that is made in its own way.
    pub fn made(
        name: String,
        place: Place,
        tolerance: u8,
        make: impl Fn() -> RgbaImage + Send + Sync + 'static,
    ) -> Self {
        Self { name, place, tolerance, subject: Subject::Made(Box::new(make)) }
    }

    pub fn rendered(&self) -> RgbaImage {
        match &self.subject {
            Subject::Layers(size, shape, layers) => {
                let surface = shape.map(Shape::surface);
                let document = Document { surface, ..read(*size, layers) };
                let picture = flatten(&document, &Progress::default()).unwrap();
                as_image(&picture, *size)
            }
            Subject::Retouched(strokes) => as_image(&retouched(strokes), SIZE),
            Subject::Made(make) => make(),
        }
    }
}

/// Every case, in the order of their names' folders.
pub fn all() -> Vec<Case> {
    let mut all = Vec::new();
    all.extend(BlendMode::ALL.iter().map(|(_, name)| blend(name)));
    all.extend(operators());
    all.extend(Model::ALL.iter().map(|(_, name)| shading(name)));
    all.push(ball_strokes());
    all.push(pixel_shading());
    all.push(scaling());
    all.push(normals());
    all.extend(masks());
    all.extend(tips());
    all.push(stroke());
    all.extend(paths());
    all.push(retouch());
    all.extend(super::sheets::all());
    all
}

pub fn read(size: Size, layers: &Value) -> Document {
    let recipe =
        json!({ "canvas": { "width": size.width, "height": size.height }, "layers": layers });
    let source = RecipeSource {
        file: Path::new("case.json"),
        files: &Pictures,
        budget: &Budget::default(),
        onto: None,
    };
    recipe::read_value(&recipe, source).unwrap_or_else(|e| panic!("{e}"))
}

pub fn as_image(picture: &TileGrid, size: Size) -> RgbaImage {
    RgbaImage::from_raw(size.width, size.height, picture.to_straight_rgba(size.rect())).unwrap()
}

/// Two ramps crossed, both of which fade: opaque on opaque, on half, on nothing, and the other way
/// round.
fn blend(mode: &str) -> Case {
    let layers = json!([
        { "kind": "gradient", "from": [0, 20], "to": [48, 28],
          "stops": [[0, "#000000"], [0.3, "#c04020"], [0.6, "#30b0e0"], [0.75, "#ffffff"], [1, "#80808000"]] },
        { "kind": "gradient", "from": [28, 0], "to": [20, 48], "blend": mode,
          "stops": [[0, "#ffffff"], [0.25, "#e0c030"], [0.5, "#4030a0"], [0.7, "#000000"], [1, "#20a06000"]] }
    ]);
    let tile = BLEND_TILES.iter().position(|name| *name == mode).unwrap_or(BLEND_TILES.len());
    let place = Place::tile("blend/modes", tile as u32, SMALL.width);
    Case {
        name: format!("blend/{mode}"),
        place,
        tolerance: EXACT,
        subject: Subject::Layers(SMALL, None, layers),
    }
}

/// Each operator with each filter, pinned at two places, the content dragged at one; and a bent
/// ramp.
fn operators() -> Vec<Case> {
    let operators = [
        ("depth", json!({ "kind": "depth", "gamma": 1.5 })),
        ("normal", json!({ "kind": "normal", "alpha": 0.4, "beta": 1.5, "detail": 0.5 })),
        ("reflection", json!({ "kind": "reflection", "alpha": 0.5 })),
        ("surface", json!({ "kind": "surface" })),
    ];
    let image = |kind: &str, operator: &Value, filter: &str| {
        let layers = json!([{ "kind": "image", "source": { "file": "tiles.png" },
            "operator": operator, "filter": filter,
            "placement": { "center": [38, 37], "scale": 0.8, "rotation": 20 },
            "anchors": [{ "at": [30.5, 33.5] }, { "at": [70.5, 10.5], "source": [66.5, 15] }] }]);
        Case::layers("operator", &format!("{kind}-{filter}"), ROUNDED, Shape::BallAndWall, layers)
    };
    let both = operators
        .iter()
        .flat_map(|(kind, operator)| ["antialias", "bilinear"].map(|f| image(kind, operator, f)));
    let ramp = json!([{ "kind": "gradient", "from": [22, 24], "to": [52, 52], "operator": operators[1].1,
        "stops": [[0, "#fff4d0"], [0.35, "#d07030"], [0.36, "#401040"], [1, "#2060a0"]] }]);
    let even = json!([{ "kind": "gradient", "from": [14, 37], "to": [62, 37], "operator": operators[3].1,
        "stops": [[0, "#fff4d0"], [0.35, "#d07030"], [0.36, "#401040"], [1, "#2060a0"]] }]);
    // The decals' tip is a picture, the line's grain lies on the surface too.
    let decals = json!([{ "kind": "fill", "color": "#f0e8d8" }, { "kind": "strokes", "strokes": [
        { "color": "#b03018", "operator": operators[3].1, "samples": [[24, 24]],
          "brush": { "size": 26, "tip": { "file": "leaf.png" } } },
        { "color": "#203050", "operator": operators[3].1, "samples": [[52, 20], [58, 40], [50, 60]],
          "brush": { "size": 12, "hardness": 0.6,
                     "grain": { "kind": "lines", "size": 4, "lies": "unwrapped" } } } ] }]);
    both.chain([
        Case::layers("operator", "normal-gradient", ROUNDED, Shape::Torus, ramp),
        Case::layers("operator", "surface-gradient", ROUNDED, Shape::Ball, even),
        Case::layers("operator", "surface-strokes", ROUNDED, Shape::Ball, decals),
    ])
    .collect()
}

/// Every term of a model, each scaled, with λ where light has a direction.
fn shading(model: &str) -> Case {
    let scaling = |gamma: f32| json!({ "alpha": 0.3, "gamma": gamma });
    let environment = json!({ "file": "sky.png", "rotation": 25, "exposure": 0.3 });
    let mut layer = json!({ "kind": "shading", "model": model,
        "lights": [
            { "kind": "directional", "direction": [-0.5, 0.6, 0.7], "color": "#fff0d8", "intensity": 0.9 },
            { "kind": "point", "position": [60, 58, 30], "color": "#80a0ff", "intensity": 0.6 }],
        "ambient": { "color": "#a0b0c0", "weight": 0.15, "scaling": scaling(0.8) },
        "diffuse": { "color": "#c08060", "weight": 0.7, "scaling": scaling(1.0) },
        "specular": { "color": "#ffffff", "weight": 0.4, "scaling": scaling(1.2) },
        "curvature_scale": 6, "lambda": 0.4 });
    match model {
        "phong" | "toon" => layer["specular"]["shininess"] = 20.into(),
        "sub-lambertian" => layer["exponent"] = 0.4.into(),
        "ashikhmin" => {
            let dim = json!({ "file": "sky.png", "rotation": 25, "exposure": -1.5 });
            (layer["nu"], layer["nv"], layer["environment"]) = (8.into(), 60.into(), dim);
        }
        "lit-sphere" => layer["sphere"] = json!({ "file": "sphere.png" }),
        "refraction" => (layer["index"], layer["environment"]) = (1.4.into(), environment),
        "mirror" => layer["environment"] = environment,
        "diffuse-environment" | "ambient-occlusion" => {
            (layer["occlusion_radius"], layer["environment"]) = (24.into(), environment);
        }
        // A new model shows what it has by itself.
        _ => {}
    }
    Case::layers("shading", model, ROUNDED, Shape::Torus, json!([layer]))
}

/// A ball whose brush marks stay whole, a little bent.
fn ball_strokes() -> Case {
    let layers = json!([{ "kind": "shading", "model": "lit-sphere", "sphere": { "file": "sphere.png" },
        "strokes": { "size": 48, "chunk": 16, "follow": 0.3 } }]);
    Case::layers("shading", "ball-strokes", ROUNDED, Shape::Torus, layers)
}

/// A painter's light in four tones that mix where they meet, one of them a color that was given.
fn pixel_shading() -> Case {
    let layers = json!([{ "kind": "fill", "color": "#d08858" },
        { "kind": "shading", "model": "painter", "painter": { "beneath": true },
          "pixel": { "bands": 4, "dither": 0.6, "colors": ["#d08858", "#a05a50"] } }]);
    Case::layers("shading", "pixel", ROUNDED, Shape::Torus, layers)
}

/// The relief of a ramp made stronger, in a group of its own.
fn scaling() -> Case {
    let layers = json!([
        { "kind": "fill", "color": "#203040" },
        { "kind": "group", "layers": [
            { "kind": "gradient", "from": [0, 0], "to": [80, 72], "stops": [[0, "#e0c8a0"], [1, "#503828"]] },
            { "kind": "radiance-scaling", "alpha": 0.3, "gamma": 2, "curvature_scale": 12, "blur": 1,
              "lambda": 0.7, "light": [-0.6, 0.4, 0.7] }
        ] }]);
    Case::layers("light", "radiance-scaling", ROUNDED, Shape::Waves, layers)
}

/// Grain on a lit ball.
fn normals() -> Case {
    let layers = json!([
        { "kind": "normals", "strength": 0.6,
          "source": { "noise": { "size": 9, "octaves": 2, "stretch": 2, "seed": 7 } } },
        { "kind": "shading", "model": "phong" }]);
    Case::layers("light", "normals", ROUNDED, Shape::Ball, layers)
}

/// White where the mask is, over blue.
fn masks() -> Vec<Case> {
    let masked = |name: &str, tolerance: u8, mask: Value| {
        let ink = json!({ "kind": "fill", "color": "#fff8e8", "mask": mask });
        let layers = json!([{ "kind": "fill", "color": "#183058" }, ink]);
        Case::layers("mask", name, tolerance, Shape::BallAndWall, layers)
    };
    vec![
        masked("file", EXACT, json!({ "file": "mask.png", "invert": true })),
        masked("fresnel", ROUNDED, json!({ "kind": "fresnel", "f0": 0.1, "power": 2.5 })),
        masked(
            "curvature",
            ROUNDED,
            json!({ "kind": "curvature", "scale": 10, "blur": 1, "from": -0.4, "to": 0.9 }),
        ),
        masked("depth", EXACT, json!({ "kind": "depth", "from": 0.9, "to": 0.1 })),
    ]
}

/// Each kind of tip as one dab on the flat, one bent by the normals and one by the depth.
fn tips() -> Vec<Case> {
    let tips = [
        ("round", json!({ "kind": "round" })),
        ("ellipse", json!({ "kind": "ellipse", "ratio": 0.4 })),
        ("square", json!({ "kind": "square", "ratio": 0.7 })),
        ("bristles", json!({ "kind": "bristles", "count": 30, "seed": 3 })),
        ("noise", json!({ "kind": "noise", "cells": 6, "density": 0.6, "seed": 5 })),
        ("picture", json!({ "file": "leaf.png" })),
        (
            "hose",
            json!({ "kind": "hose", "files": ["dot.png", "leaf.png"],
                "ranks": [{ "count": 2, "select": "incremental" }] }),
        ),
    ];
    let dab = |tip: &Value, operator: Value, at: [f32; 2], color: &str| {
        json!({ "color": color, "operator": operator, "samples": [at],
            "brush": { "size": 26, "hardness": 0.6, "rotation": 30, "tip": tip } })
    };
    let case = |(name, tip): (&str, Value)| {
        let strokes = [
            dab(&tip, json!({ "kind": "none" }), [17.0, 54.0], "#203050"),
            dab(
                &tip,
                json!({ "kind": "normal", "alpha": 0.5, "beta": 1 }),
                [52.5, 22.5],
                "#b03018",
            ),
            dab(&tip, json!({ "kind": "depth", "gamma": 2 }), [54.0, 50.0], "#186830"),
        ];
        // A hose takes its second picture with the second dab.
        let hose = json!({ "color": "#604080", "samples": [[14, 14], [34, 14]],
            "brush": { "size": 18, "spacing": 1, "tip": tip } });
        let strokes = strokes.into_iter().chain((name == "hose").then_some(hose));
        let strokes: Vec<Value> = strokes.collect();
        Case::layers(
            "tip",
            name,
            ROUNDED,
            Shape::Ball,
            json!([
            { "kind": "fill", "color": "#f0e8d8" }, { "kind": "strokes", "strokes": strokes }]),
        )
    };
    tips.into_iter().map(case).collect()
}

/// A stroke that varies with the pen, in size, flow, place and color, and one that takes away.
fn stroke() -> Case {
    let pen: Vec<[f32; 3]> = (0..=12)
        .map(|i| [8.0 + 5.0 * i as f32, 20.0 + 3.0 * ((i * i) % 11) as f32, i as f32 / 12.0])
        .collect();
    let layers = json!([
        { "kind": "fill", "color": "#e8ecf0" },
        { "kind": "strokes", "strokes": [
            { "color": "#c05020", "samples": pen, "operator": { "kind": "normal", "alpha": 0.3 },
              "brush": { "size": 18, "flow": 0.5, "spacing": 0.2, "scatter": 0.2, "jitter": { "hue": 25 }, "seed": 11,
                         "dynamics": { "size": { "pressure": 0.8 } } } },
            { "samples": [[20, 66], [66, 8]], "brush": { "size": 7, "hardness": 0.9, "erases": true } }
        ] }]);
    Case::layers("tip", "stroke", ROUNDED, Shape::Waves, layers)
}

/// Each kind of figure, one of them bent; lines of nodes with holes, dashes and uneven outlines.
fn paths() -> Vec<Case> {
    let path = |path: Value| json!({ "kind": "image", "source": { "path": path }, "clip_to_surface": false });
    let figures: Vec<Value> = FigureKind::ALL
        .iter()
        .zip(0..)
        .map(|((_, kind), i)| {
            let (x, y) = (4.0 + 25.0 * (i % 3) as f32, 8.0 + 34.0 * (i / 3) as f32);
            path(json!({ "fill": "#e0a030", "outline": 2, "outline_color": "#203050",
                "figure": { "kind": kind, "from": [x, y], "to": [x + 22.0, y + 18.0], "corner": 3,
                            "rotation": 10, "head": 12, "shaft": 5 } }))
        })
        .collect();
    let mut bent =
        path(json!({ "fill": "#c03020", "outline": 3, "outline_color": "#fff4d0", "join": "round",
        "figure": { "kind": "star", "from": [10, 8], "to": [68, 64], "sides": 6 } }));
    bent["operator"] = json!({ "kind": "surface" });
    let square = json!([[20, 44], [34, 44], [34, 58], [20, 58]]);
    let wave =
        json!([[8, 26, 0, 0, 10, -26, 0.2], [38, 18, -8, 8, 8, -8, 1], [68, 16, -4, 20, 0, 0, 3]]);
    let lines = [
        path(json!({ "lines": [{ "nodes": wave }], "outline": 5, "outline_color": "#204060" })),
        path(json!({ "fill": "#30806080", "rule": "even-odd", "lines": [
            { "nodes": [[10, 50, 0, 14, 0, -14], [44, 50, 0, -20, 0, 20]], "closed": true },
            { "nodes": square, "closed": true }] })),
        path(json!({ "lines": [{ "nodes": [[50, 66], [60, 40], [74, 64]] }], "outline": 4,
            "outline_color": "#a02020", "cap": "round", "join": "bevel", "dashes": [7, 6] })),
    ];
    vec![
        Case::layers("path", "figures", ROUNDED, Shape::Ball, figures.into()),
        Case::layers("path", "bent", ROUNDED, Shape::Ball, json!([bent])),
        Case::layers("path", "lines", ROUNDED, Shape::Ball, lines.to_vec().into()),
    ]
}

/// Smudged, blurred and cloned, one beneath the other.
fn retouch() -> Case {
    let strokes = vec![
        (BrushMode::Smudge { length: 0.9 }, [8.0, 12.0, 60.0, 16.0]),
        (BrushMode::Blur { width: 0.6 }, [8.0, 36.0, 70.0, 36.0]),
        (BrushMode::Clone { aligned: true, picture: false }, [10.0, 60.0, 66.0, 58.0]),
    ];
    let name = "tip/retouch";
    Case {
        place: Place::alone(name),
        name: name.into(),
        tolerance: ROUNDED,
        subject: Subject::Retouched(strokes),
    }
}

fn retouched(strokes: &[(BrushMode, [f32; 4])]) -> TileGrid {
    let layers = json!([{ "kind": "image", "source": { "file": "tiles.png" } }]);
    let mut pixels = flatten(&read(SIZE, &layers), &Progress::default()).unwrap();
    let scene = Document { surface: Some(Shape::Waves.surface()), ..Document::empty(SIZE) }.scene();
    let operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };
    for &(mode, [x0, y0, x1, y1]) in strokes {
        let brush = Brush { size: 16.0, hardness: 0.8, mode, ..Brush::default() };
        let stroke = Stroke::new(brush, operator, Color::BLACK, Vec::new());
        let offset = vec2(3.0, -21.0);
        let mut hand =
            ActiveRetouching::new(&[stroke], &[offset], pixels.clone(), pixels.clone(), &scene);
        let samples = [vec2(x0, y0), vec2(x1, y1)].map(Sample::at).to_vec();
        hand.draw(&[samples]).into_iter().for_each(|(at, tile)| pixels.set(at, tile));
    }
    pixels
}
