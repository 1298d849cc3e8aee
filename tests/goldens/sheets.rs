//! Sheets of many small pictures: every brush as each operator bends it, what drives a brush, dual
//! brushes, ramps, blend modes of 16 bits, adjustments, filters, effects, balls, regions of the
//! surface and stabilizers. Cells of a sheet are 64 px wide, in the order of the tables that they are
//! made from.

use super::cases::{Case, ROUNDED, as_image, read};
use super::compare::Place;
use super::surfaces::{SIZE, Shape};
use image::{Rgba, RgbaImage};
use rilievo::document::{Highlights, flatten_to_floats};
use rilievo::files::recipe;
use rilievo::math::{Vec2, vec2};
use rilievo::paint::{
    ActiveRetouching, Brush, BrushMode, DualMode, Input, Property, Sample, StabilizedPen,
    Stabilizer, Stroke,
};
use rilievo::raster::CoverageGrid;
use rilievo::surface::{RegionKind, SurfaceRegion};
use rilievo::{BlendMode, Color, Document, Operator, Progress, flatten};
use serde_json::{Value, json};

/// The side of a cell, and where it lies on the canvas.
const CELL: u32 = 64;
const CORNER: (u32, u32) = (8, 4);

/// Every cell of every sheet.
pub fn all() -> Vec<Case> {
    let mut all = Vec::new();
    for (sheet, operator) in [
        ("brushes-flat", json!({ "kind": "none" })),
        ("brushes-depth", json!({ "kind": "depth", "gamma": 1.5 })),
        ("brushes-normals", json!({ "kind": "normal", "alpha": 0.4, "beta": 1.5 })),
    ] {
        all.extend(cells(sheet, recipe::preset_names().map(|key| brush(key, &operator))));
    }
    all.extend(cells("drives", drives()));
    all.extend(cells("dual-brushes", dual_brushes()));
    all.extend(cells("ramps", ramps()));
    all.extend(cells("blend-16-bit", BlendMode::ALL.iter().map(|(_, mode)| blend(mode))));
    all.extend(cells("adjustments", adjustments()));
    all.extend(cells("filters", filters()));
    all.extend(cells("effects", effects()));
    all.extend(cells("balls", recipe::PaintedBall::all().flat_map(balls)));
    all.extend(cells("regions", regions()));
    all.extend(cells("stabilizers", stabilizers()));
    all
}

/// What makes a picture of [`SIZE`].
type Make = Box<dyn Fn() -> RgbaImage + Send + Sync>;

/// The cells of a sheet, in order.
fn cells(sheet: &str, rows: impl IntoIterator<Item = (String, Make)>) -> Vec<Case> {
    let cell = |(index, (name, make)): (usize, (String, Make))| {
        let picture =
            move || image::imageops::crop_imm(&make(), CORNER.0, CORNER.1, CELL, CELL).to_image();
        let place = Place::tile(&format!("sheets/{sheet}"), index as u32, CELL);
        Case::made(format!("{sheet}/{name}"), place, ROUNDED, picture)
    };
    rows.into_iter().enumerate().map(cell).collect()
}

/// Layers over a shape.
fn layers(shape: Option<Shape>, layers: Value) -> Make {
    Box::new(move || {
        let document = Document { surface: shape.map(Shape::surface), ..read(SIZE, &layers) };
        as_image(&flatten(&document, &Progress::default()).unwrap(), SIZE)
    })
}

/// Light paper at the left, dark at the right, so that light and dark paint is seen.
fn paper() -> Value {
    json!({ "kind": "gradient", "from": [10, 36], "to": [70, 36],
        "stops": [[0, "#f0e8d8"], [0.6, "#f0e8d8"], [0.6, "#384048"], [1, "#384048"]] })
}

/// A stroke over the cell and the ball beneath it: pressed in its middle, tilted more and more.
fn pen() -> Vec<[f32; 6]> {
    let reading = |i: i32| {
        let t = i as f32 / 24.0;
        let (x, y) = (13.0 + 54.0 * t, 58.0 - 46.0 * t + 60.0 * t * (t - 0.5) * (1.0 - t));
        [x, y, 0.15 + 3.2 * t * (1.0 - t), 50.0 * t, 20.0 - 40.0 * t, 0.2 * t + 0.1 * t * t]
    };
    (0..=24).map(reading).collect()
}

