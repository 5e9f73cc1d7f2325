pub fn average_@F@(lo: &[f64; @D@], hi: &[f64; @D@]@T@) -> @TYPE@ {
    let mut sum = [0.0; @N@];
    for k in 0..@CELLS@usize {
        let mut x = [0.0; @D@];
        let mut weight = 1.0;
        let mut rest = k;
        for i in 0..@D@ {
            x[i] = lo[i] + (hi[i] - lo[i]) * GAUSS_X[rest % 8];
            weight *= GAUSS_W[rest % 8];
            rest /= 8;
        }
        let value = @CALL@;
        for j in 0..@N@ {
            sum[j] += weight * value[j];
        }
    }
    @RETURN@
}

