pub fn get_parameter(name: &str) -> Option<f64> {
    match name {
@CASES@        _ => None,
    }
}

