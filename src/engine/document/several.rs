//! Tree edits of several layers at once; the layers of a group among them move with it. Floor 4.
//! Not here: edits of one layer (`edit`).

use super::{Document, Layer, LayerId, LayerSlot};
use std::sync::Arc;

/// The edits. Each is `None` where a layer or the place does not exist; `self` never changes.
/// `ids`: in any order.
impl Document {
    /// Those of some layers that are in no other of them, in the order of the tree, bottom first.
    /// Ids of no layer are left out.
    pub fn outermost(&self, ids: &[LayerId]) -> Vec<LayerId> {
        fn visit(layers: &[Arc<Layer>], ids: &[LayerId], out: &mut Vec<LayerId>) {
            for layer in layers {
                match layer.content.group() {
                    _ if ids.contains(&layer.id) => out.push(layer.id),
                    Some(group) => visit(&group.layers, ids, out),
                    None => {}
                }
            }
        }
        let mut out = Vec::new();
        visit(&self.layers, ids, &mut out);
        out
    }

    /// With each of some layers changed.
    pub fn with_layers(
        &self,
        ids: &[LayerId],
        mut change: impl FnMut(&mut Layer),
    ) -> Option<Document> {
        ids.iter().try_fold(self.clone(), |next, id| next.with_layer(*id, &mut change))
    }

    /// Without some layers and what is in them.
    pub fn without_layers(&self, ids: &[LayerId]) -> Option<Document> {
        self.outermost(ids).into_iter().try_fold(self.clone(), |next, id| next.without_layer(id))
    }

    /// With some layers moved to one place, in their order; `place` counts the layers without them.
    /// `None` also if a group would go into itself.
    pub fn with_moved_layers(&self, ids: &[LayerId], place: LayerSlot) -> Option<Document> {
        let outermost = self.outermost(ids);
        let moved: Option<Vec<Arc<Layer>>> =
            outermost.iter().map(|id| self.layer(*id).cloned()).collect();
        self.without_layers(ids)?.with_siblings(place, |layers, index| {
            let index = index.min(layers.len());
            layers.splice(index..index, moved?);
            Some(())
        })
    }

    /// With some layers moved up (positive) or down among their siblings; those that reach an end
    /// keep their order.
    pub fn with_nudged_layers(&self, ids: &[LayerId], by: i32) -> Option<Document> {
        let mut outermost = self.outermost(ids);
        if by > 0 {
            outermost.reverse();
        }
        let mut next = self.clone();
        // No layer moves farther than past all others.
        for _ in 0..(by.unsigned_abs() as usize).min(self.walk().len()) {
            for id in &outermost {
                let place = next.place_of(*id)?;
                next = next.with_siblings(place, |layers, index| {
                    let to = if by > 0 { index + 1 } else { index.wrapping_sub(1) };
                    if layers.get(to).is_some_and(|other| !outermost.contains(&other.id)) {
                        layers.swap(index, to);
                    }
                    Some(())
                })?;
            }
        }
        Some(next)
    }

