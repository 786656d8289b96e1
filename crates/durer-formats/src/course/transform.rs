//! Reads transforms, which consist of matrices followed by one object.

use super::lexer::TokenKind;
use super::reader::Reader;
use super::sections::object_words;
use super::words::block_of;
use durer_diag::{Diagnostic, Span};
use durer_scene::dialect::{Dialect, set};
use durer_scene::math::Vec3;
use durer_scene::scene::{MatrixOp, ObjectKind};

impl Reader<'_, '_> {
    /// Reads `Transform { matrix ... object }`.
    pub(super) fn transform(&mut self, keyword: Span) -> Option<ObjectKind> {
        let errors = self.errors();
        if !self.open(keyword) {
            return None;
        }
        let (mut ops, mut object, mut objects) = (Vec::new(), None, 0);
        let mut late = false;
        while let Some((word, span)) = self.word_before_close() {
            if let Some(op) = self.matrix(&word, span) {
                if objects > 0 && !late {
                    late = true;
                    let message = "the matrices of a `Transform` must come before its object";
                    self.error(Diagnostic::error(message).at(span));
                }
                self.check_flat(op, span);
                ops.extend(op);
            } else if word == "MaterialIndex" {
                let error = Diagnostic::error("`MaterialIndex` is not allowed in a `Transform`").at(span);
                self.error(error.help("write `MaterialIndex` before the `Transform`"));
                self.skip_value();
            } else if block_of(&word) != Some("Group") {
                let known: Vec<&str> = MatrixOp::words().into_iter().chain(object_words()).collect();
                self.unknown(&word, span, "in a transform", &known);
            } else {
                objects += 1;
                if objects == 2 {
                    let message = "a `Transform` can contain only one object";
                    if self.unclosed_by_indentation(message) {
                        break;
                    }
                    let error = Diagnostic::error(message).at(span);
                    self.error(error.help("put several objects into a `Group`"));
                }
                let read = self.object(&word, span);
                object = object.or(read);
            }
        }
        if object.is_none() && self.errors() == errors {
            let error = Diagnostic::error("this `Transform` has no object").code("missing-field").at(keyword);
            self.error(
                error.help("write the object after its matrices: `Transform { Translate 0 1 0 Sphere { ... } }`"),
            );
        }
        Some(ObjectKind::Transform(ops, Box::new(object?)))
    }

    /// Reads the matrices of a block whose `{` has already been read.
    pub(super) fn matrices(&mut self) -> Vec<MatrixOp> {
        let mut ops = Vec::new();
        while let Some((word, span)) = self.word_before_close() {
            match self.matrix(&word, span) {
                Some(op) => ops.extend(op),
                None => self.unknown(&word, span, "among matrices", &MatrixOp::words()),
            }
        }
        ops
    }

    /// Reports a single matrix that flattens space.
    pub(super) fn check_flat(&mut self, op: Option<MatrixOp>, span: Span) {
        if let Some(error) = op.and_then(flat_matrix_error) {
            let at = span.join(self.last_span());
            if self.accepts_any_values() {
                let warning = Diagnostic::warning(error.message).code("flat-transform").at(at);
                return self
                    .diagnostics
                    .push(warning.effect("the matrix is applied anyway, as in the official program"));
            }
            self.error(error.at(at));
        }
    }

    /// Reads a matrix if it begins with the given word. The inner `None` means that an error was
    /// reported.
    pub(super) fn matrix(&mut self, word: &str, span: Span) -> Option<Option<MatrixOp>> {
        let braces_needed = matches!(word, "Rotate" | "Matrix" | "Matrix4f");
        if !braces_needed && !MatrixOp::words().contains(&word) {
            return None;
        }
        let errors = self.errors();
        let opens = self.at_open();
        if opens {
            let open = self.advance();
            if !braces_needed {
                self.report_foreign_word(&format!("{word} {{"), open, set::F03);
            }
        } else if braces_needed {
            if word == "Rotate" && self.rotate_without_braces(span) {
                return Some(None);
            }
            self.expected("`{`", word);
        } else if word == "Scale" && self.scale_by_one(span) {
            return Some(None);
        }
        let known = self.errors();
        let op = self.matrix_values(word);
        if op.is_none() {
            self.skip_values();
        }
        if opens {
            // Errors inside the braces have already been reported.
            self.close(word, self.errors() == known);
        }
        if self.errors() == errors
            && let Some(error) = op.and_then(invalid_matrix_error)
        {
            self.error(error.at(span.join(self.last_span())));
        }
        Some(op)
    }

