//! The files of the page, as they were built from `web/`.

macro_rules! files {
    ($($name:literal),+ $(,)?) => {
        /// Names and bytes.
        const FILES: &[(&str, &[u8])] = &[$(($name, include_bytes!(concat!("../../../web/dist/", $name)))),+];
    };
}

files![
    "index.html",
    "index.js",
    "index.css",
    "wasm-worker.js",
    "inter-latin-wght-normal.woff2",
    "inter-latin-ext-wght-normal.woff2",
    "inter-greek-wght-normal.woff2",
];

/// A file of the page, and its type.
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

/// The page, with the mark that a server is behind it.
pub(crate) fn index() -> Vec<u8> {
    let html = String::from_utf8_lossy(file("").map_or(&[][..], |found| found.0));
    html.replacen("<head>", "<head>\n    <meta name=\"durer-server\" content=\"1\" />", 1).into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_names_no_file_that_is_not_there() {
        let text = String::from_utf8(index()).unwrap();
        assert!(text.contains("durer-server"));
        for part in text.split(['"', '\'']).filter_map(|part| part.strip_prefix("./")) {
            assert!(file(part).is_some(), "{part}");
        }
    }

    #[test]
    fn nothing_else_can_be_had() {
        for path in ["../Cargo.toml", "/etc/passwd", "index.html/..", "INDEX.HTML", "wasm/durer_wasm.js"] {
            assert!(file(path).is_none(), "{path}");
        }
    }
}
