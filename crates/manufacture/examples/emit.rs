//! Writes the files of all languages: `cargo run -p manufacture --example emit FILE FOLDER`.

use std::error::Error;
use std::path::Path;

use manufacture::{Language, Manufacture};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("expected the name of a file")?;
    let folder = arguments.next().ok_or("expected a folder")?;
    let manufacture = Manufacture::read(Path::new(&file))?;
    for (_, language) in Language::ALL {
        for file in manufacture.emit(language) {
            std::fs::write(Path::new(&folder).join(file.name), file.text)?;
        }
    }
    Ok(())
}
