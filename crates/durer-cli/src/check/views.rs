//! Radiance views beside a scene, which `durer check` offers if the scene has no view of its own.

use durer::check::Finding;
use durer::scene::Scene;
use std::path::Path;

/// Adds to the first finding about the whole picture that the scene can be rendered with a view in
/// a `.vf` file of the same folder.
pub fn offer(findings: &mut [Finding], scene: &Scene, path: &Path) {
    let radiance = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("rad"));
    if !radiance || scene.camera_span.has_position() {
        return;
    }
    let Some(finding) = findings.iter_mut().find(|finding| finding.affects_whole_picture) else { return };
    let Some(view) = view_beside(path) else { return };
    let shown = [path, &view].map(|path| path.display().to_string());
    let [scene, view] = shown.map(|shown| shlex::try_quote(&shown).map_or(shown.clone(), |quoted| quoted.into_owned()));
    let offered = format!("use the view in `{view}`: `durer render {scene} --view-file {view}`");
    let help = finding.diagnostic.help.get_or_insert_default();
    *help = if help.is_empty() { offered } else { format!("{offered}; {help}") };
}

/// Returns the `.vf` file in the folder of a scene. If there are several, one with the name of the
/// scene precedes the others.
fn view_beside(scene: &Path) -> Option<std::path::PathBuf> {
    let folder = scene.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let is_view = |name: &Path| name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vf"));
    let mut views: Vec<_> =
        entries.map(|entry| scene.with_file_name(entry.file_name())).filter(|name| is_view(name)).collect();
    views.sort_by_key(|view| (view.file_stem() != scene.file_stem(), view.clone()));
    views.into_iter().next()
}
