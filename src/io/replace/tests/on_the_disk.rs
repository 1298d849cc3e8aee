//! What a disk in memory cannot show: links, permissions, owners, open files, long paths, and two
//! programs at once.

use super::*;
use crate::fs::Disk;
use std::fs;
#[cfg(unix)]
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown, symlink};

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn put(file: &Path, bytes: &[u8], terms: impl Into<Terms>) -> Result<bool> {
    replace(&Disk, file, bytes, &terms.into(), &Progress::default())
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .flatten()
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_its_file_keeps_its_permissions() {
    let folder = folder();
    let (file, link) = (folder.path().join("real.ora"), folder.path().join("link.ora"));
    fs::write(&file, OLD).unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
    symlink("real.ora", &link).unwrap();
    put(&link, NEW, this()).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&file).unwrap(), NEW);
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o600);
    assert_eq!(fs::read(folder.path().join("real.ora~")).unwrap(), OLD);
}

#[cfg(unix)]
#[test]
fn links_that_lead_nowhere_are_refused() {
    let folder = folder();
    let link = folder.path().join("link.ora");
    symlink("nowhere", &link).unwrap();
    for keeps_previous in [false, true] {
        let terms = Terms { over: Overwrite::Forced, keeps_previous, reads: Vec::new() };
        let said = put(&link, NEW, terms).unwrap_err().to_string();
        assert!(said.contains("broken link"), "{said}");
    }
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
}

#[test]
fn folders_and_files_in_no_folder_are_refused() {
    let folder = folder();
    for keeps_previous in [false, true] {
        let terms = Terms { over: Overwrite::Forced, keeps_previous, reads: Vec::new() };
        let said = put(folder.path(), NEW, terms).unwrap_err().to_string();
        assert!(said.contains("is a folder"), "{said}");
    }
    let lost = folder.path().join("no/such/a.ora");
    let said = put(&lost, NEW, Overwrite::Nothing).unwrap_err().to_string();
    assert!(said.contains("its folder cannot be reached"), "{said}");
}

#[test]
fn a_source_is_known_behind_links_and_under_a_second_name() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("photo.png"), OLD).unwrap();
    fs::hard_link(at("photo.png"), at("hard.png")).unwrap();
    let roundabout =
        folder.path().join("..").join(folder.path().file_name().unwrap()).join("photo.png");
    let mut names = vec![at("photo.png"), at("hard.png"), roundabout];
    #[cfg(unix)]
    {
        symlink("photo.png", at("soft.png")).unwrap();
        names.push(at("soft.png"));
    }
    if cfg!(windows) {
        names.push(at("PHOTO.PNG"));
    }
    for file in names {
        let said = put(&file, NEW, Terms::export(Overwrite::Forced, vec![at("photo.png")]))
            .unwrap_err()
            .to_string();
        assert!(said.contains("made from it"), "{}: {said}", file.display());
    }
    assert_eq!(fs::read(at("photo.png")).unwrap(), OLD);
}

fn set_read_only(file: &Path, is_read_only: bool) {
    let mut rights = fs::metadata(file).unwrap().permissions();
    #[allow(clippy::permissions_set_readonly_false)] // In a folder of the test's own.
    rights.set_readonly(is_read_only);
    fs::set_permissions(file, rights).unwrap();
}

#[test]
fn a_file_set_read_only_stays_as_it_is_and_so_when_it_is_replaced() {
    let folder = folder();
    let file = folder.path().join("a.png");
    fs::write(&file, OLD).unwrap();
    set_read_only(&file, true);
    let rights = fs::metadata(&file).unwrap().permissions();
    let said =
        put(&file, NEW, Terms::export(Overwrite::Anything, Vec::new())).unwrap_err().to_string();
    assert!(said.contains("read-only"), "{said}");
    put(&file, NEW, Terms::export(Overwrite::Forced, Vec::new())).unwrap();
    assert_eq!(fs::metadata(&file).unwrap().permissions(), rights);
    assert_eq!(
        (fs::read(&file).unwrap(), names(folder.path())),
        (NEW.to_vec(), vec!["a.png".to_owned()])
    );
    set_read_only(&file, false); // Windows removes no folder with such a file.
}

#[test]
fn a_read_only_project_is_saved_by_force_again_and_again() {
    let folder = folder();
    let file = folder.path().join("a.ora");
    fs::write(&file, OLD).unwrap();
    for round in 0..3u8 {
        set_read_only(&file, true);
        if let Err(error) = put(&file, &[round; 9], Overwrite::Forced) {
            panic!("round {round}: {error}");
        }
        assert!(fs::metadata(&file).unwrap().permissions().readonly());
    }
    assert_eq!((fs::read(&file).unwrap(), names(folder.path()).len()), (vec![2; 9], 2));
    for name in names(folder.path()) {
        set_read_only(&folder.path().join(name), false);
    }
}

/// 260 characters are where Windows stops unless a path is written in its long form.
#[test]
fn a_path_of_many_folders_is_saved_again_and_again() {
    let folder = folder();
    let deep = (0..12).fold(folder.path().to_owned(), |path, i| {
        path.join(format!("folder number {i} with a long name"))
    });
    fs::create_dir_all(&deep).unwrap();
    let file = deep.join("a.ora");
    assert!(file.as_os_str().len() > 400);
    for round in 0..4u8 {
        if let Err(error) = put(&file, &[round; 9], Overwrite::Anything) {
            panic!("round {round}: {error}");
        }
    }
    assert_eq!((fs::read(&file).unwrap(), names(&deep).len()), (vec![3; 9], 2));
}