/// A brush of the program, smaller, on a ball.
fn brush(key: &str, operator: &Value) -> (String, Make) {
    let (preset, _) = recipe::preset_brush(key).unwrap();
    if preset.mode != BrushMode::Paint {
        let operator = match operator["kind"].as_str() {
            Some("depth") => Operator::Depth { gamma: 1.5 },
            Some("normal") => Operator::Normal { alpha: 0.4, beta: 1.5, detail: 0.0 },
            _ => Operator::None,
        };
        return (key.to_owned(), Box::new(move || retouched(&preset, operator)));
    }
    let stroke = json!({ "color": "#a04828", "operator": operator, "samples": pen(),
        "brush": { "preset": key, "size": 16, "reach": 0 } });
    let strokes = json!({ "kind": "strokes", "strokes": [stroke] });
    // An eraser takes paint of its own layer away.
    let layer = match preset.erases {
        false => strokes,
        true => {
            let ground = json!({ "color": "#5878a0", "samples": [[14, 36], [66, 36]],
                "brush": { "size": 44, "hardness": 0.9, "dynamics": { "flow": { "pressure": 0 } } } });
            json!({ "kind": "strokes", "strokes": [ground, stroke] })
        }
    };
    (key.to_owned(), layers(Some(Shape::Ball), json!([paper(), layer])))
}

/// What a brush that works on paint makes of tiles.
fn retouched(preset: &Brush, operator: Operator) -> RgbaImage {
    let ground = json!([{ "kind": "image", "source": { "file": "tiles.png" } }]);
    let mut pixels = flatten(&read(SIZE, &ground), &Progress::default()).unwrap();
    let scene = Document { surface: Some(Shape::Ball.surface()), ..Document::empty(SIZE) }.scene();
    let brush = Brush { size: 18.0, ..preset.clone() };
    let stroke = Stroke::new(brush, operator, Color::BLACK, Vec::new());
    let offset = vec2(9.0, -21.0);
    let mut hand =
        ActiveRetouching::new(&[stroke], &[offset], pixels.clone(), pixels.clone(), &scene);
    let sample = |[x, y, pressure, ..]: [f32; 6]| Sample { pressure, ..Sample::at(vec2(x, y)) };
    let samples: Vec<Sample> = pen().into_iter().map(sample).collect();
    hand.draw(&[samples]).into_iter().for_each(|(at, tile)| pixels.set(at, tile));
    as_image(&pixels, SIZE)
}

/// Every property driven by the pressure, and the size and the hue driven by every input.
fn drives() -> Vec<(String, Make)> {
    let cell = |name: String, changes: Value| {
        let mut brush = json!({ "size": 11, "hardness": 0.7, "spacing": 0.35, "rotation": 20, "flow": 0.8,
            "tip": { "kind": "ellipse", "ratio": 0.6 }, "seed": 5, "dynamics": { "flow": { "pressure": 0 } } });
        for (key, value) in changes.as_object().unwrap() {
            match brush[key].as_object_mut() {
                Some(known) if key == "dynamics" => {
                    known.extend(value.as_object().unwrap().clone());
                }
                _ => brush[key] = value.clone(),
            }
        }
        let stroke = json!({ "color": "#a04828", "samples": pen(), "brush": brush,
            "operator": { "kind": "normal", "alpha": 0.12, "beta": 1 } });
        let strokes = json!({ "kind": "strokes", "strokes": [stroke] });
        (name, layers(Some(Shape::Ball), json!([paper(), strokes])))
    };
    let by_pressure = Property::ALL.iter().filter_map(|(property, name)| {
        let mut changes = json!({ "dynamics": { *name: { "pressure": [[0, 0.1], [1, 0.9]] } } });
        match property {
            // What there has to be for the property to scale it.
            Property::Scatter => changes["scatter"] = json!(1.2),
            Property::Softness => changes["softness"] = json!(0.8),
            Property::Offset | Property::OffsetTurn => changes["offset"] = json!({ "amount": 0.8 }),
            Property::SizeJitter => changes["size_jitter"] = json!(0.8),
            Property::Detail | Property::Gamma | Property::Lead => return None,
            // A brush that picks up paint works on a paint layer.
            Property::Pickup | Property::PickupLength | Property::Custom => return None,
            Property::Lightness => {
                changes["dynamics"][*name] =
                    json!({ "pressure": { "add": [[0, -0.2], [1, 0.5]] } });
            }
            _ => {}
        }
        Some(cell(format!("{name} by pressure"), changes))
    });
    let by_input =
        Input::ALL.iter().filter(|(input, _)| *input != Input::Custom).map(|(_, name)| {
            let curve = json!([[0, 0.15], [0.3, 1], [1, 0.5]]);
            let drives = json!({ "size": { *name: curve }, "hue": { *name: [[0, 0], [1, 0.6]] } });
            let cycle = json!({ "length": 1.5 });
            cell(format!("size by {name}"), json!({ "dynamics": drives, "cycle": cycle }))
        });
    by_pressure.chain(by_input).collect()
}

