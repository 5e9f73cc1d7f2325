def @NAME@(x@T@):
    y = [x[i] for i in range(@D@)]
    out = 0.0
    for k in range(@POINTS@*@PANELS@):
        y[@AXIS@] = @LOW@ + @WIDTH@*(k // @POINTS@ + RULE_X[k % @POINTS@])
@BODY@        out = out + @WIDTH@*RULE_W[k % @POINTS@]*@VALUE@
    return out


