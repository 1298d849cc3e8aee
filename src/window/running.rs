//! One window for each user and display: files that another start of the program names open in the
//! window that runs already. Floor 7.
//!
//! The window listens on a port of this machine alone. The port and a secret word stand in a file that
//! the next start reads. That sends one line, `{"word": WORD, "open": [FILES]}`, and is answered
//! `taken`; whatever else happens, it opens a window of its own.

use crate::io::fs::{Disk, Fs};
use crate::io::platform;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Result, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// A window that does not answer within this time is taken for gone.
const PATIENCE: Duration = Duration::from_secs(2);
/// After a start that could not be understood.
const PAUSE: Duration = Duration::from_millis(100);
/// The longest line that is read, bytes: some thousand paths.
const LONGEST_LINE: u64 = 1 << 20;
const ANSWER: &str = "taken\n";

/// The file by which the running window is found: `rilievo/window.json` in the user's folder for what
/// programs keep; `None` if the system has none.
pub fn place() -> Option<PathBuf> {
    Some(platform::state_folder()?.join("rilievo").join("window.json"))
}

/// Where a window listens.
#[derive(PartialEq)]
struct Address {
    port: u16,
    word: String,
    /// The display that the window is on: nobody looks for a window on another one.
    display: String,
}

impl Address {
    fn read(place: &Path) -> Option<Self> {
        let value: Value = serde_json::from_slice(&std::fs::read(place).ok()?).ok()?;
        let text = |key: &str| value[key].as_str().map(str::to_owned);
        let port = u16::try_from(value["port"].as_u64()?).ok()?;
        Some(Self { port, word: text("word")?, display: text("display")? })
    }

    fn write(&self, place: &Path) -> Result<()> {
        if let Some(folder) = place.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let Self { port, word, display } = self;
        let text = format!("{}\n", json!({ "port": port, "word": word, "display": display }));
        platform::write_private(place, text.as_bytes())
    }
}

/// The display that a window of this process would be on.
fn display() -> String {
    let names = ["WAYLAND_DISPLAY", "DISPLAY"];
    names.map(|name| platform::environment_variable(name).unwrap_or_default()).join(" ")
}

/// Asks the running window to open some files and to come in front; false if there is none, or if it
/// cannot.
pub fn try_hand_over(place: &Path, files: &[PathBuf]) -> bool {
    let address = Address::read(place).filter(|address| address.display == display());
    address.is_some_and(|address| send(&address, files).is_ok_and(|is_taken| is_taken))
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
    /// * `wake`: is called when files have come.
    pub fn listen(
        place: PathBuf,
        wake: impl Fn() + Send + 'static,
    ) -> Result<(Self, Receiver<Vec<PathBuf>>)> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let port = listener.local_addr()?.port();
        let word = format!("{:016x}{:016x}", Disk.token(), Disk.token());
        let address = Address { port, word: word.clone(), display: display() };
        address.write(&place)?;
        let (files, received) = channel();
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
        Ok((Self { place, address }, received))
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

/// The next start opens a window of its own.
impl Drop for RunningWindow {
    fn drop(&mut self) {
        if Address::read(&self.place).is_some_and(|address| address == self.address) {
            // If it is still there, nobody answers at its port.
            let _ = std::fs::remove_file(&self.place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `None`, aloud, where the machine has no network of its own, as in some sandboxes.
    fn listen(place: &Path) -> Option<(RunningWindow, Receiver<Vec<PathBuf>>)> {
        let listening = RunningWindow::listen(place.to_path_buf(), || ()).unwrap();
        let port = listening.0.address.port;
        let is_heard = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_ok();
        if !is_heard {
            eprintln!("skipped: nothing can be reached at 127.0.0.1");
        }
        is_heard.then_some(listening)
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
    fn the_last_window_is_found_and_the_one_before_does_not_remove_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("window.json");
        let (Some((first, _)), Some((_second, received))) = (listen(&place), listen(&place)) else {
            return;
        };
        drop(first);
        assert!(try_hand_over(&place, &[PathBuf::from("/a.png")]));
        assert_eq!(received.recv().unwrap(), [PathBuf::from("/a.png")]);
    }

    #[test]
    fn whoever_does_not_know_the_word_or_is_on_another_display_opens_a_window_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("window.json");
        let Some((running, received)) = listen(&place) else { return };
        let Address { port, word, display } = Address::read(&place).unwrap();
        let guess = Address { port, word: "guess".into(), display: display.clone() };
        assert!(!send(&guess, &[PathBuf::from("/a.png")]).is_ok_and(|is_taken| is_taken));
        Address { port, word, display: ":77".into() }.write(&place).unwrap();
        assert!(!try_hand_over(&place, &[PathBuf::from("/a.png")]));
        assert!(received.try_recv().is_err());
        for broken in ["", "{}", "[1", r#"{"port":99999999,"word":"a","display":""}"#] {
            std::fs::write(&place, broken).unwrap();
            assert!(!try_hand_over(&place, &[]), "{broken}");
        }
        drop(running);
        assert!(place.exists(), "it is another's file now");
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
