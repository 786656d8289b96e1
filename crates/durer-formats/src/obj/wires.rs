//! Reads the lines and points of a Wavefront file, which have no surface.

use super::Statement;
use super::faces::index;
use super::words::Words;
use crate::report::Report;
use std::collections::BTreeMap;
use std::ops::Range;

/// Lines and points of a Wavefront file that share one material.
#[derive(Default)]
pub(super) struct LinesAndPoints {
    /// Byte range where the name of the material occurs, or an empty range if there is no material.
    pub(super) material: Range<usize>,
    /// Pairs of vertex indices.
    pub(super) lines: Vec<[u32; 2]>,
    pub(super) points: Vec<u32>,
}

/// Reader of the line and point statements `l` and `p` of a Wavefront file.
pub(super) struct WireReader<'a> {
    pub(super) bytes: &'a [u8],
    /// Number of vertices in the whole file, and the number of them before the current statement.
    pub(super) vertices: [usize; 2],
    /// Byte range of the name of the current material.
    pub(super) material: Range<usize>,
    /// Lines and points grouped by material, in the order in which the materials are first used.
    pub(super) groups: Vec<LinesAndPoints>,
    numbers: BTreeMap<&'a [u8], usize>,
}

impl<'a> WireReader<'a> {
    /// Creates a reader for a file that contains this many vertices.
    pub(super) fn new(bytes: &'a [u8], vertices: usize) -> Self {
        WireReader { bytes, vertices: [vertices, 0], material: 0..0, groups: Vec::new(), numbers: BTreeMap::new() }
    }

    /// Reads the vertices of an `l` or `p` statement.
    pub(super) fn read(&mut self, kind: Statement, words: &mut Words, report: &mut Report) {
        let number = *self.numbers.entry(&self.bytes[self.material.clone()]).or_insert_with(|| {
            self.groups.push(LinesAndPoints { material: self.material.clone(), ..LinesAndPoints::default() });
            self.groups.len() - 1
        });
        let wires = &mut self.groups[number];
        let mut last = None;
        while let Some(word) = words.next_word() {
            // Ignore the texture coordinate, because a stick has none.
            let length = self.bytes[word.clone()].iter().position(|&byte| byte == b'/').unwrap_or(word.len());
            let at = word.start..word.start + length;
            let Some(vertex) = index(self.bytes, at, 0, self.vertices, report) else { return };
            match kind {
                Statement::Point => wires.points.push(vertex),
                _ => wires.lines.extend(last.replace(vertex).map(|last| [last, vertex])),
            }
        }
    }
}
