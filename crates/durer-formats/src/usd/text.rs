//! Parser of USD text files (`.usda`).
//!
//! Source: *OpenUSD specification*, "USDA file format".

use super::layer::{Layer, PrimSpec, RETIMED, Reference, Specifier, Value, child_path, variant_path};
use super::lexer::{Lexer, SyntaxError, Token};
use durer_diag::Span;
use std::collections::BTreeMap;

/// Maximum nesting depth of prims and of lists.
const MAX_DEPTH: usize = 128;

type Parsed<T> = Result<T, SyntaxError>;

/// Parses a text file. `file` is its number, for spans.
pub(super) fn parse(text: &str, file: u32, name: &str) -> Parsed<Layer> {
    let mut parser =
        Parser { lexer: Lexer::new(text, file), layer: Layer { name: name.to_string(), ..Layer::default() } };
    let mut root = PrimSpec { specifier: Specifier::Def, ..PrimSpec::default() };
    if parser.lexer.accept("(")? {
        parser.metadata(&mut root)?;
    }
    while parser.lexer.peek()? != Token::End {
        parser.prim_item("/", &mut root, 0)?;
    }
    parser.layer.prims.insert("/".into(), root);
    Ok(parser.layer)
}

/// Returns the error about an opening parenthesis that is not closed before `next`.
fn unclosed(open: Span, next: &str) -> SyntaxError {
    SyntaxError { at: open, message: format!("this `(` is not closed: a `)` is missing before {next}") }
}

struct Parser<'a> {
    lexer: Lexer<'a>,
    layer: Layer,
}

