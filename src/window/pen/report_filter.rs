//! Filters the reports of a pen while it draws: passes good ones on, and ends a stroke at the first
//! invalid one. Floor 7.

use super::PenReport;
use eframe::egui::Pos2;

/// The speed, pt per second, at which a mouse has the least pressure.
const FAST_PT_PER_SEC: f32 = 2000.0;
/// The least pressure.
const LEAST_PRESSURE: f32 = 0.2;
/// The initial pressure of a mouse's stroke.
const FIRST_PRESSURE: f32 = 0.5;
/// The time in which a pressure made from speed comes two thirds of the way to a new one.
const PRESSURE_SECS: f32 = 0.06;

/// One good report of a pen that draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilteredReport {
    /// Screen pt.
    pub at: Pos2,
    /// `[0, 1]`.
    pub pressure: f32,
    pub tilt: (f32, f32),
    /// Since the stroke began.
    pub secs: f32,
}

/// Filters the reports of one stroke.
#[derive(Clone, Copy, Debug)]
pub struct ReportFilter {
    began_secs: f64,
    last: PenReport,
    pressure: f32,
    /// Whether pressure is derived from speed if the pen reports none.
    presses_by_speed: bool,
    /// The distance since time last advanced, pt.
    since_pt: f32,
}

/// Whether a report is valid.
fn is_good(report: &PenReport) -> bool {
    let tilt = [report.tilt.0, report.tilt.1];
    let is_finite =
        report.at.is_finite() && report.secs.is_finite() && tilt.iter().all(|v| v.is_finite());
    is_finite && report.pressure.is_none_or(f32::is_finite)
}

impl ReportFilter {
    /// The pen comes down; `None` if its first report is not good.
    pub fn begin(report: &PenReport, presses_by_speed: bool) -> Option<(Self, FilteredReport)> {
        let first = if presses_by_speed { FIRST_PRESSURE } else { 1.0 };
        let pressure = report.pressure.unwrap_or(first).clamp(0.0, 1.0);
        let watch = Self {
            began_secs: report.secs,
            last: *report,
            pressure,
            presses_by_speed,
            since_pt: 0.0,
        };
        is_good(report).then(|| (watch, watch.reading(report)))
    }

    /// The next report; `None` if the stroke must end at its last good one: the report has an
    /// invalid number, or is earlier than the last one.
    pub fn follow(&mut self, report: &PenReport) -> Option<FilteredReport> {
        if !is_good(report) || report.secs < self.last.secs {
            return None;
        }
        self.since_pt += report.at.distance(self.last.at);
        let elapsed = (report.secs - self.last.secs) as f32;
        match report.pressure {
            Some(pressure) => self.pressure = pressure.clamp(0.0, 1.0),
            // A pen that has pressure reports none as it lifts: it keeps its last.
            None if self.presses_by_speed && elapsed > 0.0 => {
                let speed = (self.since_pt / elapsed / FAST_PT_PER_SEC).min(1.0);
                let toward = 1.0 - (1.0 - LEAST_PRESSURE) * speed;
                self.pressure +=
                    (toward - self.pressure) * (1.0 - (-elapsed / PRESSURE_SECS).exp());
            }
            None => {}
        }
        if elapsed > 0.0 {
            self.since_pt = 0.0;
        }
        self.last = *report;
        Some(self.reading(report))
    }

    fn reading(&self, report: &PenReport) -> FilteredReport {
        let secs = (report.secs - self.began_secs) as f32;
        FilteredReport { at: report.at, pressure: self.pressure, tilt: report.tilt, secs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pen::{PenSource, RecordedPen};

    /// The good reports of a recorded stroke until it ends.
    fn readings(lines: &str, presses_by_speed: bool) -> Vec<FilteredReport> {
        let mut pen = RecordedPen::of(lines);
        let Some((mut watch, first)) = ReportFilter::begin(&pen.next().unwrap(), presses_by_speed)
        else {
            return Vec::new();
        };
        let rest = std::iter::from_fn(|| pen.next().and_then(|report| watch.follow(&report)));
        std::iter::once(first).chain(rest).collect()
    }

    #[test]
    fn a_stroke_ends_at_its_last_good_reading() {
        let good = "[10, 10, 0.5, 0.00]\n[20, 10, 0.6, 0.01]\n";
        for bad in [
            "[30, 10, null, 0.005]",
            "[\"nan\", 10, 0.5, 0.02]",
            "[30, 10, \"nan\", 0.02]",
            "[30, 10, 0.5, \"nan\"]",
        ] {
            let readings = readings(&format!("{good}{bad}\n[40, 10, 0.5, 0.03]"), false);
            assert_eq!(readings.len(), 2, "{bad}");
            assert_eq!(readings[1].pressure, 0.6);
        }
        assert!(readings("[\"nan\", 0, 1, 0]", false).is_empty());
    }

    #[test]
    fn a_pen_keeps_its_last_pressure_as_it_lifts_and_a_mouse_presses_wholly() {
        let pressures =
            |lines| readings(lines, false).iter().map(|r| r.pressure).collect::<Vec<_>>();
        assert_eq!(
            pressures("[0, 0, 0.25, 0]\n[9, 0, 0.5, 0.01]\n[9, 1, null, 0.02]"),
            [0.25, 0.5, 0.5]
        );
        assert_eq!(pressures("[0, 0, null, 0]\n[9, 0, null, 0.01]"), [1.0, 1.0]);
        assert_eq!(pressures("[0, 0, 7, 0]\n[9, 0, -3, 0.01]"), [1.0, 0.0]);
    }

    #[test]
    fn a_faster_hand_without_a_pen_presses_less() {
        let last = |step: f32| {
            let line = |i: i32| format!("[{}, 0, null, {}]\n", step * i as f32, 0.01 * i as f32);
            readings(&(0..60).map(line).collect::<String>(), true)
                .last()
                .map(|r| r.pressure)
                .unwrap()
        };
        // 100 and 1,000 pt/s.
        assert!(
            (last(1.0) - 0.96).abs() < 1e-3 && (last(10.0) - 0.6).abs() < 1e-3,
            "{} {}",
            last(1.0),
            last(10.0)
        );
    }
}
