//! A text with values in braces: what it is filled with, and how a finished text is known to be made
//! of it.

use std::fmt::{Display, Write as _};

/// A row with values: its own words, and the names of the values between them.
pub struct Template {
    pub key: String,
    /// The words before each value, and the value's name.
    before: Vec<(String, String)>,
    /// The words after the last value.
    end: String,
}

/// A value of a text, and where it stands.
pub struct FoundValue<'a> {
    pub name: &'a str,
    pub text: &'a str,
    /// In quotes stand names that users gave.
    pub is_quoted: bool,
}

impl Template {
    /// A text without values is no template.
    pub fn read(key: &str) -> Option<Self> {
        let (mut before, mut rest) = (Vec::new(), key);
        while let Some((words, name, after)) = split_at_value(rest) {
            before.push((words.to_owned(), name.to_owned()));
            rest = after;
        }
        let is_template = !before.is_empty();
        is_template.then(|| Self { key: key.to_owned(), before, end: rest.to_owned() })
    }

    fn pieces(&self) -> impl Iterator<Item = &str> {
        self.before.iter().map(|(words, _)| words.as_str()).chain([self.end.as_str()])
    }

    /// How many letters are its own.
    pub fn letters(&self) -> usize {
        self.pieces().flat_map(str::chars).filter(|c| c.is_alphabetic()).count()
    }

    /// Whether its own letters are too few to know a text by. A text is of it only if one of its
    /// values is known as well.
    pub fn is_weak(&self) -> bool {
        self.letters() < MIN_LETTERS
    }

    /// Whether it begins with a value, which may hold what belongs to others: `{what} is {number}`.
    /// A value that a colon ends does not: `{file}: not supported: {reason}`.
    pub fn has_value_first(&self) -> bool {
        let second = self.pieces().nth(1).unwrap_or_default();
        self.before[0].0.is_empty() && !(second.starts_with(": ") && second.len() > 2)
    }

    /// Its own words, apart from those that a value could make longer.
    pub fn whole_words(&self) -> impl Iterator<Item = &str> {
        let last = self.before.len();
        self.pieces().enumerate().flat_map(move |(i, piece)| {
            let is_edge = |c: char| !c.is_alphanumeric();
            let from = match i {
                0 => 0,
                _ => piece.find(is_edge).unwrap_or(piece.len()),
            };
            let to = match i == last {
                true => piece.len(),
                false => piece.rfind(is_edge).unwrap_or(0),
            };
            words_of(piece.get(from..to).unwrap_or_default())
        })
    }

    /// The values of a text that has these words, each as short as it can be.
    pub fn match_values<'a>(&'a self, text: &'a str) -> Option<Vec<FoundValue<'a>>> {
        let (first, _) = self.before.first()?;
        let mut rest = text.strip_prefix(first.as_str())?.strip_suffix(self.end.as_str())?;
        let mut values = Vec::with_capacity(self.before.len());
        for (i, (words, name)) in self.before.iter().enumerate() {
            let next = self.before.get(i + 1).map(|(words, _)| words.as_str());
            let text = match next {
                Some(words) => {
                    let (value, after) = rest.split_once(words)?;
                    rest = after;
                    value
                }
                None => rest,
            };
            let after = next.unwrap_or(&self.end);
            let is_quoted = words.ends_with('“') && after.starts_with('”');
            values.push(FoundValue { name, text, is_quoted });
        }
        Some(values)
    }
}

/// A template has at least so many letters of its own, or is weak.
const MIN_LETTERS: usize = 3;

/// The words of a text.
pub fn words_of(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

/// What stands before the first value of a text, the value's name, and what follows. A brace that is
/// not closed is a letter.
fn split_at_value(text: &str) -> Option<(&str, &str, &str)> {
    let (words, after) = text.split_once('{')?;
    let (name, rest) = after.split_once('}')?;
    Some((words, name, rest))
}

/// A text with its values in the place of their names.
pub fn fill_in(text: &str, values: &[(&str, &dyn Display)]) -> String {
    let (mut filled, mut rest) = (String::with_capacity(text.len() + 16), text);
    while let Some((words, name, after)) = split_at_value(rest) {
        filled.push_str(words);
        match values.iter().find(|(of, _)| *of == name) {
            // Writing to a string does not fail.
            Some((_, value)) => drop(write!(filled, "{value}")),
            None => drop(write!(filled, "{{{name}}}")),
        }
        rest = after;
    }
    filled.push_str(rest);
    filled
}
