"""Tables of other libraries as columns, and refusals in words of Python."""

import re
import shlex

OPTIONS = ("names", "step", "dim", "ratio", "columns", "values")


def with_index(table):
    """The table with its index as a column, if that is more than the numbers of the rows; and whether it was a series.

    Data frames and series of pandas and xarray have an index; tables of other types are returned as they are.
    """
    if hasattr(table, "data_vars"):
        table = table.to_dataframe()
    elif hasattr(table, "to_series") and hasattr(table, "dims"):
        table = table.to_series()
    index = getattr(table, "index", None)
    if not hasattr(index, "nlevels"):
        return table, False
    if index.nlevels > 1:
        names = ", ".join(map(str, index.names))
        raise ValueError(f"h: expected one index, the step; found {index.nlevels}: {names}")
    is_series = not hasattr(table, "columns")
    if is_series:
        table = table.to_frame("error" if table.name is None else table.name)
    if index.name is None and list(index) == list(range(len(index))):
        if is_series:
            expected = "a series whose index is the step; give the steps as h, the series as errors"
            raise ValueError(f"h: expected {expected}; found the index 0, 1, 2, ...")
        return table, False
    # Whole numbers without a name may be left by a selection of rows: `index` is a step only on request.
    is_whole = all(float(value).is_integer() for value in index) if index.dtype.kind in "iuf" else False
    unnamed = ("n" if is_series else "index") if is_whole else "h"
    name = unnamed if index.name is None else index.name
    if name in table.columns:
        if index.name is not None:
            raise ValueError(f"h: expected one step; found an index and a column of the name `{name}`")
        return table, False
    return table.rename_axis(name).reset_index(), is_series


def in_python(message, call, drop=()):
    """A refusal that names options of the command line, with arguments of Python.

    call: the call that was refused, without the closing parenthesis; commands that are offered become this call with more arguments, unless
    they need one of `drop`.
    """
    lines = []
    for line in message.splitlines():
        if not line.startswith("  "):
            lines.append(_named(line))
        elif (offer := _offer(line, call, drop)) is not None:
            lines.append(offer)
    return "\n".join(lines)


def _named(line):
    line = re.sub(r"--(\w+) ([A-Z]+)\b", r"\1=\2", line)
    return re.sub(r"--(\w+)", r"\1=...", line)


def in_rows(message):
    """The message with rows of a table in place of the lines of its text, whose first line has the names."""
    return re.sub(r"in lines (\d+) and (\d+)", lambda lines: "in rows {} and {}".format(*(int(line) - 2 for line in lines.groups())), message)


def _offer(line, call, drop):
    command, _, comment = line.partition("  # ") if "  # " in line else (line, "", "")
    words = shlex.split(command)
    given = [(word[2:], value) for word, value in zip(words, words[1:]) if word[:2] == "--" and word[2:] in OPTIONS]
    if any(name in drop for name, _ in given):
        return None
    arguments = "".join(f", {name}={_literal(name, value)}" for name, value in given if f" {name}=" not in call)
    return f"  {call}{arguments})" + (f"  # {comment}" if comment else "")


def _literal(name, value):
    if name in ("dim", "ratio"):
        return value
    return repr(value) if name == "step" else repr(value.split(","))