/// Both tips of a dual brush meeting by each mode; then a second tip that is a picture, one of a
/// brush in many colors, and one of a brush with grain.
fn dual_brushes() -> Vec<(String, Make)> {
    let cell = |name: String, dual: Value, changes: Value| {
        let mut brush = json!({ "size": 22, "hardness": 0.4, "spacing": 0.15, "flow": 0.3,
            "dual": dual, "seed": 5 });
        let changes = changes.as_object().cloned().unwrap_or_default();
        changes.into_iter().for_each(|(key, value)| brush[key] = value);
        let stroke = json!({ "color": "#a04828", "samples": pen(), "brush": brush,
            "operator": { "kind": "normal", "alpha": 0.12, "beta": 1 } });
        let strokes = json!({ "kind": "strokes", "strokes": [stroke] });
        (name, layers(Some(Shape::Ball), json!([paper(), strokes])))
    };
    let dots = |mode: &str| {
        json!({ "mode": mode, "size": 0.35, "spacing": 1.2, "hardness": 0.5, "scatter": 0.6,
            "flow": 0.8 })
    };
    let by_mode =
        DualMode::ALL.iter().map(|(_, mode)| cell((*mode).to_owned(), dots(mode), json!({})));
    let leaves = json!({ "mode": "multiply", "size": 0.8, "spacing": 0.5, "tip": { "file": "leaf.png" },
        "dynamics": { "rotation": { "direction": 1 } } });
    let colors = json!({ "jitter": { "hue": 90, "value": 0.2 } });
    by_mode
        .chain([
            cell("a picture".to_owned(), leaves, json!({})),
            cell("in colors".to_owned(), dots("subtract"), colors),
            cell(
                "grain".to_owned(),
                dots("subtract"),
                json!({ "grain": { "kind": "lines", "size": 4 } }),
            ),
        ])
        .collect()
}

/// Ramps of several stops, bent by each operator, with each filter.
fn ramps() -> Vec<(String, Make)> {
    let operators = [
        ("none", json!({ "kind": "none" })),
        ("depth", json!({ "kind": "depth", "gamma": 2 })),
        ("reflected", json!({ "kind": "normal", "alpha": 0.5, "beta": 1 })),
        ("refracted", json!({ "kind": "normal", "alpha": -0.4, "beta": 2, "detail": 0.6 })),
        ("mirror", json!({ "kind": "reflection", "alpha": 0.5 })),
        ("surface", json!({ "kind": "surface" })),
    ];
    let stops = [
        ("smooth", json!([[0, "#fff4d0"], [0.4, "#203878"], [0.6, "#20a088"], [1, "#ffe060"]])),
        (
            "steps",
            json!([
                [0, "#f8d048"],
                [0.3, "#d04828"],
                [0.3, "#382040"],
                [0.7, "#3090a0"],
                [0.7, "#f0f0e8"]
            ]),
        ),
        ("fading", json!([[0, "#30b06000"], [0.5, "#30b060"], [1, "#e0301000"]])),
    ];
    let filters = ["antialias", "bilinear"];
    let mut cells = Vec::new();
    for (operator_name, operator) in &operators {
        for (i, (stops_name, stops)) in stops.iter().enumerate() {
            let filter = filters[i % 2];
            let layer = json!({ "kind": "gradient", "from": [18, 20], "to": [58, 44], "stops": stops,
                "operator": operator, "filter": filter });
            let name = format!("{operator_name}, {stops_name}, {filter}");
            let ground = json!({ "kind": "fill", "color": "#8890a0" });
            cells.push((name, layers(Some(Shape::BallAndWall), json!([ground, layer]))));
        }
    }
    cells
}

