use super::*;

#[test]
fn findings_beyond_the_limit_are_counted_also_in_another_collection() {
    let mut own = Diagnostics::default();
    for _ in 0..ERROR_LIMIT + 5 {
        own.push(Diagnostic::error("wrong"));
    }
    own.push(Diagnostic::note("by the way"));
    let mut all = Diagnostics::default();
    all.push(Diagnostic::error("first"));
    all.extend(own);
    assert_eq!(all.error_count(), ERROR_LIMIT + 6);
    let errors = all.iter().filter(|d| d.severity == Severity::Error).count();
    assert_eq!((errors, all.iter().count()), (ERROR_LIMIT, ERROR_LIMIT + 1));
}

#[test]
fn columns_are_characters() {
    let mut files = Files::default();
    let text = "\u{feff}\u{e4}\u{f6} x\n\u{2026}\u{1d11e}y";
    let file = files.add("a", text.as_bytes().into());
    let at = |what: char| {
        let start = text.find(what).unwrap() as u32;
        files.position(Span { file, start, end: start + 1 })
    };
    assert_eq!((at('\u{e4}'), at('x'), at('y')), (Some((1, 1)), Some((1, 4)), Some((2, 3))));
}

#[test]
fn large_files_keep_what_is_said_of_them() {
    let mut files = Files::default();
    let small = files.add("small", vec![b'\n'; 1 << 10].into());
    let large = files.add("large", vec![b'\n'; Files::SMALL + 1].into());
    let mut messages = Diagnostics::default();
    messages.push(Diagnostic::warning("odd").at(Span { file: large, start: 5000, end: 5002 }));
    files.truncate(small, 0, &messages);
    assert_eq!(files.complete_bytes(small).map(<[u8]>::len), Some(1 << 10));
    files.truncate(large, 10, &messages);
    assert_eq!((files.complete_bytes(large), files.bytes(large).map(<[u8]>::len)), (None, Some(5002 + 256)));
    assert_eq!(files.position(Span { file: large, start: 5000, end: 5002 }), Some((5001, 1)));
}

#[test]
fn what_is_meant_is_near_or_of_the_same_letters() {
    let words = ["Rotate", "XRotate", "YRotate", "Scale", "Translate"];
    let suggestion = |word| did_you_mean(word, words);
    assert_eq!(suggestion("RotateY"), Some("YRotate"));
    assert_eq!(suggestion("rotate"), Some("Rotate"));
    assert_eq!(suggestion("Rotat"), Some("Rotate"));
    assert_eq!(suggestion("Tanslate"), Some("Translate"));
    assert_eq!(suggestion("Sphere"), None);
}
