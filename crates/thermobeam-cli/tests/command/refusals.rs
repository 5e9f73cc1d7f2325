//! Wrong command lines of all commands: exit status 2, what was found and what is allowed, and
//! nothing is written.

use super::*;

#[test]
fn a_wrong_command_line_is_refused_in_words_and_nothing_is_written() {
    let folder = Folder::new();
    let root = place(&folder);
    fs::write(root.join("empty"), "").expect("a file");
    fs::write(root.join("bytes"), [0xff, 0x00, 0x80]).expect("a file");
    let before = all(&root);
    each_is_refused(include_str!("refused.txt"), |case| {
        let refused = ended(&mut command(&root, &case.new));
        refused.refuses("");
        assert!(all(&root) == before, "{case:?} wrote");
        refused.stderr
    });
}