/// Two ramps of a few bytes' range, whose values of more than 8 bits are shown.
fn blend(mode: &str) -> (String, Make) {
    let layers = json!([
        { "kind": "gradient", "from": [8, 20], "to": [72, 30], "stops": [[0, "#504840"], [1, "#a89890"]] },
        { "kind": "gradient", "from": [30, 4], "to": [44, 68], "blend": mode, "opacity": 0.6,
          "stops": [[0, "#705038"], [0.7, "#90a8b8"], [1, "#c8d0c080"]] }
    ]);
    let make = move || {
        let document = read(SIZE, &layers);
        let pixels =
            flatten_to_floats(&document, Highlights::Clipped, &Progress::default()).unwrap();
        let fraction = |v: f32| {
            // A wave of period 16/255: continuous, so that a last bit does not jump.
            let t = (v * 255.0 / 16.0).fract();
            (255.0 * (1.0 - (2.0 * t - 1.0).abs())).round() as u8
        };
        RgbaImage::from_fn(SIZE.width, SIZE.height, |x, y| {
            let [r, g, b, _] = pixels[(y * SIZE.width + x) as usize];
            Rgba([fraction(r), fraction(g), fraction(b), 255])
        })
    };
    (mode.to_owned(), Box::new(make))
}

/// Each effect of a layer, and some of one together, on a stroke and a bar.
fn effects() -> Vec<(String, Make)> {
    let line = |samples: Vec<[f32; 6]>| {
        json!({ "brush": { "size": 16, "hardness": 1 },
        "color": "#b04030", "samples": samples })
    };
    let bar = (0..=6).map(|i| [20.0, 14.0 + 6.0 * i as f32, 1.0, 0.0, 0.0, 0.1]).collect();
    let strokes = json!([line(pen()), line(bar)]);
    let with = |effects: Value| {
        let drawn = json!({ "kind": "strokes", "strokes": strokes, "effects": effects });
        layers(None, json!([paper(), drawn]))
    };
    let stops = json!([[0, "#202040"], [0.5, "#f0c040"], [1, "#f8f8f0"]]);
    let rows = [
        ("drop-shadow", json!({ "size": 8, "distance": 7 })),
        ("outer-glow", json!({ "size": 10, "color": "#40c0ff", "blend": "normal" })),
        (
            "pattern-overlay",
            json!({ "pattern": { "width": 2, "height": 1,
            "pixels": "/wAA/wAA//8" }, "scale": 3 }),
        ),
        ("gradient-overlay", json!({ "stops": stops, "angle": 30 })),
        ("color-overlay", json!({ "color": "#3060d0", "blend": "screen" })),
        ("satin", json!({ "distance": 4, "size": 7 })),
        ("inner-glow", json!({ "size": 8 })),
        ("inner-shadow", json!({ "size": 6, "distance": 4 })),
        ("stroke", json!({ "size": 3, "fill": "gradient", "stops": stops })),
        ("bevel", json!({ "size": 8, "depth": 2 })),
    ];
    let named = |(kind, fields): (&str, Value)| {
        let mut effect = fields;
        effect["kind"] = kind.into();
        effect
    };
    let all: Vec<Value> = rows.iter().cloned().map(named).collect();
    let chisel = json!({ "kind": "bevel", "technique": "chisel", "bevel": "emboss", "size": 10 });
    let together = json!([all[9], all[8], all[7], all[0]]);
    let mut made: Vec<(String, Make)> = rows
        .iter()
        .zip(&all)
        .map(|((kind, _), effect)| ((*kind).to_owned(), with(json!([effect]))))
        .collect();
    made.push(("bevel-chisel".to_owned(), with(json!([chisel]))));
    made.push(("together".to_owned(), with(together)));
    made
}

