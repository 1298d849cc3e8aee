//! How EXR channels are called: `layer.channel` names split at the last dot, parts as layers.
//! Floor 5.

use super::ExrChannel;
use exr::meta::MetaData;
use exr::meta::attribute::{SampleType, Text};

/// The names after the last dot that distinguish a channel from its siblings, with their letter.
const SUFFIXES: [(&str, char); 15] = [
    ("r", 'r'),
    ("g", 'g'),
    ("b", 'b'),
    ("a", 'a'),
    ("x", 'x'),
    ("y", 'y'),
    ("z", 'z'),
    ("w", 'w'),
    ("v", 'v'),
    ("t", 't'),
    ("u", 'u'),
    ("red", 'r'),
    ("green", 'g'),
    ("blue", 'b'),
    ("alpha", 'a'),
];

/// Channels that belong together: `ViewLayer.Normal` with its X, Y and Z.
#[derive(Clone, Debug)]
pub struct ExrPass {
    /// Empty for the channels without a layer.
    pub name: String,
    /// Letter of each channel, in the file's order; `None` for names beyond the known ones.
    pub suffixes: Vec<Option<char>>,
    /// Indices into the file's channels.
    pub channels: Vec<usize>,
}

impl ExrPass {
    /// The channels with these lower-case letters, or `None` where one is missing.
    pub fn letters(&self, letters: &str) -> Option<Vec<usize>> {
        let find =
            |c: char| self.suffixes.iter().position(|s| *s == Some(c)).map(|i| self.channels[i]);
        letters.chars().map(find).collect()
    }

    /// The pass's name without the prefixes of view layers, lower case, letters and digits only.
    pub fn key(&self) -> String {
        let last = self.name.rsplit('.').next().unwrap_or("");
        last.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
    }
}

/// The crate reads each byte as a character; programs write UTF-8.
fn text(name: &Text) -> String {
    String::from_utf8_lossy(name.bytes()).into_owned()
}

/// Every channel of every part. A part's name leads a channel's where the channel alone has no
/// layer, or where two parts have a channel of that name.
pub fn channels(meta: &MetaData) -> Vec<ExrChannel> {
    let several = meta.headers.len() > 1;
    let all = || meta.headers.iter().flat_map(|h| h.channels.list.iter().map(|c| text(&c.name)));
    let mut out = Vec::new();
    for (part, header) in meta.headers.iter().enumerate() {
        let part_name = header.own_attributes.layer_name.as_ref().map(text).unwrap_or_default();
        for (index, channel) in header.channels.list.iter().enumerate() {
            let own = text(&channel.name);
            let ambiguous =
                several && (!own.contains('.') || all().filter(|n| *n == own).count() > 1);
            let name =
                if ambiguous && !part_name.is_empty() { format!("{part_name}.{own}") } else { own };
            let kind = match channel.sample_type {
                SampleType::F16 => "half",
                SampleType::F32 => "float",
                SampleType::U32 => "uint",
            };
            out.push(ExrChannel { name, kind, part, index });
        }
    }
    out
}

/// Groups channels by the text before the last dot; a name without a known suffix is a pass by
/// itself.
pub fn passes(channels: &[ExrChannel]) -> Vec<ExrPass> {
    let mut out: Vec<ExrPass> = Vec::new();
    for (i, channel) in channels.iter().enumerate() {
        let (layer, end) = channel.name.rsplit_once('.').unwrap_or(("", &channel.name));
        let letter =
            SUFFIXES.iter().find(|(name, _)| end.eq_ignore_ascii_case(name)).map(|(_, c)| *c);
        let name = if letter.is_some() { layer } else { &channel.name };
        match out.iter_mut().find(|p| p.name == name) {
            Some(pass) => {
                pass.suffixes.push(letter);
                pass.channels.push(i);
            }
            None => {
                out.push(ExrPass { name: name.into(), suffixes: vec![letter], channels: vec![i] })
            }
        }
    }
    out
}
