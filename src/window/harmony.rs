//! Colors that go with another one. Floor 7. Not here: where they are shown (`panels::colors`).

use crate::math::hsv;
use crate::math::srgb::{Color, quantize};

rilievo_engine::named! {
    /// Which hues go with a hue, on the wheel of the picker.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Harmony {
        #[default]
        None = "none" => ("None", "No marks on the wheel"),
        Complement = "complement" => ("Complement", "The opposite hue"),
        Analogous = "analogous" => ("Analogous", "The neighbors on both sides"),
        Triad = "triad" => ("Triad", "Three hues, a third of a turn apart"),
        Split = "split" => ("Split complement", "The neighbors of the opposite hue"),
        Square = "square" => ("Square", "Four hues, a quarter of a turn apart"),
    }
}

impl Harmony {
    /// The turns from the current hue to the others.
    pub fn turns(self) -> &'static [f32] {
        const TWELFTH: f32 = 1.0 / 12.0;
        match self {
            Harmony::None => &[],
            Harmony::Complement => &[0.5],
            Harmony::Analogous => &[-TWELFTH, TWELFTH],
            Harmony::Triad => &[-4.0 * TWELFTH, 4.0 * TWELFTH],
            Harmony::Split => &[-5.0 * TWELFTH, 5.0 * TWELFTH],
            Harmony::Square => &[0.25, 0.5, 0.75],
        }
    }

    /// The other colors, of the same saturation and value, all in `[0, 1]`.
    pub fn colors(self, [h, s, v]: [f32; 3]) -> impl Iterator<Item = Color> {
        self.turns().iter().map(move |turn| {
            let [r, g, b] = hsv::to_rgb([h + turn, s, v]).map(quantize);
            Color::rgb(r, g, b)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colors_of_red_lie_where_painters_have_them() {
        let told = |harmony: Harmony| -> Vec<String> {
            harmony.colors([0.0, 1.0, 1.0]).map(|color| color.to_string()).collect()
        };
        assert_eq!(told(Harmony::None), [""; 0]);
        assert_eq!(told(Harmony::Complement), ["#00ffff"]);
        assert_eq!(told(Harmony::Analogous), ["#ff0080", "#ff8000"]);
        assert_eq!(told(Harmony::Triad), ["#0000ff", "#00ff00"]);
        assert_eq!(told(Harmony::Split), ["#0080ff", "#00ff80"]);
        assert_eq!(told(Harmony::Square), ["#80ff00", "#00ffff", "#8000ff"]);
    }
}