/// Each adjustment, a little and much, over hues and grays.
fn adjustments() -> Vec<(String, Make)> {
    let table = [
        json!({ "kind": "brightness-contrast", "brightness": 40, "contrast": -30 }),
        json!({ "kind": "brightness-contrast", "brightness": -60, "contrast": 50, "legacy": true }),
        json!({ "kind": "levels", "master": { "black": 40, "gamma": 1.4, "white": 220 } }),
        json!({ "kind": "levels", "red": { "out_black": 60 }, "blue": { "gamma": 0.5, "out_white": 200 } }),
        json!({ "kind": "curves", "master": [[0, 20], [90, 160], [255, 230]] }),
        json!({ "kind": "curves", "red": [[0, 0], [60, 140], [160, 90], [255, 255]], "green": [[0, 255], [255, 0]] }),
        json!({ "kind": "exposure", "exposure": 1.2, "offset": -0.02 }),
        json!({ "kind": "exposure", "exposure": -1, "gamma": 1.6 }),
        json!({ "kind": "vibrance", "vibrance": 80 }),
        json!({ "kind": "vibrance", "vibrance": -40, "saturation": -50 }),
        json!({ "kind": "hue-saturation", "hue": 70, "saturation": 30, "lightness": -15 }),
        json!({ "kind": "hue-saturation", "reds": { "hue": -60 }, "greens": { "saturation": -90 },
            "blues": { "lightness": 40 } }),
        json!({ "kind": "hue-saturation", "colorize": true, "hue": 20 }),
        json!({ "kind": "color-balance", "shadows": { "red": 60 }, "highlights": { "blue": -70 } }),
        json!({ "kind": "color-balance", "midtones": { "green": 80 }, "keep_luminosity": false }),
        json!({ "kind": "black-white" }),
        json!({ "kind": "black-white", "reds": 200, "blues": -100, "tint": true, "color": "#d08040" }),
        json!({ "kind": "photo-filter", "color": "#ec8a00", "density": 60 }),
        json!({ "kind": "photo-filter", "color": "#0060ff", "density": 90, "keep_luminosity": false }),
        json!({ "kind": "channel-mixer", "red": { "red": 20, "green": 60, "constant": 20 } }),
        json!({ "kind": "channel-mixer", "gray": { "red": 120, "blue": -40 }, "monochrome": true }),
        json!({ "kind": "invert" }),
        json!({ "kind": "posterize", "levels": 3 }),
        json!({ "kind": "posterize", "levels": 9 }),
        json!({ "kind": "threshold", "level": 90 }),
        json!({ "kind": "threshold", "level": 180 }),
        json!({ "kind": "gradient-map", "stops": [[0, "#102050"], [0.5, "#d05030"], [1, "#fff0b0"]] }),
        json!({ "kind": "gradient-map", "stops": [[0, "#102050"], [0.2, "#d05030"], [1, "#fff0b0"]], "reverse": true }),
        json!({ "kind": "selective-color", "reds": { "cyan": 80 }, "neutrals": { "yellow": 50 } }),
        json!({ "kind": "selective-color", "greens": { "magenta": 90, "black": 40 },
            "whites": { "black": 60 }, "absolute": true }),
    ];
    let cell = |adjust: Value| {
        let hues = json!([
            [0, "#e02020"],
            [0.17, "#e0e020"],
            [0.33, "#20d020"],
            [0.5, "#20d0d0"],
            [0.67, "#2030e0"],
            [0.83, "#d020d0"],
            [1, "#e02020"]
        ]);
        let grays =
            json!([[0, "#000000"], [0.45, "#00000000"], [0.55, "#ffffff00"], [1, "#ffffff"]]);
        let gray = json!([[0, "#00000000"], [0.75, "#80808000"], [0.8, "#808080"], [1, "#808080"]]);
        let picture = json!([
            { "kind": "gradient", "from": [8, 36], "to": [72, 36], "stops": hues },
            { "kind": "gradient", "from": [40, 4], "to": [40, 68], "stops": grays },
            { "kind": "gradient", "from": [8, 36], "to": [72, 36], "stops": gray, "opacity": 0.7 },
            { "kind": "adjustment", "adjust": adjust },
        ]);
        (adjust.to_string(), layers(None, picture))
    };
    table.into_iter().map(cell).collect()
}

