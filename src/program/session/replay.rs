//! Actions as text: one JSON object per line, so that recorded actions can be replayed without the
//! window. Floor 6. [`ReplayValue`] writes and reads a value; `actions!`, `record!`, `names!` and
//! `as_in_recipes!` derive it. Values that documents hold are written as there.

use crate::math::{Vec2, Vec3, srgb::Color, vec2, vec3};
use crate::{Error, Result};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A value of an action's field. Reading fails with the reason, for a sentence that names the line.
pub trait ReplayValue: Sized {
    /// The value in a line of JSON.
    fn to_value(&self) -> Value;
    /// Reads it; fails with what it must be.
    fn read(value: &Value) -> std::result::Result<Self, String>;
}

/// Fields with the names that they had before, which are still read.
const FORMER_FIELDS: [(&str, &str); 1] = [("active_layer", "primary")];

/// A field of an object; absent counts as `null`.
pub fn field<T: ReplayValue>(object: &Value, name: &str) -> std::result::Result<T, String> {
    let former = || FORMER_FIELDS.iter().find(|(now, _)| *now == name);
    let value = object.get(name).or_else(|| object.get(former()?.1)).unwrap_or(&Value::Null);
    T::read(value).map_err(|reason| format!("“{name}” {reason}"))
}

impl ReplayValue for bool {
    fn to_value(&self) -> Value {
        (*self).into()
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        value.as_bool().ok_or_else(|| "must be true or false".into())
    }
}

impl ReplayValue for f32 {
    fn to_value(&self) -> Value {
        // Through its shortest decimal form: 0.1 reads 0.1, not 0.10000000149.
        self.to_string().parse::<f64>().map_or(Value::Null, Value::from)
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        let number = value.as_f64().map(|v| v as f32).filter(|v| v.is_finite());
        number.ok_or_else(|| "must be a number".into())
    }
}

impl ReplayValue for f64 {
    fn to_value(&self) -> Value {
        json!(self)
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        value.as_f64().filter(|v| v.is_finite()).ok_or_else(|| "must be a number".into())
    }
}

impl<const N: usize> ReplayValue for [f64; N] {
    fn to_value(&self) -> Value {
        json!(self.as_slice())
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        let wrong = |_| format!("must be {N} numbers");
        Vec::<f64>::read(value)?.try_into().map_err(wrong)
    }
}

/// Whole numbers.
macro_rules! whole {
    ($($ty:ty),+) => { $(impl ReplayValue for $ty {
        fn to_value(&self) -> Value {
            json!(self)
        }

        fn read(value: &Value) -> std::result::Result<Self, String> {
            let number = value.as_i64().and_then(|v| <$ty>::try_from(v).ok());
            number.ok_or_else(|| "must be a whole number".into())
        }
    })+ };
}
whole!(usize, u32, i32, u8);

impl ReplayValue for String {
    fn to_value(&self) -> Value {
        self.as_str().into()
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        value.as_str().map(Into::into).ok_or_else(|| "must be text".into())
    }
}

/// Values with their own JSON form in files.
impl ReplayValue for Value {
    fn to_value(&self) -> Value {
        self.clone()
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        if value.is_null() { Err("must be there".into()) } else { Ok(value.clone()) }
    }
}

impl ReplayValue for PathBuf {
    fn to_value(&self) -> Value {
        self.to_string_lossy().into()
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        String::read(value).map(Into::into)
    }
}

impl ReplayValue for Color {
    fn to_value(&self) -> Value {
        self.to_string().into()
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        value
            .as_str()
            .and_then(Color::parse)
            .ok_or_else(|| "must be a color such as #c08060".into())
    }
}

impl ReplayValue for Vec2 {
    fn to_value(&self) -> Value {
        Value::Array(self.to_array().iter().map(ReplayValue::to_value).collect())
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        match Vec::<f32>::read(value)?[..] {
            [x, y] => Ok(vec2(x, y)),
            _ => Err("must be two numbers".into()),
        }
    }
}

impl ReplayValue for Vec3 {
    fn to_value(&self) -> Value {
        Value::Array(self.to_array().iter().map(ReplayValue::to_value).collect())
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        match Vec::<f32>::read(value)?[..] {
            [x, y, z] => Ok(vec3(x, y, z)),
            _ => Err("must be three numbers".into()),
        }
    }
}

impl<T: ReplayValue> ReplayValue for Vec<T> {
    fn to_value(&self) -> Value {
        Value::Array(self.iter().map(ReplayValue::to_value).collect())
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        value.as_array().ok_or("must be a list")?.iter().map(T::read).collect()
    }
}

impl<T: ReplayValue> ReplayValue for Option<T> {
    fn to_value(&self) -> Value {
        self.as_ref().map_or(Value::Null, ReplayValue::to_value)
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        if value.is_null() { Ok(None) } else { T::read(value).map(Some) }
    }
}

