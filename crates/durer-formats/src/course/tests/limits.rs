//! Tests of strict mode and of limits.

use super::*;

fn findings(text: &str, dialect: Dialect) -> Vec<String> {
    read_as(text.as_bytes(), dialect, false).1
}

#[test]
fn strict_reading_allows_only_the_course_language() {
    let strict = |text: &str, dialect| read_as(text.as_bytes(), dialect, true).1;
    let ball = "Sphere { center 0 0 0 radius 1 }";
    for (dialect, text, expected) in [
        (
            Dialect::F04,
            "Group { numObjects 0 } # by me".to_string(),
            "1:24 error: the course's language has no comments [# by me]",
        ),
        (Dialect::F04, "Group{ numObjects 0 }".into(), "1:6 error: there must be a space before `{` [{]"),
        (Dialect::F04, "Group {numObjects 0 }".into(), "1:7 error: there must be a space after `{` [{]"),
        (
            Dialect::F04,
            "Materials { numMaterials 1 Material { shininess 1 } }".into(),
            "1:39 error: `shininess` is not a word of f04, but of f12a4, f12a5, f16, f23, durer [shininess]",
        ),
        (
            Dialect::F16,
            "OrthographicCamera { center 0 0 0 direction 0 0 1 up 0 1 0 size 1 }".into(),
            "1:1 error: `OrthographicCamera` is not a word of f16, but of f03, f04, durer [OrthographicCamera]",
        ),
        (
            Dialect::F04,
            "Group { numObjects 1 Sphere { radius 1 center 0 0 0 } }".into(),
            "1:40 error: `center` must be written earlier in `Sphere` [center]",
        ),
        (
            Dialect::F04,
            "Lights { numLights 1 PointLight { color 1 1 1 position 0 0 0 } }".into(),
            "1:47 error: `position` must be written earlier in `PointLight` [position]",
        ),
        (Dialect::F04, format!("Group {{ {ball} }}"), "1:1 error: `Group` has no `numObjects` [Group]"),
        (
            Dialect::F04,
            format!("Group {{ {ball} numObjects 1 }}"),
            "1:42 error: `numObjects` must come first in `Group` [numObjects]",
        ),
        (
            Dialect::F04,
            "Group { numObjects 0 } Materials { numMaterials 0 }".into(),
            "1:24 error: `Materials` must come before `Group` [Materials]",
        ),
        (
            Dialect::Durer,
            "Group { numObjects 1 Xor { numObjects 0 } }".into(),
            "1:22 error: `Xor` is a Dürer extension, not a word of the course's language [Xor]",
        ),
        (
            Dialect::F04,
            "Group { numObjects 1 HeightField { } }".into(),
            "1:22 error: `HeightField` is a Dürer extension, not a word of the course's language [HeightField]",
        ),
        (
            Dialect::F12a4,
            format!("Group {{ numObjects 1 Transform {{ Translate {{ 1 2 3 }} {ball} }} }}"),
            "1:44 error: `Translate {` is not a word of f12a4, but of f03 [{]",
        ),
    ] {
        assert_eq!(strict(&text, dialect), [expected]);
    }
    // A brace can follow a number without a space, as it does in one of the course's scenes.
    assert_eq!(strict("Materials { numMaterials 1 Material { exponent 20} }", Dialect::F04), [""; 0]);
}

#[test]
fn at_most_twenty_errors_are_reported() {
    for text in
        ["Foo { } ".repeat(1000), "} ".repeat(1000), "{ } ".repeat(1000), "Group { Sphere { radius x } } ".repeat(1000)]
    {
        assert_eq!(findings(&text, Dialect::F04).iter().filter(|f| f.contains("error")).count(), 20, "{}", &text[..20]);
    }
    assert_eq!(findings(&"Node { x } ".repeat(1000), Dialect::F23).len(), 20);
}

#[test]
fn deep_nesting_is_an_error_and_fast() {
    let start = std::time::Instant::now();
    for (dialect, head, level) in [
        (Dialect::F04, "", "Group { "),
        (Dialect::F04, "Group { ", "Transform { Scale 1 1 1 "),
        (Dialect::F04, "Group { ", "Group { Transform { "),
        (Dialect::F23, "Scene { ", "Node { "),
        (Dialect::F04, "Background ", "{ "),
        (Dialect::F04, "Foo ", "{ "),
    ] {
        let text = format!("{head}{}", level.repeat(1_000_000));
        let found = findings(&text, dialect);
        assert!(!found.is_empty() && found.len() <= 2, "{level}: {found:?}");
        let closed = format!("{text}{}", "} ".repeat(2_000_001));
        assert!(findings(&closed, dialect).len() <= 20);
    }
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
    let nested = |depth: usize| format!("{}{}", "Group { ".repeat(depth), "} ".repeat(depth));
    assert_eq!(findings(&nested(200), Dialect::F04), [""; 0]);
    assert_eq!(
        findings(&nested(300), Dialect::F04),
        ["1:1609 error: objects are nested more than 200 levels deep [Group]"]
    );
}

#[test]
fn error_about_a_long_word_is_short() {
    let found = findings(&"x".repeat(10_000_000), Dialect::F04);
    assert_eq!(found.len(), 1);
    let message = found[0].split('[').next().unwrap();
    assert!(message.len() < 200, "{message}");
    let found = findings(&format!("Background {{ color {} }}", "1".repeat(1_000_000)), Dialect::F04);
    assert!(found[0].contains("is too large a number") && found[0].split('[').next().unwrap().len() < 200);
}
