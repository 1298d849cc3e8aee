//! The program's delegate, which AppKit asks to open files. Floor 7. macOS only.

use objc2::rc::Retained;
use objc2::runtime::{NSObject, NSObjectProtocol, ProtocolObject};
use objc2::{DefinedClass, MainThreadMarker, MainThreadOnly, define_class, msg_send};
use objc2_app_kit::{NSApplication, NSApplicationDelegate};
use objc2_foundation::{NSArray, NSDictionary, NSURL, NSUserDefaults, ns_string};
use std::path::PathBuf;

type Open = Box<dyn Fn(Vec<PathBuf>)>;

define_class!(
    // SAFETY: `NSObject` asks nothing of the classes below it, and this one has no `Drop`.
    #[unsafe(super(NSObject))]
    #[thread_kind = MainThreadOnly]
    #[ivars = Open]
    /// Is told by AppKit what happens to the program.
    pub struct FileListener;

    // SAFETY: it asks nothing.
    unsafe impl NSObjectProtocol for FileListener {}

    // SAFETY: the method has the types that AppKit calls it with.
    unsafe impl NSApplicationDelegate for FileListener {
        #[unsafe(method(application:openURLs:))]
        fn open_urls(&self, _: &NSApplication, urls: &NSArray<NSURL>) {
            let file = |url: Retained<NSURL>| url.isFileURL().then(|| url.to_file_path())?;
            let files: Vec<PathBuf> = urls.iter().filter_map(file).collect();
            if !files.is_empty() {
                (self.ivars())(files);
            }
        }
    }
);

/// Hears AppKit for as long as the listener lives; `None` off the main thread. To be called when the
/// event loop has been made, before it runs: the files of the first double click come before the window
/// does.
pub fn listen(open: impl Fn(Vec<PathBuf>) + 'static) -> Option<Retained<FileListener>> {
    let main = MainThreadMarker::new()?;
    leave_arguments_alone();
    let listener = FileListener::alloc(main).set_ivars(Box::new(open) as Open);
    // SAFETY: `init` of `NSObject` has this signature.
    let listener: Retained<FileListener> = unsafe { msg_send![super(listener), init] };
    // The program does not keep its delegate alive.
    NSApplication::sharedApplication(main).setDelegate(Some(ProtocolObject::from_ref(&*listener)));
    Some(listener)
}

/// AppKit takes arguments of the command line for files to open, too; they would open twice.
fn leave_arguments_alone() {
    let (name, no) = (ns_string!("NSTreatUnknownArgumentsAsOpen"), ns_string!("NO"));
    let defaults = NSDictionary::from_slices(&[name], &[no.as_ref()]);
    // SAFETY: a text is a value that settings may have.
    unsafe { NSUserDefaults::standardUserDefaults().registerDefaults(&defaults) };
}
