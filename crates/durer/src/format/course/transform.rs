//! Transforms: matrices, then one object.

use super::lexer::TokenKind;
use super::reader::Reader;
use crate::diag::{Diagnostic, Span};
use crate::dialect::{Dialect, set};
use crate::math::Vec3;
use crate::scene::{MatrixOp, Node};

const MATRICES: [&str; 8] = ["Translate", "Scale", "UniformScale", "XRotate", "YRotate", "ZRotate", "Rotate", "Matrix"];

impl Reader<'_, '_> {
    /// `Transform { matrix ... object }`.
    pub(super) fn transform(&mut self, keyword: Span) -> Option<Node> {
        if !self.open("Transform") {
            return None;
        }
        let mut ops = Vec::new();
        let mut object = None;
        while let Some((word, span)) = self.word_before_close("Transform") {
            if let Some(op) = self.matrix(&word, span) {
                if object.is_some() {
                    let message = "a transform's matrices come before its object";
                    self.error(Diagnostic::error(message).at(span));
                }
                ops.extend(op);
            } else if word == "MaterialIndex" {
                let error = Diagnostic::error("`MaterialIndex` cannot stand in a `Transform`").at(span);
                self.error(error.help("write it before the `Transform`"));
                self.whole(&word);
            } else if object.is_none() {
                object = self.object(&word, span);
            } else {
                let error = Diagnostic::error("a `Transform` has exactly one object").at(span);
                self.error(error.help("put several objects into a `Group`"));
                self.object(&word, span);
            }
        }
        if object.is_none() && !self.diagnostics.has_errors() {
            self.error(Diagnostic::error("this `Transform` has no object").at(keyword));
        }
        Some(Node::Transform(ops, Box::new(object?)))
    }

    /// The matrices of a block whose `{` is read.
    pub(super) fn matrices(&mut self, block: &str) -> Vec<MatrixOp> {
        let mut ops = Vec::new();
        while let Some((word, span)) = self.word_before_close(block) {
            match self.matrix(&word, span) {
                Some(op) => ops.extend(op),
                None => self.unknown(&word, span, "among matrices", &MATRICES),
            }
        }
        ops
    }

    /// A matrix, if the word begins one; the inner `None` after an error.
    pub(super) fn matrix(&mut self, word: &str, span: Span) -> Option<Option<MatrixOp>> {
        let braces_needed = matches!(word, "Rotate" | "Matrix" | "Matrix4f");
        if !braces_needed && !MATRICES.contains(&word) {
            return None;
        }
        let opens = self.peek().is_some_and(|t| t.kind == TokenKind::Open);
        if braces_needed && !self.open(word) {
            return Some(None);
        }
        if opens && !braces_needed {
            let open = self.advance();
            self.foreign(&format!("{word} {{"), open, set::F03);
        }
        let op = self.matrix_values(word);
        if opens {
            self.close(word);
        }
        if let Some(MatrixOp::Scale(v)) = op
            && v.min_element() * v.max_element() == 0.0
        {
            let message = "a scale by 0 flattens space, which cannot be undone";
            self.error(Diagnostic::error(message).at(span.to(self.last_span())));
        }
        Some(op)
    }

    fn matrix_values(&mut self, word: &str) -> Option<MatrixOp> {
        Some(match word {
            "Translate" => MatrixOp::Translate(self.vec3(word)?),
            "Scale" => MatrixOp::Scale(self.vec3(word)?),
            "UniformScale" => MatrixOp::UniformScale(self.number(word, 1, 1)?),
            "XRotate" => MatrixOp::XRotate(self.number(word, 1, 1)?),
            "YRotate" => MatrixOp::YRotate(self.number(word, 1, 1)?),
            "ZRotate" => MatrixOp::ZRotate(self.number(word, 1, 1)?),
            "Rotate" => {
                let axis: Vec3 = self.vec3(word)?;
                MatrixOp::Rotate(axis, self.number(word, 1, 1)?)
            }
            _ => {
                let mut rows = [0.0; 16];
                for (i, value) in rows.iter_mut().enumerate() {
                    *value = self.number(word, i + 1, 16)?;
                }
                // 2004 lists rows; `Matrix4f`, and `Matrix` of later years, columns.
                let rows_listed =
                    word == "Matrix" && matches!(self.options.dialect, Dialect::F03 | Dialect::F04 | Dialect::Durer);
                MatrixOp::Matrix(if rows_listed { rows } else { std::array::from_fn(|i| rows[i % 4 * 4 + i / 4]) })
            }
        })
    }

    /// Expects `}`, and passes over what is before it.
    fn close(&mut self, block: &str) {
        if self.peek().is_some_and(|t| t.kind == TokenKind::Close) {
            self.advance();
            return;
        }
        self.expected("`}`", block);
        while let Some(token) = self.peek() {
            self.advance();
            if token.kind == TokenKind::Close {
                return;
            }
        }
    }
}
