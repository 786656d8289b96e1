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
