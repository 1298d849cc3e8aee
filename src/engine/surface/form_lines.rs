//! Form lines: where an illustrator puts a line on a surface, as polylines with places between
//! pixels. Floor 2. Here: which lines there are, what is asked of them, and the cache. `outlines`
//! traces broken links, `fields` the curves of smooth forms, `colors` edges of a picture, `chains`
//! joins the steps of all, and `tidy` leaves those that a hand would draw. Not here: strokes along
//! them (`paint::form_drawing`).

mod chains;
mod colors;
mod fields;
mod outlines;
mod smooth;
mod tidy;
mod turns;

#[cfg(test)]
mod tests;

pub use colors::PaperColors;
pub use smooth::SmoothNormals;
pub(in crate::surface) use smooth::{blur_copy, diffuse_copy, gradient_of};

use super::Surface;
use super::cache::HeapSize;
use super::operator::UnwrapSettings;
use crate::math::number_settings::number_settings;
use crate::math::{Vec2, Vec3};
use colors::ColorsKey;
use fields::FormCurves;
use std::sync::Arc;

crate::named! {
    /// Why there is a line. In this order: of two lines at one place, the first stays.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum LineKind {
        /// Where one form ends before another, or before nothing.
        Outline = "outlines" => ("Outlines", "Where a form ends before another, or before nothing"),
        /// Where the surface has an edge.
        Crease = "creases" => ("Creases", "Edges of the form"),
        /// Where parts meet without a step.
        Border = "borders" => ("Borders", "Where parts meet without a step"),
        /// Along the bottom of a hollow (Judd et al. 2007).
        Valley = "valleys" => ("Valleys", "Along hollows"),
        /// Where the form would soon hide what is behind it (DeCarlo et al. 2003).
        Suggestive = "suggestive" => ("Suggestive contours", "Where the form would soon be an outline"),
        /// Along a crest (Judd et al. 2007).
        Ridge = "ridges" => ("Ridges", "Along crests"),
        /// Where the light grazes the form.
        Light = "light" => ("Edge of light", "Where light ends and shade begins"),
        /// Where a cast shadow ends.
        Shadow = "shadows" => ("Edges of shadow", "Where shadows that the form casts end"),
        /// Wires around the form: lines of the plane that it unwraps to.
        Wire = "wires" => ("Wires", "Lines around the form, equally far apart on it"),
        /// Where the colors of the picture beneath change (Di Zenzo 1986; Canny 1986).
        Color = "colors" => ("Edges of color", "Where the colors of what lies beneath change"),
    }
}

impl LineKind {
    /// The kinds where a surface ends or has an edge, however smooth its form is.
    pub const SHARP: [Self; 3] = [Self::Outline, Self::Crease, Self::Border];
}

/// Which kinds of lines are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LineKinds(u16);

impl LineKinds {
    /// No kind.
    pub const NONE: Self = Self(0);
    /// Those of a pen drawing.
    pub const PEN: Self = Self(0b1_1111);

    /// Whether a kind is among them.
    pub const fn has_kind(self, kind: LineKind) -> bool {
        self.0 >> kind as u16 & 1 == 1
    }

    /// With a kind, or without it.
    pub const fn with(self, kind: LineKind, is_in: bool) -> Self {
        let bit = 1 << kind as u16;
        Self(if is_in { self.0 | bit } else { self.0 & !bit })
    }
}

number_settings! {
    /// What is asked of lines. Lengths are canvas px.
    pub struct LineSettings {
        /// σ: forms smaller than this get no line, px.
        smooth: "Smallest form", "Forms smaller than this get no line, px", 0.5..=50.0, 2.0, px;
        /// How faint a line may be.
        detail: "Detail", "How faint a fold may be and still get a line", 0.0..=1.0, 0.6;
        /// The length of the shortest line, px.
        shortest: "Shortest line", "Shorter lines are left out, px", 0.0..=1000.0, 12.0, px;
        /// How far lines stand back behind what passes in front of them, px.
        gap: "Gap behind", "How far lines stand back behind what passes in front of them, px", 0.0..=100.0, 0.0, px;
        /// How much light the edge of light has.
        lit: "Light at its edge", "How much light there is where the edge of light is drawn", 0.0..=1.0, 0.5;
        /// The distance between wires, px on the surface.
        wires: "Wires apart", "The distance between wires, px on the surface", 4.0..=2000.0, 40.0, px;
        and
        /// Whether lines are left out that the document's ink draws already.
        skip_ink: bool = false;
        /// Which there are.
        kinds: LineKinds = LineKinds::PEN;
        /// Toward the light, camera space (y up), any length.
        light: Vec3 = Vec3::new(-0.5, 0.6, 0.62);
    }
}

