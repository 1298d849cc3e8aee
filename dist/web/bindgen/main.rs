//! Makes the script that a page calls the program by, and the program without the descriptions that the
//! script is made of. `wasm-bindgen`'s own command does the same; this one has the version of `Cargo.lock`.
//!
//!     rilievo-web-bindgen PROGRAM.wasm FOLDER [names]
//!
//! With the third word functions keep their names, which a profiler shows: a quarter more to load.

use std::process::ExitCode;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (program, folder, keeps_names) = match arguments.as_slice() {
        [program, folder] => (program, folder, false),
        [program, folder, names] if names == "names" => (program, folder, true),
        _ => {
            eprintln!("usage: rilievo-web-bindgen PROGRAM.wasm FOLDER [names]");
            return ExitCode::FAILURE;
        }
    };
    let mut bindgen = Bindgen::new();
    bindgen.input_path(program).out_name("rilievo").typescript(false);
    bindgen.remove_name_section(!keeps_names).remove_producers_section(true);
    match bindgen.web(true).and_then(|bindgen| bindgen.generate(folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{program}: {error:#}");
            ExitCode::FAILURE
        }
    }
}
