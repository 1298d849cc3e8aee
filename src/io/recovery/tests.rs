use super::journal::Journal;
use super::state::LastState;
use super::*;
use crate::Budget;
use crate::document::{Content, Layer, PixelLayer, Progress};
use crate::fs::Disk;
use crate::fs::memory::{InjectedError, InjectedFailure, MemoryFs};
use crate::math::{Size, srgb::Color};
use crate::project::sample::{assert_same, everything, smoothly_painted, tiles16};
use crate::raster::TileGrid;

const LOG: &str = "/r/1.log";

/// A small drawing after `strokes` dots were painted, each where another was.
fn dotted_drawing(strokes: usize) -> Document {
    let base = Document::empty(Size::new(130, 70));
    let mut rgba = vec![0; 130 * 70 * 4];
    for i in 0..strokes {
        rgba[(i * 37 % (130 * 70)) * 4..][..4].copy_from_slice(&[i as u8, 200, 7, 255]);
    }
    let tiles = TileGrid::from_straight_rgba(&rgba, 130, 70, 0, 0);
    let layer =
        Layer::new("dots", Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }));
    Document { layers: vec![Arc::new(layer)], ..base }
}

fn journal(fs: &MemoryFs) -> Journal {
    Journal::new(Arc::new(fs.clone()), LOG.into(), "dots", None)
}

fn read(log: &[u8]) -> (usize, Option<Document>) {
    let last = LastState::of(log);
    (
        last.states,
        last.version(Path::new(LOG), &Budget::default()).unwrap().map(|version| version.document),
    )
}

fn disk() -> Arc<dyn Fs> {
    Arc::new(Disk)
}

#[test]
fn every_kind_of_layer_comes_back() {
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    let document = everything(64);
    journal.record(&document).unwrap();
    let (states, back) = read(&fs.file(LOG).unwrap());
    assert_eq!(states, 1);
    assert_same(&document, &back.unwrap());
}

#[test]
fn smooth_paint_comes_back_in_16_bits() {
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    let document = smoothly_painted();
    journal.record(&document).unwrap();
    let back = read(&fs.file(LOG).unwrap()).1.unwrap();
    assert_same(&document, &back);
    assert_eq!(tiles16(&back), tiles16(&document));
}

/// A line of so many readings of the pen.
fn draw_stroke(count: usize) -> Arc<crate::paint::Stroke> {
    use crate::paint::{Brush, Sample, Stroke};
    let one = |i: usize| {
        let t = i as f32 / 240.0;
        let at = crate::math::vec2(24.0 + 18.0 * t.sin(), 20.0 + 15.0 * (0.3 * t).cos());
        Sample { pressure: 0.5 + 0.4 * t.sin(), time_secs: t, ..Sample::at(at) }.normalized()
    };
    Arc::new(Stroke::new(
        Brush::default(),
        Default::default(),
        Color::BLACK,
        (0..count).map(one).collect(),
    ))
}

#[test]
fn strokes_of_an_hour_come_back_and_take_little() {
    use crate::document::{Live, StrokeList};
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    let strokes = vec![draw_stroke(400_000), draw_stroke(20), draw_stroke(500_000)];
    let layer = Layer::new("Ink", Content::Strokes(Live::new(StrokeList { strokes })));
    let document = Document { layers: vec![Arc::new(layer)], ..Document::empty(Size::new(48, 40)) };
    journal.record(&document).unwrap();
    let log = fs.file(LOG).unwrap();
    assert!(log.len() < 900_000 * 14, "{} bytes", log.len());
    assert_eq!(document.difference(&read(&log).1.unwrap()), None);
}

