use super::*;
use crate::layout::LAYOUTS;
use naga::TypeInner;
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn parse(kernel: Kernel) -> naga::Module {
    let source = kernel.source();
    naga::front::wgsl::parse_str(&source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&source)))
}

#[test]
fn naga_accepts_all_kernels() {
    for kernel in Kernel::ALL {
        let module = parse(kernel);
        // No capability beyond those of WebGPU is needed.
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        if let Err(error) = validator.validate(&module) {
            panic!("{kernel:?}: {}", error.emit_to_string(&kernel.source()));
        }
        assert!(module.entry_points.iter().any(|entry| entry.name == kernel.entry_point()), "{kernel:?}");
    }
}

#[test]
fn structs_have_the_same_layout_in_rust_and_wgsl() {
    let mut compared = 0;
    for kernel in Kernel::ALL {
        let module = parse(kernel);
        for layout in LAYOUTS {
            let named = module.types.iter().find(|(_, kind)| kind.name.as_deref() == Some(layout.name));
            let Some((_, naga::Type { inner: TypeInner::Struct { members, span }, .. })) = named else { continue };
            assert_eq!(*span as usize, layout.size, "{}", layout.name);
            assert_eq!(members.len(), layout.fields.len(), "{}", layout.name);
            for (member, field) in members.iter().zip(layout.fields) {
                assert_eq!((member.name.as_deref(), member.offset as usize), (Some(field.name), field.offset));
                compared += 1;
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn each_file_is_a_module_of_a_kernel() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/wgsl");
    for file in std::fs::read_dir(folder).unwrap() {
        let name = file.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
        let has = |kernel: &Kernel| kernel.modules().iter().any(|module| module.0 == name);
        assert!(Kernel::ALL.iter().any(has), "{name} is not used");
    }
}
