//! Filters: new layers, and the same done to paint. Floor 7.

use super::row::{MenuCommand, has_document, has_paint, row};
use crate::paint::PictureFilter;
use crate::requests::{PaintChange, UiRequests, WindowRequest};
use crate::session::Action;
use crate::session::actions::LayerAction;

fn add(requests: &mut UiRequests, name: &str) {
    let filter = PictureFilter::from_name(name);
    let add = |filter| Action::Layer(LayerAction::AddFilter { filter });
    requests.actions.extend(filter.map(add));
}

fn filter(requests: &mut UiRequests, name: &str) {
    if let Some(filter) = PictureFilter::from_name(name) {
        requests.request(WindowRequest::PaintChangeDialog(Box::new(PaintChange::Filter(filter))));
    }
}

/// Declares both menus: the name in documents, of the layer's command, of the command on paint, and
/// what it does.
macro_rules! commands {
    ($($name:literal, $layer:literal, $paint:literal, $hint:literal;)+) => {
        pub const LAYERS: &[MenuCommand] = &[$(
            row($layer, &[], $hint, has_document, |_, requests| add(requests, $name)),
        )+];
        pub const PAINT: &[MenuCommand] = &[$(
            row($paint, &[], $hint, has_paint, |_, requests| filter(requests, $name)),
        )+];
    };
}

commands! {
    "gaussian-blur", "New Gaussian blur layer", "Gaussian blur…", "Soft everywhere alike";
    "box-blur", "New box blur layer", "Box blur…", "The mean of a square";
    "motion-blur", "New motion blur layer", "Motion blur…",
        "As if the camera had moved along a line";
    "spin-blur", "New spin blur layer", "Spin blur…", "As if the picture turned about a point";
    "zoom-blur", "New zoom blur layer", "Zoom blur…", "As if the camera came nearer";
    "lens-blur", "New lens blur layer", "Lens blur…", "Out of focus, by the depth of the surface";
    "surface-blur", "New blur over the surface layer", "Blur over the surface…",
        "Soft by the distance on the surface, up to its contours";
    "flow-blur", "New blur along the form layer", "Blur along the form…",
        "Smeared along the lines in which the surface bends least";
    "sharpen", "New sharpen layer", "Sharpen…", "Crisper edges, by the nearest pixels";
    "unsharp-mask", "New unsharp mask layer", "Unsharp mask…",
        "Crisper edges, by their width and from a threshold on";
    "high-pass", "New high pass layer", "High pass…", "Only details, around mid-gray: for Overlay";
    "noise", "New noise layer", "Noise…", "Random steps of each pixel";
    "grain", "New grain layer", "Grain…", "Of film or paper, on the canvas or on the surface";
    "median", "New median layer", "Median…", "Removes specks and keeps edges";
    "glow", "New glow layer", "Glow…", "What is bright shines beyond its edge";
    "pixelate", "New pixelate layer", "Pixelate…", "Squares of one color";
    "halftone", "New halftone layer", "Halftone…", "Tone as dots or lines of ink, as in print";
    "edges", "New edges layer", "Edges…", "Light lines where colors differ, or dark ones";
    "offset", "New offset layer", "Offset…",
        "Shifted; what leaves on one side enters on the other";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_filter_has_its_commands_in_order() {
        let all = PictureFilter::all();
        assert_eq!((LAYERS.len(), PAINT.len()), (all.len(), all.len()));
        for ((filter, layer), paint) in all.iter().zip(LAYERS).zip(PAINT) {
            assert_eq!((layer.hint, paint.hint), (filter.hint(), filter.hint()));
            let label = filter.label();
            assert_eq!(layer.name.to_lowercase(), format!("new {} layer", label.to_lowercase()));
            assert_eq!(paint.name, format!("{label}…"));
        }
    }
}
