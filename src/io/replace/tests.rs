use super::*;
use crate::fs::memory::{InjectedError, InjectedFailure, MemoryFs};

const FILE: &str = "/d/a.ora";
const KEPT: &str = "/d/a.ora~";
const OLD: &[u8] = b"the old drawing";
/// Longer, so that many lengths of it may arrive.
const NEW: &[u8] = &[b'n'; 300];

fn on(fs: &MemoryFs, terms: &Terms) -> Result<bool> {
    replace(fs, Path::new(FILE), NEW, terms, &Progress::default())
}

fn save_on(fs: &MemoryFs, over: Overwrite) -> Result<bool> {
    on(fs, &over.into())
}

fn this() -> Overwrite {
    Overwrite::This(FileStamp::of(OLD))
}

fn disk() -> MemoryFs {
    MemoryFs::with(&[(FILE, OLD), (KEPT, b"older still")])
}

#[test]
fn the_new_file_stands_in_the_old_ones_place_and_the_old_one_is_kept() {
    for over in [this(), Overwrite::Anything, Overwrite::Forced] {
        let fs = disk();
        assert!(save_on(&fs, over).unwrap());
        assert_eq!((fs.file(FILE).unwrap(), fs.file(KEPT).unwrap()), (NEW.to_vec(), OLD.to_vec()));
        assert_eq!(fs.names(), [FILE, KEPT], "nothing else is left");
    }
}

#[test]
fn a_file_that_is_not_what_was_opened_is_not_replaced() {
    let fs = MemoryFs::with(&[(FILE, b"somebody else's")]);
    for (over, part) in [(this(), "another program changed it"), (Overwrite::Nothing, "already")] {
        let said = save_on(&fs, over).unwrap_err();
        assert!(matches!(said, Error::Changed { .. }) && said.to_string().contains(part), "{said}");
        assert_eq!(fs.file(FILE).unwrap(), b"somebody else's");
    }
    let gone = MemoryFs::with(&[("/d/other", b"")]);
    assert!(save_on(&gone, this()).unwrap(), "a file that is gone can be saved again");
}

#[test]
fn a_canceled_save_changes_nothing() {
    let fs = disk();
    let progress = Progress::default();
    progress.cancel();
    assert!(!replace(&fs, Path::new(FILE), NEW, &this().into(), &progress).unwrap());
    assert_eq!((fs.file(FILE).unwrap(), fs.names().len()), (OLD.to_vec(), 2));
}

