//! Photoshop's descriptors: nested lists of named values; names, numbers, texts and lists are kept.
//! Floor 5. Not here: what the names mean (readers of presets, fills and effects).

mod write;

pub use write::DescriptorWriter;

use super::cursor::ByteCursor;

/// Depth of objects within objects; no real file needs more.
const DEEPEST: u32 = 16;
/// Values of one descriptor together.
const MOST: u32 = 1 << 20;

/// A value of a descriptor.
#[derive(Debug, PartialEq)]
pub enum DescriptorValue {
    Number(f64),
    /// A number and its unit.
    Measure([u8; 4], f64),
    Flag(bool),
    Text(String),
    Object(DescriptorObject),
    List(Vec<DescriptorValue>),
    /// One of some named choices.
    Word(Vec<u8>),
    Bytes(Vec<u8>),
    /// A kind that is not read.
    Else,
}

impl DescriptorValue {
    /// Finite.
    fn number(&self) -> Option<f32> {
        match self {
            Self::Number(number) | Self::Measure(_, number) => {
                Some(*number as f32).filter(|number| number.is_finite())
            }
            _ => None,
        }
    }
}

/// Values by their names.
#[derive(Debug, Default, PartialEq)]
pub struct DescriptorObject(Vec<(Vec<u8>, DescriptorValue)>);

impl DescriptorObject {
    #[cfg(test)]
    pub fn of(values: Vec<(&str, DescriptorValue)>) -> Self {
        Self(values.into_iter().map(|(name, value)| (name.into(), value)).collect())
    }

    fn get(&self, name: &str) -> Option<&DescriptorValue> {
        self.0.iter().find(|(known, _)| known == name.as_bytes()).map(|(_, value)| value)
    }

    /// It is there.
    pub fn has_value(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// Finite.
    pub fn number(&self, name: &str) -> Option<f32> {
        self.get(name)?.number()
    }

    /// Its unit is a point, a 72nd of an inch.
    pub fn is_in_points(&self, name: &str) -> bool {
        matches!(self.get(name), Some(DescriptorValue::Measure(unit, _)) if unit == b"#Pnt")
    }

    /// The numbers of a list.
    pub fn numbers(&self, name: &str) -> impl Iterator<Item = f32> {
        self.list(name).iter().filter_map(DescriptorValue::number)
    }

    /// The same as exactly as they are stored; finite.
    pub fn doubles(&self, name: &str) -> impl Iterator<Item = f64> {
        self.list(name).iter().filter_map(|value| match value {
            DescriptorValue::Number(number) | DescriptorValue::Measure(_, number) => {
                Some(*number).filter(|number| number.is_finite())
            }
            _ => None,
        })
    }

    fn list(&self, name: &str) -> &[DescriptorValue] {
        match self.get(name) {
            Some(DescriptorValue::List(list)) => list.as_slice(),
            _ => &[],
        }
    }

    pub fn is_set(&self, name: &str) -> bool {
        self.get(name) == Some(&DescriptorValue::Flag(true))
    }

    /// It is there and says no.
    pub fn is_false(&self, name: &str) -> bool {
        self.get(name) == Some(&DescriptorValue::Flag(false))
    }

    pub fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            DescriptorValue::Text(text) => Some(text),
            _ => None,
        }
    }

    pub fn bytes(&self, name: &str) -> Option<&[u8]> {
        match self.get(name)? {
            DescriptorValue::Bytes(bytes) => Some(bytes),
            _ => None,
        }
    }

    /// The name of a choice.
    pub fn word(&self, name: &str) -> Option<&[u8]> {
        match self.get(name)? {
            DescriptorValue::Word(word) => Some(word),
            _ => None,
        }
    }

    pub fn object(&self, name: &str) -> Option<&DescriptorObject> {
        match self.get(name)? {
            DescriptorValue::Object(object) => Some(object),
            _ => None,
        }
    }

    /// The objects of a list.
    pub fn objects(&self, name: &str) -> impl Iterator<Item = &DescriptorObject> {
        self.list(name).iter().filter_map(|value| match value {
            DescriptorValue::Object(object) => Some(object),
            _ => None,
        })
    }
}

/// A descriptor after its version; `None` if it is cut short, or holds something unknown.
pub fn read(cursor: &mut ByteCursor) -> Option<DescriptorObject> {
    cursor.u32()?;
    object(cursor, DEEPEST, &mut MOST.clone())
}

fn object(cursor: &mut ByteCursor, deeper: u32, left: &mut u32) -> Option<DescriptorObject> {
    cursor.unicode()?;
    name(cursor)?;
    let count = cursor.u32()?;
    let mut values = Vec::new();
    for _ in 0..count {
        values.push((name(cursor)?.to_vec(), value(cursor, deeper, left)?));
    }
    Some(DescriptorObject(values))
}

/// A length and so many letters; 0 means four.
fn name<'a>(cursor: &mut ByteCursor<'a>) -> Option<&'a [u8]> {
    match cursor.length(false)? {
        0 => cursor.take(4),
        n => cursor.take(n),
    }
}

fn value(cursor: &mut ByteCursor, deeper: u32, left: &mut u32) -> Option<DescriptorValue> {
    let deeper = deeper.checked_sub(1)?;
    *left = left.checked_sub(1)?;
    let kind = cursor.key()?;
    Some(match &kind {
        b"Objc" | b"GlbO" => DescriptorValue::Object(object(cursor, deeper, left)?),
        b"VlLs" => {
            let count = cursor.u32()?;
            let mut list = Vec::new();
            for _ in 0..count {
                list.push(value(cursor, deeper, left)?);
            }
            DescriptorValue::List(list)
        }
        b"doub" => DescriptorValue::Number(double(cursor)?),
        b"UnFl" => {
            cursor.key()?;
            let count = usize::try_from(cursor.u32()?).ok()?;
            cursor.take(count.checked_mul(8)?)?;
            DescriptorValue::Else
        }
        b"UntF" => {
            let unit = cursor.key()?;
            DescriptorValue::Measure(unit, double(cursor)?)
        }
        b"long" => DescriptorValue::Number(f64::from(cursor.i32()?)),
        b"bool" => DescriptorValue::Flag(cursor.u8()? != 0),
        b"TEXT" => DescriptorValue::Text(cursor.unicode()?),
        b"enum" => {
            name(cursor)?;
            DescriptorValue::Word(name(cursor)?.to_vec())
        }
        b"type" | b"GlbC" | b"Clss" => {
            cursor.unicode()?;
            name(cursor)?;
            DescriptorValue::Else
        }
        b"comp" => {
            cursor.take(8)?;
            DescriptorValue::Else
        }
        b"tdta" => DescriptorValue::Bytes(cursor.section(false)?.rest().to_vec()),
        b"alis" | b"Pth " => {
            cursor.section(false)?;
            DescriptorValue::Else
        }
        _ => return None,
    })
}

fn double(cursor: &mut ByteCursor) -> Option<f64> {
    cursor.take(8)?.try_into().ok().map(f64::from_be_bytes)
}
