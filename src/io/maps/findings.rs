//! The importer's findings: each detected choice, and how sure it is.
//! Floor 5. Plain data: `info` prints it, an import dialog shows it.

use crate::document::source::{DepthConvention, NormalConvention};

/// Normal maps are nearer to length 1 than this, in the mean; colors of drawings and photos are
/// not.
const MOST_LENGTH_ERROR: f32 = 0.1;

/// How a choice was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChoiceOrigin {
    /// The document says so.
    Given,
    /// Detected from the numbers.
    Found,
    /// Not detectable; the most common choice.
    Assumed,
}

impl ChoiceOrigin {
    /// Its word in files and in `info`.
    pub fn name(self) -> &'static str {
        match self {
            ChoiceOrigin::Given => "given",
            ChoiceOrigin::Found => "found",
            ChoiceOrigin::Assumed => "assumed",
        }
    }
}

/// One choice: `normal.flip_y` is `true`.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The path of the field that was chosen.
    pub field: &'static str,
    /// What was chosen, as files write it.
    pub value: String,
    /// 0 a guess … 1 certain.
    pub confidence: f32,
    /// Where the choice comes from.
    pub how: ChoiceOrigin,
}

/// Everything found while maps were read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// All choices, in the order they were made.
    pub choices: Vec<Finding>,
    /// Sentences for people: what was derived, filled, clipped or looks odd.
    pub notes: Vec<String>,
    /// The complete convention by which the normals were read; with it they are read the same way
    /// again.
    pub normal: Option<NormalConvention>,
    /// The same for depth.
    pub depth: Option<DepthConvention>,
    /// Planar depth (in the file's unit) at z = 0 and z = 1, so that anchors keep their meaning
    /// when maps are replaced.
    pub depth_range: Option<(f32, f32)>,
    /// How far the vectors that were read as normals are from length 1, in the mean, each at most
    /// 1.
    pub length_error: f32,
    /// The share of pixels, joined to the border, that look like background and are taken for
    /// surface.
    pub flat_border: f32,
}

impl Findings {
    /// Whether the file that was read as normals looks like something else, such as a drawing.
    pub fn is_doubtful(&self) -> bool {
        self.length_error > MOST_LENGTH_ERROR
    }

    /// Adds a sentence for the user.
    pub fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }

    /// Adds a choice that the file or the user made.
    pub fn add_given(&mut self, field: &'static str, value: impl ToString) {
        self.choices.push(Finding {
            field,
            value: value.to_string(),
            confidence: 1.0,
            how: ChoiceOrigin::Given,
        });
    }

    /// Adds a choice that was detected.
    pub fn add_detected(&mut self, field: &'static str, value: impl ToString, confidence: f32) {
        let confidence = confidence.max(0.0).min(1.0);
        self.choices.push(Finding {
            field,
            value: value.to_string(),
            confidence,
            how: ChoiceOrigin::Found,
        });
    }

    /// Adds a choice that was made for want of evidence.
    pub fn add_assumed(&mut self, field: &'static str, value: impl ToString, confidence: f32) {
        let confidence = confidence.max(0.0).min(1.0);
        self.choices.push(Finding {
            field,
            value: value.to_string(),
            confidence,
            how: ChoiceOrigin::Assumed,
        });
    }

    /// The choice made for a field.
    pub fn choice(&self, field: &str) -> Option<&Finding> {
        self.choices.iter().find(|c| c.field == field)
    }
}
