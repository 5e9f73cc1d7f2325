pub fn set_parameter(name: &str, value: f64) -> Result<(), String> {
@READY@@BODY@    Ok(())
}

