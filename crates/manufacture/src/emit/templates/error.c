double @P@error_@F@_@NORM@(
    size_t m, const double x[], const double weights[]@T@, const double values[])
{
    double sum = 0.0;
@UNUSED@    for (size_t k = 0; k < m; ++k) {
        double value[@N@];
        @CALL@
        for (int j = 0; j < @N@; ++j) {
            const double difference = fabs(values[@N@*k + j] - value[j]);
            @ADD@
        }
    }
    return @ROOT@;
}

