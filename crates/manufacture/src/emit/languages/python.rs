//! Python with NumPy.

use super::super::texts::*;

/// The Language Reference, 2.3.1; module names of the standard library that can be identifiers.
const TAKEN: [Taken; 2] = [
    Taken {
        by: "a keyword of Python",
        names: "False None True and as assert async await break case class continue def del elif \
                else except finally for from global if import in is lambda match nonlocal not or \
                pass raise return try type while with yield",
    },
    Taken {
        by: "a module that the emitted one would hide",
        names: "abc argparse array ast asyncio atexit base64 bdb binascii bisect builtins bz2 \
                calendar cmath cmd code codecs codeop collections colorsys compileall \
                concurrent configparser contextlib contextvars copy copyreg csv ctypes curses \
                dataclasses datetime dbm decimal difflib dis doctest email encodings ensurepip enum \
                errno faulthandler fcntl filecmp fileinput fnmatch fractions ftplib functools gc \
                getopt getpass gettext glob graphlib grp gzip hashlib heapq hmac html http imaplib \
                importlib inspect io ipaddress itertools json keyword linecache locale logging lzma \
                mailbox marshal math mimetypes mmap modulefinder multiprocessing netrc numbers \
                numpy operator optparse os pathlib pdb pickle pickletools pkgutil platform plistlib \
                poplib posix posixpath pprint profile pstats pty pwd py_compile pyclbr pydoc queue \
                quopri random re readline reprlib resource rlcompleter runpy sched scipy secrets \
                select selectors shelve shlex shutil signal site smtplib socket socketserver sqlite3 \
                ssl stat statistics string stringprep struct subprocess symtable sys sysconfig \
                syslog tabnanny tarfile tempfile termios textwrap threading time timeit tkinter \
                token tokenize tomllib trace traceback tracemalloc tty turtle types typing ufl \
                unicodedata unittest urllib uuid venv warnings wave weakref webbrowser winreg \
                winsound wsgiref xml xmlrpc zipapp zipfile zipimport zlib zoneinfo",
    },
];

const SHAPED: Shaped = Shaped {
    function: "def @F@(x@T@):\n    x = np.asarray(x, dtype=float)\n    \
               out = np.empty((@N@,) + x.shape[1:])\n@BODY@    return out\n\n\n",
    values: "",
    kind: "",
    out: "",
    result: "",
    answer: "library.@F@",
};

pub(super) const PYTHON: Texts = Texts {
    ending: ".py",
    prefix: "",
    comment: "#",
    build: "python3 @NAME@_answer.py",
    tools: Some(Tools {
        probe: "python3 -c __import__('numpy')",
        missing: "Python with NumPy",
        builds: &[],
        answering: Answering::Session {
            interpreter: "python3 -B -c",
            text: include_str!("../templates/session.py"),
        },
    }),
    names: NamingRules {
        ignores_case: false,
        has_one_space: false,
        taken: &TAKEN,
    },
    arithmetic: Arithmetic {
        coordinate: "@ARRAY@[@I@]",
        suffix: "",
        times: "*",
        over: "/",
        functions: Functions {
            asin: "np.arcsin(@X@)",
            acos: "np.arccos(@X@)",
            atan: "np.arctan(@X@)",
            ..functions!("np.")
        },
        power: "(@LEFT@)**(@RIGHT@)",
        choose: "np.where(@LEFT@ @SYMBOL@ @RIGHT@, @THEN@, @ELSE@)",
    },
    statements: Statements {
        indent: "    ",
        assign: "@NAME@ = @VALUE@",
        scalar: "out[@I@] = @VALUE@",
        component: "out[@I@] = @VALUE@",
        declare: "",
        unused: "",
        block: None,
        integrand: "y",
        integrand_indent: "        ",
    },
    time: Time {
        argument: ", t",
        declaration: "",
    },
    library: Library {
        opening: "\nimport numpy as np\n\n",
        for_parameters: "",
        for_variants: "",
        entry: "",
        table: "@RULE1@_X = [\n    @X@,\n]\n@RULE1@_W = [\n    @W@,\n]\n",
        separator: ",\n    ",
        helpers: "\n",
        closing: "",
    },
    header: None,
    scalar: Shaped {
        function: "def @F@(x@T@):\n    x = np.asarray(x, dtype=float)\n    \
                   out = np.empty((@N@,) + x.shape[1:])\n@BODY@    return out[0]\n\n\n",
        ..SHAPED
    },
    tensor: SHAPED,
    integral: include_str!("../templates/integral.py"),
    norms: Some(Norms {
        average: include_str!("../templates/average.py"),
        point: "",
        points: "",
        error: include_str!("../templates/error.py"),
        l1: Norm {
            add: "",
            root: "np.sum(weights*difference)",
        },
        l2: Norm {
            add: "",
            root: "np.sqrt(np.sum(weights*difference**2))",
        },
        linf: Norm {
            add: "",
            root: "np.max(difference)",
        },
        without_weights: "",
    }),
    parameters: Parameters {
        definition: "@NAME@ = @VALUE@\n",
        definitions: "@LINES@",
        read: "@NAME@",
        read_of_variant: "@NAME@",
        assign: "@NAME@ = @VALUE@",
        setter: include_str!("../templates/setter.py"),
        body: "@CASES@    else:\n        raise ValueError(f\"unknown parameter {name}\")\n",
        case: "    @EL@if name == \"@NAME@\":\n",
        indent: "        ",
        close: "",
        global: "    global @NAME@\n",
        getter: "",
        getter_case: "",
        settings: "for word in sys.argv[2:]:\n    name, value = word.split(\"=\")\n    \
                   library.set_parameter(name, float(value))\n",
    },
    choice: Choice {
        before: "",
        case: "    @EL@if _NUMBER in [@ALL@]:\n",
        otherwise: "    else:\n",
        close: "",
        after: "",
        indent: "    ",
        number: "@K@",
        between: ", ",
        functions: include_str!("../templates/variant.py"),
        name: "\"@NAME@\"",
        between_names: ",\n    ",
        variable: "",
        ready: "",
        changes: "if _NUMBER == @K@:\n@CHANGES@",
        change: "    @NAME@ = @VALUE@\n",
        advice: "",
        current: "",
    },
    answer: Some(Answer {
        ending: ".py",
        template: include_str!("../templates/answer.py"),
        choose: "",
        time: "t = points[@D@]\n",
        time_argument: "",
        names: "",
        separator: "\"\n        \"",
        matrix: "@CALL@",
        between: ",\n        ",
        branch: "    \"@FACE@\": (\"@NAMES@\", [\n        @CALLS@,\n    ]),\n",
    }),
};
