//! A catalog: the translations of one language, read once from its file. A row's key is the English
//! text; in braces stand the names of values, which the translation may order as it likes.

use super::Language;
use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt::{Display, Write as _};
use std::sync::OnceLock;

/// The catalogs of all languages but English, in the order of [`Language::ALL`].
const FILES: [(Language, &str); 5] = [
    (Language::German, include_str!("de.json")),
    (Language::French, include_str!("fr.json")),
    (Language::Spanish, include_str!("es.json")),
    (Language::Japanese, include_str!("ja.json")),
    (Language::Chinese, include_str!("zh.json")),
];

/// The catalog of a language; English needs none.
pub fn find_catalog(language: Language) -> Option<&'static Catalog> {
    static READ: [OnceLock<Catalog>; FILES.len()] = [const { OnceLock::new() }; FILES.len()];
    let index = FILES.iter().position(|(of, _)| *of == language)?;
    Some(READ[index].get_or_init(|| Catalog::read(FILES[index].1)))
}

/// The translations of one language.
#[derive(Default)]
pub struct Catalog {
    texts: HashMap<String, String>,
    /// The rows with values, those with the most letters of their own first.
    templates: Vec<Template>,
}

impl Catalog {
    /// A file that cannot be read is an empty catalog: the program's own are held by a test.
    pub fn read(file: &str) -> Self {
        let texts: HashMap<String, String> = serde_json::from_str(file).unwrap_or_default();
        let mut templates: Vec<Template> =
            texts.keys().filter_map(|text| Template::read(text)).collect();
        templates.sort_by_key(|template| (usize::MAX - template.letters(), template.key.clone()));
        Self { texts, templates }
    }

    pub fn rows(&self) -> impl Iterator<Item = (&str, &str)> {
        self.texts.iter().map(|(english, text)| (english.as_str(), text.as_str()))
    }

    pub fn find_text(&self, english: &str) -> Option<&str> {
        self.texts.get(english).map(String::as_str)
    }

    /// See [`tr_message`](super::tr_message).
    pub fn translate_message<'a>(&'a self, message: &'a str) -> Cow<'a, str> {
        if let Some(text) = self.find_text(message) {
            return Cow::Borrowed(text);
        }
        for template in &self.templates {
            if let Some(values) = template.match_values(message) {
                let values: Vec<(&str, &str)> = values
                    .into_iter()
                    .map(|(name, value)| (name, self.find_text(value).unwrap_or(value)))
                    .collect();
                let values: Vec<(&str, &dyn Display)> =
                    values.iter().map(|(name, value)| (*name, value as &dyn Display)).collect();
                let text = self.find_text(&template.key).unwrap_or(&template.key);
                return Cow::Owned(fill_in(text, &values));
            }
        }
        Cow::Borrowed(message)
    }
}

/// A row with values: its own words, and the names of the values between them.
struct Template {
    key: String,
    /// The words before each value, and the value's name.
    before: Vec<(String, String)>,
    /// The words after the last value.
    end: String,
}

impl Template {
    /// A text without values is no template, nor is one without words: it would be like any text.
    fn read(key: &str) -> Option<Self> {
        let (mut before, mut rest) = (Vec::new(), key);
        while let Some((words, name, after)) = split_at_value(rest) {
            before.push((words.to_owned(), name.to_owned()));
            rest = after;
        }
        let template = Self { key: key.to_owned(), before, end: rest.to_owned() };
        (!template.before.is_empty() && template.letters() >= MIN_LETTERS).then_some(template)
    }

    /// How many letters are its own.
    fn letters(&self) -> usize {
        let before = self.before.iter().map(|(words, _)| words.as_str());
        before.chain([self.end.as_str()]).flat_map(str::chars).filter(|c| c.is_alphabetic()).count()
    }

    /// The values of a message that has these words, each as short as it can be.
    fn match_values<'a>(&'a self, message: &'a str) -> Option<Vec<(&'a str, &'a str)>> {
        let (first, _) = self.before.first()?;
        let mut rest = message.strip_prefix(first.as_str())?.strip_suffix(self.end.as_str())?;
        let mut values = Vec::with_capacity(self.before.len());
        for (i, (_, name)) in self.before.iter().enumerate() {
            let value = match self.before.get(i + 1) {
                Some((words, _)) => {
                    let (value, after) = rest.split_once(words.as_str())?;
                    rest = after;
                    value
                }
                None => rest,
            };
            values.push((name.as_str(), value));
        }
        Some(values)
    }
}

/// A template has at least so many letters of its own.
const MIN_LETTERS: usize = 3;

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
