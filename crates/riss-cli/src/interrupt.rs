//! Ctrl-C: the step that is being solved is finished and written, then the run stops. Pressed again it stops at once.

use std::sync::atomic::{AtomicUsize, Ordering};

static PRESSED: AtomicUsize = AtomicUsize::new(0);

/// Listens from now on; where the system does not allow it, Ctrl-C ends the program as ever.
pub fn listen() {
    let _ = ctrlc::set_handler(|| match PRESSED.fetch_add(1, Ordering::SeqCst) {
        0 => eprintln!("\nfinishing this step; press Ctrl-C again to stop at once"),
        // Files are put in place whole: what is there stays readable.
        _ => std::process::exit(crate::STOPPED.into()),
    });
}

/// Whether the run shall stop after this step.
pub fn is_asked() -> bool {
    PRESSED.load(Ordering::SeqCst) > 0
}
