//! Paths that stay parameters: nodes with handles, or figures such as stars and arrows, with a fill
//! and an outline. Floor 3. Not here: where a path lies on the canvas and how it bends (`image`).

mod drawing;
mod figure;
mod fit;
mod flatten;
mod half;
mod live_path;
mod nodes;
mod panels;
mod ribbon;
mod subpath;

pub use drawing::PathDrawing;
pub use figure::{Figure, FigureKind};
pub use fit::fit_closed;
pub use flatten::{FlatLine, LinePlace};
pub use half::StraightCut;
pub use live_path::{LivePath, PathCap, PathGeometry, PathJoin, PathRule};
pub use nodes::{NodeHandle, PathPlace};
pub use panels::{PanelDrag, PanelSettings, order_panels};
pub use subpath::{PathNode, Subpath};
