def error_@F@_@NORM@(x, weights@T@, values):
    difference = np.abs(values - @EXACT@(x@T@))
    return @ROOT@