/// The disk, what is written, and the previous version that is kept.
type Situation = (fn() -> MemoryFs, Terms, Option<&'static [u8]>);

/// The situations in which a disk fails or loses power: the existing files, how the new one is
/// written, and what is kept.
fn situations() -> Vec<Situation> {
    let older: Option<&[u8]> = Some(b"older still");
    vec![
        (disk, this().into(), Some(OLD)),
        (disk, Overwrite::Anything.into(), Some(OLD)),
        (disk_without_links, this().into(), Some(OLD)),
        (empty_disk, Overwrite::Nothing.into(), None),
        (disk, Terms::export(Overwrite::Forced, vec!["/d/photo.png".into()]), older),
        (disk, Terms::export(Overwrite::Anything, Vec::new()), older),
        (empty_disk, Terms::export(Overwrite::Nothing, vec!["/d/other".into()]), None),
    ]
}

fn empty_disk() -> MemoryFs {
    MemoryFs::with(&[("/d/other", b"")])
}

fn leftovers(fs: &MemoryFs) -> Vec<String> {
    fs.names().into_iter().filter(|name| name.contains(".rilievo-")).collect()
}

/// Every operation of a save or an export fails with every error, once and for ever.
#[test]
fn a_failing_disk_costs_neither_the_old_file_nor_a_panic() {
    const ENOSPC: i32 = 28;
    const EIO: i32 = 5;
    const EROFS: i32 = 30;
    const EACCES: i32 = 13;
    const EMFILE: i32 = 24;
    let codes = [ENOSPC, EIO, EROFS, EACCES, EMFILE].map(InjectedError::Code);
    let mut cases = 0;
    for (which, (made, terms, kept)) in situations().into_iter().enumerate() {
        let whole = made();
        assert!(on(&whole, &terms).unwrap());
        assert!(whole.operations() > 12, "{}", whole.operations());
        let old = made().file(FILE);
        for at in 0..whole.operations() {
            for (error, sticky) in codes
                .into_iter()
                .chain([InjectedError::Short])
                .flat_map(|e| [(e, false), (e, true)])
            {
                let fs = made();
                fs.fail(InjectedFailure { at, error, sticky });
                let result = on(&fs, &terms);
                fs.heal();
                let now = fs.file(FILE);
                let what = format!(
                    "situation {which}, operation {at}, {error:?}, sticky {sticky}: {result:?}"
                );
                match &result {
                    Ok(is_done) => {
                        assert!(*is_done && now.as_deref() == Some(NEW), "{what}");
                        assert_eq!(fs.file(KEPT).as_deref(), kept, "{what}");
                    }
                    // Only the folder's flush comes after the new file is in place.
                    Err(said) => {
                        let is_late =
                            now.as_deref() == Some(NEW) && said.to_string().contains("power cut");
                        assert!(now == old || is_late, "{what}");
                        // After a single failure the previous version is back.
                        let is_as_before = fs.file(KEPT) == made().file(KEPT);
                        assert!(sticky || is_late || is_as_before, "{what}: {:?}", fs.file(KEPT));
                        assert!(said.to_string().contains(FILE), "{what}");
                        // If only one operation fails, the unfinished file is removed.
                        assert!(
                            sticky || leftovers(&fs).is_empty(),
                            "{what}: {:?}",
                            leftovers(&fs)
                        );
                    }
                }
                cases += 1;
            }
        }
    }
    eprintln!("{cases} failures");
}

#[test]
fn a_file_held_for_a_moment_is_waited_for() {
    let whole = disk();
    save_on(&whole, this()).unwrap();
    const EBUSY: i32 = 16;
    let saved = (0..whole.operations()).filter(|&at| {
        let fs = disk();
        fs.fail(InjectedFailure { at, error: InjectedError::Code(EBUSY), sticky: false });
        save_on(&fs, this()).is_ok()
    });
    assert!(saved.count() >= 1, "the rename is tried again");
}

#[test]
fn where_files_cannot_have_two_names_the_old_one_is_copied() {
    let whole = disk();
    save_on(&whole, this()).unwrap();
    const EPERM: i32 = 1;
    let kept_by_copy = (0..whole.operations()).any(|at| {
        let fs = disk();
        fs.fail(InjectedFailure { at, error: InjectedError::Code(EPERM), sticky: false });
        save_on(&fs, this()).is_ok()
            && fs.operations() > whole.operations()
            && fs.file(KEPT).unwrap() == OLD
    });
    assert!(kept_by_copy);
}

/// Power cuts before every operation of a save, with every combination of what may be lost; the
/// number of states.
fn power_cuts(
    fs: MemoryFs,
    save: impl Fn(&MemoryFs) -> bool,
) -> std::result::Result<usize, String> {
    let is_new = fs.file(FILE).is_none();
    fs.record();
    let saved = save(&fs);
    let moments = fs.moments();
    let mut states = 0;
    for (i, moment) in moments.iter().enumerate() {
        for luck in moment.lucks(1 << 13) {
            let after = moment.after_power_cut(luck);
            states += 1;
            let now = after.file(FILE).or_else(|| is_new.then(|| OLD.to_vec()));
            let now =
                now.ok_or_else(|| format!("no file at all after operation {i}, luck {luck}"))?;
            if now != OLD && now != NEW {
                return Err(format!(
                    "neither old nor new after operation {i}, luck {luck}: {now:?}"
                ));
            }
            if saved && i == moments.len() - 1 && now != NEW {
                return Err(format!("“saved”, yet the old file is back (luck {luck})"));
            }
        }
    }
    Ok(states)
}

/// A disk that knows no second names, so that the old file is copied.
fn disk_without_links() -> MemoryFs {
    let fs = disk();
    fs.refuse_links();
    fs
}

#[test]
fn a_power_cut_leaves_the_old_file_or_the_new_one() {
    let swept =
        || MemoryFs::with(&[(FILE, OLD), ("/d/.rilievo-1-2.part", b"left by a killed save")]);
    let mut states = 0;
    for (made, terms, _) in situations().into_iter().chain([(
        swept as fn() -> MemoryFs,
        Overwrite::Anything.into(),
        None,
    )]) {
        states += power_cuts(made(), |fs| on(fs, &terms).is_ok()).unwrap();
    }
    eprintln!("{states} states after power cuts");
    assert!(states >= 20_000, "{states}");
}

/// The proof can fail: saving without any one of its steps is caught.
#[test]
fn the_power_cuts_catch_a_save_that_leaves_out_a_step() {
    let write = |fs: &MemoryFs, path: &str, sync: bool| {
        let mut handle = fs.create_new(Path::new(path)).unwrap();
        handle.write_all(NEW).unwrap();
        if sync {
            handle.sync().unwrap();
        }
    };
    let in_place = power_cuts(disk(), |fs| {
        fs.remove(Path::new(FILE)).unwrap();
        write(fs, FILE, true);
        fs.sync_dir(Path::new("/d")).is_ok()
    });
    assert!(in_place.is_err(), "writing in place");
    let unsynced = power_cuts(disk(), |fs| {
        write(fs, "/d/part", false);
        fs.rename(Path::new("/d/part"), Path::new(FILE)).unwrap();
        fs.sync_dir(Path::new("/d")).is_ok()
    });
    assert!(
        unsynced.unwrap_err().contains("neither old nor new"),
        "renaming without flushing the file"
    );
    let folder_unsynced = power_cuts(disk(), |fs| {
        write(fs, "/d/part", true);
        fs.rename(Path::new("/d/part"), Path::new(FILE)).is_ok()
    });
    assert!(
        folder_unsynced.unwrap_err().contains("the old file is back"),
        "without flushing the folder"
    );
}

#[test]
fn a_file_set_read_only_is_replaced_only_by_who_insists() {
    for over in [this(), Overwrite::Anything] {
        for keeps_previous in [false, true] {
            let fs = disk();
            fs.set_read_only(FILE);
            let terms = Terms { over, keeps_previous, reads: Vec::new() };
            let said = on(&fs, &terms).unwrap_err();
            assert!(
                matches!(said, Error::Changed { .. }) && said.to_string().contains("read-only"),
                "{said}"
            );
            assert_eq!((fs.file(FILE).unwrap(), fs.names().len()), (OLD.to_vec(), 2));
            assert!(on(&fs, &Terms { over: Overwrite::Forced, ..terms }).unwrap());
            assert_eq!(fs.file(FILE).unwrap(), NEW);
        }
    }
}

#[test]
fn what_the_document_is_made_from_is_never_replaced_whatever_its_name() {
    let fs = disk();
    fs.link(Path::new(FILE), Path::new("/d/second name")).unwrap();
    for read in [FILE, "/d/second name"] {
        let terms = Terms::export(Overwrite::Forced, vec!["/d/gone".into(), read.into()]);
        let said = on(&fs, &terms).unwrap_err().to_string();
        assert!(said.contains("made from it"), "{said}");
        assert!(check(&fs, Path::new(FILE), &terms).is_err());
    }
    assert_eq!(fs.file(FILE).unwrap(), OLD);
}

#[test]
fn a_failed_save_among_other_peoples_files_leaves_nothing_behind() {
    let fs = disk();
    fs.give_away(FILE);
    let said = save_on(&fs, Overwrite::Forced).unwrap_err().to_string();
    assert!(said.contains("could not be replaced"), "{said}");
    assert_eq!(
        (fs.file(FILE).unwrap(), fs.names()),
        (OLD.to_vec(), vec![FILE.to_owned(), KEPT.to_owned()])
    );
}

#[test]
fn a_failed_save_leaves_the_version_before_as_it_was() {
    for links in [true, false] {
        for before in [Some(b"older still".as_slice()), None] {
            let fs = disk();
            if before.is_none() {
                fs.remove(Path::new(KEPT)).unwrap();
            }
            if !links {
                fs.refuse_links();
            }
            fs.give_away(FILE);
            let names = fs.names();
            assert!(save_on(&fs, Overwrite::Forced).is_err());
            assert_eq!(fs.file(KEPT).as_deref(), before, "links: {links}");
            assert_eq!((fs.file(FILE).unwrap(), fs.names()), (OLD.to_vec(), names));
        }
    }
}

#[test]
fn a_save_after_one_that_failed_late_leaves_nothing_behind() {
    let fs = disk();
    // The failed one had kept the old file already, so that it has two names.
    fs.remove(Path::new(KEPT)).unwrap();
    fs.link(Path::new(FILE), Path::new(KEPT)).unwrap();
    assert!(save_on(&fs, this()).unwrap());
    assert_eq!(fs.names(), [FILE, KEPT]);
    assert_eq!((fs.file(FILE).unwrap(), fs.file(KEPT).unwrap()), (NEW.to_vec(), OLD.to_vec()));
}

#[test]
fn a_name_as_long_as_a_disk_allows_is_saved_again_and_again() {
    let name = format!("/d/{}.ora", "n".repeat(251));
    let fs = MemoryFs::with(&[(&name, OLD)]);
    let mut before = OLD.to_vec();
    for round in 0..3u8 {
        let bytes = vec![round; 40];
        assert!(
            replace(
                &fs,
                Path::new(&name),
                &bytes,
                &Overwrite::Anything.into(),
                &Progress::default()
            )
            .unwrap()
        );
        let kept: Vec<String> = fs.names().into_iter().filter(|name| name.ends_with('~')).collect();
        assert_eq!((fs.file(&name).unwrap(), kept.len()), (bytes.clone(), 1));
        assert_eq!(fs.file(&kept[0]).unwrap(), before);
        before = bytes;
    }
    assert_eq!(fs.names().len(), 2);
}

#[test]
fn a_save_leaves_alone_what_an_export_beside_it_is_writing() {
    let fs = disk();
    let export = PartFile::create(&fs, Path::new("/d")).unwrap();
    save_on(&fs, this()).unwrap();
    assert_eq!(leftovers(&fs), [export.path.display().to_string()]);
}

mod corrupting;
mod on_the_disk;
