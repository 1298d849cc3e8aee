//! A disk that forgets a bit of everything that is written.

use super::*;
use crate::fs::{EntryKind, Identity};
use std::io::Read;

#[test]
fn a_disk_that_gives_back_other_bytes_is_caught_before_anything_is_replaced() {
    /// Forgets a bit of everything that is written.
    struct CorruptingFs(MemoryFs);
    struct CorruptingHandle(Box<dyn FileHandle>);
    impl Read for CorruptingHandle {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.0.read(buffer)
        }
    }

    impl Write for CorruptingHandle {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let mut wrong = bytes.to_vec();
            wrong[5] ^= 4;
            self.0.write(&wrong)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl FileHandle for CorruptingHandle {
        fn sync(&mut self) -> io::Result<()> {
            self.0.sync()
        }

        fn hold(&mut self) -> io::Result<bool> {
            self.0.hold()
        }
    }

    impl Fs for CorruptingFs {
        fn create_new(&self, path: &Path) -> io::Result<Box<dyn FileHandle>> {
            Ok(Box::new(CorruptingHandle(self.0.create_new(path)?)))
        }

        fn open(&self, path: &Path) -> io::Result<Box<dyn FileHandle>> {
            self.0.open(path)
        }

        fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
            self.0.rename(from, to)
        }

        fn link(&self, from: &Path, to: &Path) -> io::Result<()> {
            self.0.link(from, to)
        }

        fn remove(&self, path: &Path) -> io::Result<()> {
            self.0.remove(path)
        }

        fn sync_dir(&self, folder: &Path) -> io::Result<()> {
            self.0.sync_dir(folder)
        }

        fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
            self.0.resolve(path)
        }

        fn find(&self, path: &Path) -> io::Result<Option<EntryKind>> {
            self.0.find(path)
        }

        fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
            self.0.list(folder)
        }

        fn create_folder(&self, folder: &Path) -> io::Result<()> {
            self.0.create_folder(folder)
        }

        fn copy_ownership(&self, from: &Path, to: &Path) -> io::Result<()> {
            self.0.copy_ownership(from, to)
        }

        fn is_same_owner(&self, one: &Path, other: &Path) -> io::Result<bool> {
            self.0.is_same_owner(one, other)
        }

        fn identity(&self, path: &Path) -> io::Result<Option<Identity>> {
            self.0.identity(path)
        }

        fn is_read_only(&self, path: &Path) -> io::Result<bool> {
            self.0.is_read_only(path)
        }

        fn token(&self) -> u64 {
            self.0.token()
        }

        fn lock(&self, path: &Path) -> io::Result<Option<Box<dyn crate::fs::FileLock>>> {
            self.0.lock(path)
        }

        fn pause(&self, _: Duration) {}
    }
    let fs = disk();
    let said = replace(
        &CorruptingFs(fs.clone()),
        Path::new(FILE),
        NEW,
        &this().into(),
        &Progress::default(),
    )
    .unwrap_err();
    assert!(said.to_string().contains("different bytes"), "{said}");
    assert_eq!((fs.file(FILE).unwrap(), fs.names().len()), (OLD.to_vec(), 2));
    // The proof can fail: the same without reading back reports nothing, and the drawing is broken.
    let careless = CorruptingFs(disk());
    let mut handle = careless.create_new(Path::new("/d/part")).unwrap();
    handle.write_all(NEW).and_then(|()| handle.sync()).unwrap();
    careless.rename(Path::new("/d/part"), Path::new(FILE)).unwrap();
    assert_ne!(careless.0.file(FILE).unwrap(), NEW);
}
