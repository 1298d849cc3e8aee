//! Fonts for the languages whose letters the window's own font lacks: found among those of this
//! machine, and shown behind the window's own while they are needed. Floor 7. Not here: the search
//! (`io::text`).

use super::jobs;
use crate::io::text::{InstalledFont, find_font};
use crate::language::Language;
use eframe::egui::{Context, FontData, FontDefinitions, FontFamily};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// A language, some of its letters, and families with its own forms of them.
type LanguageLetters = (Language, &'static str, &'static [&'static str]);

/// The languages that need a font of the machine.
const HAN: [LanguageLetters; 2] = [
    (
        Language::Japanese,
        "あア漢語、",
        &[
            "Noto Sans CJK JP",
            "Noto Sans JP",
            "Source Han Sans",
            "Source Han Sans JP",
            "Yu Gothic UI",
            "Yu Gothic",
            "Hiragino Sans",
            "Hiragino Kaku Gothic ProN",
            "Meiryo UI",
            "Meiryo",
            "IPAexGothic",
            "IPAGothic",
            "MS Gothic",
        ],
    ),
    (
        Language::Chinese,
        "简体中文,",
        &[
            "Noto Sans CJK SC",
            "Noto Sans SC",
            "Source Han Sans SC",
            "Source Han Sans CN",
            "Microsoft YaHei UI",
            "Microsoft YaHei",
            "PingFang SC",
            "Hiragino Sans GB",
            "WenQuanYi Micro Hei",
            "WenQuanYi Zen Hei",
            "SimHei",
            "SimSun",
        ],
    ),
];

/// What was found for each of them.
static FOUND: [OnceLock<Option<InstalledFont>>; HAN.len()] = [const { OnceLock::new() }; HAN.len()];

/// The font of this machine for a language that needs one. The first time it searches, which may take
/// as long as reading all fonts does.
pub fn find_language_font(language: Language) -> Option<InstalledFont> {
    let index = HAN.iter().position(|(of, _, _)| *of == language)?;
    let (_, letters, families) = HAN[index];
    *FOUND[index].get_or_init(|| find_font(letters, families))
}

/// Whether the letters of a language can be shown; `None` until it is known, see
/// [`search_language_fonts`].
pub fn can_show(language: Language) -> Option<bool> {
    match HAN.iter().position(|(of, _, _)| *of == language) {
        Some(index) => FOUND[index].get().map(Option::is_some),
        None => Some(true),
    }
}

/// Searches the fonts of all languages on a thread of its own, once.
pub fn search_language_fonts(ctx: &Context) {
    static IS_BEGUN: AtomicBool = AtomicBool::new(false);
    if IS_BEGUN.swap(true, Ordering::Relaxed) {
        return;
    }
    let waker = ctx.clone();
    // Without a thread these languages are not offered.
    let _ = jobs::spawn("fonts of languages", move || {
        for (language, _, _) in HAN {
            find_language_font(language);
        }
        waker.request_repaint();
    });
}

/// The fonts behind the window's own.
#[derive(Default)]
pub struct FallbackFonts {
    shown: Vec<InstalledFont>,
}

impl FallbackFonts {
    /// Shows letters that are in no font of the window in the font of this language, and where names
    /// of all languages are listed, in those of the others.
    pub fn follow(&mut self, ctx: &Context, language: Language, has_list: bool) {
        let mut wanted = Vec::new();
        if language.is_written_in_han() {
            wanted.extend(find_language_font(language));
        }
        // The font of one has the letters in the name of the other, too, if it is not Japanese.
        for of in [Language::Chinese, Language::Japanese] {
            if has_list
                && can_show(of) == Some(true)
                && (of != Language::Japanese || wanted.is_empty())
            {
                wanted.extend(find_language_font(of));
            }
        }
        wanted.dedup();
        if wanted == self.shown {
            return;
        }
        let mut fonts = FontDefinitions::default();
        for (i, (bytes, index)) in wanted.iter().filter_map(|font| font.read()).enumerate() {
            let name = format!("language {i}");
            let data = FontData { index, ..FontData::from_owned(bytes) };
            fonts.font_data.insert(name.clone(), Arc::new(data));
            for family in [FontFamily::Proportional, FontFamily::Monospace] {
                fonts.families.entry(family).or_default().push(name.clone());
            }
        }
        ctx.set_fonts(fonts);
        self.shown = wanted;
    }
}
