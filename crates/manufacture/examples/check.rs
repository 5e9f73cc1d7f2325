//! Checks a file: `cargo run -p manufacture --example check FILE`.

use std::error::Error;
use std::path::Path;

use manufacture::{Manufacture, Sampling};

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args()
        .nth(1)
        .ok_or("expected the name of a file")?;
    let check = Manufacture::read(Path::new(&file))?.check(&Sampling::default())?;
    for share in &check.shares {
        println!("{}: {}: {:.3}", share.equation, share.term, share.share);
    }
    for finding in &check.findings {
        println!("{}: {}: {}", finding.code, finding.key, finding.text);
    }
    println!("{}", check.verdict);
    Ok(())
}
