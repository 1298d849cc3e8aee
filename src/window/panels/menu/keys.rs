//! The menus by keyboard: which menu of the bar opens, by Alt, its letter, and the arrows left and
//! right. Floor 7. Not here: the arrows up and down, submenus, Enter and Escape, which are the
//! toolkit's.

use crate::commands::MENUS;
use crate::keymap::{KeyTarget, Keymap};
use crate::language::tr;
use eframe::egui::containers::menu::{MenuState, SubMenu};
use eframe::egui::{
    Context, Event, FocusDirection, Id, Key, KeyboardShortcut, Modifiers, Popup, Response, Ui,
};

/// A press of Alt is short if it lasts no longer.
const TAP_SECS: f64 = 0.4;

/// The menus of the bar and what the keys ask of them.
#[derive(Default)]
pub struct MenuKeys {
    /// The buttons of the bar as shown last, and the menu of each.
    shown: Vec<(Id, Id)>,
    /// The menu that is to be opened.
    wanted: Option<usize>,
    /// Since when Alt is held, if nothing else happened meanwhile.
    alt_since: Option<f64>,
}

impl MenuKeys {
    /// Opens the first menu.
    pub fn open(&mut self) {
        self.wanted = Some(0);
    }

    /// Before the bar is shown: what the keys of this frame ask.
    ///
    /// * `by_alt`: whether Alt opens menus.
    pub fn listen(&mut self, ui: &Ui, by_alt: bool) {
        let ctx = ui.ctx();
        let open = self.shown.iter().position(|(_, menu)| Popup::is_id_open(ctx, *menu));
        let is_tap = self.is_alt_tapped(ctx);
        if is_tap && by_alt && open.is_none() && !ctx.text_edit_focused() {
            self.open();
        }
        match open {
            Some(open) => self.go_beside(ctx, open),
            // A menu that was left by other means leaves the keys to the canvas.
            None if self.wanted.is_none() => {
                let focused = ctx.memory(|memory| memory.focused());
                let is_of_bar = |(button, _): &&(Id, Id)| Some(*button) == focused;
                if let Some((button, _)) = self.shown.iter().find(is_of_bar) {
                    ctx.memory_mut(|memory| memory.surrender_focus(*button));
                }
            }
            None => {}
        }
        self.shown.clear();
    }

    /// After a button of the bar was shown.
    pub fn show(&mut self, button: &Response) {
        let menu = Popup::default_response_id(button);
        if self.wanted == Some(self.shown.len()) {
            self.wanted = None;
            Popup::open_id(&button.ctx, menu);
            button.request_focus();
            button.ctx.request_repaint();
        }
        self.shown.push((button.id, menu));
    }

    /// Alt was pressed and released, shortly and alone.
    fn is_alt_tapped(&mut self, ctx: &Context) -> bool {
        let is_other = |event: &Event| {
            !matches!(event, Event::ModifiersChanged(_))
                && !matches!(event, Event::Key { pressed: false, .. })
        };
        // As they came: a key that was used is no longer among the events.
        let (held, now_secs, is_disturbed) = ctx.input(|input| {
            let is_disturbed = input.raw.events.iter().any(is_other) || input.pointer.any_down();
            (input.modifiers, input.time, is_disturbed)
        });
        if is_disturbed {
            self.alt_since = held.alt.then_some(f64::NEG_INFINITY);
            return false;
        }
        match self.alt_since {
            None if held == Modifiers::ALT => self.alt_since = Some(now_secs),
            Some(_) if held.alt && held != Modifiers::ALT => {
                self.alt_since = Some(f64::NEG_INFINITY)
            }
            Some(since) if !held.alt => {
                self.alt_since = None;
                return now_secs - since < TAP_SECS;
            }
            _ => {}
        }
        false
    }

    /// Opens the menu whose first letter is pressed with Alt, unless that key has another use.
    pub fn hear_letter(&mut self, ctx: &Context, keymap: &Keymap) {
        // On macOS, Alt and a letter type characters.
        if cfg!(target_os = "macos") || ctx.egui_wants_keyboard_input() {
            return;
        }
        for (index, (title, _)) in MENUS.iter().enumerate() {
            let Some(key) = tr(title).get(..1).and_then(Key::from_name) else { continue };
            let is_pressed =
                ctx.input(|input| input.modifiers == Modifiers::ALT && input.key_pressed(key));
            let keys = KeyboardShortcut::new(Modifiers::ALT, key);
            let has_use = |keyed: KeyTarget| keymap.of(keyed).contains(&keys);
            if is_pressed && !KeyTarget::all().any(has_use) {
                ctx.input_mut(|input| input.consume_key(Modifiers::ALT, key));
                self.wanted = Some(index);
            }
        }
    }

    /// The arrows left and right go to the menu beside the open one, unless they are a submenu's.
    fn go_beside(&mut self, ctx: &Context, open: usize) {
        let (left, right) = ctx
            .input(|input| (input.key_pressed(Key::ArrowLeft), input.key_pressed(Key::ArrowRight)));
        if left == right {
            return;
        }
        let (button, menu) = self.shown[open];
        let focused = ctx.memory(|memory| memory.focused());
        let layer = focused.and_then(|id| ctx.read_response(id)).map(|found| found.layer_id.id);
        let is_of_menu = layer == Some(menu);
        let opens = right && is_of_menu && focused.is_some_and(|id| has_submenu(ctx, id));
        if opens || !(is_of_menu || focused.is_none_or(|id| id == button)) {
            return;
        }
        ctx.memory_mut(|memory| memory.move_focus(FocusDirection::None));
        let all = self.shown.len();
        self.wanted = Some(if left { (open + all - 1) % all } else { (open + 1) % all });
    }
}

/// Whether an entry of a menu opens another menu.
fn has_submenu(ctx: &Context, entry: Id) -> bool {
    let state = SubMenu::id_from_widget_id(entry).with(MenuState::ID);
    ctx.data(|data| data.get_temp::<MenuState>(state).is_some())
}
