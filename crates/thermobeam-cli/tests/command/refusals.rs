//! Wrong command lines of all commands: exit status 2, what was found and what is allowed, and
//! nothing is written.

use std::fs;

use super::flags::place;
use super::workspace::all;
use super::{Folder, command};
use convergence_study_tests::{ended, says};

const NO_FILE: &str = "missing: cannot be read: ";
const FOLDER: &str = "studies: cannot be read: ";
const BYTES: &str = "bytes:1:1: found the byte 0xff; expected UTF-8 text";
const TAKEN: &str = "rates.csv: expected a folder, found a file";
const POSITIVE: &str = "expected a number > 0";
const WITHOUT: &str = "required arguments were not provided";

/// Command lines, and words of the message.
const REFUSED: [(&str, &str); 89] = [
    (
        "rnu scene.toml",
        "the commands are completions, equilibria, ",
    ),
    ("--colour never list", "'--color'"),
    ("--color blue list", "possible values: auto, always, never"),
    ("run", WITHOUT),
    ("run missing", NO_FILE),
    ("run studies", FOLDER),
    ("run bytes", BYTES),
    (
        "run empty",
        "empty:1:1: time: missing; expected a table: the method, its steps",
    ),
    ("run rates.csv", "rates.csv:1:2: not valid TOML"),
    (
        "run sweep.toml",
        "sweep.toml:3:2: grid: unknown key `grid`; expected beam, obstacles",
    ),
    (
        "run scene.toml scene.toml",
        "unexpected argument 'scene.toml'",
    ),
    ("run scene.toml --out rates.csv", TAKEN),
    ("run scene.toml --out rates.csv/below", TAKEN),
    ("run scene.toml --time-limit 0", POSITIVE),
    ("run scene.toml --time-limit -1", POSITIVE),
    ("run scene.toml --time-limit nan", POSITIVE),
    ("run scene.toml --case-limit 3", "'--time-limit'"),
    (
        "run scene.toml --target-error small",
        "expected a finite number > 0",
    ),
    (
        "run scene.toml --target-error 1e-3 --keep-scheme",
        "unexpected argument '--keep-scheme'",
    ),
    ("run scene.toml --format csv", "possible values: text, json"),
    ("run scene.toml --jobs 0", "expected a whole number >= 1"),
    ("equilibria", WITHOUT),
    ("equilibria missing", NO_FILE),
    ("equilibria bytes", BYTES),
    ("equilibria scene.toml -o rates.csv", TAKEN),
    ("sweep missing", NO_FILE),
    ("sweep studies", FOLDER),
    (
        "sweep scene.toml",
        "scene.toml:2:2: initial: unknown key `initial`; expected sweep, set, grid, list",
    ),
    (
        "sweep sweep.toml --resume",
        "unexpected argument '--resume'",
    ),
    ("sweep", "<FILE>"),
    (
        "sweep sweep.toml --merge swept --out joined",
        "cannot be used with",
    ),
    (
        "sweep sweep.toml --partition 3/2",
        "expected k/n with 1 <= k <= n",
    ),
    ("sweep sweep.toml --time-limit -3", POSITIVE),
    (
        "sweep sweep.toml --partition 1/2 --out swept",
        "swept/results.jsonl:1: expected {",
    ),
    (
        "sweep --merge swept",
        "--out DIR: expected the folder for the joined results; found none",
    ),
    (
        "sweep --merge missing --out joined",
        "missing/results.jsonl: ",
    ),
    (
        "sweep --merge swept swept --out joined",
        "expected each share once",
    ),
    (
        "sweep --merge swept --out swept",
        "swept/results.jsonl: expected no file there before the shares are joined",
    ),
    ("sweep --merge swept --out rates.csv", TAKEN),
    (
        "verify long",
        "`long` matches no study; expected short, or a pattern",
    ),
    (
        "verify studies/short.toml short",
        "expected ids of studies or study files; found the file `studies/short.toml` beside `short`",
    ),
    (
        "verify studies/short.toml --bless",
        "--bless: expected the studies of the project; found the file `studies/short.toml`",
    ),
    ("verify [", "`[` is not a pattern"),
    ("verify --tier slow", "possible values: quick, full"),
    ("verify --case-limit 3", "'--time-limit'"),
    ("verify --time-limit soon", POSITIVE),
    ("verify --time-limit 0", POSITIVE),
    ("verify --time-limit -1", POSITIVE),
    ("verify --time-limit inf", POSITIVE),
    ("verify --time-limit 1e300", "--time-limit"),
    (
        "verify --bless --dry-run",
        "cannot be used with '--dry-run'",
    ),
    ("verify --out rates.csv", TAKEN),
    ("study", WITHOUT),
    ("study missing", NO_FILE),
    ("study studies", FOLDER),
    ("study bytes", BYTES),
    (
        "study scene.toml",
        "study: missing; expected a table with id, claim and tier",
    ),
    (
        "study studies/short.toml studies/short.toml",
        "expected an id that no other study has",
    ),
    ("list long", "`long` matches no study"),
    ("list --format md", "possible values: text, json"),
    ("new", WITHOUT),
    ("new solver x", "possible values: study, scene, "),
    ("new study X", "lowercase letters, digits, `.` or `-`"),
    (
        "new study short",
        "expected a new file, found one of that name",
    ),
    (
        "new study x --language julia",
        "found `new study`; expected `new program`",
    ),
    ("new program x --language perl", "possible values: python, "),
    ("new program x --command {m}", "found the placeholder {m}"),
    ("new program x --out rates.csv", TAKEN),
    ("manufacture missing", NO_FILE),
    ("manufacture studies", FOLDER),
    ("manufacture bytes", BYTES),
    (
        "manufacture scene.toml",
        "unknown key `mesh`; expected one of manufacture domain ",
    ),
    (
        "manufacture heat.toml --language perl",
        "expected one of c, fortran, python",
    ),
    ("manufacture heat.toml --at missing", NO_FILE),
    (
        "manufacture heat.toml --at rates.csv",
        "unknown column `h`; expected one of x face",
    ),
    (
        "manufacture heat.toml --against no-such-program",
        "no-such-program cannot be started in the folder ",
    ),
    (
        "manufacture heat.toml --against cat --timeout 3",
        "'--time-limit'",
    ),
    (
        "manufacture heat.toml --points 1",
        "expected a whole number >= 2",
    ),
    (
        "manufacture heat.toml --seed -1",
        "expected a whole number >= 0",
    ),
    ("report missing", "missing: "),
    (
        "report bytes",
        "found bytes that are no UTF-8; expected UTF-8 text",
    ),
    (
        "report rates.csv",
        "expected a record as `verify` writes it",
    ),
    ("rates missing", NO_FILE),
    ("rates bytes", BYTES),
    (
        "rates rates.csv --order two",
        "expected a number > 0, '>=P' with such a number P",
    ),
    ("rates rates.csv --tolerance wide", "expected a number"),
    (
        "rates rates.csv --dim 2 --ratio 2",
        "cannot be used with '--ratio <R>'",
    ),
    (
        "schema mesh",
        "error: schema: found `mesh`; expected one of study, scene, manufacture\n",
    ),
    ("completions tcsh", "possible values: bash, "),
];

#[test]
fn a_wrong_command_line_is_refused_in_words_and_nothing_is_written() {
    let folder = Folder::new();
    let root = place(&folder);
    fs::write(root.join("empty"), "").expect("a file");
    fs::write(root.join("bytes"), [0xff, 0x00, 0x80]).expect("a file");
    let before = all(&root);
    for (line, words) in REFUSED {
        let refused = ended(&mut command(&root, line));
        assert!(says(&refused.stderr, words), "{line}: {refused:?}");
        refused.refuses("");
        assert!(all(&root) == before, "{line} wrote");
    }
}
