//! The brushes that the user marked, and those that were used last. Floor 7. Not here: the brushes
//! (`session::brushes`), the panel (`panels::brushes`).

use serde_json::{Map, Value, json};

/// The most brushes that are listed as used last.
const MOST_USED: usize = 8;
/// The most favorites that are read.
const MOST_FAVORITES: usize = 500;

/// Both by the keys of the brushes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BrushShelf {
    /// In the order in which they were marked.
    pub favorites: Vec<String>,
    /// Newest first.
    pub used: Vec<String>,
}

impl BrushShelf {
    /// A brush is in hand.
    pub fn note_used(&mut self, key: &str) {
        if self.used.first().is_none_or(|newest| newest != key) {
            self.used.retain(|known| known != key);
            self.used.insert(0, key.to_owned());
            self.used.truncate(MOST_USED);
        }
    }

    pub fn is_favorite(&self, key: &str) -> bool {
        self.favorites.iter().any(|known| known == key)
    }

    /// Marks a brush, or removes the mark.
    pub fn mark(&mut self, key: &str, on: bool) {
        self.favorites.retain(|known| known != key);
        self.favorites.extend(on.then(|| key.to_owned()));
    }

    pub fn to_json(&self) -> Value {
        json!({ "favorites": self.favorites, "used": self.used })
    }

    /// What is unknown is left out.
    pub fn from_json(value: &Map<String, Value>) -> Self {
        let keys = |name: &str, most: usize| {
            let list = value.get(name).and_then(Value::as_array).into_iter().flatten();
            list.filter_map(|key| key.as_str().map(str::to_owned)).take(most).collect()
        };
        Self { favorites: keys("favorites", MOST_FAVORITES), used: keys("used", MOST_USED) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_brush_is_first_and_each_is_listed_once() {
        let mut shelf = BrushShelf::default();
        ["a", "b", "a", "a"].iter().for_each(|key| shelf.note_used(key));
        assert_eq!(shelf.used, ["a", "b"]);
        (0..20).for_each(|i| shelf.note_used(&i.to_string()));
        assert_eq!((shelf.used.len(), &*shelf.used[0]), (MOST_USED, "19"));
        shelf.mark("x", true);
        shelf.mark("y", true);
        shelf.mark("x", true);
        assert!(shelf.is_favorite("x") && shelf.favorites == ["y", "x"]);
        assert_eq!(BrushShelf::from_json(shelf.to_json().as_object().unwrap()), shelf);
        shelf.mark("x", false);
        assert!(!shelf.is_favorite("x"));
        let wrong = json!({ "favorites": [3, "a"], "used": "b" });
        assert_eq!(BrushShelf::from_json(wrong.as_object().unwrap()).favorites, ["a"]);
    }
}
