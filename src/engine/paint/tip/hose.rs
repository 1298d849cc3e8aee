//! Hoses: tips of several pictures, from which each dab takes one. Floor 3. The rules are those of
//! GIMP's image hoses, so that imported hoses paint as they do there.

use crate::math::hash;
use crate::paint::dynamics::DabInputs;
use crate::paint::image::PictureSource;
use std::f32::consts::TAU;
use std::sync::Arc;

/// A tip of several pictures, in one or more ranks: with ranks of 4 and 2, the first chooses one of
/// four pairs of pictures, the second one of the pair.
#[derive(Clone, PartialEq)]
pub struct Hose {
    pictures: Arc<[PictureSource]>,
    ranks: Arc<[HoseRank]>,
}

/// A row of choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HoseRank {
    /// The number of choices, `≥ 1`.
    pub count: u32,
    /// What selects a picture of the rank.
    pub select: RankSelect,
}

crate::named! {
    /// What chooses.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum RankSelect {
        /// One after the other.
        #[default]
        Incremental = "incremental",
        Random = "random",
        /// The stroke's direction: the first is up, the others follow clockwise.
        Angular = "angular",
        Pressure = "pressure",
        Speed = "velocity",
        TiltX = "xtilt",
        TiltY = "ytilt",
    }
}

/// What is known of a dab when its picture is chosen.
#[derive(Clone, Copy, Debug, Default)]
pub struct DabMoment {
    /// Its number in the stroke.
    pub number: u32,
    /// What drives the dab.
    pub inputs: DabInputs,
}

impl Hose {
    /// The pictures of one hose.
    pub const MOST_PICTURES: usize = 1024;
    /// GIMP's own limit.
    pub const MOST_RANKS: usize = 4;

    /// Pictures beyond the product of the ranks are never chosen. Without pictures nothing is
    /// painted.
    pub fn new(pictures: Vec<PictureSource>, ranks: Vec<HoseRank>) -> Self {
        Self { pictures: pictures.into(), ranks: ranks.into() }
    }

    /// All its pictures.
    pub fn pictures(&self) -> &[PictureSource] {
        &self.pictures
    }

    /// The ranks, the one with the largest stride first.
    pub fn ranks(&self) -> &[HoseRank] {
        &self.ranks
    }

    /// The same choice among other pictures.
    pub fn with_pictures(&self, pictures: Vec<PictureSource>) -> Self {
        Self { pictures: pictures.into(), ranks: self.ranks.clone() }
    }

    /// The index of a dab's picture, below the number of pictures if there are any.
    pub fn choose(&self, moment: &DabMoment) -> usize {
        let mut stride =
            self.ranks.iter().fold(1usize, |n, rank| n.saturating_mul(rank.count.max(1) as usize));
        let mut index = 0usize;
        for (place, rank) in (0..).zip(self.ranks.iter()) {
            let count = rank.count.max(1);
            stride /= count as usize;
            let step = rank.select.step(count, moment, place);
            index = index.saturating_add(step.min(count - 1) as usize * stride.max(1));
        }
        index.min(self.pictures.len().saturating_sub(1))
    }

    /// The longer side of a picture as a ratio of the longest one's, which is the diameter.
    pub fn share(&self, index: usize) -> f32 {
        let side = |source: &PictureSource| source.picture.size.longer_side();
        let longest = self.pictures.iter().map(side).fold(1.0, f32::max);
        self.pictures.get(index).map_or(1.0, |source| side(source) / longest)
    }
}

