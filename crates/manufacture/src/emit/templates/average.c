@TYPE@ @P@average_@F@(const double lo[], const double hi[]@T@@OUT@)
{
    double sum[@N@] = {0.0};
    for (int k = 0; k < @CELLS@; ++k) {
        double x[@D@], value[@N@], weight = 1.0;
        for (int i = 0, rest = k; i < @D@; ++i, rest /= 8) {
            x[i] = lo[i] + (hi[i] - lo[i])*@P@gauss_x[rest % 8];
            weight *= @P@gauss_w[rest % 8];
        }
        @CALL@
        for (int j = 0; j < @N@; ++j) sum[j] += weight*value[j];
    }
    @RETURN@
}

