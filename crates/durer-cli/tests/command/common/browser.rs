//! Tests pages in a real browser, using headless Chromium with file:// URLs.

use super::TestFolder;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Functions for a script at the end of a page: `see(text)` records a text, and `done()` ends the
/// run.
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
// Headless runs have no pointer to capture.
Element.prototype.setPointerCapture = () => {};
// Pages draw again after a change.
const wait = () => new Promise(resolve => setTimeout(resolve, 60));
const count = selector => document.querySelectorAll(selector).length;
const find = selector => document.querySelector(selector);
window.addEventListener("unhandledrejection", e => { see(`ERROR ${e.reason}`); done(); });
window.addEventListener("error", e => { see(`ERROR ${e.message}`); done(); });
"#;

fn chromium() -> Option<PathBuf> {
    let paths = std::env::var_os("PATH")?;
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .iter()
        .find_map(|name| std::env::split_paths(&paths).map(|folder| folder.join(name)).find(|path| path.is_file()));
    if found.is_none() {
        println!("skipped: chromium not found");
    }
    found
}

/// Opens a page, runs a script at its end, and checks that the script records all of the given
/// texts. The test is skipped if no browser is installed.
///
/// The page must not load anything from disk or the network. It must be readable at several window
/// widths, in light and dark mode.
#[track_caller]
pub fn sees(folder: &TestFolder, page: &str, script: &str, wanted: &[&str]) {
    let Some(chromium) = chromium() else { return };
    let title = title_of(folder, &chromium, page, "clicked.html", &format!("{HELPERS}{script}"));
    for wanted in wanted.iter().chain(&["fetched 0"]) {
        assert!(title.contains(wanted), "`{wanted}` is not in {title}");
    }
    // Inside a frame, the content treats the frame as its window.
    put_with(folder, page, "framed.html", READABLE);
    let frames =
        WIDTHS.map(|width| format!("<iframe src=framed.html style='width:{width}px;height:1000px;border:0'></iframe>"));
    folder.write("frames.html", format!("<!DOCTYPE html><title></title><body>{}</body>", frames.concat()));
    let title = title_of(folder, &chromium, "frames.html", "framing.html", FRAMES);
    assert_eq!(title.matches(": readable").count(), 2 * WIDTHS.len(), "{page}: {title}");
}

/// Window widths at which pages are tested.
const WIDTHS: [u32; 3] = [400, 900, 1600];

/// Script that waits for the messages of the frames.
const FRAMES: &str = r#"
const told = [];
window.onmessage = event => {
  told.push(event.data);
  if (told.length === document.querySelectorAll("iframe").length) document.title = "SEEN " + told.join(" | ") + " END";
};
"#;

/// Script that checks a page in light and dark mode. It checks the contrast of text (WCAG 2.1 AA,
/// 1.4.3: 4.5 : 1, large text 3 : 1), the contrast of coloured drawings (1.4.11: 3 : 1), and that
/// the page is not wider than its window.
const READABLE: &str = r#"
const parts = color => { const [r, g, b, a = 1] = color.match(/[\d.]+/g).map(Number); return { rgb: [r, g, b], a }; };
const light = rgb => rgb.map(c => c / 255).map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4).reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
const contrast = (a, b) => { const [x, y] = [light(a), light(b)]; return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05); };
const over = (top, below) => top.rgb.map((c, i) => top.a * c + (1 - top.a) * below[i]);
const groundOf = element => {
  if (!element) return [255, 255, 255];
  const own = parts(getComputedStyle(element).backgroundColor);
  return own.a === 1 ? own.rgb : over(own, groundOf(element.parentElement));
};
const judge = scheme => {
  document.documentElement.dataset.theme = scheme;
  const wrong = [];
  let least = 21;
  for (const element of document.querySelectorAll("body *")) {
    const text = [...element.childNodes].filter(node => node.nodeType === 3).map(node => node.textContent.trim()).join(" ").trim();
    const style = getComputedStyle(element);
    if (!text || ["SCRIPT", "STYLE", "NOSCRIPT", "OPTION"].includes(element.tagName) || !element.checkVisibility({ visibilityProperty: true })) continue;
    const svg = element instanceof SVGElement;
    const ground = groundOf(element), ink = over(parts(svg ? style.fill : style.color), ground), size = parseFloat(style.fontSize);
    const found = contrast(ink, ground), large = size >= 24 || size >= 18.66 && style.fontWeight >= 700;
    least = Math.min(least, found);
    if (found < (large ? 3 : 4.5)) wrong.push(`${found.toFixed(2)} for "${text.slice(0, 30)}"`);
  }
  const probe = document.body.appendChild(document.createElement("i"));
  for (const name of ["camera", "reflected", "transmitted", "scattered", "lit", "shadowed"]) {
    probe.style.color = `var(--ray-${name})`;
    const found = contrast(parts(getComputedStyle(probe).color).rgb, groundOf(document.body));
    if (found < 3) wrong.push(`${found.toFixed(2)} for lines of ${name}`);
  }
  probe.remove();
  const width = document.documentElement.scrollWidth;
  if (width > innerWidth) wrong.push(`${width} pixels wide`);
  return `${innerWidth} ${scheme}: ${wrong.length ? wrong.slice(0, 5).join(", ") : `readable, least contrast ${least.toFixed(2)}`}`;
};
window.addEventListener("error", e => parent.postMessage(`ERROR ${e.message}`, "*"));
// Colours change at once.
document.head.append(Object.assign(document.createElement("style"), { textContent: "* { transition: none !important }" }));
setTimeout(() => {
  document.querySelectorAll("details").forEach(details => details.open = true);
  parent.postMessage(["light", "dark"].map(judge).join("; "), "*");
}, 500);
"#;

/// Writes a copy of a page with a script added at its end.
fn put_with(folder: &TestFolder, page: &str, name: &str, script: &str) {
    let text = String::from_utf8(folder.bytes(page)).unwrap();
    let end = text.rfind("</body>").unwrap();
    folder.write(name, format!("{}<script>{script}</script>{}", &text[..end], &text[end..]));
}

/// Returns the title of a page after a script at the end of the page has run.
#[track_caller]
fn title_of(folder: &TestFolder, chromium: &Path, page: &str, name: &str, script: &str) -> String {
    let text = String::from_utf8(folder.bytes(page)).unwrap();
    // The namespaces of XML are URLs, but they are never loaded.
    let links = text.replace("http://www.w3.org/", "");
    assert!(!links.contains("http://") && !links.contains("https://"), "{page} names an address");
    put_with(folder, page, name, script);
    let run = Command::new("timeout")
        .arg("60")
        .arg(chromium)
        .args(["--no-sandbox", "--headless=new", "--disable-gpu", "--virtual-time-budget=4000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", folder.path("browser").display()))
        .arg(format!("file://{}", folder.path(name).display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&run.stdout);
    let title = dom.split("<title>").nth(1).and_then(|rest| rest.split("</title>").next()).unwrap_or("");
    assert!(title.starts_with("SEEN "), "{title}\n{}", String::from_utf8_lossy(&run.stderr));
    title.into()
}