/// Declares an enum of actions; each variant has a name in replays and named fields.
macro_rules! actions {
    ($(#[$meta:meta])* $name:ident {
        $($(#[$about:meta])* $word:literal $variant:ident { $($field:ident: $ty:ty),* $(,)? })+
    }) => {
        $(#[$meta])*
        #[derive(Clone)]
        // An action is its word with its fields; those that do not explain themselves have a doc.
        #[allow(missing_docs)]
        pub enum $name { $($(#[$about])* $variant { $($field: $ty),* }),+ }
        impl $name {
            /// The words of all of them.
            #[cfg(test)]
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// Its word.
            pub fn word(&self) -> &'static str {
                match self { $(Self::$variant { .. } => $word),+ }
            }
        }

        #[cfg(test)]
        impl $crate::session::tests::stories::Roll for $name {
            fn roll(dice: &mut $crate::session::tests::stories::Dice) -> Self {
                let all: &[fn(&mut $crate::session::tests::stories::Dice) -> Self] = &[$(|_dice| Self::$variant {
                    $($field: _dice.value($word, stringify!($field))),*
                }),+];
                all[dice.variant(Self::WORDS, stringify!($name))](dice)
            }
        }

        impl $crate::session::replay::ReplayValue for $name {
            fn to_value(&self) -> serde_json::Value {
                let mut object = serde_json::Map::new();
                match self { $(Self::$variant { $($field),* } => {
                    object.insert("do".into(), $word.into());
                    $(object.insert(stringify!($field).into(), $field.to_value());)*
                })+ }
                serde_json::Value::Object(object)
            }

            fn read(value: &serde_json::Value) -> std::result::Result<Self, String> {
                match value.get("do").and_then(|word| word.as_str()) {
                    $(Some($word) => Ok(Self::$variant {
                        $($field: $crate::session::replay::field(value, stringify!($field))?),*
                    }),)+
                    Some(word) => Err(format!("“do” is “{word}”, which is not known here")),
                    None => Err("“do” is missing".into()),
                }
            }
        }
    };
}
pub(crate) use actions;

/// Replays a struct of another floor field by field.
macro_rules! record {
    ($name:ty { $($field:ident),+ $(,)? }) => {
        impl $crate::session::replay::ReplayValue for $name {
            fn to_value(&self) -> serde_json::Value {
                let mut object = serde_json::Map::new();
                $(object.insert(stringify!($field).into(), self.$field.to_value());)+
                serde_json::Value::Object(object)
            }

            fn read(value: &serde_json::Value) -> std::result::Result<Self, String> {
                $(let $field = $crate::session::replay::field(value, stringify!($field))?;)+
                Ok(Self { $($field),+ })
            }
        }

        #[cfg(test)]
        impl $crate::session::tests::stories::Roll for $name {
            fn roll(dice: &mut $crate::session::tests::stories::Dice) -> Self {
                Self { $($field: dice.value(stringify!($name), stringify!($field))),+ }
            }
        }
    };
}
pub(crate) use record;

/// Replays values as recipes write them.
macro_rules! as_in_recipes {
    ($($name:ty),+) => { $(impl $crate::session::replay::ReplayValue for $name {
        fn to_value(&self) -> serde_json::Value {
            $crate::io::recipe::value::RecipeValue::to_json(self)
        }

        fn read(value: &serde_json::Value) -> std::result::Result<Self, String> {
            $crate::io::recipe::value::RecipeValue::from_value(value)
        }
    })+ };
}
pub(crate) use as_in_recipes;

/// Replays an enum of plain choices by their names (`name` and `from_name`).
macro_rules! names {
    ($name:ty) => {
        impl $crate::session::replay::ReplayValue for $name {
            fn to_value(&self) -> serde_json::Value {
                self.name().into()
            }

            fn read(value: &serde_json::Value) -> std::result::Result<Self, String> {
                let found = value.as_str().and_then(<$name>::from_name);
                found.ok_or_else(|| format!("is {value}, which is not known here"))
            }
        }

        #[cfg(test)]
        impl $crate::session::tests::stories::Roll for $name {
            fn roll(dice: &mut $crate::session::tests::stories::Dice) -> Self {
                dice.one_of(&<$name>::ALL.map(|row| row.0))
            }
        }
    };
}
pub(crate) use names;

/// The lines of a replay as values. Empty lines and lines that begin with `#` are skipped.
pub fn lines<T: ReplayValue>(file: &Path, text: &str) -> Result<Vec<T>> {
    let read = |(i, text)| line(text).map_err(|reason| line_error(file, i + 1, reason)).transpose();
    text.lines().enumerate().filter_map(read).collect()
}

/// One line as a value, `None` if it is empty or begins with `#`. Fails with the reason.
pub fn line<T: ReplayValue>(text: &str) -> std::result::Result<Option<T>, String> {
    if text.trim().is_empty() || text.starts_with('#') {
        return Ok(None);
    }
    let value: Value = serde_json::from_str(text).map_err(|e| format!("is not JSON: {e}"))?;
    T::read(&value).map(Some)
}

/// The error of a line that cannot be read, counted from 1.
pub fn line_error(file: &Path, line: usize, reason: String) -> Error {
    Error::invalid(file, format!("line {line}"), reason)
}
