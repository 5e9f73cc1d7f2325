"""Tables of other libraries as columns."""


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
