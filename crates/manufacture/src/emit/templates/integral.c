static double @NAME@(const double x[]@T@)
{
@UNUSED@    double y[@D@], sum = 0.0;
    for (int i = 0; i < @D@; ++i) y[i] = x[i];
    for (int k = 0; k < @POINTS@*@PANELS@; ++k) {
        y[@AXIS@] = @LOW@ + @WIDTH@*(k / @POINTS@ + @P@rule_x[k % @POINTS@]);
@BODY@        sum += @WIDTH@*@P@rule_w[k % @POINTS@]*@VALUE@;
    }
    return sum;
}

