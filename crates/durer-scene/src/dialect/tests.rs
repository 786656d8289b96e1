use super::*;

#[test]
fn table_rows_match_their_dialects() {
    let names = ["f03", "f04", "f12a4", "f12a5", "f16", "f23", "durer"];
    for (i, (dialect, name)) in Dialect::ALL.into_iter().zip(names).enumerate() {
        assert_eq!(dialect as u8, 1 << i);
        assert_eq!(dialect.name(), name);
        assert_eq!(Dialect::from_name(name), Some(dialect));
        assert_eq!(serde_json::to_string(&dialect).unwrap(), format!("\"{name}\""));
        assert!(dialect.is_in(set::ALL));
    }
    assert_eq!(Dialect::from_name("F04"), None);
    assert_eq!(set::ALL, 127);
}

#[test]
fn compatibilities_have_unique_names_and_bits() {
    for (i, (compat, name, doc)) in Quirk::ALL.iter().enumerate() {
        assert_eq!(Quirk::from_name(name), Some(*compat));
        assert_eq!(compat.bit(), 1 << i);
        assert!(doc.trim().ends_with('.'), "{name}");
        assert_eq!(Quirk::ALL.iter().filter(|row| row.1 == *name).count(), 1, "{name}");
    }
    assert_eq!(Quirk::from_name("no-such-bug"), None);
}

#[test]
fn sane_rules_have_no_old_bugs() {
    for dialect in Dialect::ALL {
        let sane = dialect.rules().without_quirks();
        assert_eq!(sane.quirks, 0);
        assert_eq!((sane.epsilon, sane.paths), (None, PathBase::SceneFile));
        assert_eq!(sane.without_quirks(), sane, "{}", sane.name);
        assert_eq!(sane.name, dialect.name());
    }
    assert_eq!(Dialect::Durer.rules().without_quirks(), *Dialect::Durer.rules());
}