    /// Returns how many numbers follow, and the span of the last one.
    fn numbers_ahead(&self) -> (usize, Span) {
        let number = |i: usize| self.ahead(i).filter(|t| self.text(t.span).parse::<f32>().is_ok());
        let count = (0..17).take_while(|i| number(*i).is_some()).count();
        (count, number(count.saturating_sub(1)).map_or(self.last_span(), |token| token.span))
    }

    /// Reports `Rotate 0 1 0 45`, in which the braces are missing, and skips the numbers.
    fn rotate_without_braces(&mut self, word: Span) -> bool {
        let (count, last) = self.numbers_ahead();
        if count != 4 && count != 1 {
            return false;
        }
        let whole = word.join(last);
        let numbers = self.text(Span { start: word.end, ..whole }).trim().to_string();
        let error = Diagnostic::error("`Rotate` needs braces around its axis and angle").code("syntax").at(whole);
        self.error(match count {
            4 => error.help(format!("write `Rotate {{ {numbers} }}`")).fix(whole, format!("Rotate {{ {numbers} }}")),
            _ => error.help(format!(
                "for rotation about one axis, write `XRotate {numbers}`, `YRotate {numbers}` or `ZRotate {numbers}`"
            )),
        });
        for _ in 0..count {
            self.advance();
        }
        true
    }

    /// Reports `Scale 2`, which has only one number, and skips the number.
    fn scale_by_one(&mut self, word: Span) -> bool {
        let (count, last) = self.numbers_ahead();
        // Incomplete values, and words in the place of numbers, cause errors of their own.
        let ends = |text: &str| text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '}');
        if count != 1 || !self.ahead(1).is_some_and(|next| ends(&self.text(next.span))) {
            return false;
        }
        let number = self.text(last);
        let error =
            Diagnostic::error("`Scale` takes three numbers, one for each axis").code("syntax").at(word.join(last));
        self.error(
            error
                .help(format!("for the same scale along all axes, write `UniformScale {number}`"))
                .fix(word, "UniformScale"),
        );
        self.advance();
        true
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
                // In 2003 and 2004, `Matrix` lists the rows of the matrix. `Matrix4f` and the
                // `Matrix` of later years list the columns.
                let rows_listed =
                    word == "Matrix" && matches!(self.options.dialect, Dialect::F03 | Dialect::F04 | Dialect::Durer);
                MatrixOp::Matrix(if rows_listed { rows } else { std::array::from_fn(|i| rows[i % 4 * 4 + i / 4]) })
            }
        })
    }

    /// Requires `}` as the next token, after skipping any values before it. If a word of the
    /// language comes before the `}`, the `}` is missing.
    fn close(&mut self, block: &str, complain: bool) {
        if complain && self.peek().is_none_or(|t| t.kind != TokenKind::Close) {
            self.expected("`}`", block);
        }
        self.skip_values();
        if self.peek().is_some_and(|t| t.kind == TokenKind::Close) {
            self.advance();
        }
    }
}

/// Returns an error if a matrix flattens space.
pub(crate) fn flat_matrix_error(op: MatrixOp) -> Option<Diagnostic> {
    let flat = match op {
        MatrixOp::Scale(v) => v.to_array().contains(&0.0),
        MatrixOp::UniformScale(s) => s == 0.0,
        _ => false,
    };
    let error =
        Diagnostic::error("a scale factor of 0 flattens space: the transform has no inverse").code("flat-transform");
    flat.then(|| error.help("use a factor of 1 along axes that keep their size"))
}

/// Returns an error if the values of a complete matrix are not valid.
pub(crate) fn invalid_matrix_error(op: MatrixOp) -> Option<Diagnostic> {
    match op {
        MatrixOp::Rotate(axis, _) if axis == Vec3::ZERO => Some(
            Diagnostic::error("the axis of a rotation must not be 0 0 0").help("write the axis first, then the angle"),
        ),
        MatrixOp::Matrix(rows) if rows[12..] != [0.0, 0.0, 0.0, 1.0] => {
            let error = Diagnostic::error("the last row of a matrix must be 0 0 0 1");
            Some(error.help("`Matrix` of 2003 and 2004 lists rows, `Matrix4f` lists columns"))
        }
        _ => None,
    }
}
