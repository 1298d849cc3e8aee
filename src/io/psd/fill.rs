//! What layers are filled with: one color, a gradient or a pattern; colors and ramps as descriptors
//! say them. Floor 5. Not here: the blocks of fills (`fill_block`), the pictures of patterns
//! (`pattern`).

use super::colors::{Colors, Mode, lab_to_linear};
use super::descriptor::DescriptorObject;
use crate::math::srgb::{self, Color};
use crate::math::{Rect, Size, Vec2, hsv, vec2};
use crate::paint::RampStyle;
use crate::paint::{Gradient, GradientStop, ImageFilter};

/// What a fill layer is filled with.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerFill {
    Solid(Color),
    Gradient(GradientFill),
    Pattern(PatternFill),
}

/// A gradient and how it lies on what it fills.
#[derive(Clone, Debug, PartialEq)]
pub struct GradientFill {
    pub way: RampStyle,
    /// Counter-clockwise, as seen.
    pub degrees: f32,
    /// Relative to the length that just fills, which is 1.
    pub scale: f32,
    /// Offset of the middle, in shares of what is filled.
    pub offset: Vec2,
    /// It fills the layer, not the canvas.
    pub aligned: bool,
    pub stops: Vec<GradientStop>,
}

/// Which pattern, and how it lies.
#[derive(Clone, Debug, PartialEq)]
pub struct PatternFill {
    pub id: String,
    pub scale: f32,
    pub phase: Vec2,
}

/// Stops from one that the file names to the next: colors and opacities have middles of their own,
/// where ramps bend.
const BETWEEN: usize = 8;
/// No real gradient has more stops.
const MOST_STOPS: usize = 1000;

/// A percentage as a share.
pub fn share(object: &DescriptorObject, name: &str, absent: f32) -> f32 {
    object.number(name).map_or(absent, |percent| percent / 100.0)
}

/// A color in any of the ways that descriptors say one. With 32 bits a channel, RGB and gray are
/// light there.
pub fn color(said: &DescriptorObject, colors: &Colors) -> Option<Color> {
    let byte = |v: f32, full: f32| srgb::quantize(v / full);
    let all = |names: [&str; 3]| {
        Some([said.number(names[0])?, said.number(names[1])?, said.number(names[2])?])
    };
    let in_mode = |mode: Mode, values: [u8; 4]| in_mode(mode, values, colors);
    if let Some(rgb) = all(["Rd  ", "Grn ", "Bl  "]) {
        let [r, g, b] = rgb.map(|v| match colors.is_light {
            true => srgb::quantize(srgb::encode((v / 255.0).max(0.0))),
            false => byte(v, 255.0),
        });
        return Some(in_mode(Mode::Rgb, [r, g, b, 0]));
    }
    if let Some([h, s, v]) = all(["H   ", "Strt", "Brgh"]) {
        let [r, g, b] = hsv::to_rgb([h / 360.0, s / 100.0, v / 100.0]).map(|v| byte(v, 1.0));
        return Some(in_mode(Mode::Rgb, [r, g, b, 0]));
    }
    if let (Some(cmy), Some(k)) = (all(["Cyn ", "Mgnt", "Ylw "]), said.number("Blck")) {
        let [c, m, y] = cmy.map(|ink| byte(100.0 - ink, 100.0));
        return Some(in_mode(Mode::Cmyk, [c, m, y, byte(100.0 - k, 100.0)]));
    }
    if let Some(lab) = all(["Lmnc", "A   ", "B   "]) {
        return Some(lab_color(lab, colors));
    }
    let gray = 1.0 - said.number("Gry ")? / 100.0;
    let gray = if colors.is_light { srgb::encode(gray.max(0.0)) } else { gray };
    Some(in_mode(Mode::Gray, [srgb::quantize(gray), 0, 0, 0]))
}

/// A color that is said in inks or Lab as the values of a file of that mode; `None` of others.
pub fn own_values(said: &DescriptorObject, mode: Mode) -> Option<[f32; 4]> {
    let number = |name: &str| said.number(name);
    match mode {
        Mode::Cmyk => {
            let light = |name: &str| Some(1.0 - number(name)? / 100.0);
            Some([light("Cyn ")?, light("Mgnt")?, light("Ylw ")?, light("Blck")?])
        }
        Mode::Lab => {
            let around = |name: &str| Some((number(name)? + 128.0) / 255.0);
            Some([number("Lmnc")? / 100.0, around("A   ")?, around("B   ")?, 0.0])
        }
        _ => None,
    }
}

