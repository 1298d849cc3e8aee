//! Reading values out of JSON: every value knows its path, so that every refusal can name it.
//! Floor 5. Ranges are checked here, so that everything that was read is valid.

use crate::math::named::{current_name, former_name};
use crate::math::{COORDINATE, Vec2, Vec3, srgb::Color, vec2, vec3};
use crate::{Error, Result};
use serde_json::{Map, Value};
use std::{ops::RangeInclusive, path::Path};

/// The path of a key below another: `layers[2]` and `operator` make `layers[2].operator`.
pub fn child_path(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

/// One JSON value and the path that leads to it.
#[derive(Clone)]
pub struct JsonNode<'a> {
    file: &'a Path,
    path: String,
    value: &'a Value,
    /// Whether numbers must lie in their ranges.
    ranged: bool,
}

impl<'a> JsonNode<'a> {
    /// The outermost value of a file.
    pub fn root(file: &'a Path, value: &'a Value) -> Self {
        Self { file, path: String::new(), value, ranged: true }
    }

    /// A value that is not from a file, whose numbers need only be finite: `Document::fits` refuses
    /// later what does not fit.
    pub fn without_range(value: &'a Value) -> Self {
        Self { file: Path::new(""), path: String::new(), value, ranged: false }
    }

    /// Whether a number is expected within a range.
    pub fn is_ranged(&self) -> bool {
        self.ranged
    }

    fn is_expected(&self, range: &RangeInclusive<f32>, number: f32) -> bool {
        if self.ranged { range.contains(&number) } else { number.is_finite() }
    }

