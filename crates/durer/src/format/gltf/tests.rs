//! glTF files against what the Khronos validator says of them.
