//! Pages in a real browser: headless Chromium, from file://.

use super::Place;
use std::path::PathBuf;
use std::process::Command;

/// What a page's script may say of itself, put at its end: `see(text)` notes something, `done()` ends.
const HELPERS: &str = r#"
const seen = [];
const see = text => seen.push(text);
const done = () => {
  const fetched = performance.getEntriesByType("resource").map(entry => entry.name).filter(name => !name.startsWith("data:"));
  see(`fetched ${fetched.length}`);
  document.title = "SEEN " + seen.join(" | ") + " END";
};
const mouse = (target, type, x, y, buttons = 1) => {
  const box = target.getBoundingClientRect();
  const at = { clientX: box.left + x * box.width, clientY: box.top + y * box.height };
  target.dispatchEvent(new PointerEvent(type, { ...at, buttons, bubbles: true, pointerId: 1 }));
};
// No finger is on the screen that could be held on to.
Element.prototype.setPointerCapture = () => {};
window.addEventListener("error", e => { see(`ERROR ${e.message}`); done(); });
"#;

fn chromium() -> Option<PathBuf> {
    let paths = std::env::var_os("PATH")?;
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .iter()
        .find_map(|name| std::env::split_paths(&paths).map(|folder| folder.join(name)).find(|path| path.is_file()));
    if found.is_none() {
        println!("skipped: there is no chromium to open the page in");
    }
    found
}

/// Opens a page, runs a script at its end, and wants it to see all of some texts. Nothing is done where there is no browser.
///
/// The page must fetch nothing: no file, no network.
#[track_caller]
pub fn sees(place: &Place, page: &str, script: &str, wanted: &[&str]) {
    let Some(chromium) = chromium() else { return };
    let text = String::from_utf8(place.bytes(page)).unwrap();
    // The name of SVG's language is an address that nobody opens.
    let links = text.replace("http://www.w3.org/2000/svg", "");
    assert!(!links.contains("http://") && !links.contains("https://"), "{page} names an address");
    let end = text.rfind("</body>").unwrap();
    let with = format!("{}<script>{HELPERS}{script}</script>{}", &text[..end], &text[end..]);
    place.put("clicked.html", with);
    let run = Command::new("timeout")
        .arg("60")
        .arg(chromium)
        .args(["--no-sandbox", "--headless=new", "--disable-gpu", "--virtual-time-budget=4000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", place.path("browser").display()))
        .arg(format!("file://{}", place.path("clicked.html").display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&run.stdout);
    let title = dom.split("<title>").nth(1).and_then(|rest| rest.split("</title>").next()).unwrap_or("");
    assert!(title.starts_with("SEEN "), "{title}\n{}", String::from_utf8_lossy(&run.stderr));
    for wanted in wanted.iter().chain(&["fetched 0"]) {
        assert!(title.contains(wanted), "`{wanted}` is not in {title}");
    }
}