#[test]
fn selections_come_back_with_the_strokes_in_them_and_selecting_writes_no_stroke_again() {
    use crate::document::{Live, StrokeList};
    use crate::paint::{Selection, StrokeSelection};
    use crate::raster::CoverageGrid;
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    let square = |x0| Selection::new(CoverageGrid::full(crate::math::Rect::new(x0, 3, 40, 30)));
    let empty = Document::empty(Size::new(48, 40)).with_selection(Some(square(5)));
    let own = empty.stroke_selection().map(|own| own.moved(crate::math::vec2(1.5, 0.0)));
    let other = StrokeSelection::new(Arc::new(square(20)));
    let strokes = vec![
        Arc::new(draw_stroke(9).selecting(own)),
        Arc::new(draw_stroke(50_000).selecting(Some(other))),
        draw_stroke(7),
    ];
    let layer = Layer::new("Ink", Content::Strokes(Live::new(StrokeList { strokes })));
    let document = Document { layers: vec![Arc::new(layer)], ..empty };
    journal.record(&document).unwrap();
    let whole = fs.file(LOG).unwrap().len();
    assert_eq!(document.difference(&read(&fs.file(LOG).unwrap()).1.unwrap()), None);
    // The places of the others in the list change; their blobs do not.
    let next = document.with_kept_selection("a").unwrap().with_selection(Some(square(9)));
    journal.record(&next).unwrap();
    let log = fs.file(LOG).unwrap();
    assert!((log.len() - whole) * 10 < whole, "{} of {whole}", log.len() - whole);
    assert_eq!(next.difference(&read(&log).1.unwrap()), None);
}

#[test]
fn what_is_selected_of_a_part_comes_back_though_the_part_is_made_of_paint() {
    use crate::document::parts::{Inflation, OutlineSource, Part, PartKind};
    use crate::paint::Selection;
    use crate::surface::region::{RegionKind, SurfaceRegion};
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let tiles = TileGrid::from_straight_rgba(&[[9, 90, 9, 255]; 40 * 40].concat(), 40, 40, 5, 5);
    let ink = PixelLayer { file: String::new(), x: 0, y: 0, tiles };
    let layers = vec![Arc::new(Layer::new("Ink", Content::Pixels(ink)))];
    let outline = OutlineSource::Layer { layer: "Ink".into(), color: None };
    let inflation = Inflation::default();
    let part = Part::new("part-1", PartKind::Inflate { outline, inflation });
    let document = Document { layers, ..Document::empty(Size::new(50, 50)) };
    let document = document.with_parts(vec![Arc::new(part)]);
    let region = SurfaceRegion::new(RegionKind::Depth, crate::math::vec2(25.0, 25.0));
    let selection = Selection::of_region(region, &document.scene());
    assert!(!selection.is_empty());
    let document = document.with_selection(Some(selection));
    journal(&fs).record(&document).unwrap();
    let log = fs.file(LOG).unwrap();
    let back =
        super::sessions::read(Path::new(LOG), &log, &Budget::default(), &Progress::default());
    let back = back.unwrap().unwrap().version.document;
    assert_eq!(document.difference(&back), None);
}

#[test]
fn a_log_of_an_older_version_with_a_number_a_value_opens() {
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    journal.record(&everything(64)).unwrap();
    let rows: Vec<[f32; 3]> = (0..200_000).map(|i| [i as f32 / 8.0, 7.0, 0.5]).collect();
    let mut log = fs.file(LOG).unwrap();
    let blob = serde_json::json!({ "color": "#102030", "samples": rows }).to_string();
    assert!(super::log::push(
        &mut log,
        super::log::RecordKind::Blob,
        &[&99_999u64.to_le_bytes(), blob.as_bytes()]
    ));
    let state = serde_json::json!({
        "document": { "canvas": { "width": 8, "height": 8 }, "layers": [{ "kind": "strokes", "strokes": [99_999] }] },
        "files": {},
    });
    assert!(super::log::push(
        &mut log,
        super::log::RecordKind::State,
        &[state.to_string().as_bytes()]
    ));
    let back = read(&log).1.unwrap();
    assert_eq!(back.strokes(back.layers[0].id)[0].samples().len(), 200_000);
}

