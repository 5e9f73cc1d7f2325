//! What the other crates of this workspace use besides the published names, and what tests look
//! at. **No promise of stability**: any version may change any item.

#[cfg(feature = "files")]
pub mod input {
    pub mod advice {
        pub use crate::input::advice::{Argument, ArgumentValue, CommandLine, Setting, Surface};
    }
}
#[cfg(feature = "reports")]
pub mod program {
    pub mod guard {
        pub use crate::program::guard::{COMMAND, enable_by};
    }
}
#[cfg(feature = "tables")]
pub mod rates {
    pub use crate::rates::{
        Claimed, ClaimedOrder, FILE, Refusal, Request, Sheet, TableSheet, Tables, call, claimed,
        object, sheet,
    };
}
pub mod run {
    pub use crate::run::available;
}
#[cfg(feature = "reports")]
pub mod store {
    pub use crate::store::{Baseline, GuardedChange, Movement, Record};
}
pub mod study {
    pub use crate::study::{STEPS, first_repeated};
    pub mod header {
        pub use crate::study::header::is_name;
    }
    pub mod norms {
        pub use crate::study::norms::{INSIDE, all_norms, largest_inside};
    }
    pub mod sampled {
        pub use crate::study::sampled::{Sampled, SampledLevel};
    }
    pub mod until_decided {
        pub use crate::study::until_decided::{Looks, Next, conclude, first_levels, next_by_time};
    }
}
#[cfg(feature = "reports")]
pub mod verify {
    pub use crate::verify::publish;
}
#[cfg(feature = "tables")]
pub mod where_lost {
    pub use crate::run::Located;
    pub use crate::where_lost::{Search, figure, located, lost, text_of_located};
}