impl RankSelect {
    /// Which of `count` a dab takes; `place`: the rank's own, so that two random ranks differ.
    fn step(self, count: u32, moment: &DabMoment, place: u32) -> u32 {
        // Comparisons turn NaN into the first.
        let of_unit = |v: f32, n: u32| (v.max(0.0).min(1.0) * n as f32).round() as u32;
        let DabInputs { pressure, speed, direction, tilt, tilt_direction, seed, .. } =
            moment.inputs;
        let (lean_up, lean_right) = (tilt_direction * TAU).sin_cos();
        match self {
            RankSelect::Incremental => moment.number % count,
            RankSelect::Random => {
                ((hash::unit(seed, place, 4) * count as f32) as u32).min(count - 1)
            }
            RankSelect::Angular => of_unit((0.25 - direction).rem_euclid(1.0), count) % count,
            RankSelect::Pressure => of_unit(pressure, count - 1),
            RankSelect::Speed => of_unit(speed, count - 1),
            RankSelect::TiltX => of_unit(0.5 + 0.5 * tilt * lean_right, count - 1),
            RankSelect::TiltY => of_unit(0.5 - 0.5 * tilt * lean_up, count - 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::paint::Adjust;
    use crate::raster::Picture;

    fn hose(ranks: &[(u32, RankSelect)]) -> Hose {
        let count: u32 = ranks.iter().map(|(count, _)| count).product();
        let picture = |i: u32| {
            let side = 8 + 8 * (i % 2);
            let picture =
                Picture::srgb8(Size::new(side, side), vec![[255; 4]; (side * side) as usize])
                    .unwrap();
            PictureSource::new(format!("{i}.png"), picture, Adjust::default())
        };
        let ranks = ranks.iter().map(|&(count, select)| HoseRank { count, select }).collect();
        Hose::new((0..count).map(picture).collect(), ranks)
    }

    fn moment(inputs: DabInputs) -> DabMoment {
        DabMoment { number: 0, inputs }
    }

    #[test]
    fn pictures_follow_one_after_the_other_and_begin_again() {
        let hose = hose(&[(3, RankSelect::Incremental)]);
        let chosen: Vec<_> = (0..7)
            .map(|number| hose.choose(&DabMoment { number, ..DabMoment::default() }))
            .collect();
        assert_eq!(chosen, [0, 1, 2, 0, 1, 2, 0]);
    }

    #[test]
    fn the_first_picture_of_a_direction_is_up_and_the_others_follow_clockwise() {
        let hose = hose(&[(4, RankSelect::Angular)]);
        let chosen =
            |direction| hose.choose(&moment(DabInputs { direction, ..DabInputs::default() }));
        let (up, right, down, left) = (0.25, 0.0, 0.75, 0.5);
        assert_eq!([up, right, down, left].map(chosen), [0, 1, 2, 3]);
        assert_eq!(chosen(0.27), 0, "a little to the left of up is nearest to up");
    }

    #[test]
    fn ranks_multiply_and_the_first_strides_over_the_others() {
        let hose = hose(&[(4, RankSelect::Angular), (2, RankSelect::Pressure)]);
        let down =
            |pressure| moment(DabInputs { direction: 0.75, pressure, ..DabInputs::default() });
        assert_eq!(hose.choose(&down(1.0)), 5);
        assert_eq!(hose.choose(&down(0.2)), 4);
    }

    #[test]
    fn chance_takes_every_picture_and_the_same_one_for_the_same_dab() {
        let hose = hose(&[(5, RankSelect::Random)]);
        let chosen = |seed| hose.choose(&moment(DabInputs { seed, ..DabInputs::default() }));
        let mut seen = [0; 5];
        (0..500).for_each(|seed| seen[chosen(seed)] += 1);
        assert!(seen.iter().all(|n| (60..140).contains(n)), "{seen:?}");
        assert_eq!(chosen(77), chosen(77));
    }

    #[test]
    fn what_is_not_a_number_and_what_has_no_pictures_is_no_trouble() {
        let all = RankSelect::ALL.map(|(select, _)| (3, select));
        let nan = f32::NAN;
        let inputs = DabInputs {
            pressure: nan,
            direction: nan,
            speed: f32::INFINITY,
            tilt: nan,
            tilt_direction: -1e30,
            ..DabInputs::default()
        };
        let moment = DabMoment { number: 7, inputs };
        assert!(hose(&all[..3]).choose(&moment) < 27);
        assert!(hose(&all[3..]).choose(&moment) < 81);
        assert_eq!(Hose::new(Vec::new(), Vec::new()).choose(&moment), 0);
        let huge = vec![HoseRank { count: u32::MAX, select: RankSelect::Pressure }; 4];
        assert_eq!(Hose::new(Vec::new(), huge).choose(&moment), 0);
    }

    #[test]
    fn smaller_pictures_stay_smaller() {
        let hose = hose(&[(2, RankSelect::Incremental)]);
        assert_eq!((hose.share(0), hose.share(1), hose.share(9)), (0.5, 1.0, 1.0));
    }
}