#[test]
fn a_file_that_is_being_read_is_replaced() {
    let folder = folder();
    let file = folder.path().join("a.png");
    fs::write(&file, OLD).unwrap();
    let reader = fs::File::open(&file).unwrap();
    put(&file, NEW, Terms::export(Overwrite::Forced, Vec::new())).unwrap();
    drop(reader);
    assert_eq!((fs::read(&file).unwrap(), names(folder.path()).len()), (NEW.to_vec(), 1));
}

/// A save reads back what it holds.
#[test]
fn a_held_file_is_read_by_all_and_held_by_one() {
    let folder = folder();
    let file = folder.path().join("a.part");
    let mut ours = Disk.create_new(&file).unwrap();
    assert!(ours.hold().unwrap());
    ours.write_all(NEW).unwrap();
    let mut theirs = Disk.open(&file).unwrap();
    let mut found = Vec::new();
    theirs.read_to_end(&mut found).unwrap();
    assert_eq!(found, NEW);
    assert!(!theirs.hold().unwrap());
    assert!(Disk.lock(&file).unwrap().is_none());
    drop(ours);
    assert!(theirs.hold().unwrap());
}

/// As by a program that shows it and lets nobody else replace it.
#[cfg(windows)]
#[test]
fn a_file_that_another_program_holds_stays_as_it_is() {
    use std::os::windows::fs::OpenOptionsExt;
    const READING: u32 = 1;
    for keeps_previous in [false, true] {
        let folder = folder();
        let file = folder.path().join("a.ora");
        fs::write(&file, OLD).unwrap();
        let holder = fs::OpenOptions::new().read(true).share_mode(READING).open(&file).unwrap();
        let terms = Terms { over: Overwrite::Forced, keeps_previous, reads: Vec::new() };
        let said = put(&file, NEW, terms.clone()).unwrap_err().to_string();
        assert!(said.contains("a.ora"), "{said}");
        assert_eq!(fs::read(&file).unwrap(), OLD, "{said}");
        assert_eq!(names(folder.path()), ["a.ora"], "{said}");
        drop(holder);
        put(&file, NEW, terms).unwrap();
        assert_eq!(fs::read(&file).unwrap(), NEW);
    }
}

#[test]
fn a_name_of_255_bytes_is_saved_again_and_again() {
    let folder = folder();
    let file = folder.path().join(format!("{}.ora", "n".repeat(251)));
    for round in 0..4u8 {
        if let Err(error) = put(&file, &[round; 9], Overwrite::Anything) {
            panic!("round {round}: {error}");
        }
    }
    assert_eq!((fs::read(&file).unwrap(), names(folder.path()).len()), (vec![3; 9], 2));
}

/// Root saves for somebody else, as with `sudo`.
#[cfg(unix)]
#[test]
fn what_root_saves_stays_its_owners() {
    const NOBODY: u32 = 65_534;
    let folder = folder();
    let file = folder.path().join("a.ora");
    fs::write(&file, OLD).unwrap();
    if chown(&file, Some(NOBODY), Some(NOBODY)).is_err() {
        return eprintln!("skipped: only root gives files away");
    }
    put(&file, NEW, Overwrite::Anything).unwrap();
    let found = fs::metadata(&file).unwrap();
    assert_eq!((found.uid(), found.gid()), (NOBODY, NOBODY));
}

#[test]
fn of_many_that_make_the_same_new_file_at_once_one_does() {
    let folder = folder();
    for round in 0..40 {
        let file = folder.path().join(format!("{round}.png"));
        let made: Vec<u8> = std::thread::scope(|scope| {
            let file = &file;
            let threads =
                (0..4u8).map(|i| scope.spawn(move || (i, put(file, &[i; 50], Overwrite::Nothing))));
            let threads: Vec<_> = threads.collect();
            let done = threads.into_iter().map(|thread| thread.join().unwrap());
            done.filter_map(|(i, result)| match result {
                Ok(is_done) => is_done.then_some(i),
                Err(error) => {
                    assert!(error.to_string().contains("already"), "{error}");
                    None
                }
            })
            .collect()
        });
        assert_eq!(made.len(), 1, "round {round}");
        assert_eq!(fs::read(&file).unwrap(), [made[0]; 50]);
    }
    assert_eq!(names(folder.path()).len(), 40);
}

#[test]
fn saves_and_exports_in_one_folder_do_not_hurt_each_other() {
    let folder = folder();
    let (ora, png) = (folder.path().join("a.ora"), folder.path().join("a.png"));
    std::thread::scope(|scope| {
        for (file, terms) in
            [(&ora, Overwrite::Forced.into()), (&png, Terms::export(Overwrite::Forced, Vec::new()))]
        {
            scope.spawn(move || {
                (0..100u8).for_each(|i| assert!(put(file, &[i; 3000], terms.clone()).unwrap()))
            });
        }
    });
    assert_eq!(names(folder.path()), ["a.ora", "a.ora~", "a.png"]);
}
