//! What the other crates of this workspace use besides the published names, and what tests look
//! at. **No promise of stability**: any version may change any item.

#[cfg(feature = "command-line")]
pub mod cli {
    pub use crate::cli::{COMMANDS, Command, command_line, ended, program, status_of};
    pub mod exit {
        pub use crate::cli::exit::{CommandOutcome, Unusable, say};
    }
    pub mod flags {
        pub use crate::cli::flags::Flags;
    }
    pub mod help {
        pub use crate::cli::help::{HelpPage, pages};
    }
    pub mod running {
        pub use crate::cli::running::{consent, counting, seconds};
    }
    pub mod schema {
        pub use crate::cli::schema::{MANUFACTURE, of_studies, other_files, page, text};
    }
    pub mod screen {
        pub use crate::cli::screen::complain;
    }
    pub mod workspace {
        pub use crate::cli::workspace::root;
    }
}
#[cfg(feature = "files")]
pub mod input {
    pub use crate::input::{POSITIVE, parse, parse_beside, parse_overlaid, read_text};
    pub mod schema {
        pub use crate::input::schema::of;
    }
    pub mod advice {
        pub use crate::input::advice::{Argument, ArgumentValue, CommandLine, Setting, Surface};
    }
}
#[cfg(feature = "reports")]
pub mod program {
    pub use crate::program::{MANUFACTURE, PROJECT, ROW, TABLE, TAYLOR, TEMPLATE};
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
#[cfg(feature = "reports")]
pub mod report {
    pub use crate::report::markdown;
}
pub mod run {
    pub use crate::run::{available, catch};
}
#[cfg(feature = "reports")]
pub mod store {
    pub use crate::store::{
        Baseline, GuardedChange, Movement, Provenance, Record, content_hash, json,
    };
    pub mod atomic {
        pub use crate::store::atomic::{begin_write, naming, prepare_folder, write, write_with};
    }
}
pub mod study {
    #[cfg(feature = "files")]
    pub use crate::study::StudyFile;
    pub use crate::study::{Described, STEPS, first_repeated};
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