/// The encoded sRGB of a file's values.
pub fn show_values(values: &[[f32; 4]], colors: &Colors) -> Vec<[f32; 3]> {
    if colors.mode == Mode::Lab {
        let encode = |v: f32| srgb::encode(v.max(0.0).min(1.0));
        let color = |&[l, a, b, _]: &[f32; 4]| lab_to_linear([l, a, b], false).map(encode);
        return values.iter().map(color).collect();
    }
    let plane = |c: usize| Some(values.iter().map(|value| srgb::quantize(value[c])).collect());
    let planes = [plane(0), plane(1), plane(2), plane(3)];
    let rgba = colors.to_srgb(Size::new(values.len() as u32, 1), &planes, None);
    let color = |&[r, g, b, _]: &[u8; 4]| [r, g, b].map(|v| f32::from(v) / 255.0);
    rgba.as_chunks::<4>().0.iter().map(color).collect()
}

/// A color of one mode, of a file in perhaps another.
fn in_mode(mode: Mode, values: [u8; 4], colors: &Colors) -> Color {
    let channels = usize::from(mode.channels());
    let icc = colors.icc.filter(|_| colors.mode == mode);
    let own = Colors { mode, channels, icc, is_deep_lab: false, ..*colors };
    let planes = values.map(|v| Some(vec![v]));
    let rgba = own.to_srgb(Size::new(1, 1), &planes, None);
    Color { r: rgba[0], g: rgba[1], b: rgba[2], a: 255 }
}

/// A color of Lab, L to 100.
pub fn lab_color([l, a, b]: [f32; 3], colors: &Colors) -> Color {
    let byte = |v: f32, full: f32| srgb::quantize(v / full);
    let values = [byte(l, 100.0), byte(a + 128.0, 255.0), byte(b + 128.0, 255.0), 0];
    in_mode(Mode::Lab, values, colors)
}

/// A color of CIE XYZ relative to D50.
pub fn xyz_color([x, y, z]: [f32; 3], colors: &Colors) -> Color {
    // The white point of D50, and CIE's curve of lightness.
    let f = |v: f32| if v > 0.008_856 { v.cbrt() } else { 7.787 * v + 16.0 / 116.0 };
    let [fx, fy, fz] = [f(x / 0.9642), f(y), f(z / 0.8249)];
    lab_color([116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)], colors)
}

/// A ramp and how it lies, as fills and effects say it; `None` of noise.
pub fn gradient(said: &DescriptorObject, colors: &Colors) -> Option<GradientFill> {
    // The ramp of a glow runs outward, and says no type.
    let way = match said.word("Type").unwrap_or_default() {
        b"Rdl " => RampStyle::Radial,
        b"Angl" => RampStyle::Angle,
        b"Rflc" => RampStyle::Reflected,
        b"Dmnd" => RampStyle::Diamond,
        _ => RampStyle::Linear,
    };
    let offset = said.object("Ofst");
    let along = |name: &str| offset.map_or(0.0, |offset| share(offset, name, 0.0));
    let stops = in_direction(stops(said.object("Grad")?, colors)?, said, way);
    Some(GradientFill {
        way,
        degrees: said.number("Angl").unwrap_or(0.0),
        scale: share(said, "Scl ", 1.0).max(0.001).min(1000.0),
        offset: vec2(along("Hrzn"), along("Vrtc")),
        aligned: !said.is_false("Algn"),
        stops,
    })
}

/// Stops from the beginning of a ramp to its end, as it runs here: reversed where the file says so,
/// and around a middle, where Photoshop's runs clockwise.
pub fn in_direction(
    mut stops: Vec<GradientStop>,
    said: &DescriptorObject,
    way: RampStyle,
) -> Vec<GradientStop> {
    if said.is_set("Rvrs") != (way == RampStyle::Angle) {
        stops.iter_mut().for_each(|stop| stop.t = 1.0 - stop.t);
        stops.reverse();
    }
    stops
}

/// A value at a place of a ramp, and where the middle between the one before and it lies.
#[derive(Clone, Copy)]
pub struct Mark<T> {
    pub t: f32,
    pub middle: f32,
    pub value: T,
}

impl<T> Mark<T> {
    /// How much of its value there is at a share of the way from the mark before: half at the middle.
    pub fn bend(&self, s: f32) -> f32 {
        if s < self.middle {
            0.5 * s / self.middle
        } else {
            0.5 + 0.5 * (s - self.middle) / (1.0 - self.middle)
        }
    }
}

/// The ramp's colors and opacities as stops of colors with alpha; `None` of noise.
fn stops(ramp: &DescriptorObject, colors: &Colors) -> Option<Vec<GradientStop>> {
    let place = |object: &DescriptorObject| {
        let t = object.number("Lctn")? / 4096.0;
        Some((t.max(0.0).min(1.0), share(object, "Mdpn", 0.5).max(0.01).min(0.99)))
    };
    let mut inks: Vec<Mark<[f32; 3]>> = Vec::new();
    for object in ramp.objects("Clrs").take(MOST_STOPS) {
        let (t, middle) = place(object)?;
        let [r, g, b, _] = object.object("Clr ").and_then(|said| color(said, colors))?.to_f32();
        inks.push(Mark { t, middle, value: [r, g, b] });
    }
    let mut opacities: Vec<Mark<[f32; 1]>> = Vec::new();
    for object in ramp.objects("Trns").take(MOST_STOPS) {
        let (t, middle) = place(object)?;
        opacities.push(Mark { t, middle, value: [share(object, "Opct", 1.0)] });
    }
    self::ramp(inks, opacities)
}

