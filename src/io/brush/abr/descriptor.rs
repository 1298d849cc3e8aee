//! Photoshop's descriptors: nested lists of named values, of which names, numbers, texts and lists are kept.
//! Floor 5. What the names mean is `presets`'.

use super::utf16;
use crate::psd::cursor::Cursor;

/// Objects within objects; more is no brush's.
const DEEPEST: u32 = 16;
/// Values of one descriptor together.
const MOST: u32 = 1 << 20;

/// A value of a descriptor.
#[derive(Debug, PartialEq)]
pub enum Value {
    Number(f64),
    Flag(bool),
    Text(String),
    Object(Object),
    List(Vec<Value>),
    /// Of a kind that no brush is read from.
    Else,
}

/// Values by their names.
#[derive(Debug, Default, PartialEq)]
pub struct Object(Vec<(Vec<u8>, Value)>);

impl Object {
    fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(known, _)| known == name.as_bytes()).map(|(_, value)| value)
    }
    /// Finite.
    pub fn number(&self, name: &str) -> Option<f32> {
        match self.get(name)? {
            Value::Number(number) => Some(*number as f32).filter(|number| number.is_finite()),
            _ => None,
        }
    }
    pub fn flag(&self, name: &str) -> bool {
        self.get(name) == Some(&Value::Flag(true))
    }
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
    pub fn object(&self, name: &str) -> Option<&Object> {
        match self.get(name)? {
            Value::Object(object) => Some(object),
            _ => None,
        }
    }
    /// The objects of a list.
    pub fn objects(&self, name: &str) -> impl Iterator<Item = &Object> {
        let list = match self.get(name) {
            Some(Value::List(list)) => list.as_slice(),
            _ => &[],
        };
        list.iter().filter_map(|value| match value {
            Value::Object(object) => Some(object),
            _ => None,
        })
    }
}

/// A descriptor behind its version; `None` where it is cut short, or holds what is not understood.
pub fn read(cursor: &mut Cursor) -> Option<Object> {
    cursor.u32()?;
    object(cursor, DEEPEST, &mut MOST.clone())
}

fn object(cursor: &mut Cursor, deeper: u32, left: &mut u32) -> Option<Object> {
    utf16(cursor)?;
    name(cursor)?;
    let count = cursor.u32()?;
    let mut values = Vec::new();
    for _ in 0..count {
        values.push((name(cursor)?.to_vec(), value(cursor, deeper, left)?));
    }
    Some(Object(values))
}

/// A length and so many letters; 0 stands for four.
fn name<'a>(cursor: &mut Cursor<'a>) -> Option<&'a [u8]> {
    match cursor.length(false)? {
        0 => cursor.take(4),
        n => cursor.take(n),
    }
}

fn value(cursor: &mut Cursor, deeper: u32, left: &mut u32) -> Option<Value> {
    let deeper = deeper.checked_sub(1)?;
    *left = left.checked_sub(1)?;
    let kind = cursor.key()?;
    Some(match &kind {
        b"Objc" | b"GlbO" => Value::Object(object(cursor, deeper, left)?),
        b"VlLs" => {
            let count = cursor.u32()?;
            let mut list = Vec::new();
            for _ in 0..count {
                list.push(value(cursor, deeper, left)?);
            }
            Value::List(list)
        }
        b"doub" => Value::Number(double(cursor)?),
        b"UntF" => {
            cursor.key()?;
            Value::Number(double(cursor)?)
        }
        b"long" => Value::Number(f64::from(cursor.i32()?)),
        b"bool" => Value::Flag(cursor.u8()? != 0),
        b"TEXT" => Value::Text(utf16(cursor)?),
        b"enum" => {
            name(cursor)?;
            name(cursor)?;
            Value::Else
        }
        b"type" | b"GlbC" | b"Clss" => {
            utf16(cursor)?;
            name(cursor)?;
            Value::Else
        }
        b"comp" => {
            cursor.take(8)?;
            Value::Else
        }
        b"tdta" | b"alis" | b"Pth " => {
            cursor.section(false)?;
            Value::Else
        }
        _ => return None,
    })
}

fn double(cursor: &mut Cursor) -> Option<f64> {
    cursor.take(8)?.try_into().ok().map(f64::from_be_bytes)
}