/// Each filter, and those that the surface leads, over a square of two colors before a gradient.
fn filters() -> Vec<(String, Make)> {
    let table = [
        json!({ "kind": "gaussian-blur", "radius": 2 }),
        json!({ "kind": "gaussian-blur", "radius": 7 }),
        json!({ "kind": "box-blur", "radius": 4.5 }),
        json!({ "kind": "motion-blur", "angle": 30, "length": 24 }),
        json!({ "kind": "motion-blur", "angle": -75, "length": 16 }),
        json!({ "kind": "spin-blur", "angle": 40 }),
        json!({ "kind": "zoom-blur", "amount": 40, "x": 20 }),
        json!({ "kind": "lens-blur", "radius": 5, "by_depth": false, "highlights": 200 }),
        json!({ "kind": "lens-blur", "radius": 9, "focus": 10 }),
        json!({ "kind": "surface-blur", "radius": 6 }),
        json!({ "kind": "flow-blur", "length": 24 }),
        json!({ "kind": "flow-blur", "length": 24, "across": true }),
        json!({ "kind": "sharpen", "amount": 150 }),
        json!({ "kind": "unsharp-mask", "amount": 150, "radius": 3 }),
        json!({ "kind": "unsharp-mask", "amount": 150, "radius": 3, "stop_at_contours": true }),
        json!({ "kind": "high-pass", "radius": 4 }),
        json!({ "kind": "noise", "amount": 30 }),
        json!({ "kind": "noise", "amount": 30, "size": 3, "gaussian": true, "monochrome": true }),
        json!({ "kind": "grain", "amount": 80, "size": 6 }),
        json!({ "kind": "grain", "amount": 80, "size": 6, "on_surface": true, "monochrome": false }),
        json!({ "kind": "median", "radius": 3 }),
        json!({ "kind": "glow", "amount": 120, "radius": 6 }),
        json!({ "kind": "pixelate", "size": 7 }),
        json!({ "kind": "halftone", "size": 6 }),
        json!({ "kind": "halftone", "size": 5, "lines": true, "angle": 20, "ink": "#203070", "paper": "#f4ead0" }),
        json!({ "kind": "halftone", "size": 5, "four_inks": true }),
        json!({ "kind": "halftone", "size": 7, "on_surface": true, "transparent": true }),
        json!({ "kind": "edges" }),
        json!({ "kind": "edges", "colored": false, "inverted": true }),
        json!({ "kind": "offset", "right": 30 }),
    ];
    let cell = |filter: Value| {
        let stripes = json!([
            [0, "#203050"],
            [0.3, "#203050"],
            [0.31, "#f0d080"],
            [0.45, "#f0d080"],
            [0.46, "#803020"],
            [0.7, "#d0f0ff"],
            [1, "#ffffff"]
        ]);
        let across = json!([
            [0.3, "#50c04000"],
            [0.31, "#50c040"],
            [0.42, "#50c040"],
            [0.43, "#50c04000"],
            [0.7, "#10101000"],
            [0.71, "#101010"],
            [0.76, "#101010"],
            [0.77, "#10101000"]
        ]);
        let picture = json!([
            { "kind": "gradient", "from": [10, 10], "to": [70, 60], "stops": stripes,
                "clip_to_surface": false },
            { "kind": "gradient", "from": [66, 6], "to": [12, 66], "stops": across,
                "clip_to_surface": false },
            { "kind": "shading", "model": "toon", "opacity": 0.4 },
            { "kind": "filter", "filter": filter },
        ]);
        (filter.to_string(), layers(Some(Shape::BallAndWall), picture))
    };
    table.into_iter().map(cell).collect()
}

