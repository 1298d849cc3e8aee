//! Rilievo as a library: paint over normal and depth maps without the window.
//!
//! A [`Document`] is a canvas, a [`Surface`] to paint on, and layers. Read it from a recipe or a
//! project file, or build it in code; [`render`] makes the picture. Values are cheap to clone and
//! never change while they are shared.
//!
//! Make a surface from a normal map in memory, bend a gradient over it, and keep the picture:
//!
//! ```
//! use rilievo::math::vec2;
//! use rilievo::paint::Gradient;
//! use rilievo::raster::Plane;
//! use rilievo::{Color, Document, Layer, Maps, Operator, Overwrite, Size, Surface, write_picture};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let file = folder.path().join("ball.png");
//! // Camera space: x to the right, y up, z to the viewer. A zero normal is background.
//! let normals = Plane::from_fn(Size::new(128, 128), |x, y| {
//!     let p = (vec2(x as f32, y as f32) - 63.5) / 60.0;
//!     if p.length() < 1.0 { vec2(p.x, -p.y).extend((1.0 - p.length_squared()).sqrt()) } else { Default::default() }
//! });
//! let surface = Surface::new(Maps::from_normals(normals))?;
//! let ramp = Gradient::new(vec2(40.0, 30.0), vec2(90.0, 100.0), &[Color::WHITE, Color::rgb(40, 60, 120)])
//!     .with_operator(Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 });
//! let document = Document::over(surface).with_top(Layer::new("Ramp", ramp));
//! write_picture(&document, &file, Overwrite::Nothing)?;
//! # assert!(file.exists());
//! # Ok(())
//! # }
//! ```
//!
//! Open what the program made, or a recipe, and render it in memory:
//!
//! ```
//! use rilievo::{Budget, open, render};
//!
//! # fn main() -> rilievo::Result<()> {
//! # let folder = tempfile::tempdir().unwrap();
//! # let file = folder.path().join("painting.json");
//! # let text = r##"{ "format": "rilievo", "version": 1, "canvas": { "width": 64, "height": 64 },
//! #     "layers": [{ "kind": "fill", "color": "#20242c" }] }"##;
//! # std::fs::write(&file, text).unwrap();
//! let opened = open(&file, &Budget::default())?;
//! for note in &opened.notes {
//!     eprintln!("{note}");
//! }
//! let pixels = render(&opened.document);
//! assert_eq!(pixels.pixel(10, 10), [0x20, 0x24, 0x2c, 255]);
//! # Ok(())
//! # }
//! ```
//!
//! Save a document as a project that the program opens:
//!
//! ```
//! use rilievo::{BlendMode, Color, Document, Layer, Overwrite, Progress, Size, save};
//!
//! # fn main() -> rilievo::Result<()> {
//! # let folder = tempfile::tempdir().unwrap();
//! # let project = folder.path().join("two-fills.ora");
//! let glow = Layer { blend: BlendMode::Screen, opacity: 0.5, ..Layer::new("Glow", Color::rgb(192, 128, 64)) };
//! let document = Document::empty(Size::new(320, 200))
//!     .with_top(Layer::new("Ground", Color::rgb(32, 36, 44)))
//!     .with_top(glow);
//! save(&document, &project, Overwrite::Nothing, &Progress::default())?;
//! # assert!(project.exists());
//! # Ok(())
//! # }
//! ```
//!
//! The repository's `examples` folder has a page each on rendering, gradients, strokes, shapes made
//! from drawings, and a shading model of one's own.
//!
//! | module | holds |
//! |---|---|
//! | [`surface`] | normal and depth maps, the operators that bend marks over them, anchors |
//! | [`paint`] | brushes and strokes, gradients, placed images, fills, selections |
//! | [`shading`] | materials, lights, environments, radiance scaling |
//! | [`shape`] | shapes for drawings that have no maps: parts, and what they are made of |
//! | [`document`] | documents and layers, and rendering them |
//! | [`raster`] | pixels: tiles, planes, pictures, blend modes |
//! | [`math`] | vectors, sizes, rectangles, colors |
//! | [`files`] | recipes, projects, pictures and maps on the disk, and the limits that readers respect |
//!
//! Coordinates are canvas pixels, x to the right and y down; the middle of the first pixel is (0.5,
//! 0.5). Normals are in camera space, y up. Colors are sRGB, and pixels of a picture are
//! premultiplied. Angles are in degrees, counter-clockwise as seen, where a name does not say
//! otherwise.
//!
//! Anything not named here is not part of the library: the crates `rilievo-engine`, `rilievo-io`,
//! `rilievo-program` and `rilievo-window` may change with every release.

#![warn(missing_docs)]

/// Normal and depth maps, the operators that bend marks over them, and the anchors that pin marks.
pub mod surface {
    #[doc(inline)]
    pub use rilievo_engine::surface::{
        Anchor, Bend, Curvature, Deformation, DetailMap, FlowField, Maps, NoiseRelief, Objects,
        Operator, PaintLimit, Scene, StructureTensor, Surface, SurfaceError, Weights,
        objects::CanvasPart,
        plane_piece::PlanePiece,
        region::{RegionKind, SurfaceRegion},
    };
}