#[test]
fn an_edit_adds_what_it_changed_and_no_more() {
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    let document = everything(64);
    journal.record(&document).unwrap();
    let whole = fs.file(LOG).unwrap().len();
    let id = document.layer_named("ground").unwrap().id;
    let edited =
        document.with_layer(id, |layer| layer.content = Content::Fill(Color::WHITE)).unwrap();
    journal.record(&edited).unwrap();
    let log = fs.file(LOG).unwrap();
    assert!((log.len() - whole) * 3 < whole, "{} of {whole}", log.len() - whole);
    assert_same(&edited, &read(&log).1.unwrap());
}

#[test]
fn a_log_cut_anywhere_loses_the_last_edit_at_most() {
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    let versions: Vec<Document> = (1..5).map(dotted_drawing).collect();
    // How long the log was after each version.
    let mut ends = Vec::new();
    for version in &versions {
        journal.record(version).unwrap();
        ends.push(fs.file(LOG).unwrap().len());
    }
    let log = fs.file(LOG).unwrap();
    for end in 0..=log.len() {
        let whole = ends.iter().filter(|&&e| e <= end).count();
        let (states, back) = read(&log[..end]);
        assert_eq!(states, whole, "cut at {end}");
        match whole {
            0 => assert!(back.is_none()),
            n if ends.contains(&end) => assert_same(&versions[n - 1], &back.unwrap()),
            _ => assert!(back.is_some()),
        }
    }
}

#[test]
fn a_log_with_any_bit_flipped_gives_a_version_that_was() {
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    let pictures: Vec<Vec<u8>> = (1..4)
        .map(|i| {
            journal.record(&dotted_drawing(i)).unwrap();
            pixels_of(&dotted_drawing(i))
        })
        .collect();
    let log = fs.file(LOG).unwrap();
    let mut least = usize::MAX;
    for bit in 0..log.len() * 8 {
        let mut broken = log.clone();
        broken[bit / 8] ^= 1 << (bit % 8);
        let (states, back) = read(&broken);
        least = least.min(states);
        if let Some(back) = back {
            assert!(pixels_of(&back) == pictures[states - 1], "bit {bit}");
        }
    }
    assert_eq!(least, 0, "the first record's bits count");
}

fn pixels_of(document: &Document) -> Vec<u8> {
    let Content::Pixels(pixels) = &document.layers[0].content else { panic!("pixels") };
    pixels.tiles.to_straight_rgba(document.size.rect())
}

#[test]
fn a_log_that_has_grown_is_written_anew() {
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    journal.least_compacted = 1000;
    let mut longest = 0;
    for i in 1..60 {
        journal.record(&dotted_drawing(i)).unwrap();
        longest = longest.max(fs.file(LOG).unwrap().len());
    }
    let (states, back) = read(&fs.file(LOG).unwrap());
    assert!(states < 59 && longest < 60_000, "{states} versions, {longest} bytes");
    assert!(pixels_of(&back.unwrap()) == pixels_of(&dotted_drawing(59)));
    assert_eq!(fs.names(), [LOG, "/r/other"]);
}

/// Every operation of three records fails with every error, once and for ever: what was recorded
/// before stays.
#[test]
fn a_failing_disk_costs_at_most_what_could_not_be_written() {
    let run = |fs: &MemoryFs| {
        let mut journal = journal(fs);
        journal.least_compacted = 2000;
        (1..12)
            .filter(|&i| journal.record(&dotted_drawing(i)).and_then(|()| journal.sync()).is_ok())
            .last()
    };
    let whole = MemoryFs::with(&[("/r/other", b"")]);
    assert_eq!(run(&whole), Some(11));
    for at in 0..whole.operations() {
        for error in
            [28, 5, 30, 13, 24].map(InjectedError::Code).into_iter().chain([InjectedError::Short])
        {
            for sticky in [false, true] {
                let fs = MemoryFs::with(&[("/r/other", b"")]);
                fs.fail(InjectedFailure { at, error, sticky });
                let last = run(&fs);
                fs.heal();
                let back = fs.file(LOG).and_then(|log| read(&log).1);
                let what = format!("operation {at}, {error:?}, sticky {sticky}");
                // The last one itself may have been the one that failed.
                assert!(sticky || last >= Some(10), "{what}: it goes on after one failure");
                if let Some(last) = last {
                    let found =
                        pixels_of(&back.unwrap_or_else(|| panic!("{what}: nothing is left")));
                    assert!((last..12).any(|i| found == pixels_of(&dotted_drawing(i))), "{what}");
                }
            }
        }
    }
}

