//! Names that a file cannot have in a language: its keywords, and what its modules hide.

/// Names that are taken, and what takes them.
pub(crate) struct Taken {
    pub(crate) by: &'static str,
    pub(crate) names: &'static str,
}

/// C11, 7.1.2: the name of the header is that of the file.
pub(super) const C: [Taken; 1] = [Taken {
    by: "a header of the standard library that the emitted one would hide",
    names: "assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp \
            signal stdalign stdarg stdatomic stdbool stddef stdint stdio stdlib stdnoreturn \
            string tgmath threads time uchar wchar wctype",
}];

/// Fortran has no reserved words; modules share one space with procedures.
pub(super) const FORTRAN: [Taken; 3] = [
    Taken {
        by: "an intrinsic module of Fortran",
        names: "iso_c_binding iso_fortran_env ieee_arithmetic ieee_exceptions ieee_features",
    },
    Taken {
        by: "a name that the emitted module itself has",
        names: "choose_variant dp gauss_x gauss_w require_variant rule_x rule_w set_parameter variant",
    },
    Taken {
        by: "a variable of the program that answers for the module",
        names: "cut double face p place status t text value x",
    },
];

/// The Language Reference, 2.3.1; module names of the standard library that can be identifiers.
pub(super) const PYTHON: [Taken; 2] = [
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

/// `iskeyword()` of Octave and MATLAB; functions that the emitted file calls.
pub(super) const OCTAVE: [Taken; 2] = [
    Taken {
        by: "a keyword of Octave",
        names: "break case catch classdef continue do else elseif end end_try_catch \
                end_unwind_protect endclassdef endenumeration endevents endfor endfunction endif \
                endmethods endparfor endproperties endspmd endswitch endwhile enumeration events \
                for function global if methods otherwise parfor persistent properties return spmd \
                switch try until unwind_protect unwind_protect_cleanup while",
    },
    Taken {
        by: "a function of Octave that the emitted one would hide",
        names: "abs acos any argv asin atan cos cosh error exp fgetl find floor fscanf gauss getenv \
                get_parameter \
                isempty isfield isscalar log log10 max min mod num2cell numel ones parameters pick \
                printf puts rule set_parameter sin sinh size sprintf sqrt stdin store strcmp \
                strsplit strtrim sum tan tanh true variant zeros",
    },
];

/// The Rust Reference, 2.1; crates that are always there.
pub(super) const RUST: [Taken; 2] = [
    Taken {
        by: "a keyword of Rust",
        names: "Self abstract as async await become box break const continue crate do dyn else \
                enum extern false final fn for gen if impl in let loop macro match mod move mut \
                override priv pub ref return self static struct super trait true try type \
                typeof unsafe unsized use virtual where while yield",
    },
    Taken {
        by: "a crate that every program has",
        names: "alloc core std",
    },
];
