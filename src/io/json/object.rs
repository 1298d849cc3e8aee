//! Writes JSON objects: the counterpart of [`super::Fields`]. Floor 5. A field with its default
//! value is left out.

use crate::math::{Vec2, Vec3, srgb::Color};
use serde_json::{Map, Value};

/// A JSON object being written, its fields in the order they are set.
#[derive(Clone, Default)]
pub struct JsonObject(Map<String, Value>);

impl JsonObject {
    /// Sets a field.
    pub fn set(&mut self, name: &str, value: Value) {
        self.0.insert(name.to_owned(), value);
    }

    /// Sets a field unless it is its default; so do the next ones.
    pub fn number(&mut self, name: &str, value: f32, default: f32) {
        if value != default {
            self.set(name, number(value));
        }
    }

    /// Sets a field unless it is the default.
    pub fn flag(&mut self, name: &str, value: bool, default: bool) {
        if value != default {
            self.set(name, value.into());
        }
    }

    /// The same for a text.
    pub fn text(&mut self, name: &str, value: &str, default: &str) {
        if value != default {
            self.set(name, value.into());
        }
    }

    /// The same for a color.
    pub fn color(&mut self, name: &str, value: Color, default: Color) {
        if value != default {
            self.set(name, color(value));
        }
    }

    /// The word of a table for a value.
    pub fn word<T: PartialEq>(
        &mut self,
        name: &str,
        table: &[(T, &'static str)],
        value: T,
        default: T,
    ) {
        if value != default
            && let Some((_, word)) = table.iter().find(|(v, _)| *v == value)
        {
            self.set(name, (*word).into());
        }
    }

    /// Sets a field if there is a value.
    pub fn set_some<T>(&mut self, name: &str, value: Option<T>, write: impl Fn(T) -> Value) {
        if let Some(value) = value {
            self.set(name, write(value));
        }
    }

    /// Sets an object unless it is empty.
    pub fn object(&mut self, name: &str, value: JsonObject) {
        if !value.0.is_empty() {
            self.set(name, value.into_value());
        }
    }

    /// The fields in their order.
    pub fn fields(&self) -> &Map<String, Value> {
        &self.0
    }

    /// Whether nothing was set.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The object as a value.
    pub fn into_value(self) -> Value {
        Value::Object(self.0)
    }
}

/// The shortest decimal that reads back as the same f32.
pub fn number(value: f32) -> Value {
    if value.fract() == 0.0 && value.abs() < 1e9 {
        return Value::from(value as i64);
    }
    // Through text: 0.1f32 widened to f64 would read 0.10000000149011612.
    value.to_string().parse::<f64>().map_or(Value::Null, Value::from)
}

/// A point as a list.
pub fn point(p: Vec2) -> Value {
    Value::Array(vec![number(p.x), number(p.y)])
}

/// A vector as a list.
pub fn vector(v: Vec3) -> Value {
    Value::Array(vec![number(v.x), number(v.y), number(v.z)])
}

/// A color as a text.
pub fn color(c: Color) -> Value {
    c.to_string().into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;

    #[test]
    fn every_number_reads_back_as_the_same_bits() {
        for i in 0..100_000 {
            let v = f32::from_bits(hash::mix(i));
            if v.is_finite() {
                let text = number(v).to_string();
                let read = serde_json::from_str::<f64>(&text).unwrap() as f32;
                assert!(read == v, "{v} {text}");
            }
        }
        assert_eq!(number(0.2).to_string(), "0.2");
        assert_eq!(number(512.0).to_string(), "512");
    }
}
