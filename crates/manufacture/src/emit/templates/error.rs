pub fn error_@F@_@NORM@(x: &[[f64; @D@]], weights: &[f64]@T@, values: &[f64]) -> f64 {
    let mut sum = 0.0_f64;
    for k in 0..x.len() {
        let value = @CALL@;
        for j in 0..@N@ {
            let difference = f64::abs(values[@N@ * k + j] - value[j]);
            @ADD@
        }
    }
    @ROOT@
}

