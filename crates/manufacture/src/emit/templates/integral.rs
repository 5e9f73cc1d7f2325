fn @NAME@(x: &[f64; @D@]@T@) -> f64 {
    let mut y = *x;
    let mut sum = 0.0;
    for k in 0..@POINTS@ * @PANELS@ {
        y[@AXIS@] = @LOW@ + @WIDTH@ * ((k / @POINTS@) as f64 + RULE_X[k % @POINTS@]);
@BODY@        sum += @WIDTH@ * RULE_W[k % @POINTS@] * @VALUE@;
    }
    sum
}

