//! The files of the web page, which are built from `web/`.

macro_rules! files {
    ($($name:literal),+ $(,)?) => {
        /// Names and contents of the files of the page.
        const FILES: &[(&str, &[u8])] = &[$(($name, include_bytes!(concat!("../../../web/dist/", $name)))),+];
    };
}

files![
    "index.html",
    "index.js",
    "index.css",
    "lecture-page.js",
    "wasm-worker.js",
    "inter-latin-wght-normal.woff2",
    "inter-latin-ext-wght-normal.woff2",
    "inter-greek-wght-normal.woff2",
];

/// Returns the contents and the media type of a file that belongs to the page.
pub(crate) fn file(path: &str) -> Option<(&'static [u8], &'static str)> {
    let name = if path.is_empty() { "index.html" } else { path };
    let (name, bytes) = FILES.iter().find(|(known, _)| *known == name)?;
    let kind = match name.rsplit_once('.')?.1 {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "woff2" => "font/woff2",
        _ => "application/octet-stream",
    };
    Some((bytes, kind))
}

/// Returns the HTML page with a marker that makes the page connect to this server.
pub(crate) fn index() -> Vec<u8> {
    let html = String::from_utf8_lossy(file("").map_or(&[][..], |found| found.0));
    html.replacen("<head>", "<head>\n    <meta name=\"durer-server\" content=\"1\" />", 1).into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn page_refers_to_existing_files_only() {
        let text = String::from_utf8(index()).unwrap();
        assert!(text.contains("durer-server"));
        for part in text.split(['"', '\'']).filter_map(|part| part.strip_prefix("./")) {
            assert!(file(part).is_some(), "{part}");
        }
    }

    #[test]
    fn all_built_files_are_served_and_cached() {
        let web = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web");
        let offline = std::fs::read_to_string(web.join("playground/offline.js")).unwrap();
        for entry in std::fs::read_dir(web.join("dist")).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            assert!(file(&name).is_some(), "{name}");
            assert!(offline.contains(&format!("\"{name}\"")), "{name}");
        }
    }

    #[test]
    fn other_paths_are_not_served() {
        for path in ["../Cargo.toml", "/etc/passwd", "index.html/..", "INDEX.HTML", "wasm/durer_wasm.js"] {
            assert!(file(path).is_none(), "{path}");
        }
    }
}
