//! Palettes: colors to paint with, in an order, each perhaps with a name. Floor 3. A palette is a
//! value; documents and the user's own list hold them. Not here: the files of other programs (`io`).

mod of_pixels;

pub use of_pixels::ColorCounter;

use crate::math::range::at_most;
use crate::math::srgb::Color;

/// Colors in an order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColorPalette {
    /// May be empty.
    pub name: String,
    /// How many stand in a row; 0 is as many as there is room for.
    pub columns: u32,
    /// In their order.
    pub colors: Vec<NamedColor>,
}

/// A color of a palette.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedColor {
    /// Opaque.
    pub color: Color,
    /// Empty if it has none.
    pub name: String,
}

impl NamedColor {
    /// A color, made opaque, with a name, tidied.
    pub fn new(color: Color, name: &str) -> Self {
        Self { color: Color { a: 255, ..color }, name: tidy_name(name) }
    }
}

impl From<Color> for NamedColor {
    fn from(color: Color) -> Self {
        Self::new(color, "")
    }
}

/// A name that every format can hold on one line: without control characters and spaces around it,
/// and not too long.
pub fn tidy_name(name: &str) -> String {
    let plain: String = name.chars().filter(|c| !c.is_control()).collect();
    let short: String = plain.trim().chars().take(ColorPalette::LONGEST_NAME).collect();
    short.trim_end().to_owned()
}

impl ColorPalette {
    /// The most colors; the largest books of inks have some five thousand.
    pub const MOST: usize = 10_000;
    /// The most in a row.
    pub const MOST_COLUMNS: u32 = 256;
    /// The most characters of a name.
    pub const LONGEST_NAME: usize = 80;

    /// Of these colors, without names.
    pub fn of_colors(name: &str, colors: &[Color]) -> Self {
        let colors = colors.iter().copied().map(NamedColor::from).collect();
        Self { name: tidy_name(name), columns: 0, colors }
    }

    /// Whether there is nothing in it that would have to be saved.
    pub fn is_blank(&self) -> bool {
        *self == Self::default()
    }

    /// Grays and earths, then a few clear hues: a start, not a choice.
    pub fn basic() -> Self {
        const COLORS: [[u8; 3]; 14] = [
            [0, 0, 0],
            [64, 64, 64],
            [128, 128, 128],
            [192, 192, 192],
            [255, 255, 255],
            [92, 58, 38],
            [176, 120, 78],
            [232, 196, 150],
            [190, 40, 40],
            [236, 150, 40],
            [244, 214, 84],
            [76, 150, 84],
            [56, 116, 190],
            [120, 72, 156],
        ];
        Self::of_colors("Basic", &COLORS.map(|[r, g, b]| Color::rgb(r, g, b)))
    }

    /// Refuses what files cannot hold.
    pub fn fits(&self) -> Result<(), String> {
        at_most("Colors of a palette", self.colors.len(), Self::MOST)?;
        if self.columns > Self::MOST_COLUMNS {
            let most = Self::MOST_COLUMNS;
            return Err(format!("A palette has {} columns; at most {most} fit", self.columns));
        }
        if std::iter::once(&self.name)
            .chain(self.colors.iter().map(|named| &named.name))
            .any(|name| tidy_name(name) != *name)
        {
            return Err("A name of a palette is too long or takes more than a line".into());
        }
        if self.colors.iter().any(|named| named.color.a != 255) {
            return Err("A color of a palette is transparent".into());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_a_line_and_colors_opaque() {
        let named = NamedColor::new(Color { a: 9, ..Color::WHITE }, " Sky\n\u{7}blue  ");
        assert_eq!((named.color, named.name.as_str()), (Color::WHITE, "Skyblue"));
        assert_eq!(tidy_name(&"é ".repeat(200)).chars().count(), 79);
    }

    #[test]
    fn what_no_file_gives_back_is_refused() {
        let basic = ColorPalette::basic();
        assert_eq!(basic.fits(), Ok(()));
        let one = |color: NamedColor| ColorPalette { colors: vec![color], ..basic.clone() };
        let clear = NamedColor { color: Color::TRANSPARENT, name: String::new() };
        let long = NamedColor { color: Color::BLACK, name: " a".into() };
        let many = vec![NamedColor::from(Color::BLACK); ColorPalette::MOST + 1];
        let wrong = [
            (one(clear), "transparent"),
            (one(long), "more than a line"),
            (ColorPalette { columns: 257, ..basic.clone() }, "257 columns"),
            (ColorPalette { colors: many, ..basic.clone() }, "10001"),
        ];
        for (palette, part) in wrong {
            let said = palette.fits().unwrap_err();
            assert!(said.contains(part), "{said}");
        }
    }
}
