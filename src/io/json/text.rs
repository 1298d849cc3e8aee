//! JSON text to values: bounded in size, nesting and count before anything is built, and no key
//! given twice. Floor 5.

use crate::Budget;
use crate::{Error, Result};
use serde_json::Value;
use std::{collections::HashSet, path::Path};

/// Parses a whole text. The sentence of a failure names line and column, or the path of a key given
/// twice.
pub fn parse(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Value> {
    let (text, value) = parse_text(file, bytes, budget)?;
    if let Some(path) = first_key_given_twice(text) {
        return Err(Error::invalid(file, path, "is given twice"));
    }
    Ok(value)
}

/// Parses a text of other programs: of a key given twice the last counts, as it does there.
pub fn parse_foreign(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Value> {
    parse_text(file, bytes, budget).map(|(_, value)| value)
}

fn parse_text<'a>(file: &Path, bytes: &'a [u8], budget: &Budget) -> Result<(&'a str, Value)> {
    if bytes.len() as u64 > budget.json_bytes {
        let reason =
            format!("the text has {} bytes; it may have {}", bytes.len(), budget.json_bytes);
        return Err(Error::too_large(file, reason));
    }
    if is_utf16(bytes) {
        return Err(Error::decode(file, "it is UTF-16 text; save it as UTF-8"));
    }
    let text = std::str::from_utf8(bytes).map_err(|e| {
        Error::decode(file, format!("it is not UTF-8 text (at byte {})", e.valid_up_to()))
    })?;
    // Some editors open a text with a byte-order mark.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    measure(file, text, budget)?;
    let value = serde_json::from_str(text)
        .map_err(|e| Error::decode(file, format!("it is not JSON: {e}")))?;
    Ok((text, value))
}

/// A text of two bytes a character that begins like an object, with or without a byte-order mark:
/// some editors and shells write such.
pub fn is_utf16(bytes: &[u8]) -> bool {
    let begins = |bytes: &[u8], of: fn([u8; 2]) -> u16| {
        let mut units = bytes.as_chunks().0.iter().take(LONGEST_INDENT).map(|pair| of(*pair));
        let first = units.find(|unit| !matches!(unit, 0xfeff | 0x20 | 0x09 | 0x0a | 0x0d));
        first == Some(u16::from(b'{'))
    };
    begins(bytes, u16::from_le_bytes) || begins(bytes, u16::from_be_bytes)
}

/// Characters before a text's first bracket that are looked through.
const LONGEST_INDENT: usize = 1 << 10;

/// As how many values an object counts: its table of keys takes that much.
const OBJECT: usize = 8;

/// Holds nesting and the number of values to the budget without building anything: a text of
/// brackets and commas would take fifty times its size as values. It tolerates what is not JSON:
/// the parser refuses that with a better message.
fn measure(file: &Path, text: &str, budget: &Budget) -> Result<()> {
    let (mut depth, mut values, mut in_string, mut escaped) = (0usize, 1usize, false, false);
    for b in text.bytes() {
        match b {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            _ if in_string => {}
            b'[' | b'{' => {
                depth += 1;
                values += if b == b'{' { OBJECT } else { 1 };
                if depth > budget.json_depth {
                    let reason = format!("it is nested deeper than {} levels", budget.json_depth);
                    return Err(Error::too_large(file, reason));
                }
            }
            b']' | b'}' => depth = depth.saturating_sub(1),
            b',' => values += 1,
            _ => {}
        }
    }
    if values > budget.json_values {
        return Err(Error::too_large(
            file,
            format!("it holds more than {} values", budget.json_values),
        ));
    }
    Ok(())
}

/// One open bracket on the way down.
enum OpenBracket {
    List { index: usize },
    Object { keys: HashSet<String>, key: String, awaits_key: bool },
}

/// The path of the first key that its object holds twice. The text must be valid JSON; the parser
/// would keep the last.
fn first_key_given_twice(text: &str) -> Option<String> {
    let bytes = text.as_bytes();
    let mut open: Vec<OpenBracket> = Vec::new();
    let mut i = 0;
    while i < bytes.len() {
        match bytes[i] {
            b'[' => open.push(OpenBracket::List { index: 0 }),
            b'{' => open.push(OpenBracket::Object {
                keys: HashSet::new(),
                key: String::new(),
                awaits_key: true,
            }),
            b']' | b'}' => drop(open.pop()),
            b',' => match open.last_mut() {
                Some(OpenBracket::List { index }) => *index += 1,
                Some(OpenBracket::Object { awaits_key, .. }) => *awaits_key = true,
                None => {}
            },
            b'"' => {
                let end = end_of_string(bytes, i);
                if let Some(OpenBracket::Object { keys, key, awaits_key }) = open.last_mut()
                    && std::mem::take(awaits_key)
                {
                    // Unescaped, so that "a" and "\u0061" are one key.
                    *key = serde_json::from_str(text.get(i..end)?).ok()?;
                    if !keys.insert(key.clone()) {
                        return Some(path_of(&open));
                    }
                }
                i = end - 1;
            }
            _ => {}
        }
        i += 1;
    }
    None
}

/// The index after the closing quote of the string that opens at `start`.
fn end_of_string(bytes: &[u8], start: usize) -> usize {
    let mut i = start + 1;
    while i < bytes.len() && bytes[i] != b'"' {
        i += if bytes[i] == b'\\' { 2 } else { 1 };
    }
    (i + 1).min(bytes.len())
}

fn path_of(open: &[OpenBracket]) -> String {
    let mut path = String::new();
    for step in open {
        match step {
            OpenBracket::List { index } => path += &format!("[{index}]"),
            OpenBracket::Object { key, .. } => path = super::fields::child_path(&path, key),
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error_of(text: &str) -> String {
        parse(Path::new("r.json"), text.as_bytes(), &Budget::default()).unwrap_err().to_string()
    }

    #[test]
    fn syntax_errors_name_line_and_column() {
        assert!(
            error_of("{\n \"a\": ,\n}").contains("line 2 column 7"),
            "{}",
            error_of("{\n \"a\": ,\n}")
        );
        assert!(parse(Path::new("r.json"), &[b'"', 0xff, b'"'], &Budget::default()).is_err());
    }

    #[test]
    fn a_key_given_twice_is_named_by_its_path() {
        assert_eq!(
            error_of(r#"{"layers": [1, {"a": {}, "\u0061": 2}]}"#),
            "r.json: layers[1].a: is given twice"
        );
        let apart = r#"{"a": {"x": 1}, "b": [{"x": "{\"x\": 1,"}, {"x": 2}]}"#;
        assert!(parse(Path::new("r.json"), apart.as_bytes(), &Budget::default()).is_ok());
    }

    #[test]
    fn deep_and_crowded_texts_are_refused_before_they_are_parsed() {
        assert!(error_of(&"[".repeat(1_000_000)).contains("nested deeper than 120"));
        let crowded = format!("[{}0]", "0,".repeat(5_000_000));
        assert!(error_of(&crowded).contains("values"));
        assert!(error_of(&format!("[{}0]", "{},".repeat(600_000))).contains("values"));
        let small = Budget { json_bytes: 1000, ..Budget::default() };
        let spaces = |count: usize| format!("0{}", " ".repeat(count - 1)).into_bytes();
        let read = |count| parse(Path::new("r.json"), &spaces(count), &small);
        assert!(read(1000).is_ok());
        assert!(read(1001).unwrap_err().to_string().contains("bytes"));
    }

    #[test]
    fn numbers_beyond_every_float_are_refused() {
        assert!(error_of("1e999").contains("out of range"));
    }

    #[test]
    fn a_text_in_utf16_is_called_so() {
        for mark in ["", "\u{feff}", " \n"] {
            let units: Vec<u16> = format!("{mark}{{\"a\": 1}}").encode_utf16().collect();
            for bytes in [
                units.iter().flat_map(|unit| unit.to_le_bytes()).collect::<Vec<u8>>(),
                units.iter().flat_map(|unit| unit.to_be_bytes()).collect(),
            ] {
                let said =
                    parse(Path::new("r.json"), &bytes, &Budget::default()).unwrap_err().to_string();
                assert!(said.contains("UTF-16"), "{said}");
            }
        }
        assert!(!is_utf16(b"{}") && !is_utf16(b"\x89PNG") && !is_utf16(b"{ {") && !is_utf16(b""));
    }

    #[test]
    fn a_byte_order_mark_is_no_error() {
        assert!(parse(Path::new("r.json"), "\u{feff}{}".as_bytes(), &Budget::default()).is_ok());
    }
}
