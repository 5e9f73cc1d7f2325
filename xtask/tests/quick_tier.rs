//! The quick tier with this build of the solver: it judges mutants that the tests have missed.

use std::fs;
use std::path::Path;
use std::process::Command;

use convergence_study_tests::files::files_below;

#[test]
#[ignore = "what `verify` does, without optimisation; for `cargo mutants`, see .cargo/mutants.toml"]
fn the_quick_tier_passes_and_no_number_moves() {
    let root = tempfile::tempdir().expect("a folder");
    // Read at run time, not at compile time: the copy in which it was compiled may be gone.
    let package = std::env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo");
    let studies = Path::new(&package).join("../studies");
    for path in files_below(&studies) {
        let inside = path.strip_prefix(&studies).expect("below it");
        let to = root.path().join("studies").join(inside);
        fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
        fs::copy(&path, to).expect("a copy");
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    command
        .args(["verify", "--quiet", "--time-limit", "120"])
        .current_dir(root.path());
    let output = command.output().expect("the program starts");
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stdout)
    );
}
