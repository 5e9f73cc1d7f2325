//! A small workspace for `verify`, and its contents afterwards.

use super::*;

/// A study of a few milliseconds that passes.
pub(crate) fn quick(id: &str) -> String {
    study(id, "[5, 10, 20, 40]")
}

/// A study whose last case takes hours.
pub(crate) fn endless(id: &str) -> String {
    study(id, "[10, 20, 40, 9000000000]")
}

fn study(id: &str, steps: &str) -> String {
    format!(
        "[study]\nid = \"{id}\"\nclaim = \"first order in dt\"\ntier = \"quick\"\n[exact]\n\
         u = [{{ x = \"0.3*sin(1.3*pi*x)\", t = \"cos(3*t) + 0.2*t\" }}]\n\
         [refine]\naxis = \"time\"\nisolate = true\nelements = 8\nsteps = {steps}\nt_end = 1.0\n\
         [[expect]]\nnorm = \"theorem-3.4\"\norder = 1.0\ntolerance = 0.2\n"
    )
}

/// Installs these as the studies of a workspace.
pub(crate) fn with_studies(root: &Path, studies: &[(&str, String)]) {
    let folder = root.join("studies");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    for (id, text) in studies {
        fs::write(folder.join(format!("{id}.toml")), text).expect("a study");
    }
}

/// A workspace with these studies.
pub(crate) fn workspace(folder: &Folder, name: &str, studies: &[(&str, String)]) -> PathBuf {
    let root = folder.path(name);
    with_studies(&root, studies);
    root
}

/// `verify` with these arguments in a workspace.
pub(crate) fn verify(root: &Path, arguments: &str) -> Command {
    let mut command = super::command(root, &format!("verify {arguments}"));
    command
        .env_remove("GITHUB_ACTIONS")
        .env_remove("GITHUB_STEP_SUMMARY");
    command
}

/// Files below a folder with their bytes, except those with machine and time.
pub(crate) fn set(reports: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = all(reports);
    // A run killed while testing the folder leaves an empty file outside the set, which the next
    // run removes.
    files.retain(|name, _| {
        !name.starts_with("local/") && !name.starts_with(".probe.") && !name.ends_with('/')
    });
    for (_, page) in files
        .iter_mut()
        .filter(|(name, _)| name.ends_with("index.html"))
    {
        let text = String::from_utf8_lossy(page);
        let lines = text
            .lines()
            .filter(|line| !line.starts_with("<p class=\"provenance\">"));
        *page = lines.collect::<Vec<_>>().join("\n").into_bytes();
    }
    files
}

/// All files below a folder with their bytes, and all folders, whose names end in `/`.
pub(crate) fn all(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(folder).expect("below").display();
            if path.is_dir() {
                files.insert(format!("{name}/"), vec![]);
                folders.push(path);
            } else {
                files.insert(name.to_string(), fs::read(&path).expect("a file"));
            }
        }
    }
    files
}
