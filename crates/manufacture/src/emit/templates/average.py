def average_@F@(lo, hi@T@):
    out = 0.0
    for index in np.ndindex(*(8,)*@D@):
        x = np.array([lo[i] + (hi[i] - lo[i])*GAUSS_X[k] for i, k in enumerate(index)])
        out = out + np.prod([GAUSS_W[k] for k in index])*exact_@F@(x@T@)
    return out


