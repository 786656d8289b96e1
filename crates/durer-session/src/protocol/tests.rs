use super::*;
use crate::{DrawnScene, ExplainedSample, TermCast};
use std::path::Path;
use ts_rs::TS;

/// Returns the TypeScript types in the order of the protocol's files.
fn typescript() -> String {
    macro_rules! declarations {
        ($($type:ty),+ $(,)?) => { [$(<$type>::decl()),+] };
    }
    let all = declarations![
        RequestMessage,
        EventMessage,
        Request,
        Event,
        Setting,
        Motion,
        NamedChoice,
        TextPosition,
        Severity,
        Finding,
        TextEdit,
        SceneSummary,
        JobState,
        SceneItem,
        CameraState,
        FieldState,
        MistakeChoice,
        PictureInfo,
        FormulaRow,
        Segment,
        SegmentKind,
        Term,
        PixelExplanation,
        Verdict,
        ObjectTest,
        CastResult,
        CastHit,
        Outline,
        LightMarker,
        Structure,
        CameraRay,
        TraversalTest,
        TraversalStep,
        Traversal,
        TreeBox,
        SceneNode,
        MaterialState,
        Keyword,
        KeywordField,
        DrawnScene,
        TermCast,
        ExplainedSample,
    ];
    let head = "// Written by `DURER_WRITE=1 cargo test -p durer-session` from crates/durer-session/src/protocol.rs.\n";
    let types: Vec<String> = all.iter().map(|declaration| format!("export {declaration}\n")).collect();
    format!("{head}\n{}", types.join("\n"))
}

#[test]
fn typescript_types_match_the_protocol() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/src/protocol.ts");
    let wanted = typescript();
    if std::env::var_os("DURER_WRITE").is_some() {
        std::fs::write(&path, &wanted).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(there == wanted, "web/src/protocol.ts is stale: DURER_WRITE=1 cargo test -p durer-session");
}

#[test]
fn answer_is_encoded_as_length_json_and_payload() {
    let answer = EventMessage { session: 3, id: 7, event: Event::Saved };
    let bytes = answer.encode(&[1, 2, 3]);
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    assert_eq!(&bytes[4 + length..], [1, 2, 3]);
    let (read, payload) = EventMessage::decode(&bytes).unwrap();
    assert_eq!((read.session, read.id), (3, 7));
    assert!(matches!(read.event, Event::Saved));
    assert_eq!(payload, [1, 2, 3]);
    assert!(EventMessage::decode(&bytes[..length]).is_none());
}
