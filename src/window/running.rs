//! One window for each user and display: files that another start of the program names open in the
//! window that runs already. Floor 7.
//!
//! The window listens on a port of this machine alone. The port and a secret word stand in a file that
//! the next start reads, with those of other windows that run. It sends one line,
//! `{"word": WORD, "open": [FILES]}`, to the newest, which answers `taken`; where no window does so, it
//! opens one of its own. Starts take turns, so that of several at once the first opens the window.

use crate::io::fs::{Disk, FileLock, Fs};
use crate::io::platform;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Result, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

/// A window that does not answer within this time is taken for gone.
const PATIENCE: Duration = Duration::from_secs(2);
/// After a start that could not be understood.
const PAUSE: Duration = Duration::from_millis(100);
/// Another start that has not opened its window within this time is not waited for.
const LONGEST_TURN: Duration = Duration::from_secs(10);
/// Between two looks at whether another start is done.
const LOOK: Duration = Duration::from_millis(20);
/// The longest line that is read, bytes: some thousand paths.
const LONGEST_LINE: u64 = 1 << 20;
const ANSWER: &str = "taken\n";

/// The file by which running windows are found: `rilievo/window.json` in the user's folder for what
/// programs keep; `None` if the system has none.
pub fn place() -> Option<PathBuf> {
    Some(platform::state_folder()?.join("rilievo").join("window.json"))
}

/// While it lives, other starts of the program wait, if the disk knows locks.
pub struct Turn(
    #[expect(dead_code, reason = "held until it is dropped")] Option<Box<dyn FileLock>>,
);

impl Turn {
    /// Waits until no other start is looking for a running window or opening one.
    pub fn wait(place: &Path) -> Self {
        if let Some(folder) = place.parent() {
            // Where that fails, the lock does.
            let _ = std::fs::create_dir_all(folder);
        }
        let (lock, since) = (place.with_extension("lock"), Instant::now());
        while since.elapsed() < LONGEST_TURN {
            match Disk.lock(&lock) {
                Ok(Some(held)) => return Self(Some(held)),
                Ok(None) => std::thread::sleep(LOOK),
                Err(_) => break,
            }
        }
        Self(None)
    }
}

/// Where a window listens.
#[derive(Clone, PartialEq)]
struct Address {
    port: u16,
    word: String,
    /// The display that the window is on: nobody looks for a window on another one.
    display: String,
}

impl Address {
    /// Those of all windows, the newest last; none if the file cannot be read.
    fn read_all(place: &Path) -> Vec<Self> {
        let value: Option<Value> =
            std::fs::read(place).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
        let values = value.as_ref().and_then(Value::as_array);
        values.into_iter().flatten().filter_map(Self::of).collect()
    }

    fn of(value: &Value) -> Option<Self> {
        let text = |key: &str| value[key].as_str().map(str::to_owned);
        let port = u16::try_from(value["port"].as_u64()?).ok()?;
        Some(Self { port, word: text("word")?, display: text("display")? })
    }

    fn to_json(&self) -> Value {
        let Self { port, word, display } = self;
        json!({ "port": port, "word": word, "display": display })
    }

    fn write_all(addresses: &[Self], place: &Path) -> Result<()> {
        if let Some(folder) = place.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let values: Vec<Value> = addresses.iter().map(Self::to_json).collect();
        platform::write_private(place, format!("{}\n", json!(values)).as_bytes())
    }

    /// Removes those for which the condition does not hold.
    fn retain(place: &Path, condition: impl Fn(&Self) -> bool) {
        let mut addresses = Self::read_all(place);
        let count = addresses.len();
        addresses.retain(condition);
        // If one is still there, nobody answers at its port.
        let _ = match addresses.len() {
            0 => std::fs::remove_file(place),
            left if left < count => Self::write_all(&addresses, place),
            _ => Ok(()),
        };
    }
}

/// The display that a window of this process would be on.
fn display() -> String {
    let names = ["WAYLAND_DISPLAY", "DISPLAY"];
    names.map(|name| platform::environment_variable(name).unwrap_or_default()).join(" ")
}

