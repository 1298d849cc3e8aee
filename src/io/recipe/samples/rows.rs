//! Rows of readings in a document's text, packed before it is parsed.
//! Floor 5.

use super::columns::pack;
use super::{UNSAID, of_numbers};
use crate::paint::Sample;
use std::borrow::Cow;

/// A document's text with lists of readings in today's packed form, each one value: before it is
/// parsed, for as values a number takes eighty bytes, and many short strokes would hold more of
/// them than a document may. What is not wholly rows of numbers stays, for the parser to say what
/// is wrong.
pub fn with_rows_packed(text: &[u8]) -> Cow<'_, [u8]> {
    let mut out = Vec::new();
    let (mut copied, mut at) = (0, 0);
    while let Some(start) = rows_after(text, &mut at) {
        let mut rest = &text[start..];
        let Some(samples) = rows(&mut rest) else { continue };
        out.extend_from_slice(&text[copied..start]);
        out.extend_from_slice(format!("\"{}\"", pack(&samples)).as_bytes());
        (copied, at) = (text.len() - rest.len(), text.len() - rest.len());
    }
    if copied == 0 {
        return text.into();
    }
    out.extend_from_slice(&text[copied..]);
    out.into()
}

/// Where the next list that is the value of a key `samples` begins; `at` moves past the key.
fn rows_after(text: &[u8], at: &mut usize) -> Option<usize> {
    const KEY: &[u8] = b"samples";
    loop {
        let start = *at + text.get(*at..)?.iter().position(|b| *b == b'"')? + 1;
        let mut end = start;
        while *text.get(end)? != b'"' {
            end += if text[end] == b'\\' { 2 } else { 1 };
        }
        *at = end + 1;
        if &text[start..end] == KEY {
            let mut rest = &text[*at..];
            if skip(&mut rest, b':') && rest.trim_ascii_start().first() == Some(&b'[') {
                return Some(text.len() - rest.trim_ascii_start().len());
            }
        }
    }
}

/// Passes one byte by, and spaces before it.
fn skip(rest: &mut &[u8], byte: u8) -> bool {
    let after = rest
        .trim_ascii_start()
        .split_first()
        .filter(|(first, _)| **first == byte)
        .map(|(_, after)| after);
    *rest = after.unwrap_or(rest);
    after.is_some()
}

/// `[[x, y, …], …]`, if it holds nothing else.
fn rows(rest: &mut &[u8]) -> Option<Vec<Sample>> {
    let mut samples = Vec::new();
    if !skip(rest, b'[') {
        return None;
    }
    loop {
        if !skip(rest, b'[') {
            return None;
        }
        let mut values = [0.0, 0.0, UNSAID[0], UNSAID[1], UNSAID[2], UNSAID[3]];
        let mut count = 0;
        loop {
            *values.get_mut(count)? = number(rest)?;
            count += 1;
            if !skip(rest, b',') {
                break;
            }
        }
        if count < 2 || !skip(rest, b']') {
            return None;
        }
        samples.push(of_numbers(values));
        if !skip(rest, b',') {
            return skip(rest, b']').then_some(samples);
        }
    }
}

/// A number as JSON writes it.
fn number(rest: &mut &[u8]) -> Option<f32> {
    let text = rest.trim_ascii_start();
    let is_part = |b: &u8| b.is_ascii_digit() || b"+-.eE".contains(b);
    let (digits, after) = text.split_at(text.iter().position(|b| !is_part(b))?);
    let whole = digits.strip_prefix(b"-").unwrap_or(digits);
    let is_json = match whole {
        [b'0'] | [b'0', b'.', b'0'..=b'9', ..] | [b'0', b'e' | b'E', ..] => true,
        [b'1'..=b'9', ..] => {
            !whole.windows(2).any(|w| w[0] == b'.' && !w[1].is_ascii_digit())
                && !whole.ends_with(b".")
        }
        _ => false,
    };
    *rest = after;
    let number: f64 = std::str::from_utf8(digits).ok().filter(|_| is_json)?.parse().ok()?;
    Some(number as f32)
}
