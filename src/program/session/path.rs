//! A layer's path that is valid from one run to the next: indices from the bottom through the
//! groups. Floor 6. In memory layers have ids, which differ with every run.

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
                let here = layer.id == id
                    || layer.content.group().is_some_and(|group| find(&group.layers, id, path));
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
        rest.iter().try_fold(document.layers.get(*first)?, |layer, index| {
            layer.content.group()?.layers.get(*index)
        })
    }
}

/// The paths of the layers that an action applies to. A single one is written as just the path, as
/// in older replays.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LayerPaths(Vec<LayerPath>);

impl LayerPaths {
    /// For some layers; those that are gone are left out.
    pub fn of(document: &Document, ids: &[LayerId]) -> Self {
        Self(ids.iter().filter_map(|id| LayerPath::of(document, *id)).collect())
    }

    /// The layers at the paths; `None` if one leads nowhere, or there are none.
    pub fn find(&self, document: &Document) -> Option<Vec<LayerId>> {
        let found: Option<Vec<_>> =
            self.0.iter().map(|path| path.find(document).map(|layer| layer.id)).collect();
        found.filter(|found| !found.is_empty())
    }

    /// Whether it names more than one layer.
    pub fn is_several(&self) -> bool {
        self.0.len() > 1
    }

    /// As a replay may name them, whether they lead anywhere or not.
    #[cfg(test)]
    pub fn several(paths: Vec<LayerPath>) -> Self {
        Self(paths)
    }
}

impl From<LayerPath> for LayerPaths {
    fn from(path: LayerPath) -> Self {
        Self(vec![path])
    }
}

impl From<&LayerPath> for LayerPaths {
    fn from(path: &LayerPath) -> Self {
        Self::from(path.clone())
    }
}

impl ReplayValue for LayerPaths {
    fn to_value(&self) -> Value {
        match &self.0[..] {
            [one] => one.to_value(),
            all => Value::Array(all.iter().map(ReplayValue::to_value).collect()),
        }
    }

    fn read(value: &Value) -> Result<Self, String> {
        if value.is_array() {
            Vec::read(value).map(Self)
        } else {
            LayerPath::read(value).map(Self::from)
        }
    }
}

impl ReplayValue for LayerPath {
    fn to_value(&self) -> Value {
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
        let group =
            Content::Group(Group { layers: vec![fill("b"), fill("c")], pass_through: false });
        let layers = vec![fill("a"), Arc::new(Layer::new("g", group))];
        let document = Document { layers, ..Document::empty(Size::new(4, 4)) };
        let path = LayerPath::of(&document, document.layer_named("c").unwrap().id).unwrap();
        assert_eq!(path.to_value(), "1.1");
        assert_eq!(LayerPath::read(&path.to_value()).unwrap().find(&document).unwrap().name, "c");
        assert!(LayerPath(vec![0, 1]).find(&document).is_none());
    }

    #[test]
    fn one_layer_is_written_as_its_path_and_several_as_a_list() {
        let fill = |name: &str| Arc::new(Layer::new(name, Content::Fill(Color::BLACK)));
        let document =
            Document { layers: vec![fill("a"), fill("b")], ..Document::empty(Size::new(4, 4)) };
        let ids: Vec<LayerId> = document.layers.iter().map(|layer| layer.id).collect();
        let [one, both] = [&ids[1..], &ids[..]].map(|ids| LayerPaths::of(&document, ids));
        assert_eq!(
            (one.to_value(), both.to_value()),
            (Value::from("1"), serde_json::json!(["0", "1"]))
        );
        for paths in [one, both] {
            assert_eq!(LayerPaths::read(&paths.to_value()), Ok(paths));
        }
        assert_eq!(
            LayerPaths::read(&"7".into()).unwrap().find(&document),
            None,
            "there is no such layer"
        );
        assert_eq!(LayerPaths::default().find(&document), None);
    }
}
