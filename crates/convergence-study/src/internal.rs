//! Tables of errors, for the Python package and for the page in a browser, which word refusals in
//! their own way. **No promise of stability**: any version may change any item.

#[cfg(feature = "files")]
pub mod input {
    pub mod advice {
        pub use crate::input::advice::{Argument, ArgumentValue, CommandLine, Setting, Surface};
    }
}
#[cfg(feature = "tables")]
pub mod rates {
    pub use crate::rates::{
        Claimed, ClaimedOrder, FILE, Refusal, Request, Sheet, TableSheet, Tables, call, claimed,
        object, sheet,
    };
}