    /// Path of the value, such as `layers[2].operator.gamma`.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The value itself.
    pub fn value(&self) -> &'a Value {
        self.value
    }

    /// A refusal of this value.
    pub fn refusal(&self, reason: impl ToString) -> Error {
        Error::invalid(self.file, self.field(), reason)
    }

    /// Whether a refusal with this field is of the value itself, not of one within it.
    pub fn is_at(&self, field: &str) -> bool {
        field == self.field()
    }

    fn field(&self) -> &str {
        if self.path.is_empty() { "the document" } else { &self.path }
    }

    /// A refusal of more than there may be.
    pub fn too_large(&self, reason: impl ToString) -> Error {
        Error::too_large(self.file, format!("{} {}", self.path, reason.to_string()))
    }

    /// The path of a list item that is stored in another form than as a JSON value.
    pub fn item(&self, i: usize) -> JsonNode<'a> {
        JsonNode { path: format!("{}[{i}]", self.path), value: &Value::Null, ..*self }
    }

    /// Names this value in a failure that it led to.
    pub fn name_in_error(&self, error: Error) -> Error {
        Error::At { file: self.file.into(), field: self.path.clone(), error: Box::new(error) }
    }

    fn wrong_kind(&self, wanted: &str) -> Error {
        let is = match self.value {
            Value::Null => "null",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::String(_) => "text",
            Value::Array(_) => "a list",
            Value::Object(_) => "an object",
        };
        self.refusal(format!("is {is}; it must be {wanted}"))
    }

    /// An object, field by field.
    pub fn fields(&self) -> Result<Fields<'a>> {
        let map = self.value.as_object().ok_or_else(|| self.wrong_kind("an object"))?;
        Ok(Fields { node: self.clone(), map, known: Vec::new() })
    }

    /// A list of at most `most` items.
    pub fn list(&self, most: usize) -> Result<Vec<JsonNode<'a>>> {
        let items = self.value.as_array().ok_or_else(|| self.wrong_kind("a list"))?;
        if items.len() > most {
            let reason = format!("{} has {} items; it may have {most}", self.path, items.len());
            return Err(Error::too_large(self.file, reason));
        }
        let item = |(i, value)| JsonNode { path: format!("{}[{i}]", self.path), value, ..*self };
        Ok(items.iter().enumerate().map(item).collect())
    }

    /// A list of `least` to `most` numbers, as one point, vector or reading.
    pub fn numbers(
        &self,
        least: usize,
        most: usize,
        range: RangeInclusive<f32>,
    ) -> Result<Vec<f32>> {
        let items = self.value.as_array().ok_or_else(|| self.wrong_kind("a list of numbers"))?;
        if !(least..=most).contains(&items.len()) {
            let wanted =
                if least == most { format!("{most}") } else { format!("{least} to {most}") };
            return Err(self.refusal(format!("has {} items; it must have {wanted}", items.len())));
        }
        let quick = items
            .iter()
            .map(|item| item.as_f64().map(|v| v as f32).filter(|v| self.is_expected(&range, *v)));
        if let Some(values) = quick.collect() {
            return Ok(values);
        }
        // Only a refusal needs the path of each number.
        self.list(most)?.iter().map(|item| item.number(range.clone())).collect()
    }

    /// A number within a range.
    pub fn number(&self, range: RangeInclusive<f32>) -> Result<f32> {
        let number = self.value.as_f64().ok_or_else(|| self.wrong_kind("a number"))?;
        let (low, high) = (*range.start(), *range.end());
        // As f32 first: a number just beyond the range in f64 may be its end in f32.
        if !self.is_expected(&range, number as f32) {
            return Err(self.refusal(format!("is {number}; it must be between {low} and {high}")));
        }
        Ok(number as f32)
    }

    /// A number as it is written, not rounded to f32.
    pub fn exact_number(&self, range: RangeInclusive<f32>) -> Result<f64> {
        self.number(range).map(|rounded| self.value.as_f64().unwrap_or(f64::from(rounded)))
    }

    /// A whole number within a range.
    pub fn integer(&self, range: RangeInclusive<i64>) -> Result<i64> {
        let number = self.value.as_f64().ok_or_else(|| self.wrong_kind("a whole number"))?;
        // 12.0 is a whole number too: other programs write it so.
        let whole = (number.fract() == 0.0).then_some(number as i64);
        let whole =
            whole.ok_or_else(|| self.refusal(format!("is {number}; it must be a whole number")))?;
        if self.ranged && !range.contains(&whole) {
            let (low, high) = (range.start(), range.end());
            return Err(self.refusal(format!("is {number}; it must be between {low} and {high}")));
        }
        Ok(whole)
    }

    /// A whole number from 0.
    pub fn whole(&self, range: RangeInclusive<u32>) -> Result<u32> {
        let number = self.integer(i64::from(*range.start())..=i64::from(*range.end()))?;
        u32::try_from(number).map_err(|_| {
            self.refusal(format!("is {number}; it must be between 0 and {}", u32::MAX))
        })
    }

    /// True or false.
    pub fn boolean(&self) -> Result<bool> {
        self.value.as_bool().ok_or_else(|| self.wrong_kind("true or false"))
    }

    /// A text.
    pub fn text(&self) -> Result<&'a str> {
        self.value.as_str().ok_or_else(|| self.wrong_kind("text"))
    }

    /// Canvas px.
    pub fn point(&self) -> Result<Vec2> {
        self.numbers(2, 2, COORDINATE).map(|v| vec2(v[0], v[1]))
    }

    /// Three numbers within a range.
    pub fn vector(&self, range: RangeInclusive<f32>) -> Result<Vec3> {
        self.numbers(3, 3, range).map(|v| vec3(v[0], v[1], v[2]))
    }

    /// A color such as `#c08060`.
    pub fn color(&self) -> Result<Color> {
        let text = self.text()?;
        Color::parse(text).ok_or_else(|| {
            self.refusal(format!("is “{text}”; a color is written #rrggbb or #rrggbbaa"))
        })
    }

    /// One of the names of a table, which may be spelled as it was in version 0.1.
    pub fn one_of<T: Copy>(&self, table: &[(T, &str)]) -> Result<T> {
        let text = self.text()?;
        let current = current_name(text);
        let found = table.iter().find(|(_, name)| *name == current).map(|(value, _)| *value);
        found.ok_or_else(|| {
            let names: Vec<_> = table.iter().map(|(_, name)| *name).collect();
            self.refusal(format!("is “{text}”; it must be one of {}", names.join(", ")))
        })
    }
}

/// The fields of one object. Each is read by name; [`Fields::finish`] refuses those that were never
/// read.
pub struct Fields<'a> {
    node: JsonNode<'a>,
    map: &'a Map<String, Value>,
    known: Vec<&'static str>,
}

