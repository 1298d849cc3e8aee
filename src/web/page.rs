//! What the page is told. Floor 8. Its scripts in `dist/web` say what they do with each.

use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// The pointer looks like this, by the name that style sheets have for it.
    #[wasm_bindgen(js_namespace = host, js_name = setCursor)]
    pub fn set_cursor(name: &str);

    /// The page has this title.
    #[wasm_bindgen(js_namespace = host, js_name = setTitle)]
    pub fn set_title(title: &str);

    /// Opens an address in another tab.
    #[wasm_bindgen(js_namespace = host, js_name = openAddress)]
    pub fn open_address(address: &str);

    /// A text is edited at this place, in px of style sheets; so a keyboard on the screen is wanted.
    #[wasm_bindgen(js_namespace = host, js_name = editText)]
    pub fn edit_text(x: f32, y: f32, width: f32, height: f32);

    /// No text is edited.
    #[wasm_bindgen(js_namespace = host, js_name = endText)]
    pub fn end_text();

    /// Something went wrong that no message of the window tells.
    #[wasm_bindgen(js_namespace = console)]
    pub fn error(sentence: &str);
}
