//! Names of the areas of a drawing: by their color, and by where they are if several have it.
//! Floor 3.

use super::palette::NOTHING;
use crate::math::srgb::Color;
use crate::math::{Vec2, vec2};
use crate::raster::Plane;

/// Hues in degrees, up to where each is called so.
const HUES: [(f32, &str); 10] = [
    (14.0, "red"),
    (42.0, "orange"),
    (68.0, "yellow"),
    (160.0, "green"),
    (195.0, "turquoise"),
    (250.0, "blue"),
    (290.0, "violet"),
    (325.0, "magenta"),
    (345.0, "pink"),
    (360.0, "red"),
];
/// A color less saturated than this is a gray.
const LEAST_CHROMA: f32 = 0.09;
/// Two places nearer to each other than this share of the figure are not told apart by a side.
const LEAST_APART: f32 = 0.05;

/// What a color is called: “dark blue”.
pub fn color_name(color: Color) -> String {
    let [r, g, b] = [color.r, color.g, color.b].map(|v| f32::from(v) / 255.0);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let (chroma, light) = (most - least, (most + least) / 2.0);
    if chroma < LEAST_CHROMA {
        let gray = match light {
            l if l < 0.15 => "black",
            l if l < 0.4 => "dark gray",
            l if l < 0.65 => "gray",
            l if l < 0.88 => "light gray",
            _ => "white",
        };
        return gray.to_owned();
    }
    let sixth = match () {
        _ if most == r => ((g - b) / chroma).rem_euclid(6.0),
        _ if most == g => (b - r) / chroma + 2.0,
        _ => (r - g) / chroma + 4.0,
    };
    let hue = 60.0 * sixth;
    let name = HUES.iter().find(|(to, _)| hue <= *to).map_or("red", |(_, name)| name);
    // What is between red and yellow has names of its own where it is dark or pale.
    let is_warm = (14.0..=50.0).contains(&hue);
    let shade = match () {
        _ if light < 0.14 => return "black".to_owned(),
        _ if light > 0.93 => return "white".to_owned(),
        _ if is_warm && light < 0.42 => return "brown".to_owned(),
        _ if (14.0..=68.0).contains(&hue) && light > 0.74 => return "cream".to_owned(),
        _ if name == "red" && light > 0.7 => return "pink".to_owned(),
        _ if light < 0.3 => "dark ",
        _ if light > 0.75 => "light ",
        _ => "",
    };
    format!("{shade}{name}")
}

/// Names of areas that differ from each other: “Dark blue”, “Blue, left”, “Blue, right 2”.
///
/// * `labels`: the number of the area of each pixel; a larger one is none.
pub fn area_names(colors: &[Color], labels: &Plane<u16>) -> Vec<String> {
    let (middles, figure) = middles(labels, colors.len());
    let plain: Vec<String> = colors.iter().map(|color| color_name(*color)).collect();
    let placed = |i: usize| {
        let alike: Vec<usize> = (0..plain.len()).filter(|j| plain[*j] == plain[i]).collect();
        match alike.len() {
            1 => plain[i].clone(),
            _ => format!("{}, {}", plain[i], place_among(i, &alike, &middles, figure)),
        }
    };
    let placed: Vec<String> = (0..plain.len()).map(placed).collect();
    let number = |i: usize| placed[..=i].iter().filter(|name| **name == placed[i]).count();
    let name = |i: usize| match number(i) {
        1 => capital(&placed[i]),
        n => format!("{} {n}", capital(&placed[i])),
    };
    (0..placed.len()).map(name).collect()
}

fn capital(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The middle of each area, and the size of all together, px.
fn middles(labels: &Plane<u16>, n: usize) -> (Vec<Vec2>, Vec2) {
    let mut sums = vec![(0.0f64, 0.0f64, 0u32); n];
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for y in 0..labels.height() {
        for (x, label) in labels.row(y).iter().enumerate().filter(|(_, label)| **label < NOTHING) {
            let at = vec2(x as f32, y as f32);
            (low, high) = (low.min(at), high.max(at));
            if let Some((sum_x, sum_y, count)) = sums.get_mut(usize::from(*label)) {
                *sum_x += x as f64;
                *sum_y += y as f64;
                *count += 1;
            }
        }
    }
    let middle = |(x, y, count): &(f64, f64, u32)| {
        let count = f64::from((*count).max(1));
        vec2((x / count) as f32, (y / count) as f32)
    };
    (sums.iter().map(middle).collect(), (high - low).max(Vec2::ONE))
}

/// Where an area is among those of its color.
fn place_among(own: usize, alike: &[usize], middles: &[Vec2], figure: Vec2) -> String {
    let side = |axis: usize, [low, high]: [&'static str; 2]| {
        let of = |i: usize| middles[i][axis] / figure[axis];
        let all = || alike.iter().map(|i| of(*i));
        let (least, most) = (all().fold(f32::MAX, f32::min), all().fold(f32::MIN, f32::max));
        let share = (of(own) - least) / (most - least).max(f32::MIN_POSITIVE);
        let word = match share {
            s if s < 1.0 / 3.0 => low,
            s if s > 2.0 / 3.0 => high,
            _ => "middle",
        };
        (most - least, word)
    };
    let (across, x) = side(0, ["left", "right"]);
    let (down, y) = side(1, ["top", "bottom"]);
    match (across >= LEAST_APART, down >= LEAST_APART) {
        (true, true) if alike.len() > 2 && x != "middle" && y != "middle" => format!("{y} {x}"),
        (true, true) if alike.len() > 2 && x == "middle" => y.to_owned(),
        _ if across >= down => x.to_owned(),
        _ => y.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    fn rgb(r: u8, g: u8, b: u8) -> Color {
        Color { r, g, b, a: 255 }
    }

    #[test]
    fn colors_are_called_as_people_call_them() {
        let known = [
            (rgb(255, 255, 255), "white"),
            (rgb(20, 20, 22), "black"),
            (rgb(128, 130, 128), "gray"),
            (rgb(230, 40, 30), "red"),
            (rgb(226, 117, 45), "orange"),
            (rgb(90, 50, 35), "brown"),
            (rgb(245, 235, 215), "cream"),
            (rgb(240, 190, 60), "yellow"),
            (rgb(240, 220, 60), "yellow"),
            (rgb(60, 170, 90), "green"),
            (rgb(45, 112, 165), "blue"),
            (rgb(30, 42, 75), "dark blue"),
            (rgb(150, 200, 250), "light blue"),
        ];
        for (color, name) in known {
            assert_eq!(color_name(color), name, "{color:?}");
        }
    }

    #[test]
    fn areas_of_one_color_are_told_apart_by_their_places_and_then_by_numbers() {
        let labels = Plane::from_fn(Size::new(90, 60), |x, y| match (x / 30, y / 20) {
            (0, 0) => 0,
            (2, 0) => 1,
            (2, 2) => 2,
            (1, 1) => 3,
            (1, 2) => 4,
            _ => NOTHING,
        });
        let blue = rgb(40, 90, 200);
        let colors = [blue, blue, rgb(230, 40, 30), rgb(240, 220, 60), rgb(240, 220, 60)];
        let names = area_names(&colors, &labels);
        assert_eq!(names, ["Blue, left", "Blue, right", "Red", "Yellow, top", "Yellow, bottom"]);
        let names = area_names(&[blue; 5], &labels);
        let mut unique = names.clone();
        unique.sort();
        unique.dedup();
        assert_eq!(unique.len(), 5, "{names:?}");
        assert_eq!(names[..2], ["Blue, top left", "Blue, top right"]);
    }
}
