//! Whether what is said of an edit names what was edited: where a save does not come back as it was,
//! and where an edit is refused, the user reads this.

use super::promises::Broken;
use crate::document::{Document, Layer};
use crate::session::Property;
use crate::session::actions::{Action, LayerAction};
use std::sync::Arc;

/// What differs after a property was set is called by its name, and is the layer that was set.
pub fn difference_is_named(
    action: &Action,
    before: &Document,
    after: &Document,
) -> Result<(), Broken> {
    let Action::Layer(LayerAction::Set { layer, to, done: true }) = action else { return Ok(()) };
    let Some(what) = before.difference(after) else { return Ok(()) };
    let layers = layer.find(before).unwrap_or_default();
    let mut set = layers.iter().filter_map(|id| before.layer(*id));
    let names = |layer: &Arc<Layer>| {
        names_of(to).iter().any(|name| what == format!("“{}”: its {name}", layer.name))
    };
    // Outlines follow the names of layers.
    let is_outline = matches!(to, Property::Name { .. }) && what.ends_with("of its shape");
    if set.any(names) || is_outline {
        return Ok(());
    }
    Err(Broken::new("a difference by another name", format!("{}: {what}", to.label())))
}

/// A sentence that refuses to set a property begins with the layer, or with what there would be too
/// much of.
pub fn refusal_is_named(action: &Action, before: &Document, note: &str) -> Result<(), Broken> {
    let Action::Layer(LayerAction::Set { layer, .. }) = action else { return Ok(()) };
    const WHOLE: [&str; 5] =
        ["Layers ", "Groups ", "Readings of the pen ", "The drawing would hold ", "Too large: "];
    let shown = |layer: &Layer| layer.name.chars().take(60).collect::<String>();
    let layers = layer.find(before).unwrap_or_default();
    let mut set = layers.iter().filter_map(|id| before.layer(*id));
    if set.any(|layer| note.starts_with(&format!("“{}", shown(layer))))
        || WHOLE.iter().any(|begins| note.starts_with(begins))
    {
        return Ok(());
    }
    Err(Broken::new("a refusal by another name", note.into()))
}

/// What a property is called where two documents differ in it. A new property belongs here.
fn names_of(property: &Property) -> &'static [&'static str] {
    use Property::*;
    match property {
        Name { .. } => &["name"],
        Visible { .. } => &["visibility"],
        Opacity { .. } => &["opacity"],
        Effects { .. } | FillOpacity { .. } => &["effects"],
        Blend { .. } | BlendLinear { .. } => &["blend mode"],
        ClipBelow { .. } | ClipToSurface { .. } => &["clipping"],
        Locked { .. } => &["lock"],
        Labeled { .. } => &["label"],
        Transformed { .. } | Sampled { .. } => &["transform"],
        Unliquified {} => &["liquify"],
        PassThrough { .. } => &["passing through"],
        Fill { .. } => &["color", "lines or how they are drawn"],
        Lines { .. }
        | Hatched { .. }
        | GuidedBy { .. }
        | RedrawnOn { .. }
        | ToneOf { .. }
        | Hand { .. }
        | LineSize { .. }
        | DrawnWith { .. } => &["lines or how they are drawn"],
        Anchors { .. } | Power { .. } | Adjusted { .. } => &["picture or how it lies"],
        Worded { .. } | Drawn { .. } => &["picture or how it lies", "name"],
        Bend { .. } | Pieces { .. } | Filtered { .. } => &["picture or how it lies", "gradient"],
        Place { .. } | Beyond { .. } => &["picture or how it lies", "detail"],
        Stops { .. } | Ends { .. } | Ramp { .. } => &["gradient"],
        Mask { .. } | MaskInverted { .. } | MaskDisabled { .. } => &["mask"],
        Grained { .. } | Strength { .. } => &["detail"],
        Features { .. } => &["material", "scaling"],
        Scaled { .. } | ScalingLight { .. } | ScalingReference { .. } | KeepMean { .. } => {
            &["scaling"]
        }
        Adjustment { .. } => &["adjustment"],
        FilterLayer { .. } => &["filter"],
        Surrounded { .. } | Without { .. } | Occlusion { .. } | Bounces { .. } => &["material"],
        ShadingModel { .. } | Lights { .. } | InMood { .. } | Shadowed { .. } => &["material"],
        Ambient { .. } | Diffuse { .. } | Specular { .. } | Painted { .. } => &["material"],
        Shininess { .. } | Bands { .. } | Exponent { .. } | Solid { .. } => &["material"],
        Anisotropy { .. } | RefractiveIndex { .. } | BallMarks { .. } | Pixeled { .. } => {
            &["material"]
        }
    }
}