/// A ring lit by a painted ball: read for each normal, and with its brush marks whole.
fn balls(ball: recipe::PaintedBall) -> [(String, Make); 2] {
    let lit = |strokes: Value| {
        json!([{ "kind": "shading", "model": "lit-sphere", "sphere": { "file": ball.file() },
            "strokes": strokes }])
    };
    let whole = json!({ "size": 64, "chunk": 18 });
    [
        (ball.key.to_owned(), layers(Some(Shape::Torus), lit(json!(false)))),
        (format!("{}, strokes", ball.key), layers(Some(Shape::Ball), lit(whole))),
    ]
}

/// Regions of every kind around two points, white on blue.
fn regions() -> Vec<(String, Make)> {
    let mut cells = Vec::new();
    for (kind, name) in RegionKind::ALL {
        for (shape, at, contiguous) in [
            (Shape::BallAndWall, vec2(27.5, 30.5), true),
            (Shape::Waves, vec2(30.5, 40.5), false),
            (Shape::Torus, vec2(24.5, 24.5), true),
        ] {
            // All of the waves is one object.
            if (kind, shape) == (RegionKind::Object, Shape::Waves) {
                continue;
            }
            let made = SurfaceRegion { contiguous, softness: 0.5, ..SurfaceRegion::new(kind, at) };
            let make = move || coverage(&made.on(&shape.surface()));
            cells.push((format!("{name} of {shape:?}"), Box::new(make) as Make));
        }
    }
    cells
}

fn coverage(grid: &CoverageGrid) -> RgbaImage {
    RgbaImage::from_fn(SIZE.width, SIZE.height, |x, y| {
        let v = grid.at(x as i32, y as i32);
        Rgba([
            24 + (u32::from(v) * 230 / 255) as u8,
            48 + (u32::from(v) * 200 / 255) as u8,
            88,
            255,
        ])
    })
}

/// What each stabilizer makes of a shaky line, on the canvas and on waves.
fn stabilizers() -> Vec<(String, Make)> {
    let table = [
        ("none", Stabilizer::None),
        ("average 0.5", Stabilizer::Average { weight: 0.5 }),
        ("average 0.8", Stabilizer::Average { weight: 0.8 }),
        ("string 6", Stabilizer::String { length_px: 6.0 }),
        ("string 14", Stabilizer::String { length_px: 14.0 }),
        ("lag 0.02", Stabilizer::Lag { secs: 0.02 }),
        ("lag 0.08", Stabilizer::Lag { secs: 0.08 }),
    ];
    let cell = |(name, stabilizer): (&str, Stabilizer)| {
        let make = move || {
            let mut pen = StabilizedPen::new(stabilizer);
            let mut line: Vec<Vec2> =
                shaky().into_iter().filter_map(|s| pen.push(s)).map(|s| s.at).collect();
            line.extend(pen.finish().map(|sample| sample.at));
            let samples: Vec<[f32; 2]> = line.iter().map(|p| p.to_array()).collect();
            let shake: Vec<[f32; 2]> = shaky().iter().map(|s| s.at.to_array()).collect();
            let stroke = |samples: Vec<[f32; 2]>, color: &str, size: f32| {
                json!({ "color": color,
                "samples": samples, "brush": { "size": size, "hardness": 0.8 } })
            };
            let strokes = [stroke(shake, "#a0a8b8", 2.5), stroke(samples, "#a02810", 2.5)];
            let drawn = json!([{ "kind": "fill", "color": "#f0f0f0" }, { "kind": "strokes", "strokes": strokes }]);
            as_image(&flatten(&read(SIZE, &drawn), &Progress::default()).unwrap(), SIZE)
        };
        (name.to_owned(), Box::new(make) as Make)
    };
    table.into_iter().map(cell).collect()
}

/// A curve drawn in half a second by a hand that trembles.
fn shaky() -> Vec<Sample> {
    let sample = |i: i32| {
        let t = i as f32 / 60.0;
        let tremor = vec2((i * 7 % 5) as f32 - 2.0, (i * 11 % 7) as f32 - 3.0) * 0.8;
        let at = vec2(14.0 + 52.0 * t, 56.0 - 180.0 * t * (1.0 - t) * (1.0 - 0.5 * t)) + tremor;
        Sample { time_secs: 0.5 * t, ..Sample::at(at) }
    };
    (0..=60).map(sample).collect()
}