/// Marks: brushes and their strokes, gradients, placed images, fills and selections.
pub mod paint {
    #[doc(inline)]
    pub use rilievo_engine::paint::{
        ActiveRetouching, ActiveStrokes, Adjust, Attachment, Backdrop, Brush, BrushMode,
        ColorJitter, Curve, Cycle, DabInputs, DistanceMetric, Drive, DualBrush, DualMode,
        DualSettings, Dynamics, Falloff, Figure, FigureKind, Fill, Gradient, GradientStop,
        ImageFilter, Input, LivePath, Offset, PathCap, PathGeometry, PathJoin, PathNode, PathRule,
        Pickup, PictureOrigin, PictureSource, PlacedImage, Placement, Property, Rate, Sample,
        Selection, Spread, StabilizedPen, Stabilizer, Stroke, StrokeAttachment, StrokeFrame,
        StrokeSelection, StylusFilter, Subpath, Text, TextAlign, TextRun, TextStyle, Tip,
        grain::{BrushGrain, GrainSource, GrainSpace},
        tip::{Bristles, Hose, Noise},
    };
}

/// Light: materials, lights, environments, and radiance scaling.
pub mod shading {
    #[doc(inline)]
    pub use rilievo_engine::shading::{
        BallStrokes, Environment, FeatureScale, Features, Light, LightKind, LitSphere, Model, Mood,
        NumberSetting, Painter, Projection, RadianceScaling, Reference, Scaling, Shading, Shadows,
        SolidGlass, Term,
    };
}

/// Shapes for drawings that have no maps: parts of a document, and what they are made of.
pub mod shape {
    #[doc(inline)]
    pub use rilievo_engine::document::parts::{
        CoverageFile, FlatColor, Inflation, OutlineSource, Part, PartKind, PartMaps, Parts,
        ProfilePicture,
        drawing::{FigureBackground, without_background},
        from_flats::{FlatParts, PartFor, parts_of_flats},
    };
    #[doc(inline)]
    pub use rilievo_engine::shape::{
        Ball, Bevel, BevelCurve, Body, Combine, Detail, LineForm, Lines, Primitive, SculptStroke,
        SculptTool, Touch,
    };
}

/// Documents: layers and what they hold, and rendering them.
pub mod document {
    #[doc(inline)]
    pub use rilievo_engine::document::{
        Content, DerivedMask, DetailSource, Document, Group, Highlights, History, Layer, LayerId,
        LayerLabel, LayerLock, LayerMask, LayerSlot, LayerTransform, Live, MaskKind, Mesh,
        MeshFrame, NamedSelection, NormalLayer, PixelLayer, PreparedDocument, Progress, StrokeList,
        TransformShape, diff, flatten, flatten_layer, flatten_layers, flatten_to_floats,
    };
}

/// Pixels: tiles of a layer, planes of a map, pictures of a file, and how colors are blended.
pub mod raster {
    #[doc(inline)]
    pub use rilievo_engine::raster::{
        Asset, BlendMode, CoverageGrid, Lattice, Outside, Picture, PlanarTile, Plane, Resampling,
        SelectionMode, TILE, Tile, TileAt, TileGrid, picture::Texels,
    };
}

/// Numbers: vectors, sizes, rectangles, maps of the plane and colors.
pub mod math {
    #[doc(inline)]
    pub use rilievo_engine::math::{
        Affine2, Mat2, Mat3, PlaneMap, Range, Rect, Size, Vec2, Vec3, srgb::Color, vec2, vec3,
    };
}

/// Files: recipes, projects, pictures and maps, and the limits that their readers respect.
pub mod files {
    #[doc(inline)]
    pub use rilievo_engine::document::source::{
        DepthConvention, DepthEncoding, MapSource, MaskSource, Near, NormalConvention,
        NormalEncoding, NormalSpace, SurfaceSource,
    };
    #[doc(inline)]
    pub use rilievo_io::{
        Budget, Files, OpenedDocument, Overwrite, RecipeFolder, SavedDocument, Terms, export, maps,
        open, picture, recipe, save, text,
    };
}

#[doc(no_inline)]
pub use crate::document::{Content, Document, Group, Layer, Progress, flatten, flatten_layer};
#[doc(no_inline)]
pub use crate::files::{Budget, Overwrite, export::write_picture, open, save};
#[doc(no_inline)]
pub use crate::math::{Color, Size};
#[doc(no_inline)]
pub use crate::raster::{BlendMode, TileGrid};
#[doc(no_inline)]
pub use crate::surface::{Anchor, Bend, Maps, Operator, Surface};
pub use rilievo_engine::{Error, Remedy, Result};

/// The whole picture of a document: premultiplied sRGB in tiles, the pixels of the canvas and no
/// others.
///
/// If the document's parts have changed, its surface is computed first. Uses all cores. To show
/// progress or to cancel, call [`flatten()`] with a [`Progress`].
pub fn render(document: &Document) -> TileGrid {
    // None only where the work was canceled, and nobody can.
    flatten(&document.reshaped(), &Progress::default()).unwrap_or_default()
}
