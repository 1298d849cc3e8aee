//! Links the program for the page of a browser: threads share one memory, which grows to the 4 GiB that
//! `io::machine` tells of, and have the stack that desktops give.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is_page = std::env::var("CARGO_CFG_TARGET_FAMILY").is_ok_and(|family| family == "wasm");
    if !is_page {
        return;
    }
    let options =
        ["--shared-memory", "--import-memory", "--max-memory=4294967296", "-zstack-size=8388608"];
    let threads = ["__wasm_init_tls", "__tls_size", "__tls_align", "__tls_base"];
    options.iter().for_each(|option| println!("cargo:rustc-cdylib-link-arg={option}"));
    threads.iter().for_each(|name| println!("cargo:rustc-cdylib-link-arg=--export={name}"));
}
