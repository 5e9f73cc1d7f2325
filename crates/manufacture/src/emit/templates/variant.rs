/// The number of the variant that the environment variable MANUFACTURE_VARIANT names; it is read at
/// the first call. 0 is the solution of the file.
pub fn variant() -> usize {
    static CHOSEN: std::sync::OnceLock<usize> = std::sync::OnceLock::new();
    *CHOSEN.get_or_init(|| {
        let names = [
            "",
            @LIST@,
        ];
        let name = std::env::var_os("MANUFACTURE_VARIANT").unwrap_or_default();
        let Some(place) = names.iter().position(|known| name == **known) else {
            let name = name.to_string_lossy();
            let names = names.join(" ");
            eprintln!("MANUFACTURE_VARIANT: unknown variant `{name}`; expected one of{names}");
            std::process::exit(2);
        };
@CHANGES@        place
    })
}

