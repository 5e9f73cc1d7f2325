//! Writes one picture of each kind, from made-up data:
//! `cargo run -p thermobeam-study --example gallery -- DIR`.

#[path = "../tests/charts/figures/mod.rs"]
mod figures;

use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let folder = std::env::args_os().nth(1).map_or_else(
        || std::env::temp_dir().join("thermobeam-gallery"),
        PathBuf::from,
    );
    std::fs::create_dir_all(&folder)?;
    for (name, svg) in figures::gallery() {
        let file = folder.join(format!("{name}.svg"));
        std::fs::write(&file, &svg)?;
        println!("{} ({} kB)", file.display(), svg.len() / 1000);
    }
    Ok(())
}