/// Asks the newest running window to open some files and to come in front; false if there is none, or
/// none can. Those that do not answer are not asked again.
pub fn try_hand_over(place: &Path, files: &[PathBuf]) -> bool {
    let display = display();
    let addresses = Address::read_all(place);
    let near = addresses.iter().rev().filter(|address| address.display == display);
    let mut gone = Vec::new();
    let mut is_taken = false;
    for address in near {
        match send(address, files) {
            Ok(true) => {
                is_taken = true;
                break;
            }
            Ok(false) => {}
            Err(_) => gone.push(address.clone()),
        }
    }
    if !gone.is_empty() {
        Address::retain(place, |address| !gone.contains(address));
    }
    is_taken
}

fn send(address: &Address, files: &[PathBuf]) -> Result<bool> {
    let Some(files) = files.iter().map(|file| file.to_str()).collect::<Option<Vec<_>>>() else {
        return Ok(false);
    };
    let to = (Ipv4Addr::LOCALHOST, address.port).into();
    let mut stream = TcpStream::connect_timeout(&to, PATIENCE)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let_come_in_front();
    let line = json!({ "word": address.word, "open": files });
    stream.write_all(format!("{line}\n").as_bytes())?;
    let mut answer = String::new();
    BufReader::new(stream.take(ANSWER.len() as u64)).read_line(&mut answer)?;
    Ok(answer == ANSWER)
}

/// Lets another program's window come in front. Windows allows it only to the program that the user
/// has just started, and to those that it lets.
#[cfg(windows)]
fn let_come_in_front() {
    use windows_sys::Win32::UI::WindowsAndMessaging::{ASFW_ANY, AllowSetForegroundWindow};
    // SAFETY: it takes a number and nothing else. If it fails, the taskbar shows the window's wish.
    unsafe { AllowSetForegroundWindow(ASFW_ANY) };
}

#[cfg(not(windows))]
fn let_come_in_front() {}

/// Listens for other starts of the program, for as long as it lives.
pub struct RunningWindow {
    place: PathBuf,
    address: Address,
}

impl RunningWindow {
    /// Fails where no port is free or the file cannot be written; then every start opens a window of
    /// its own.
    ///
    /// * `files`: receives those that other starts name.
    /// * `wake`: is called when files have come.
    pub fn listen(
        place: PathBuf,
        files: Sender<Vec<PathBuf>>,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let port = listener.local_addr()?.port();
        let word = format!("{:016x}{:016x}", Disk.token(), Disk.token());
        let address = Address { port, word: word.clone(), display: display() };
        let mut addresses = Address::read_all(&place);
        addresses.push(address.clone());
        Address::write_all(&addresses, &place)?;
        // It ends with the process.
        std::thread::spawn(move || {
            for stream in listener.incoming() {
                match stream.and_then(|stream| take(stream, &word, &files)) {
                    Ok(true) => wake(),
                    Ok(false) => {}
                    // What the system cannot accept now it may accept soon.
                    Err(_) => std::thread::sleep(PAUSE),
                }
            }
        });
        Ok(Self { place, address })
    }
}

/// Reads what one start asks for; false if it does not know the word.
fn take(mut stream: TcpStream, word: &str, files: &Sender<Vec<PathBuf>>) -> Result<bool> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut line = String::new();
    BufReader::new(stream.try_clone()?.take(LONGEST_LINE)).read_line(&mut line)?;
    let value: Value = serde_json::from_str(&line)?;
    let named = value["open"].as_array().filter(|_| value["word"] == word);
    let named = named.and_then(|names| {
        names.iter().map(|name| name.as_str().map(PathBuf::from)).collect::<Option<Vec<_>>>()
    });
    let is_taken = named.is_some_and(|named| files.send(named).is_ok());
    if is_taken {
        stream.write_all(ANSWER.as_bytes())?;
    }
    Ok(is_taken)
}

/// The next start does not ask this window.
impl Drop for RunningWindow {
    fn drop(&mut self) {
        let _turn = Turn::wait(&self.place);
        Address::retain(&self.place, |address| *address != self.address);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::{Receiver, channel};

    /// `None`, aloud, where the machine has no network of its own, as in some sandboxes.
    fn listen(place: &Path) -> Option<(RunningWindow, Receiver<Vec<PathBuf>>)> {
        let (files, received) = channel();
        let running = RunningWindow::listen(place.to_path_buf(), files, || ()).unwrap();
        let port = running.address.port;
        let is_heard = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_ok();
        if !is_heard {
            eprintln!("skipped: nothing can be reached at 127.0.0.1");
        }
        is_heard.then_some((running, received))
    }

    #[test]
    fn files_of_another_start_come_to_the_running_window() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("state").join("window.json");
        let files = [folder.path().join("a b.png"), folder.path().join("日本").join("Müller.ora")];
        assert!(!try_hand_over(&place, &files), "none runs");
        let Some((running, received)) = listen(&place) else { return };
        assert!(try_hand_over(&place, &files) && try_hand_over(&place, &[]));
        assert_eq!(received.recv().unwrap(), files);
        assert_eq!(received.recv().unwrap(), [] as [PathBuf; 0], "it only comes in front");
        drop(running);
        assert!(!try_hand_over(&place, &files), "it is closed");
    }

