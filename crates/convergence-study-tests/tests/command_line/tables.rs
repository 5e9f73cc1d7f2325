//! Tables of any size, and in another encoding.

use super::{run, workspace, write};

#[test]
fn a_table_in_utf_16_is_refused_with_what_to_do() {
    let root = workspace();
    let words = "\u{feff}h,L2\n".encode_utf16();
    write(
        &root,
        "t",
        words.flat_map(u16::to_le_bytes).collect::<Vec<u8>>(),
    );
    run(&root, "rates t").refuses("found UTF-16; expected UTF-8 text: save the file as UTF-8");
}