#[test]
fn a_power_cut_takes_nothing_that_was_flushed() {
    let fs = MemoryFs::with(&[("/r/other", b"")]);
    let mut journal = journal(&fs);
    journal.record(&dotted_drawing(1)).unwrap();
    journal.record(&dotted_drawing(2)).unwrap();
    journal.sync().unwrap();
    fs.record();
    journal.record(&dotted_drawing(3)).unwrap();
    for moment in fs.moments() {
        for luck in moment.lucks(1 << 10) {
            let (states, back) = read(&moment.after_power_cut(luck).file(LOG).unwrap());
            assert!(states >= 2 && pixels_of(&back.unwrap()) == pixels_of(&dotted_drawing(states)));
        }
    }
}

#[test]
fn sessions_that_live_are_left_alone_and_those_that_died_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let start = |i, title| {
        RecoveryLog::start(disk(), folder.path(), &dotted_drawing(i), title, None).unwrap()
    };
    let (first, second) = (start(1, "one"), start(2, "two"));
    assert!(sessions(&disk(), folder.path()).is_empty(), "both live");
    assert!(second.wait_until_written(Duration::from_secs(60)));
    second.record(&dotted_drawing(5));
    drop(first);
    drop(second);
    let mut left = sessions(&disk(), folder.path());
    let titles: Vec<&str> = left.iter().map(|session| session.title.as_str()).collect();
    assert_eq!(titles, ["one", "two"]);
    assert!(sessions(&disk(), folder.path()).is_empty(), "another window holds them");
    let recovered = left[1].recover(&Budget::default(), &Progress::default()).unwrap().unwrap();
    assert!(
        recovered.versions == 2
            && pixels_of(&recovered.version.document) == pixels_of(&dotted_drawing(5))
    );
    drop(left);
    for session in sessions(&disk(), folder.path()) {
        session.discard().unwrap();
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_closed_session_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let recovery = RecoveryLog::start(
        disk(),
        folder.path(),
        &dotted_drawing(3),
        "one",
        Some(Path::new("/a.ora")),
    )
    .unwrap();
    recovery.flush();
    assert_eq!(recovery.trouble(), None);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    recovery.close().unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_session_that_failed_once_says_so_and_garbage_keeps_nobody_from_starting() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in [("a.log", &b"garbage"[..]), ("b.log", b""), ("c.log", &[0xff; 5000])] {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let mut left = sessions(&disk(), folder.path());
    assert_eq!(left.len(), 3);
    assert!(left.iter_mut().all(|session| !session.has_failed
        && session.recover(&Budget::default(), &Progress::default()).is_err()));
    drop(left);
    let again = sessions(&disk(), folder.path());
    assert!(again.iter().all(|session| session.has_failed), "they are opened by hand only");
    assert!(folder.path().join("c.log").exists(), "nothing is deleted unasked");
    assert!(sessions(&disk(), Path::new("/no/such/folder")).is_empty());
}

/// Processes are recognized by the locks they hold, not by their ids, which are reused.
#[test]
fn a_process_number_that_came_again_hides_nothing() {
    let folder = tempfile::tempdir().unwrap();
    drop(RecoveryLog::start(disk(), folder.path(), &dotted_drawing(3), "one", None).unwrap());
    let paths = std::fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.path());
    let log = paths
        .into_iter()
        .find(|path| path.extension().is_some_and(|extension| extension == "log"))
        .unwrap();
    // The test can fail: a check of the process id in the name finds a live process and hides the
    // drawing.
    let number = log.file_name().unwrap().to_string_lossy().split('-').nth(1).unwrap().to_owned();
    assert_eq!(number, std::process::id().to_string());
    assert_eq!(sessions(&disk(), folder.path()).len(), 1);
}
