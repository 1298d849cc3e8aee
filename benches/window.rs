//! From the event to the pixel, in the real window on a display of its own: an anchor of a photo on
//! a map of 3840 × 2160 dragged; a brush and a pan on it and on a project of ten layers of 4096 ×
//! 4096; a gloss brush on ten layers of 2048 × 2048 over a dome. Milliseconds from the pointer's
//! motion until the screen changes there, or for the brush until it is dark beneath the pen.
//!
//! `cargo bench --bench window`. Needs Xvfb and xdotool, and says so if they are missing. A program
//! that draws with a graphics card is quicker: Xvfb draws with the processor and shares it with the
//! painting. The aim: a median of 33 ms and at most 100.

#[cfg(any(not(unix), target_os = "macos"))]
fn main() {
    println!("skipped: there is no X server for it on this system");
}

#[cfg(all(unix, not(target_os = "macos")))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    x11::run()
}

#[cfg(all(unix, not(target_os = "macos")))]
mod x11 {
    use image::RgbImage;
    use rilievo::document::PixelLayer;
    use rilievo::math::vec3;
    use rilievo::raster::Plane;
    use rilievo::{Content, Document, Layer, Maps, Progress, Size, Surface, TileGrid};
    use rilievo_engine::math::hash;
    use rilievo_io::project;
    use std::path::{Path, PathBuf};
    use std::process::{Child, Command, Stdio};
    use std::sync::Arc;
    use std::thread::sleep;
    use std::time::{Duration, Instant};
    use x11rb::connection::Connection;
    use x11rb::protocol::xproto::{ConnectionExt, ImageFormat};
    use x11rb::rust_connection::RustConnection;

    type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

    const SCREEN: (i32, i32) = (1920, 1080);
    /// An event with no visible answer within this time counts as lost.
    const LOST: Duration = Duration::from_secs(3);
    /// Lines that are painted.
    const LINES: i32 = 4;
    /// Side of the squares that are watched.
    const SIDE: i32 = 48;

    pub fn run() -> Result<()> {
        for tool in ["Xvfb", "xdotool"] {
            if Command::new("which")
                .arg(tool)
                .stdout(Stdio::null())
                .status()
                .map_or(true, |status| !status.success())
            {
                println!("skipped: {tool} is not installed");
                return Ok(());
            }
        }
        let folder = tempfile::tempdir()?;
        println!(
            "{:<44} {:>8} {:>8} {:>8}",
            "ms from the event to the pixel", "middle", "9 of 10", "slowest"
        );
        let map = photo_on_a_map(folder.path())?;
        let project = ten_layers(&folder.path().join("layers.ora"), 4096, None)?;
        let dome = Some(dome(2048)?.into());
        let dome = ten_layers(&folder.path().join("dome.ora"), 2048, dome)?;
        let mut stage = Stage::new(&map, folder.path())?;
        stage.drag_anchor("3840 × 2160")?;
        stage.paint_and_look("3840 × 2160")?;
        drop(stage);
        Stage::new(&project, folder.path())?.paint_and_look("ten layers of 4096²")?;
        Stage::new(&dome, folder.path())?.paint_gloss("ten layers of 2048²")
    }

    /// Pale, so that black paint is seen anywhere.
    fn pale(x: u32, y: u32, channel: u32) -> u8 {
        140 + (hash::mix(x / 20 + 7919 * (y / 20) + 31 * channel) % 110) as u8
    }

    /// A photo bent by the normals of a wavy map.
    fn photo_on_a_map(folder: &Path) -> Result<PathBuf> {
        let normal = |x: u32, y: u32| {
            let (x, y) = (x as f32, y as f32);
            let n =
                [0.5 * (x * 0.01).sin() + 0.2 * (y * 0.023).sin(), 0.5 * (y * 0.012).cos(), 1.0];
            let length = n.iter().map(|v| v * v).sum::<f32>().sqrt();
            image::Rgb(n.map(|v| ((v / length * 0.5 + 0.5) * 255.0).round() as u8))
        };
        RgbImage::from_fn(3840, 2160, normal).save(folder.join("normal.png"))?;
        let photo = RgbImage::from_fn(1800, 1200, |x, y| {
            image::Rgb([0, 1, 2].map(|channel| pale(x, y, channel)))
        });
        photo.save(folder.join("photo.png"))?;
        let document = serde_json::json!({
            "format": "rilievo", "version": 1,
            "surface": { "normal": { "file": "normal.png", "convention": "opengl" } },
            "layers": [
                { "name": "Ground", "kind": "fill", "color": "#e0d8c8", "clip_to_surface": false },
                { "name": "Photo", "kind": "image", "source": { "file": "photo.png" }, "placement": { "scale": 2 },
                  "operator": { "kind": "normal", "alpha": 1 },
                  "anchors": [{ "at": [1920, 1080], "source": [900, 600] }] },
            ],
        });
        let file = folder.join("map.json");
        std::fs::write(&file, document.to_string())?;
        Ok(file)
    }

