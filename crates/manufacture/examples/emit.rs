//! Writes the files of all languages:
//! `cargo run -p manufacture --example emit FILE FOLDER [--variants]`.

use std::error::Error;
use std::path::Path;

use manufacture::{Language, Manufacture, Sampling};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("expected the name of a file")?;
    let folder = arguments.next().ok_or("expected a folder")?;
    let manufacture = Manufacture::read(Path::new(&file))?;
    let has_variants = arguments.next().is_some_and(|word| word == "--variants");
    let variants = has_variants
        .then(|| manufacture.variants(&Sampling::default()))
        .transpose()?;
    for (_, language) in Language::ALL {
        let files = match &variants {
            Some(variants) => variants.emit(language),
            None => manufacture.emit(language),
        };
        for file in files {
            std::fs::write(Path::new(&folder).join(file.name), file.text)?;
        }
    }
    Ok(())
}
