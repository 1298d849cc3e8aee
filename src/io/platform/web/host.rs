//! Messages to the page. Floor 5. The page's script says what it does with each
//! (`dist/web/worker.js`).

use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// Starts one more worker, which calls [`run_tasks`](super::run_tasks).
    #[wasm_bindgen(js_namespace = host, js_name = startThread)]
    pub fn start_thread();

    /// Stores bytes in a file, from a byte of it on; what followed is gone.
    #[wasm_bindgen(js_namespace = host)]
    pub fn store(path: &str, from: f64, bytes: &[u8]);

    /// Gives a stored file another name, in place of what had it.
    #[wasm_bindgen(js_namespace = host)]
    pub fn rename(from: &str, to: &str);

    /// Removes a stored file.
    #[wasm_bindgen(js_namespace = host)]
    pub fn remove(path: &str);

    /// Hands a finished file to the user.
    #[wasm_bindgen(js_namespace = host, js_name = handOut)]
    pub fn hand_out(path: &str, bytes: &[u8]);

    /// Asks the page something; the answer has the same number.
    #[wasm_bindgen(js_namespace = host)]
    pub fn ask(number: u32, question: &str, details: &str, bytes: &[u8]);

    /// The locale of the browser.
    #[wasm_bindgen(js_namespace = host)]
    pub fn locale() -> String;

    /// The page's number.
    #[wasm_bindgen(js_namespace = host, js_name = pageId)]
    pub fn page_id() -> u32;
}