impl LineSettings {
    /// Those of a new layer: it draws nothing that ink draws already.
    pub const BESIDE_INK: Self = Self { skip_ink: true, ..Self::DEFAULT };

    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut next = *self;
        for setting in Self::lengths() {
            setting.put(&mut next, (setting.get)(self) * factor);
        }
        next
    }

    /// Whether some of the lines follow the light.
    fn is_lit(&self) -> bool {
        LIT.into_iter().any(|kind| self.kinds.has_kind(kind))
    }

    fn key(&self, colors: Option<&Arc<PaperColors>>) -> LineKey {
        let is_lit = self.is_lit();
        let light = if is_lit { self.light.normalize_or(Vec3::Z).to_array() } else { [0.0; 3] };
        let [x, y, z] = light.map(f32::to_bits);
        let own = [self.smooth, self.detail, self.shortest, self.gap, self.wires];
        let [a, b, c, d, e] = own.map(f32::to_bits);
        let lit = if is_lit { self.lit.to_bits() } else { 0 };
        let bits = [a, b, c, d, e, lit, x, y, z];
        LineKey { kinds: self.kinds, bits, colors: colors.map(ColorsKey::of) }
    }
}

/// What tells lines from others of the same surface.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::surface) struct LineKey {
    kinds: LineKinds,
    bits: [u32; 9],
    colors: Option<ColorsKey>,
}

/// A point of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePoint {
    /// Canvas px.
    pub at: Vec2,
    /// How clear the line is there, `[0, 1]`.
    pub strength: f32,
}

/// A line.
#[derive(Clone, Debug, PartialEq)]
pub struct FormLine {
    /// Why it is there.
    pub kind: LineKind,
    /// Its points, about a pixel apart. What lies behind an outline is on the right of it (y down).
    pub points: Vec<LinePoint>,
    /// It ends where it begins.
    pub is_closed: bool,
    /// Whether its first and its last point lie on another line, which it is joined to.
    pub is_joined: [bool; 2],
}

impl FormLine {
    /// Its length, px.
    pub fn length_px(&self) -> f32 {
        let steps = self.points.windows(2).map(|pair| pair[0].at.distance(pair[1].at));
        let (first, last) = (self.points.first(), self.points.last());
        let closing = first.zip(last).filter(|_| self.is_closed);
        steps.sum::<f32>() + closing.map_or(0.0, |(a, b)| a.at.distance(b.at))
    }

    fn bytes(&self) -> u64 {
        (size_of::<Self>() + self.points.len() * size_of::<LinePoint>()) as u64
    }
}

/// The lines of a surface.
#[derive(Debug, Default, PartialEq)]
pub struct FormLines {
    /// Those of one kind after the other.
    pub lines: Vec<FormLine>,
}

impl HeapSize for FormLines {
    fn heap_bytes(&self) -> u64 {
        self.lines.iter().map(FormLine::bytes).sum()
    }
}

impl FormLines {
    fn of(surface: &Surface, settings: &LineSettings, colors: Option<&Arc<PaperColors>>) -> Self {
        let unlit = surface.unlit_lines(settings, colors);
        let mut lines = unlit.before.clone();
        let mut more = unlit.after.clone();
        if settings.is_lit() {
            let normals = surface.smooth_normals(settings.smooth);
            let traced = FormCurves { surface, normals: &normals, settings }.trace_light();
            more.extend(tidy::smooth_lines(traced, settings));
        }
        tidy::add_lines(&mut lines, more, settings);
        Self { lines: tidy::finish_lines(lines, settings) }
    }
}

/// The kinds that follow the light.
const LIT: [LineKind; 2] = [LineKind::Light, LineKind::Shadow];

/// The lines that stay where they are when the light moves.
#[derive(Debug)]
pub(in crate::surface) struct UnlitLines {
    /// Of kinds before those of the light: no two at one place.
    before: Vec<FormLine>,
    /// Of kinds after them, wherever they are.
    after: Vec<FormLine>,
}

