//! What `rates` says of how it reads tables and claims.

use std::fs;

use super::{run, workspace};

pub(super) fn rates_says_how_it_read_a_table() {
    let root = workspace(false);
    fs::write(root.path().join("t"), "spam,L2,other\n0.4,0.16,4\n0.2,0.04,8\n0.1,0.01,16\n").unwrap();
    let rates = |more: &[&str]| run(&root, &[&["rates", "t"], more].concat());
    let note = "step: `spam`, the first column";
    let (status, out, _) = rates(&["--order", "2", "--quiet"]);
    assert_eq!((status, out.as_str()), (Some(0), &*format!("{note}\npass: 1 of 1 column agrees with its order\n")));
    let (_, out, _) = rates(&["--order", "2", "--format", "json"]);
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&object["notes"][0], &object["rates"][1]["decides"]), (&note.into(), &false.into()));
    assert!(object["rates"][1]["reason"].as_str().is_some_and(|reason| reason.contains("does not fall")), "{out}");
    let (_, _, err) = rates(&["--order", "2", "--out", "out/notes"]);
    let page = fs::read_to_string(root.path().join("out/notes/rates.md")).unwrap();
    assert!(page.contains("step: \\`spam\\`, the first column"), "{err}{page}");
    // Named, it is the step without a word, and no name that is claimed is taken for it.
    let (status, out, _) = rates(&["--order", "L2=2", "--step", "spam"]);
    assert!(status == Some(0) && !out.contains("step: "), "{out}");
    let (status, _, err) = rates(&["--order", "spam=2"]);
    assert!(status == Some(2) && err.contains("expected a column of steps: add `h`"), "{err}");
    // What an order for all leaves out is judged where its name is claimed, or chosen, and decides with --all.
    for more in [&["--order", "other=2"][..], &["--columns", "L2,other"], &["--all"]] {
        let (status, out, _) = rates(&[&["--order", "2"], more].concat());
        assert_eq!(status, Some(1), "{more:?}: {out}");
    }
    let utf_16: Vec<u8> = "\u{feff}h,L2\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(root.path().join("t"), utf_16).unwrap();
    assert!(rates(&[]).2.contains("found UTF-16; expected UTF-8 text: save the file as UTF-8"));
}

pub(super) fn claims_that_contradict_each_other_are_refused() {
    let root = workspace(false);
    fs::write(root.path().join("t"), "h [m],L2 [Pa],H1 (Pa)\n0.4,0.16,0.4\n0.2,0.04,0.2\n0.1,0.01,0.1\n").unwrap();
    for (options, says) in [
        (
            &["--order", "2", "--order", "3"][..],
            "one order for all columns, and --order NAME=P for others; found --order 2 and --order 3",
        ),
        (&["--order", "L2=2", "--order", "L2 [Pa]=3"], "each column once; found `L2 [Pa]` a second time"),
        (&["--order", "L2=2,H1=1"], "found `L2=2,H1`; repeat --order for each column"),
        (&["--order", "l2 [pa]=2"], "found `l2 [pa]`, did you mean `L2 [Pa]`?"),
        (&["--order", "-2"], "expected a number > 0, or NAME= and a number > 0"),
        (&["--floor", "-1"], "floor = -1: expected a finite number >= 0"),
        (&["--dim", "-1"], "expected a number > 0"),
    ] {
        let (status, out, err) = run(&root, &[&["rates", "t"], options].concat());
        assert_eq!((status, out.as_str()), (Some(2), ""), "{options:?}");
        assert!(err.contains(says), "{options:?}: {err}");
    }
    let (status, out, err) = run(&root, &["rates", "t", "--order", "2", "--order", "H1=1", "--step", "h"]);
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
}