    /// Normals lean outward, each differently, so that a bent dab is seen once.
    fn dome(side: u32) -> Result<Surface> {
        let size = Size::new(side, side);
        let from_middle = |v: usize| 1.6 * (v as f32 / side as f32 - 0.5);
        let normal = |x: usize, y: usize| {
            let (x, y) = (from_middle(x), -from_middle(y));
            vec3(0.8 * x, 0.8 * y, (1.0 - 0.64 * (x * x + y * y)).max(0.01).sqrt())
        };
        Ok(Surface::new(Maps {
            normals: Plane::from_fn(size, normal),
            depth: Plane::from_fn(size, |x, y| {
                0.2 + 0.5 * (from_middle(x).powi(2) + from_middle(y).powi(2))
            }),
            coverage: Plane::full(size, 255),
        })?)
    }

    fn ten_layers(file: &Path, side: u32, surface: Option<Arc<Surface>>) -> Result<PathBuf> {
        let layer = |i: u32| {
            let alpha = |x: u32, y: u32| {
                if i == 0 { 255 } else { hash::mix(x / 256 + 61 * (y / 256) + i) as u8 / 2 }
            };
            let pixel = |x: u32, y: u32| {
                [pale(x + i, y, 0), pale(x, y + i, 1), pale(x, y, 2 + i), alpha(x, y)]
            };
            let rgba: Vec<u8> =
                (0..side).flat_map(|y| (0..side).flat_map(move |x| pixel(x, y))).collect();
            let tiles = TileGrid::from_straight_rgba(&rgba, side as usize, side as usize, 0, 0);
            Layer::new(
                format!("{i}"),
                Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }),
            )
            .into()
        };
        let document = Document {
            layers: (0..10).map(layer).collect(),
            surface,
            ..Document::empty(Size::new(side, side))
        };
        let bytes = project::write(file, &document, &Progress::default())?.ok_or("canceled")?;
        std::fs::write(file, bytes)?;
        Ok(file.to_path_buf())
    }

    /// A program that ends with it.
    struct Running(Child);

    impl Drop for Running {
        fn drop(&mut self) {
            let _ = self.0.kill();
            let _ = self.0.wait();
        }
    }

    /// The window on its display, and where the canvas lies in it.
    struct Stage {
        // The window ends before the display does.
        _window: Running,
        _server: Running,
        display: String,
        connection: RustConnection,
        root: u32,
        middle: (i32, i32),
    }

    impl Stage {
        fn new(file: &Path, folder: &Path) -> Result<Self> {
            // A folder for each window, so that this one is not offered what the last one left when
            // it was killed.
            let folder = folder.join(file.file_stem().unwrap_or_default());
            let number = (90..)
                .find(|n| !Path::new(&format!("/tmp/.X{n}-lock")).exists())
                .ok_or("no display is free")?;
            let display = format!(":{number}");
            let mut server = Command::new("Xvfb");
            server.arg(&display).args(["-screen", "0", &format!("{}x{}x24", SCREEN.0, SCREEN.1)]);
            let server = server
                .args(["-ac", "-noreset", "+extension", "GLX"])
                .stderr(Stdio::null())
                .spawn()?;
            let server = Running(server);
            sleep(Duration::from_secs(1));
            let mut window = Command::new(env!("CARGO_BIN_EXE_rilievo"));
            window
                .arg(file)
                .env("DISPLAY", &display)
                .env_remove("WAYLAND_DISPLAY")
                .env_remove("DBUS_SESSION_BUS_ADDRESS");
            window
                .env("XDG_CONFIG_HOME", folder.join("config"))
                .env("XDG_STATE_HOME", folder.join("state"));
            let window = Running(window.stdout(Stdio::null()).stderr(Stdio::null()).spawn()?);
            let (connection, screen) = x11rb::connect(Some(&display))?;
            let root = connection.setup().roots[screen].root;
            let mut stage = Self {
                _window: window,
                _server: server,
                display,
                connection,
                root,
                middle: (0, 0),
            };
            stage.until(Duration::from_secs(60), |stage| {
                Ok(stage.pixels(0, 0, 200, 20)?.iter().any(|&v| v > 40))
            })?;
            let (width, height) = (SCREEN.0.to_string(), SCREEN.1.to_string());
            let search = [
                "search",
                "--name",
                "Rilievo",
                "windowmove",
                "0",
                "0",
                "windowsize",
                &width,
                &height,
            ];
            stage.xdotool(&[&search[..], &["windowfocus"]].concat())?;
            stage.wait_until_still()?;
            stage.middle = stage.middle_of_canvas()?;
            Ok(stage)
        }

        /// BGRX of a part of the screen.
        fn pixels(&self, x: i32, y: i32, width: i32, height: i32) -> Result<Vec<u8>> {
            let (format, root) = (ImageFormat::Z_PIXMAP, self.root);
            let (x, y, width, height) = (x as i16, y as i16, width as u16, height as u16);
            Ok(self.connection.get_image(format, root, x, y, width, height, !0)?.reply()?.data)
        }

        fn move_to(&self, x: i32, y: i32) -> Result<()> {
            self.connection.warp_pointer(0u32, self.root, 0, 0, 0, 0, x as i16, y as i16)?;
            Ok(self.connection.flush()?)
        }

        fn xdotool(&self, words: &[&str]) -> Result<()> {
            Command::new("xdotool").args(words).env("DISPLAY", &self.display).status()?;
            Ok(())
        }

        /// How long it takes until something is so, ms.
        fn until(
            &self,
            most: Duration,
            mut is_so: impl FnMut(&Self) -> Result<bool>,
        ) -> Result<Option<f32>> {
            let begun = Instant::now();
            while begun.elapsed() < most {
                if is_so(self)? {
                    return Ok(Some(begun.elapsed().as_secs_f32() * 1000.0));
                }
                sleep(Duration::from_micros(500));
            }
            Ok(None)
        }

        /// Waits until nothing moves for a while.
        fn wait_until_still(&self) -> Result<()> {
            let (mut last, mut since) = (Vec::new(), Instant::now());
            self.until(Duration::from_secs(120), |stage| {
                sleep(Duration::from_millis(100));
                let now = stage.pixels(0, 0, SCREEN.0, SCREEN.1)?;
                if now != last {
                    (last, since) = (now, Instant::now());
                }
                Ok(since.elapsed() > Duration::from_millis(1500))
            })?;
            Ok(())
        }

        /// The middle of the area that is pale compared with the window's own colors.
        fn middle_of_canvas(&self) -> Result<(i32, i32)> {
            let all = self.pixels(0, 0, SCREEN.0, SCREEN.1)?;
            let is_pale = |x: i32, y: i32| {
                all[((y * SCREEN.0 + x) * 4) as usize..][..3].iter().all(|&v| v > 130)
            };
            let inside =
                (120..SCREEN.1 - 50).flat_map(|y| (60..SCREEN.0 - 280).map(move |x| (x, y)));
            let pale: Vec<(i32, i32)> = inside.filter(|&(x, y)| is_pale(x, y)).collect();
            let middle = |of: fn(&(i32, i32)) -> i32| {
                let (low, high) = (pale.iter().map(of).min(), pale.iter().map(of).max());
                low.zip(high).map(|(low, high)| (low + high) / 2)
            };
            Ok(middle(|at| at.0).zip(middle(|at| at.1)).ok_or("no canvas is seen")?)
        }

        /// Moves along a path with a button down, and watches a square next to the middle.
        fn drag(
            &self,
            what: &str,
            button: &str,
            step: (i32, i32),
            beside: (i32, i32),
        ) -> Result<()> {
            let (x, y) = self.middle;
            let (seen_x, seen_y) = (x + beside.0, y + beside.1);
            self.move_to(x, y)?;
            sleep(Duration::from_millis(300));
            self.xdotool(&["mousedown", button])?;
            let mut took = Vec::new();
            for i in 1..40 {
                let before = self.pixels(seen_x, seen_y, SIDE, SIDE)?;
                self.move_to(x + step.0 * (i % 20), y + step.1 * (i % 20))?;
                took.push(self.until(LOST, |stage| {
                    Ok(stage.pixels(seen_x, seen_y, SIDE, SIDE)? != before)
                })?);
                pause(i);
            }
            self.xdotool(&["mouseup", button])?;
            told(what, took);
            self.wait_until_still()
        }

        fn drag_anchor(&mut self, of: &str) -> Result<()> {
            self.xdotool(&["key", "a"])?;
            sleep(Duration::from_millis(500));
            self.drag(&format!("an anchor, {of}"), "1", (6, 3), (200, 150))
        }

        fn paint_and_look(&mut self, of: &str) -> Result<()> {
            self.xdotool(&["key", "b"])?;
            self.wait_until_still()?;
            self.paint(&format!("a brush, the whole of {of}"), 12)?;
            self.undo_lines()?;
            self.xdotool(&["key", "1"])?;
            self.wait_until_still()?;
            self.paint(&format!("a brush, a part of {of}"), 50)?;
            self.drag(&format!("a pan over {of}"), "2", (12, 7), (100, 100))
        }

        /// A gloss brush, three steps larger than at first: 138 px.
        fn paint_gloss(&mut self, of: &str) -> Result<()> {
            self.xdotool(&["key", "b", "F3", "bracketright", "bracketright", "bracketright"])?;
            self.wait_until_still()?;
            self.paint(&format!("a gloss brush, all of {of}"), 40)?;
            self.undo_lines()?;
            self.xdotool(&["key", "1"])?;
            self.wait_until_still()?;
            self.paint(&format!("a gloss brush, a part of {of}"), 80)
        }

        /// Where lines were painted, no dab is seen.
        fn undo_lines(&self) -> Result<()> {
            self.xdotool(&[&["key"][..], &["ctrl+z"; LINES as usize]].concat())
        }

        /// Lines; `step` px between two motions, more than a radius.
        fn paint(&self, what: &str, step: i32) -> Result<()> {
            let mut took = Vec::new();
            for line in 0..LINES {
                let (left, y) = (self.middle.0 - 300, self.middle.1 - 150 + 90 * line);
                self.move_to(left, y)?;
                sleep(Duration::from_millis(200));
                self.xdotool(&["mousedown", "1"])?;
                sleep(Duration::from_millis(200));
                for i in 1..=(600 / step).min(24) {
                    // Next to the middle, where the pointer's own dot is.
                    let x = left + i * step;
                    let light =
                        |stage: &Self| stage.pixels(x - 4, y - 4, 3, 3).map(|seen| mean(&seen));
                    let before = light(self)?;
                    self.move_to(x, y)?;
                    took.push(self.until(LOST, |stage| Ok(light(stage)? < before - 40.0))?);
                    pause(i);
                }
                self.xdotool(&["mouseup", "1"])?;
                sleep(Duration::from_millis(400));
            }
            told(what, took);
            self.wait_until_still()
        }
    }

    /// Between two events, in no step with the frames.
    fn pause(i: i32) {
        sleep(Duration::from_millis(8 + (i * 7 % 17) as u64));
    }

    fn mean(bgrx: &[u8]) -> f32 {
        let sum: f32 = bgrx
            .chunks_exact(4)
            .map(|p| p[..3].iter().map(|&v| f32::from(v)).sum::<f32>() / 3.0)
            .sum();
        sum / (bgrx.len() / 4).max(1) as f32
    }

    fn told(what: &str, took: Vec<Option<f32>>) {
        let mut ms: Vec<f32> = took.iter().flatten().copied().collect();
        ms.sort_by(f32::total_cmp);
        let Some(&slowest) = ms.last() else { return println!("{what:<44} nothing was seen") };
        let (middle, most) = (ms[ms.len() / 2], ms[ms.len() * 9 / 10]);
        let lost: Vec<String> =
            (0..took.len()).filter(|i| took[*i].is_none()).map(|i| i.to_string()).collect();
        let note = match lost.len() {
            0 => String::new(),
            count => format!("   {count} of {} not seen: {}", took.len(), lost.join(" ")),
        };
        println!("{what:<44} {middle:>8.1} {most:>8.1} {slowest:>8.1}{note}");
    }
}
