//! What the other crates of this workspace use besides the published names, and what tests look
//! at. **No promise of stability**: any version may change any item.

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