impl UnlitLines {
    fn of(surface: &Surface, settings: &LineSettings, colors: Option<&Arc<PaperColors>>) -> Self {
        let has_kind = |kind| settings.kinds.has_kind(kind);
        let mut traced = Vec::new();
        if [LineKind::Valley, LineKind::Suggestive, LineKind::Ridge].into_iter().any(has_kind) {
            let normals = surface.smooth_normals(settings.smooth);
            traced.extend(FormCurves { surface, normals: &normals, settings }.trace_form());
        }
        if has_kind(LineKind::Wire) {
            let unwrapped = surface.unwrapping(UnwrapSettings::OF_WIRES);
            traced.extend(fields::wires(surface, &unwrapped, settings));
        }
        if let Some(colors) = colors {
            traced.extend(colors.trace(surface.size(), settings));
        }
        let mut smooth = surface.sharp_lines(settings).0.clone();
        smooth.extend(tidy::smooth_lines(traced, settings));
        let (first, after) = smooth.into_iter().partition(|line| line.kind < LIT[0]);
        let mut before = Vec::new();
        tidy::add_lines(&mut before, first, settings);
        Self { before, after }
    }
}

impl HeapSize for UnlitLines {
    fn heap_bytes(&self) -> u64 {
        self.before.iter().chain(&self.after).map(FormLine::bytes).sum()
    }
}

/// The lines of the sharp kinds, which stay when the form is smoothed.
#[derive(Debug)]
pub(in crate::surface) struct SharpLines(Vec<FormLine>);

impl HeapSize for SharpLines {
    fn heap_bytes(&self) -> u64 {
        self.0.iter().map(FormLine::bytes).sum()
    }
}

impl Surface {
    /// The lines of the surface, cached. Nothing is differenced across a broken link.
    pub fn form_lines(&self, settings: &LineSettings) -> Arc<FormLines> {
        self.form_lines_on(settings, None)
    }

    /// The same, with edges of the colors of a picture that lies on it if those are wanted.
    pub fn form_lines_on(
        &self,
        settings: &LineSettings,
        colors: Option<&Arc<PaperColors>>,
    ) -> Arc<FormLines> {
        const KEPT: usize = 4;
        let colors = colors.filter(|_| settings.kinds.has_kind(LineKind::Color));
        let compute = |_| FormLines::of(self, settings, colors);
        self.derived.form_lines.get_or_compute(settings.key(colors), KEPT, compute)
    }

    /// What stays of its lines when the light moves, cached.
    fn unlit_lines(
        &self,
        settings: &LineSettings,
        colors: Option<&Arc<PaperColors>>,
    ) -> Arc<UnlitLines> {
        const KEPT: usize = 2;
        let kinds = LIT.into_iter().fold(settings.kinds, |kinds, kind| kinds.with(kind, false));
        let settings = LineSettings { kinds, ..*settings };
        let compute = |_| UnlitLines::of(self, &settings, colors);
        self.derived.unlit_lines.get_or_compute(settings.key(colors), KEPT, compute)
    }

    /// Its outlines, creases and borders, cached.
    fn sharp_lines(&self, settings: &LineSettings) -> Arc<SharpLines> {
        const KEPT: usize = 2;
        let wanted = LineKind::SHARP.into_iter().filter(|kind| settings.kinds.has_kind(*kind));
        let kinds = wanted.fold(LineKinds::NONE, |kinds, kind| kinds.with(kind, true));
        let LineSettings { detail, shortest, .. } = *settings;
        let settings = LineSettings { detail, shortest, kinds, ..LineSettings::DEFAULT };
        self.derived.sharp_lines.get_or_compute(settings.key(None), KEPT, |_| {
            SharpLines(tidy::smooth_lines(outlines::trace(self, &settings), &settings))
        })
    }

    /// Its normals, blurred within each piece. Cached.
    pub fn smooth_normals(&self, smooth_px: f32) -> Arc<SmoothNormals> {
        const KEPT: usize = 2;
        let smooth_px = smooth_px.max(0.0).min(0.25 * self.size().longer_side());
        let compute = |_| SmoothNormals::of(self, smooth_px);
        self.derived.smooth_normals.get_or_compute(smooth_px.to_bits(), KEPT, compute)
    }
}
