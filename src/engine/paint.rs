//! Floor 3: marks. Each mark is a footprint (*where*: operator, anchors, weights) times a source
//! (*what*: tip, ramp, image), evaluated over tiles. This module does not know the layer tree.

pub mod adjust;
pub mod adjustment;
pub mod attachment;
pub mod brush;
pub mod brush_options;
pub mod color_palette;
mod curve;
mod dab;
mod dab_walker;
pub mod dynamics;
pub mod effect;
pub mod fill;
pub mod filter;
pub mod form_drawing;
pub mod gradient;
pub mod grain;
pub mod image;
pub mod liquify;
mod patches;
pub mod path;
pub mod pattern;
mod peaked;
pub mod picking;
mod prepared_tip;
mod profile;
mod ramp;
mod ramp_colors;
mod ramp_style;
pub mod retouch;
mod rim;
mod sample;
mod scaled;
pub mod scene;
pub mod selection;
pub mod settings;
pub mod stabilizer;
mod stamp;
pub mod stroke;
mod stroke_tile;
mod surface_metric;
#[cfg(test)]
mod test_scenes;
pub mod text;
mod tint;
pub mod tip;

pub use adjust::Adjust;
pub use adjustment::{ColorAdjustment, LiveAdjustment};
pub use attachment::{Attachment, StrokeAttachment};
pub use brush::dual_brush::{DualBrush, DualMode, DualSettings};
pub use brush::{Brush, BrushMode, ColorJitter, Stabilizer, StrokeFrame, Tip};
pub use brush_options::{
    Cycle, DistanceMetric, Falloff, Offset, Pickup, Rate, Spread, StylusFilter,
};
pub use color_palette::{ColorPalette, NamedColor};
pub use dynamics::{Curve, DabInputs, Drive, Dynamics, Input, Property};
pub use effect::{EffectKind, EffectLight, EffectPlace, LayerEffect};
pub use fill::Fill;
pub use filter::{LiveFilter, PictureFilter};
pub use form_drawing::{
    ColorPicture, DrawingHand, DrawingSources, FormDrawing, FormPattern, FoundSources, InkOnCanvas,
    ReadLayers, TonePicture, ToneSource,
};
pub use gradient::{Gradient, GradientStop};
pub use image::{PictureOrigin, PictureSource, PlacedImage, Placement};
pub use liquify::{LiquifySettings, LiquifyStroke, LiquifyTool};
pub use path::{
    Figure, FigureKind, FlatLine, LinePlace, LivePath, PanelDrag, PanelSettings, PathCap,
    PathGeometry, PathJoin, PathNode, PathRule, Subpath,
};
pub use ramp_colors::RampColors;
pub use ramp_style::RampStyle;
pub use retouch::ActiveRetouching;
pub use sample::Sample;
pub use scene::{ImageFilter, Scene};
pub use selection::{Selection, StrokeSelection};
pub use stabilizer::StabilizedPen;
pub use stroke::{ActiveStrokes, Backdrop, Stroke};
pub use text::{Text, TextAlign, TextPath, TextRun, TextStyle};
