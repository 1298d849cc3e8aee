//! A layer's path that is valid from one run to the next: indices from the bottom through the groups.
//! Floor 6. In memory layers have ids; those are new with every run.

use super::replay::ReplayValue;
use crate::document::{Document, Layer, LayerId};
use serde_json::Value;
use std::sync::Arc;

/// `2.0` is the bottom layer in the group that is third from the bottom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayerPath(Vec<usize>);

impl LayerPath {
    /// The path of a layer.
    pub fn of(document: &Document, id: LayerId) -> Option<Self> {
        fn find(layers: &[Arc<Layer>], id: LayerId, path: &mut Vec<usize>) -> bool {
            layers.iter().enumerate().any(|(index, layer)| {
                path.push(index);
                let here = layer.id == id || layer.content.group().is_some_and(|group| find(&group.layers, id, path));
                if !here {
                    path.pop();
                }
                here
            })
        }
        let mut path = Vec::new();
        find(&document.layers, id, &mut path).then_some(Self(path))
    }
    /// The layer at the path.
    pub fn find<'a>(&self, document: &'a Document) -> Option<&'a Arc<Layer>> {
        let (first, rest) = self.0.split_first()?;
        rest.iter().try_fold(document.layers.get(*first)?, |layer, index| layer.content.group()?.layers.get(*index))
    }
}

impl ReplayValue for LayerPath {
    fn written(&self) -> Value {
        self.0.iter().map(ToString::to_string).collect::<Vec<_>>().join(".").into()
    }
    fn read(value: &Value) -> Result<Self, String> {
        let text = value.as_str().ok_or("must be a layer's place such as “2.0”")?;
        let path = text.split('.').map(|index| index.parse().ok()).collect::<Option<Vec<usize>>>();
        path.map(Self).ok_or_else(|| format!("is “{text}”, which is no layer's place"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Group};
    use crate::math::{Size, srgb::Color};

    #[test]
    fn a_path_leads_to_its_layer_and_back() {
        let fill = |name: &str| Arc::new(Layer::new(name, Content::Fill(Color::BLACK)));
        let group = Content::Group(Group { layers: vec![fill("b"), fill("c")], pass_through: false });
        let layers = vec![fill("a"), Arc::new(Layer::new("g", group))];
        let document = Document { layers, ..Document::empty(Size::new(4, 4)) };
        let path = LayerPath::of(&document, document.layer_named("c").unwrap().id).unwrap();
        assert_eq!(path.written(), "1.1");
        assert_eq!(LayerPath::read(&path.written()).unwrap().find(&document).unwrap().name, "c");
        assert!(LayerPath(vec![0, 1]).find(&document).is_none());
    }
}
