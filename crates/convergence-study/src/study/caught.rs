//! Panics caught and turned into messages.

use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::Once;

use super::kind::CaseFailure;

thread_local! {
    static WATCHED: Cell<bool> = const { Cell::new(false) };
    static LAST: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// The result of `compute`, or the message of its panic, with file and line.
///
/// Panics in here print nothing; panics elsewhere are reported as usual.
pub(crate) fn catch<T>(compute: impl FnOnce() -> T) -> Result<T, String> {
    install_hook();
    let before = WATCHED.replace(true);
    // State that a panic leaves half done lives inside `compute` and goes with it: studies are
    // shared only as `&self`.
    let result = panic::catch_unwind(AssertUnwindSafe(compute));
    WATCHED.set(before);
    result.map_err(|_| LAST.take().unwrap_or_else(|| "panicked".to_owned()))
}

impl CaseFailure {
    /// The result of `compute`; its panic as a failure, so that other cases go on.
    ///
    /// # Errors
    /// The message of the panic, with file and line.
    pub fn caught<T>(compute: impl FnOnce() -> T) -> Result<T, Self> {
        catch(compute).map_err(Self::new)
    }
}

/// Installs a hook before the current one that keeps the messages of watched panics.
fn install_hook() {
    static INSTALL: Once = Once::new();
    INSTALL.call_once(|| {
        let previous = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if WATCHED.get() {
                LAST.set(Some(message(info)));
            } else {
                previous(info);
            }
        }));
    });
}

fn message(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let text = payload.downcast_ref::<&str>().copied();
    let text = text
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    match info.location() {
        Some(place) => format!(
            "panicked at {}:{}: {text}",
            file_name(place.file()),
            place.line()
        ),
        None => format!("panicked: {text}"),
    }
}

/// The name without its folders, which may depend on the machine and would appear in committed
/// reports.
fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}