    /// With some layers replaced by one, in the place of the topmost of them. `None` also if none
    /// of them exist.
    pub fn with_one_for(&self, ids: &[LayerId], one: Layer) -> Option<Document> {
        let outermost = self.outermost(ids);
        let place = self.place_of(*outermost.last()?)?;
        let siblings = match place.group {
            None => &self.layers,
            Some(group) => &self.layer(group)?.content.group()?.layers,
        };
        let beneath =
            siblings.iter().take(place.index).filter(|layer| !outermost.contains(&layer.id));
        let place = LayerSlot { index: beneath.count(), ..place };
        self.without_layers(ids)?.with_inserted(one, place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Group};
    use crate::math::{Size, srgb::Color};

    fn fill(name: &str) -> Layer {
        Layer::new(name, Content::Fill(Color::BLACK))
    }

    fn group(name: &str, layers: Vec<Layer>) -> Layer {
        let layers = layers.into_iter().map(Arc::new).collect();
        Layer::new(name, Content::Group(Group { layers, pass_through: false }))
    }

    /// a, g(b, h(c)), d, e
    fn document() -> Document {
        let inner = group("g", vec![fill("b"), group("h", vec![fill("c")])]);
        let layers = [fill("a"), inner, fill("d"), fill("e")].map(Arc::new).into();
        Document { layers, ..Document::empty(Size::new(8, 8)) }
    }

    fn ids(document: &Document, names: &str) -> Vec<LayerId> {
        names.chars().map(|name| document.layer_named(&name.to_string()).unwrap().id).collect()
    }

    /// Groups with what is in them: `ag(bh(c))de`.
    fn tree_text(document: &Document) -> String {
        fn tell(layers: &[Arc<Layer>]) -> String {
            let one = |layer: &Arc<Layer>| match layer.content.group() {
                Some(group) => format!("{}({})", layer.name, tell(&group.layers)),
                None => layer.name.clone(),
            };
            layers.iter().map(one).collect()
        }
        tell(&document.layers)
    }

    #[test]
    fn what_stands_in_a_selected_group_moves_with_it() {
        let document = document();
        let outer = document.outermost(&ids(&document, "ecga"));
        assert_eq!(outer, ids(&document, "age"), "bottom first, without c");
        assert_eq!(tree_text(&document.without_layers(&ids(&document, "gcd")).unwrap()), "ae");
    }

    #[test]
    fn several_layers_move_to_one_place_in_the_order_they_lay() {
        let document = document();
        let h = document.layer_named("h").unwrap().id;
        let moved = |names: &str, place| {
            document.with_moved_layers(&ids(&document, names), place).map(|d| tree_text(&d))
        };
        assert_eq!(moved("ea", LayerSlot::in_group(h, 0)).as_deref(), Some("g(bh(aec))d"));
        assert_eq!(moved("cd", LayerSlot::top_level(0)).as_deref(), Some("cdag(bh())e"));
        assert_eq!(moved("ab", LayerSlot::top_level(99)).as_deref(), Some("g(h(c))deab"));
        assert_eq!(moved("ga", LayerSlot::in_group(h, 0)), None, "a group into itself");
    }

    #[test]
    fn several_layers_are_nudged_and_stop_at_the_end_in_order() {
        let document = document();
        let nudged = |names: &str, by| {
            tree_text(&document.with_nudged_layers(&ids(&document, names), by).unwrap())
        };
        assert_eq!(nudged("ad", 1), "g(bh(c))aed");
        assert_eq!(nudged("de", 1), "ag(bh(c))de", "there is nowhere to go");
        assert_eq!(nudged("de", i32::MIN), "deag(bh(c))");
        assert_eq!(nudged("ah", 1), "g(bh(c))ade");
    }

    #[test]
    fn one_layer_takes_the_place_of_several_where_the_topmost_stood() {
        let document = document();
        let with = |names: &str| {
            document.with_one_for(&ids(&document, names), fill("x")).map(|d| tree_text(&d))
        };
        assert_eq!(with("ad").as_deref(), Some("g(bh(c))xe"));
        assert_eq!(with("ab").as_deref(), Some("g(xh(c))de"));
        assert_eq!(with("ce").as_deref(), Some("ag(bh())dx"));
        assert_eq!(with(""), None);
    }

    #[test]
    fn a_change_of_several_layers_leaves_the_others_shared() {
        let document = document();
        let next =
            document.with_layers(&ids(&document, "ac"), |layer| layer.opacity = 0.25).unwrap();
        let opacities: Vec<f32> =
            ["a", "b", "c", "d"].map(|n| next.layer_named(n).unwrap().opacity).into();
        assert_eq!(opacities, [0.25, 1.0, 0.25, 1.0]);
        assert!(Arc::ptr_eq(&document.layers[2], &next.layers[2]));
        assert!(document.with_layers(&[LayerId::fresh()], |_| ()).is_none());
    }
}
