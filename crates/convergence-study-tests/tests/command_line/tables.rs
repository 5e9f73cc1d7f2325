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

#[test]
fn no_error_is_too_small_or_too_large() {
    let root = workspace();
    let steps = [0.1, 0.05, 0.025, 0.0125];
    for unit in [1e-200, 1e-9, 1.0, 1e40, 1e200] {
        let errors = [4.1e-3, 1.02e-3, 2.55e-4, 6.37e-5].map(|error| unit * error);
        let rows = steps
            .iter()
            .zip(errors)
            .map(|(h, error)| format!("{h} {error:e}\n"));
        write(&root, "t", "h e\n".to_owned() + &rows.collect::<String>());
        run(&root, "rates t --order 2").says(0, "pass: 2.000");
        run(&root, "rates t --order 1").says(1, "fail: 2.000");
    }
}
