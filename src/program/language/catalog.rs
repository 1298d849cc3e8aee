//! A catalog: the translations of one language, read once from its file. A row's key is the English
//! text; in braces stand the names of values, which the translation may order as it likes.

use super::Language;
use super::template::{Template, fill_in, words_of};
use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt::Display;
use std::sync::{Mutex, OnceLock, PoisonError};

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
    let read = || Catalog { language, ..Catalog::read(FILES[index].1) };
    Some(READ[index].get_or_init(read))
}

/// The translations of one language.
#[derive(Default)]
pub struct Catalog {
    texts: HashMap<String, String>,
    /// The rows with values, those with the most letters of their own first.
    templates: Vec<Template>,
    /// Of a word: the templates that have it, of their own words the one that the fewest have.
    by_word: HashMap<String, Vec<usize>>,
    /// The templates without a whole word.
    wordless: Vec<usize>,
    /// How numbers and colons are written.
    language: Language,
    /// Messages that were translated before: what is shown is asked for again in every frame.
    seen: Mutex<HashMap<String, Option<String>>>,
}

/// How deep messages within messages are translated: an error may have a cause that has a cause.
const DEEPEST: usize = 6;

/// How many messages are kept.
const MOST_SEEN: usize = 1024;

impl Catalog {
    /// A file that cannot be read is an empty catalog: the program's own are held by a test.
    pub fn read(file: &str) -> Self {
        let texts: HashMap<String, String> = serde_json::from_str(file).unwrap_or_default();
        let mut templates: Vec<Template> =
            texts.keys().filter_map(|text| Template::read(text)).collect();
        templates.sort_by_key(|template| (usize::MAX - template.letters(), template.key.clone()));
        let mut counts: HashMap<&str, usize> = HashMap::new();
        for word in templates.iter().flat_map(Template::whole_words) {
            *counts.entry(word).or_default() += 1;
        }
        let mut by_word: HashMap<String, Vec<usize>> = HashMap::new();
        let mut wordless = Vec::new();
        for (i, template) in templates.iter().enumerate() {
            match template.whole_words().min_by_key(|word| counts.get(word)) {
                Some(word) => by_word.entry(word.to_owned()).or_default().push(i),
                None => wordless.push(i),
            }
        }
        let (language, seen) = (Language::English, Mutex::default());
        Self { texts, templates, by_word, wordless, language, seen }
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
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = seen.get(message) {
            return known.clone().map_or(Cow::Borrowed(message), Cow::Owned);
        }
        let found = self.translate(message, 0);
        if seen.len() >= MOST_SEEN {
            seen.clear();
        }
        seen.insert(message.to_owned(), found.clone());
        found.map_or(Cow::Borrowed(message), Cow::Owned)
    }

    /// A message in the language, if any of it is known.
    fn translate(&self, message: &str, depth: usize) -> Option<String> {
        if let Some(text) = self.find_text(message) {
            return Some(text.to_owned());
        }
        if depth == DEEPEST || !message.contains(char::is_alphabetic) {
            return None;
        }
        if let Some(amount) = self.language.amount_text(message) {
            return Some(amount);
        }
        if message.contains('\n') {
            return self.translate_parts(message, "\n", depth);
        }
        let templates = self.candidates(message);
        let (later, first): (Vec<&Template>, Vec<&Template>) =
            templates.into_iter().partition(|template| template.has_value_first());
        let find = |templates: &[&Template]| {
            templates.iter().find_map(|template| self.translate_instance(template, message, depth))
        };
        find(&first)
            .or_else(|| self.translate_tail(message, depth))
            .or_else(|| find(&later))
            .or_else(|| self.translate_sentences(message, depth))
            .or_else(|| self.translate_parts(message, "; ", depth))
    }

    /// The templates that a message could be an instance of, the longest first.
    fn candidates(&self, message: &str) -> Vec<&Template> {
        let mut found: Vec<usize> = words_of(message)
            .filter_map(|word| self.by_word.get(word))
            .chain([&self.wordless])
            .flatten()
            .copied()
            .collect();
        found.sort_unstable();
        found.dedup();
        found.into_iter().map(|i| &self.templates[i]).collect()
    }

    /// A message that has a template's words, with its values translated as messages of their own.
    fn translate_instance(
        &self,
        template: &Template,
        message: &str,
        depth: usize,
    ) -> Option<String> {
        let values = template.match_values(message)?;
        let translated: Vec<Option<String>> = values
            .iter()
            .map(|value| match value.is_quoted {
                true => None,
                false => self.translate(value.text, depth + 1),
            })
            .collect();
        if template.is_weak() && translated.iter().all(Option::is_none) {
            return None;
        }
        let values: Vec<(&str, String)> = values
            .iter()
            .zip(translated)
            .map(|(value, text)| (value.name, text.unwrap_or_else(|| value.text.to_owned())))
            .collect();
        let values: Vec<(&str, &dyn Display)> =
            values.iter().map(|(name, value)| (*name, value as &dyn Display)).collect();
        Some(fill_in(self.find_text(&template.key)?, &values))
    }

    /// `file: field: reason`, of which the reason is known.
    fn translate_tail(&self, message: &str, depth: usize) -> Option<String> {
        message.match_indices(": ").find_map(|(at, colon)| {
            let (head, tail) = (&message[..at], &message[at + colon.len()..]);
            let tail = self.translate(tail, depth + 1)?;
            let head = self.find_text(head).unwrap_or(head);
            Some(format!("{head}{}{tail}", self.language.colon()))
        })
    }

    /// Several sentences, each by itself.
    fn translate_sentences(&self, message: &str, depth: usize) -> Option<String> {
        let ends = message.match_indices(['.', '?', '!', '…']);
        let mut ends = ends.map(|(at, mark)| at + mark.len());
        let end = ends.find(|&end| message[end..].starts_with(' '))?;
        let (first, rest) = (&message[..end], &message[end + 1..]);
        let texts = [first, rest].map(|part| (part, self.translate(part, depth + 1)));
        join(&texts, " ")
    }

    /// The same for parts between separators.
    fn translate_parts(&self, message: &str, separator: &str, depth: usize) -> Option<String> {
        if !message.contains(separator) {
            return None;
        }
        let parts = message.split(separator);
        let texts: Vec<_> = parts.map(|part| (part, self.translate(part, depth + 1))).collect();
        join(&texts, separator)
    }
}

/// Parts and their translations; nothing if none is translated.
fn join(texts: &[(&str, Option<String>)], separator: &str) -> Option<String> {
    texts.iter().any(|(_, text)| text.is_some()).then(|| {
        let parts: Vec<&str> =
            texts.iter().map(|(part, text)| text.as_deref().unwrap_or(part)).collect();
        parts.join(separator)
    })
}