    #[test]
    fn the_newest_window_is_asked_and_the_one_before_when_it_is_closed() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("window.json");
        let (Some((first, older)), Some((second, newer))) = (listen(&place), listen(&place)) else {
            return;
        };
        let (a, b) = (PathBuf::from("/a.png"), PathBuf::from("/b.png"));
        assert!(try_hand_over(&place, std::slice::from_ref(&a)));
        assert_eq!((newer.recv().unwrap(), older.try_recv().ok()), (vec![a], None));
        drop(second);
        assert!(try_hand_over(&place, std::slice::from_ref(&b)));
        assert_eq!(older.recv().unwrap(), [b]);
        drop(first);
        assert!(!place.exists());
    }

    #[test]
    fn a_killed_window_is_asked_once() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("window.json");
        let Some((running, received)) = listen(&place) else { return };
        let port =
            TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port();
        let killed = Address { port, word: "killed".into(), display: display() };
        let both = [running.address.clone(), killed];
        Address::write_all(&both, &place).unwrap();
        assert!(try_hand_over(&place, &[]));
        assert!(received.recv().unwrap().is_empty());
        assert!(Address::read_all(&place) == both[..1]);
    }

    /// A file manager starts the program once for each of the files that it opens.
    #[test]
    fn of_several_starts_at_once_one_opens_a_window() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("state").join("window.json");
        if listen(&place).is_none() {
            return;
        }
        let (files, received) = channel();
        let start = |i: usize| {
            let turn = Turn::wait(&place);
            let file = PathBuf::from(format!("/{i}.png"));
            let opened = (!try_hand_over(&place, &[file])).then(|| {
                std::thread::sleep(LOOK);
                RunningWindow::listen(place.clone(), files.clone(), || ()).unwrap()
            });
            drop(turn);
            opened
        };
        let opened: Vec<RunningWindow> = std::thread::scope(|scope| {
            let starts: Vec<_> = (0..5).map(|i| scope.spawn(move || start(i))).collect();
            starts.into_iter().filter_map(|start| start.join().unwrap()).collect()
        });
        assert_eq!((opened.len(), received.try_iter().count()), (1, 4));
    }

    #[test]
    fn whoever_does_not_know_the_word_or_is_on_another_display_opens_a_window_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("window.json");
        let Some((running, received)) = listen(&place) else { return };
        let Address { port, word, display } = running.address.clone();
        let guess = Address { port, word: "guess".into(), display: display.clone() };
        assert!(!send(&guess, &[PathBuf::from("/a.png")]).is_ok_and(|is_taken| is_taken));
        let elsewhere = Address { port, word, display: ":77".into() };
        Address::write_all(std::slice::from_ref(&elsewhere), &place).unwrap();
        assert!(!try_hand_over(&place, &[PathBuf::from("/a.png")]));
        assert!(received.try_recv().is_err());
        drop(running);
        assert!(Address::read_all(&place) == [elsewhere], "it is another's file now");
        for broken in ["", "{}", "[1", "[2]", r#"[{"port":99999999,"word":"a","display":""}]"#] {
            std::fs::write(&place, broken).unwrap();
            assert!(!try_hand_over(&place, &[]), "{broken}");
        }
    }

    #[test]
    fn nonsense_at_the_port_does_not_end_it() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("window.json");
        let Some((running, received)) = listen(&place) else { return };
        for nonsense in ["", "\n", "GET / HTTP/1.1\r\n\r\n", "{\"open\":[\"/a\"]}\n"] {
            let mut stream =
                TcpStream::connect((Ipv4Addr::LOCALHOST, running.address.port)).unwrap();
            stream.write_all(nonsense.as_bytes()).unwrap();
        }
        assert!(try_hand_over(&place, &[PathBuf::from("/a.png")]));
        assert_eq!(received.recv().unwrap(), [PathBuf::from("/a.png")]);
    }
}