impl<'a> Fields<'a> {
    /// The object itself.
    pub fn node(&self) -> &JsonNode<'a> {
        &self.node
    }

    /// A field, where it is there; its name may be spelled as it was in version 0.1.
    pub fn get(&mut self, name: &'static str) -> Option<JsonNode<'a>> {
        let is_there = |name: &&str| self.map.contains_key(*name);
        let former = former_name(name).filter(is_there).filter(|_| !is_there(&name));
        let name = former.unwrap_or(name);
        self.known.push(name);
        self.map.get(name).map(|value| self.child(name, value))
    }

    /// A field that has no default.
    pub fn require(&mut self, name: &'static str) -> Result<JsonNode<'a>> {
        let found = self.get(name);
        found.ok_or_else(|| self.child(name, &Value::Null).refusal("is missing"))
    }

    fn child(&self, name: &str, value: &'a Value) -> JsonNode<'a> {
        JsonNode { path: child_path(&self.node.path, name), value, ..self.node }
    }

    /// A number within a range, or the default where it is absent.
    pub fn number(
        &mut self,
        name: &'static str,
        default: f32,
        range: RangeInclusive<f32>,
    ) -> Result<f32> {
        self.get(name).map_or(Ok(default), |node| node.number(range))
    }

    /// True or false, or the default where it is absent.
    pub fn boolean(&mut self, name: &'static str, default: bool) -> Result<bool> {
        self.get(name).map_or(Ok(default), |node| node.boolean())
    }

    /// A color, or the default where it is absent.
    pub fn color(&mut self, name: &'static str, default: Color) -> Result<Color> {
        self.get(name).map_or(Ok(default), |node| node.color())
    }

    /// A point, or the default where it is absent.
    pub fn point(&mut self, name: &'static str, default: Vec2) -> Result<Vec2> {
        self.get(name).map_or(Ok(default), |node| node.point())
    }

    /// A word of a table, or the default where it is absent.
    pub fn one_of<T: Copy>(
        &mut self,
        name: &'static str,
        table: &[(T, &str)],
        default: T,
    ) -> Result<T> {
        self.get(name).map_or(Ok(default), |node| node.one_of(table))
    }

    /// Refuses a field that was never read, naming its path and the most similar known name.
    pub fn finish(self) -> Result<()> {
        let Some((name, value)) =
            self.map.iter().find(|(name, _)| !self.known.contains(&name.as_str()))
        else {
            return Ok(());
        };
        let near =
            self.known.iter().filter(|known| differences(known, name) <= 1 + known.len() / 4);
        let reason = match near.min_by_key(|known| differences(known, name)) {
            Some(known) => format!("is unknown; did you mean “{known}”?"),
            None => format!("is unknown; the known ones are {}", self.known.join(", ")),
        };
        Err(self.child(name, value).refusal(reason))
    }
}

/// The edit distance of two words (Levenshtein).
fn differences(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, cb) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn root(value: &Value) -> Fields<'_> {
        JsonNode::root(Path::new("r.json"), value).fields().unwrap()
    }

    #[test]
    fn an_unknown_field_is_named_with_the_one_that_was_meant() {
        let value = json!({ "operator": { "gama": 1 } });
        let mut operator = root(&value).get("operator").unwrap().fields().unwrap();
        operator.number("gamma", 1.0, 0.0..=8.0).unwrap();
        let said = operator.finish().unwrap_err().to_string();
        assert_eq!(said, "r.json: operator.gama: is unknown; did you mean “gamma”?");
        let value = json!({ "zebra": 1 });
        let mut fields = root(&value);
        fields.boolean("visible", true).unwrap();
        assert!(fields.finish().unwrap_err().to_string().contains("the known ones are visible"));
    }

    #[test]
    fn values_out_of_range_or_of_the_wrong_kind_are_named() {
        let value = json!({ "a": 2, "b": "x", "c": [1], "d": 1e300, "e": "#12", "f": 1.5 });
        let mut f = root(&value);
        let says = |r: Result<f32>, what: &str| assert!(r.unwrap_err().to_string().contains(what));
        says(f.number("a", 0.0, 0.0..=1.0), "a: is 2; it must be between 0 and 1");
        says(f.number("b", 0.0, 0.0..=1.0), "b: is text; it must be a number");
        says(f.point("c", Vec2::ZERO).map(|p| p.x), "c: has 1 items; it must have 2");
        says(f.number("d", 0.0, COORDINATE), "must be between");
        says(f.color("e", Color::BLACK).map(|_| 0.0), "#rrggbb");
        says(f.get("f").unwrap().integer(0..=9).map(|_| 0.0), "a whole number");
        says(f.require("g").map(|_| 0.0), "g: is missing");
    }

    #[test]
    fn words_differ_by_the_letters_to_change() {
        assert_eq!(differences("gamma", "gama"), 1);
        assert_eq!(differences("", "abc"), 3);
        assert_eq!(differences("flow", "blend"), 4);
    }
}