/// Colors and opacities as stops of colors with alpha; `None` without a color.
pub fn ramp(
    mut inks: Vec<Mark<[f32; 3]>>,
    mut opacities: Vec<Mark<[f32; 1]>>,
) -> Option<Vec<GradientStop>> {
    inks.sort_by(|a, b| a.t.total_cmp(&b.t));
    opacities.sort_by(|a, b| a.t.total_cmp(&b.t));
    inks.first()?;
    // Straight between colors that have their opacities beside them: stops as they are here.
    let is_stop = |(ink, opacity): (&Mark<[f32; 3]>, &Mark<[f32; 1]>)| {
        ink.t == opacity.t && ink.middle == 0.5 && opacity.middle == 0.5
    };
    if inks.len() == opacities.len() && inks.iter().zip(&opacities).all(is_stop) {
        let stop = |(ink, opacity): (Mark<[f32; 3]>, Mark<[f32; 1]>)| {
            let ([r, g, b], [a]) = (ink.value, opacity.value);
            let [r, g, b, a] = [r, g, b, a].map(srgb::quantize);
            GradientStop { t: ink.t, color: Color { r, g, b, a } }
        };
        return Some(inks.into_iter().zip(opacities).map(stop).collect());
    }
    let mut places: Vec<f32> =
        [0.0, 1.0].into_iter().chain(inks.iter().map(|mark| mark.t)).collect();
    places.extend(opacities.iter().map(|mark| mark.t));
    places.sort_by(f32::total_cmp);
    places.dedup();
    let between = |pair: &[f32]| {
        let (from, to) = (pair[0], pair[1]);
        (0..BETWEEN).map(move |i| from + (to - from) * i as f32 / BETWEEN as f32)
    };
    let all: Vec<f32> = places.windows(2).flat_map(between).chain(places.last().copied()).collect();
    let stop = |t: f32| {
        let [r, g, b] = at(&inks, t)?;
        let [a] = at(&opacities, t).unwrap_or([1.0]);
        let [r, g, b, a] = [r, g, b, a].map(srgb::quantize);
        Some(GradientStop { t, color: Color { r, g, b, a } })
    };
    all.into_iter().map(stop).collect()
}

/// The value at a place: between two marks it is halfway at their middle.
fn at<const N: usize>(marks: &[Mark<[f32; N]>], t: f32) -> Option<[f32; N]> {
    let next = marks.partition_point(|mark| mark.t <= t);
    let (Some(from), Some(to)) = (next.checked_sub(1).map(|i| marks[i]), marks.get(next)) else {
        return if next == 0 { marks.first() } else { marks.last() }.map(|mark| mark.value);
    };
    let s = to.bend((t - from.t) / (to.t - from.t));
    Some(std::array::from_fn(|i| from.value[i] + (to.value[i] - from.value[i]) * s))
}

impl GradientFill {
    /// As a gradient of this program, on the rectangle that it fills.
    pub fn live(&self, rect: Rect) -> Gradient {
        let (from, to) = self.ends(rect);
        let stops = self.stops.clone();
        let line = Gradient::new(from, to, &[]);
        Gradient { style: self.way, stops, filter: ImageFilter::Bilinear, ..line }
    }

    fn ends(&self, rect: Rect) -> (Vec2, Vec2) {
        self.way.ends(rect, self.degrees, self.scale, self.offset)
    }

    /// The color of a pixel.
    pub fn color_at(&self, rect: Rect, [x, y]: [i32; 2]) -> Option<Color> {
        let line = self.way.middle_and_half(self.ends(rect));
        let [r, g, b, a] = self.at(self.way.place(line, vec2(x as f32 + 0.5, y as f32 + 0.5)));
        Some(Color { r, g, b, a })
    }

    fn at(&self, t: f32) -> [u8; 4] {
        let t = t.max(0.0).min(1.0);
        let next = self.stops.partition_point(|stop| stop.t <= t);
        let color = |stop: Option<&GradientStop>| stop.map_or([0.0; 4], |stop| stop.color.to_f32());
        match (next.checked_sub(1), self.stops.get(next)) {
            (Some(i), Some(to)) => {
                let from = self.stops[i];
                let s = (t - from.t) / (to.t - from.t);
                let (a, b) = (color(Some(&from)), color(Some(to)));
                std::array::from_fn(|c| srgb::quantize(a[c] + (b[c] - a[c]) * s))
            }
            (None, first) => color(first).map(srgb::quantize),
            (Some(last), None) => color(self.stops.get(last)).map(srgb::quantize),
        }
    }
}