impl Parser<'_> {
    fn error<T>(&self, message: impl Into<String>) -> Parsed<T> {
        Err(SyntaxError { at: self.lexer.last(), message: message.into() })
    }

    fn name(&mut self, what: &str) -> Parsed<String> {
        match self.lexer.next()? {
            Token::Word(word) => Ok(word.to_string()),
            other => self.error(format!("expected {what}, found {other}")),
        }
    }

    fn string(&mut self, what: &str) -> Parsed<String> {
        match self.lexer.next()? {
            Token::Text(text) => Ok(text),
            other => self.error(format!("expected {what} in quotes, found {other}")),
        }
    }

    /// Parses a child prim, a property or a set of variants, and adds it to a prim.
    fn prim_item(&mut self, path: &str, prim: &mut PrimSpec, depth: usize) -> Parsed<()> {
        if depth > MAX_DEPTH {
            return self.error(format!("prims are nested more than {MAX_DEPTH} deep"));
        }
        let token = self.lexer.next()?;
        let at = self.lexer.last();
        match token {
            Token::Word("def") => self.prim(path, prim, Specifier::Def, at, depth),
            Token::Word("over") => self.prim(path, prim, Specifier::Over, at, depth),
            Token::Word("class") => self.prim(path, prim, Specifier::Class, at, depth),
            Token::Word("variantSet") => self.variant_set(path, prim, depth),
            Token::Word("reorder") => {
                // The order of children and properties has no effect on the picture.
                self.name("`nameChildren` or `properties`")?;
                self.lexer.expect("=")?;
                self.value(0).map(|_| ())
            }
            Token::Symbol(';') => Ok(()),
            Token::Word(word) if path != "/" => self.property(word.to_string(), prim, at),
            other => self.error(format!("expected `def`, `over` or `class`, found {other}")),
        }
    }

    fn prim(
        &mut self,
        parent: &str,
        siblings: &mut PrimSpec,
        specifier: Specifier,
        at: Span,
        depth: usize,
    ) -> Parsed<()> {
        let mut prim = PrimSpec { specifier, span: at, ..PrimSpec::default() };
        if let Token::Word(word) = self.lexer.peek()? {
            prim.type_name = word.to_string();
            self.lexer.next()?;
        }
        let name = self.string("the name of the prim")?;
        prim.span = Span { end: self.lexer.last().end, ..at };
        let path = child_path(parent, &name);
        if self.lexer.accept("(")? {
            self.metadata(&mut prim)?;
        }
        self.body(&path, &mut prim, depth)?;
        if self.layer.prims.insert(path.clone(), prim).is_some() {
            return Err(SyntaxError { at, message: format!("the prim `{path}` is defined twice") });
        }
        siblings.children.push(name);
        Ok(())
    }

    /// Parses the items of a prim between braces.
    fn body(&mut self, path: &str, prim: &mut PrimSpec, depth: usize) -> Parsed<()> {
        self.lexer.expect("{")?;
        while !self.lexer.accept("}")? {
            self.prim_item(path, prim, depth + 1)?;
        }
        Ok(())
    }

    fn variant_set(&mut self, path: &str, prim: &mut PrimSpec, depth: usize) -> Parsed<()> {
        let set = self.string("the name of the variant set")?;
        self.lexer.expect("=")?;
        self.lexer.expect("{")?;
        while !self.lexer.accept("}")? {
            let name = self.string("the name of a variant")?;
            let mut variant = PrimSpec { span: self.lexer.last(), ..PrimSpec::default() };
            if self.lexer.accept("(")? {
                self.metadata(&mut variant)?;
            }
            let variant_path = variant_path(path, &set, &name);
            self.body(&variant_path, &mut variant, depth)?;
            self.layer.prims.insert(variant_path, variant);
            prim.variants.entry(set.clone()).or_default().push(name);
        }
        Ok(())
    }

    /// Parses an attribute or a relationship; `first` is its first word.
    fn property(&mut self, first: String, prim: &mut PrimSpec, at: Span) -> Parsed<()> {
        let (mut word, mut operation) = (first, String::new());
        while matches!(word.as_str(), "prepend" | "append" | "add" | "delete" | "reorder") {
            operation = std::mem::replace(&mut word, self.name("a type")?);
        }
        while matches!(word.as_str(), "custom" | "uniform" | "varying" | "config") {
            word = self.name("a type")?;
        }
        if word != "rel" && self.lexer.accept("[")? {
            self.lexer.expect("]")?;
        }
        let full = self.name("the name of a property")?;
        let span = Span { end: self.lexer.last().end, ..at };
        let (name, aspect) = match full.rsplit_once('.') {
            Some((name, aspect @ ("timeSamples" | "connect" | "spline"))) => (name.to_string(), aspect),
            _ => (full.clone(), ""),
        };
        let mut property = prim.properties.remove(&name).unwrap_or_default();
        property.span = span;
        if self.lexer.accept("=")? {
            match (word.as_str(), aspect) {
                ("rel", _) | (_, "connect") => property.targets.add(&operation, self.paths()?),
                (_, "timeSamples") => property.samples = self.samples()?,
                (_, "spline") => self.skip_block()?,
                _ => property.value = Some(self.value(0)?),
            }
        }
        if self.lexer.accept("(")? {
            let mut fields = PrimSpec::default();
            self.metadata(&mut fields)?;
            property.metadata.extend(fields.metadata);
        }
        prim.properties.insert(name, property);
        Ok(())
    }

    /// Skips a block between braces.
    fn skip_block(&mut self) -> Parsed<()> {
        self.lexer.expect("{")?;
        let mut depth = 1;
        while depth > 0 {
            match self.lexer.next()? {
                Token::Symbol('{') => depth += 1,
                Token::Symbol('}') => depth -= 1,
                Token::End => return self.error("a `}` is missing"),
                _ => {}
            }
        }
        Ok(())
    }

    fn samples(&mut self) -> Parsed<Vec<(f64, Value)>> {
        self.lexer.expect("{")?;
        let mut samples = Vec::new();
        while !self.lexer.accept("}")? {
            let Token::Number(time) = self.lexer.next()? else { return self.error("expected a time") };
            self.lexer.expect(":")?;
            samples.push((time, self.value(0)?));
            self.lexer.accept(",")?;
        }
        samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(samples)
    }

    /// Parses a path or a list of paths.
    fn paths(&mut self) -> Parsed<Vec<String>> {
        match self.lexer.next()? {
            Token::Path(path) => Ok(vec![path]),
            Token::Word("None") => Ok(Vec::new()),
            Token::Symbol('[') => {
                let mut paths = Vec::new();
                while !self.lexer.accept("]")? {
                    match self.lexer.next()? {
                        Token::Path(path) => paths.push(path),
                        other => return self.error(format!("expected a path such as `</World>`, found {other}")),
                    }
                    self.lexer.accept(",")?;
                }
                Ok(paths)
            }
            other => self.error(format!("expected a path such as `</World>`, found {other}")),
        }
    }

    /// Parses the metadata of a prim, of a variant or of the layer, up to the closing parenthesis.
    fn metadata(&mut self, prim: &mut PrimSpec) -> Parsed<()> {
        let open = self.lexer.last();
        while !self.lexer.accept(")")? {
            if self.lexer.accept(";")? || self.lexer.accept(",")? {
                continue;
            }
            let word = match self.lexer.next()? {
                // A string without a name is a comment.
                Token::Text(_) => continue,
                Token::Word(word) => word.to_string(),
                Token::End => return Err(unclosed(open, "the end of the file")),
                Token::Symbol('{') => return Err(unclosed(open, "this `{`")),
                other => return self.error(format!("expected the name of a field, found {other}")),
            };
            // A prim cannot be in the metadata.
            if matches!(word.as_str(), "def" | "over" | "class")
                && matches!(self.lexer.peek()?, Token::Word(_) | Token::Text(_))
            {
                return Err(unclosed(open, &format!("`{word}`")));
            }
            let is_edit = matches!(word.as_str(), "prepend" | "append" | "add" | "delete" | "reorder");
            let (operation, field) = if is_edit { (word, self.name("a field")?) } else { (String::new(), word) };
            self.lexer.expect("=")?;
            match field.as_str() {
                "references" => prim.references.add(&operation, self.references()?),
                "payload" => prim.payloads.add(&operation, self.references()?),
                "inherits" => prim.inherits.add(&operation, self.paths()?),
                "specializes" => prim.specializes.add(&operation, self.paths()?),
                "apiSchemas" => prim.api_schemas.add(&operation, self.texts()?),
                "variantSets" => prim.variant_sets.add(&operation, self.texts()?),
                "variants" => {
                    if let Value::Dictionary(chosen) = self.dictionary(0)? {
                        let chosen = chosen.into_iter().filter_map(|(set, name)| Some((set, name.text()?.to_string())));
                        prim.selections.extend(chosen);
                    }
                }
                "subLayers" => {
                    let layers = self.references()?;
                    let is_retimed = layers.iter().any(|layer| layer.is_retimed);
                    prim.metadata.insert(RETIMED.into(), Value::Bool(is_retimed));
                    let names = layers.into_iter().map(|layer| layer.asset).collect();
                    prim.metadata.insert(field, Value::Texts(names));
                }
                _ => {
                    let value = self.value(0)?;
                    prim.metadata.insert(field, value);
                }
            }
        }
        Ok(())
    }

    /// Parses a string or a list of strings.
    fn texts(&mut self) -> Parsed<Vec<String>> {
        Ok(match self.value(0)? {
            Value::Texts(texts) => texts,
            Value::Text(text) => vec![text],
            _ => Vec::new(),
        })
    }

    /// Parses references, payloads or sublayers: one or a list of `@file@</prim> (offset)`.
    fn references(&mut self) -> Parsed<Vec<Reference>> {
        let mut all = Vec::new();
        if matches!(self.lexer.peek()?, Token::Word("None")) {
            self.lexer.next()?;
            return Ok(all);
        }
        let is_list = self.lexer.accept("[")?;
        loop {
            if is_list && self.lexer.accept("]")? {
                break;
            }
            let mut one = Reference::default();
            match self.lexer.next()? {
                Token::Asset(asset) => {
                    one.asset = asset;
                    if let Token::Path(path) = self.lexer.peek()? {
                        one.prim = path;
                        self.lexer.next()?;
                    }
                }
                Token::Path(path) => one.prim = path,
                other => return self.error(format!("expected a file such as `@a.usd@`, found {other}")),
            }
            if self.lexer.accept("(")? {
                let mut fields = PrimSpec::default();
                self.metadata(&mut fields)?;
                let is = |name: &str, usual: f64| fields.metadata.get(name).is_none_or(|x| x.number() == Some(usual));
                one.is_retimed = !(is("offset", 0.0) && is("scale", 1.0));
            }
            all.push(one);
            if !is_list {
                break;
            }
            self.lexer.accept(",")?;
        }
        Ok(all)
    }

    fn dictionary(&mut self, depth: usize) -> Parsed<Value> {
        self.lexer.expect("{")?;
        let mut entries = BTreeMap::new();
        while !self.lexer.accept("}")? {
            if self.lexer.accept(",")? || self.lexer.accept(";")? {
                continue;
            }
            // An entry is `type name = value`.
            let mut key = match self.lexer.next()? {
                Token::Word(word) => word.to_string(),
                Token::Text(text) => text,
                other => return self.error(format!("expected a type, found {other}")),
            };
            if self.lexer.accept("[")? {
                self.lexer.expect("]")?;
            }
            match self.lexer.peek()? {
                Token::Word(word) => key = word.to_string(),
                Token::Text(text) => key = text,
                _ => {}
            }
            if !matches!(self.lexer.peek()?, Token::Symbol('=' | ':')) {
                self.lexer.next()?;
            }
            if !self.lexer.accept("=")? {
                self.lexer.expect(":")?;
            }
            let value = self.value(depth + 1)?;
            entries.insert(key, value);
        }
        Ok(Value::Dictionary(entries))
    }

    /// Parses a value of any type.
    fn value(&mut self, depth: usize) -> Parsed<Value> {
        if depth > MAX_DEPTH {
            return self.error(format!("values are nested more than {MAX_DEPTH} deep"));
        }
        if matches!(self.lexer.peek()?, Token::Symbol('{')) {
            return self.dictionary(depth);
        }
        match self.lexer.next()? {
            Token::Number(number) => Ok(Value::Number(number)),
            Token::Text(text) => Ok(Value::Text(text)),
            Token::Asset(asset) => Ok(Value::Asset(asset)),
            Token::Path(path) => Ok(Value::Text(path)),
            Token::Word("true" | "True") => Ok(Value::Bool(true)),
            Token::Word("false" | "False") => Ok(Value::Bool(false)),
            Token::Word("None") => Ok(Value::Blocked),
            Token::Word(word) => Ok(Value::Text(word.to_string())),
            Token::Symbol('(') => {
                let mut numbers = Vec::new();
                self.tuple(&mut numbers, depth)?;
                Ok(Value::Tuple(numbers))
            }
            Token::Symbol('[') => self.array(depth),
            other => self.error(format!("expected a value, found {other}")),
        }
    }

    /// Parses the numbers of a tuple after its opening parenthesis. Matrices are tuples of tuples.
    fn tuple(&mut self, numbers: &mut Vec<f64>, depth: usize) -> Parsed<()> {
        if depth > MAX_DEPTH {
            return self.error(format!("values are nested more than {MAX_DEPTH} deep"));
        }
        let open = self.lexer.last();
        loop {
            match self.lexer.next()? {
                Token::Number(number) => numbers.push(number),
                Token::Symbol('(') => self.tuple(numbers, depth + 1)?,
                Token::Symbol(',') => {}
                Token::Symbol(')') => return Ok(()),
                other if self.is_after_tuple(&other) => {
                    return Err(SyntaxError { at: open, message: "this `(` is not closed: a `)` is missing".into() });
                }
                other => return self.error(format!("expected a number, found {other}")),
            }
        }
    }

    /// Returns true if a token cannot be in a tuple, but only after it: a closing bracket, the end
    /// of the file, or the type of a property before its name.
    fn is_after_tuple(&mut self, token: &Token) -> bool {
        match token {
            Token::Symbol(']' | '}') | Token::End => true,
            Token::Word(_) => matches!(self.lexer.peek(), Ok(Token::Word(_) | Token::Symbol('['))),
            _ => false,
        }
    }

    /// Parses an array after its opening bracket.
    fn array(&mut self, depth: usize) -> Parsed<Value> {
        let (mut values, mut texts, mut width) = (Vec::new(), Vec::new(), None);
        loop {
            let before = values.len();
            match self.lexer.next()? {
                Token::Number(number) => values.push(number),
                Token::Symbol('(') => self.tuple(&mut values, depth + 1)?,
                Token::Symbol(',') => continue,
                Token::Symbol(']') => break,
                Token::Text(text) | Token::Asset(text) | Token::Path(text) => texts.push(text),
                Token::Word("true" | "True") => values.push(1.0),
                Token::Word("false" | "False") => values.push(0.0),
                Token::Word("None") => {}
                Token::Word(word) => texts.push(word.to_string()),
                other => return self.error(format!("expected a value or `]`, found {other}")),
            }
            let added = values.len() - before;
            if added > 0 && *width.get_or_insert(added) != added {
                return self.error("the elements of an array must have equally many numbers");
            }
        }
        Ok(match texts.is_empty() {
            true => Value::Numbers { width: width.unwrap_or(1), values },
            false => Value::Texts(texts),
        })
    }
}
