//! Parser that converts JSON text (RFC 8259) into a tree in which every value has its byte range.
//! The parser is strict, and it rejects objects in which two members have the same name.

use std::ops::Range;

/// Maximum depth to which values may be nested. The language allows 200 levels of objects, and each
/// takes three levels of JSON: an object, a list, and a transform.
const MAX_DEPTH: usize = 640;

/// JSON value together with its byte range in the text; [`parse`] returns a tree of these nodes.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub value: Value,
    pub at: Range<usize>,
}

/// Content of a JSON [`Node`], which is null, a boolean, a number, a string, an array, or an
/// object.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Null,
    Bool,
    /// A JSON number. The text of the number is at the byte range of the node.
    Number,
    String(String),
    Array(Vec<Node>),
    Object(Vec<Member>),
}

/// Member of a JSON object: its name, the byte range of the name, and its value.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub name: String,
    pub at: Range<usize>,
    pub node: Node,
}

/// Syntax error found while parsing JSON.
#[derive(Clone, Debug)]
pub(super) struct SyntaxError {
    pub at: Range<usize>,
    pub message: String,
    /// Range of a related position, such as the first of two members with the same name.
    pub first: Option<Range<usize>>,
}

impl Node {
    /// Name of the kind of value, for use in messages.
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Null => "`null`",
            Value::Bool => "a Boolean",
            Value::Number => "a number",
            Value::String(_) => "a string",
            Value::Array(_) => "a list",
            Value::Object(_) => "an object",
        }
    }

    /// Range to underline in messages: the opening bracket of a list or an object, or all of any
    /// other value.
    pub fn head(&self) -> Range<usize> {
        match &self.value {
            Value::Array(_) | Value::Object(_) => self.at.start..self.at.start + 1,
            _ => self.at.clone(),
        }
    }
}

/// Parses a JSON text.
pub(super) fn parse(text: &[u8]) -> Result<Node, SyntaxError> {
    // Editors on Windows may put a byte order mark at the start.
    let at = if text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let mut parser = Parser { text, at, depth: 0 };
    let node = parser.value()?;
    parser.skip_whitespace();
    match parser.at == text.len() {
        true => Ok(node),
        false => Err(parser.unexpected("the end of the file")),
    }
}

/// Recursive-descent parser of a JSON text.
struct Parser<'a> {
    text: &'a [u8],
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn skip_whitespace(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\n' | b'\r')) {
            self.at += 1;
        }
    }

    /// Skips the next byte if it is the given one, and returns true if so.
    fn skip_if(&mut self, byte: u8) -> bool {
        let passes = self.peek() == Some(byte);
        self.at += usize::from(passes);
        passes
    }

    fn error<T>(&self, at: Range<usize>, message: impl Into<String>) -> Result<T, SyntaxError> {
        Err(SyntaxError { at, message: message.into(), first: None })
    }

    /// Returns an error for the word at the current position; `wanted` describes what was expected
    /// instead.
    fn unexpected(&self, wanted: &str) -> SyntaxError {
        let ends = |b: &u8| b.is_ascii_whitespace() || b",:[]{}\"".contains(b);
        let rest = &self.text[self.at..];
        let length = rest.iter().position(ends).unwrap_or(rest.len()).max(1).min(rest.len());
        let at = self.at..self.at + length;
        let actual = match length {
            0 => "the file ends".to_string(),
            _ => format!("found {}", crate::report::quoted(&self.text[at.clone()])),
        };
        SyntaxError { at, message: format!("expected {wanted}, but {actual}"), first: None }
    }

    fn value(&mut self) -> Result<Node, SyntaxError> {
        self.skip_whitespace();
        let start = self.at;
        let value = match self.peek() {
            Some(b'{') => self.nested(Self::object)?,
            Some(b'[') => self.nested(Self::array)?,
            Some(b'"') => Value::String(self.string()?),
            Some(b'-' | b'0'..=b'9') => self.number()?,
            _ => self.literal()?,
        };
        Ok(Node { value, at: start..self.at })
    }

    fn nested(&mut self, read: fn(&mut Self) -> Result<Value, SyntaxError>) -> Result<Value, SyntaxError> {
        if self.depth >= MAX_DEPTH {
            return self.error(self.at..self.at + 1, format!("values are nested more than {MAX_DEPTH} levels deep"));
        }
        self.depth += 1;
        self.at += 1;
        let value = read(self)?;
        self.depth -= 1;
        Ok(value)
    }

    fn object(&mut self) -> Result<Value, SyntaxError> {
        let mut members = Vec::new();
        self.skip_whitespace();
        while !self.skip_if(b'}') {
            if !members.is_empty() && !self.skip_if(b',') {
                return Err(self.unexpected("`,` or `}`"));
            }
            self.skip_whitespace();
            let start = self.at;
            if self.peek() != Some(b'"') {
                return Err(self.unexpected("a name in quotes"));
            }
            let (name, at) = (self.string()?, start..self.at);
            self.skip_whitespace();
            if !self.skip_if(b':') {
                return Err(self.unexpected("`:`"));
            }
            members.push(Member { name, at, node: self.value()? });
            self.skip_whitespace();
        }
        match first_duplicate(&members) {
            Some((first, again)) => Err(SyntaxError {
                at: again.at.clone(),
                message: format!("{} occurs twice in this object", crate::report::quoted(again.name.as_bytes())),
                first: Some(first.at.clone()),
            }),
            None => Ok(Value::Object(members)),
        }
    }

    fn array(&mut self) -> Result<Value, SyntaxError> {
        let mut items = Vec::new();
        self.skip_whitespace();
        while !self.skip_if(b']') {
            if !items.is_empty() && !self.skip_if(b',') {
                return Err(self.unexpected("`,` or `]`"));
            }
            items.push(self.value()?);
            self.skip_whitespace();
        }
        Ok(Value::Array(items))
    }

    fn literal(&mut self) -> Result<Value, SyntaxError> {
        for (word, value) in [("null", Value::Null), ("true", Value::Bool), ("false", Value::Bool)] {
            if self.text[self.at..].starts_with(word.as_bytes()) {
                self.at += word.len();
                return Ok(value);
            }
        }
        Err(self.unexpected("a value"))
    }

    fn digits(&mut self) -> usize {
        let start = self.at;
        while matches!(self.peek(), Some(b'0'..=b'9')) {
            self.at += 1;
        }
        self.at - start
    }

    fn number(&mut self) -> Result<Value, SyntaxError> {
        let start = self.at;
        self.skip_if(b'-');
        let zero = self.peek() == Some(b'0');
        let whole = self.digits();
        let mut sound = whole > 0 && !(zero && whole > 1);
        if self.skip_if(b'.') {
            sound &= self.digits() > 0;
        }
        if self.skip_if(b'e') || self.skip_if(b'E') {
            let _ = self.skip_if(b'+') || self.skip_if(b'-');
            sound &= self.digits() > 0;
        }
        match sound {
            true => Ok(Value::Number),
            false => {
                self.at = start;
                Err(self.unexpected("a JSON number"))
            }
        }
    }

    fn string(&mut self) -> Result<String, SyntaxError> {
        let start = self.at;
        self.at += 1;
        let mut bytes = Vec::new();
        loop {
            match self.peek() {
                None => return self.error(start..start + 1, "this string does not end"),
                Some(b'"') => break,
                Some(b'\\') => {
                    let escape = self.at;
                    let Some(char) = self.escaped() else {
                        let end = self.at.clamp(escape + 1, self.text.len());
                        return self.error(escape..end, "the escape sequence is not valid in JSON");
                    };
                    bytes.extend(char.encode_utf8(&mut [0; 4]).bytes());
                }
                Some(byte @ ..0x20) => {
                    let message =
                        format!("a string cannot contain the character with code {byte}: write \\u{byte:04x}");
                    return self.error(self.at..self.at + 1, message);
                }
                Some(byte) => {
                    bytes.push(byte);
                    self.at += 1;
                }
            }
        }
        self.at += 1;
        String::from_utf8(bytes).or_else(|_| self.error(start..self.at, "this string is not UTF-8"))
    }

    /// Reads an escape sequence and returns its character. On failure, `at` is the position that
    /// the error refers to.
    fn escaped(&mut self) -> Option<char> {
        self.at += 1;
        let letter = self.peek()?;
        self.at += 1;
        Some(match letter {
            b'"' | b'\\' | b'/' => char::from(letter),
            b'b' => '\u{8}',
            b'f' => '\u{c}',
            b'n' => '\n',
            b'r' => '\r',
            b't' => '\t',
            b'u' => {
                let first = self.hexadecimal()?;
                if !(0xd800..0xdc00).contains(&first) {
                    return char::from_u32(first);
                }
                // Characters above U+FFFF are written as surrogate pairs.
                let second = (self.skip_if(b'\\') && self.skip_if(b'u')).then(|| self.hexadecimal()).flatten()?;
                let low = second.checked_sub(0xdc00).filter(|low| *low < 0x400)?;
                char::from_u32(0x10000 + ((first - 0xd800) << 10 | low))?
            }
            _ => return None,
        })
    }

    fn hexadecimal(&mut self) -> Option<u32> {
        let digits = self.text.get(self.at..self.at + 4).filter(|digits| digits.iter().all(u8::is_ascii_hexdigit))?;
        self.at += 4;
        u32::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()
    }
}

/// Returns the earliest member whose name is already used, preceded by the member that used it
/// first.
fn first_duplicate(members: &[Member]) -> Option<(&Member, &Member)> {
    let mut sorted: Vec<usize> = (0..members.len()).collect();
    sorted.sort_by_key(|&i| (&members[i].name, i));
    let pairs = sorted.windows(2).filter(|pair| members[pair[0]].name == members[pair[1]].name);
    pairs.min_by_key(|pair| pair[1]).map(|pair| (&members[pair[0]], &members[pair[1]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accepts_the_same_texts_as_serde_json() {
        let texts: &[&[u8]] = &[
            b"0",
            b"-0.5e+3",
            b"01",
            b"1.",
            b".5",
            b"-",
            b"1e",
            b"+1",
            b"[]",
            b"[1,]",
            b"[1 2]",
            b"{\"a\":1,}",
            b"{a:1}",
            b"{\"a\" 1}",
            b"{\"a\":{}} x",
            b"nul",
            b"truex",
            b"true",
            b" [null , false]\n",
            b"\"\\u00e9\\ud83d\\ude00\\n\"",
            b"\"\\ud83d\"",
            b"\"\\x\"",
            b"\"\\u12",
            b"\"a\nb\"",
            b"\"\xff\"",
            b"\"open",
            b"",
            b"[",
            b"{\"a\"",
            b"\"\\",
        ];
        for text in texts {
            let theirs = serde_json::from_slice::<serde_json::Value>(text);
            let ours = parse(text);
            let shown = String::from_utf8_lossy(text);
            assert_eq!(ours.is_ok(), theirs.is_ok(), "{shown}: {ours:?}");
            if let (Ok(Node { value: Value::String(ours), .. }), Ok(theirs)) = (&ours, theirs) {
                assert_eq!(Some(ours.as_str()), theirs.as_str(), "{shown}");
            }
            if let Err(error) = ours {
                assert!(error.at.start <= error.at.end && error.at.end <= text.len(), "{shown}: {error:?}");
            }
        }
    }

    #[test]
    fn values_have_byte_ranges() {
        let text = br#" {"a": [1, "b"], "c": -2.5 }"#;
        let Value::Object(members) = parse(text).unwrap().value else { panic!() };
        let shown = |at: &Range<usize>| String::from_utf8_lossy(&text[at.clone()]).into_owned();
        assert_eq!((shown(&members[0].at), shown(&members[0].node.at)), ("\"a\"".into(), "[1, \"b\"]".into()));
        assert_eq!((shown(&members[0].node.head()), shown(&members[1].node.at)), ("[".into(), "-2.5".into()));
        let twice = parse(br#"{"a": 1, "b": 2, "b": 3, "a": 4}"#).unwrap_err();
        assert_eq!((twice.at, twice.first), (17..20, Some(9..12)));
    }

    #[test]
    fn nesting_is_bounded() {
        let nested = |depth: usize| [vec![b'['; depth], vec![b']'; depth]].concat();
        assert!(parse(&nested(MAX_DEPTH)).is_ok());
        assert_eq!(parse(&nested(MAX_DEPTH + 1)).unwrap_err().at, MAX_DEPTH..MAX_DEPTH + 1);
        assert!(parse(&vec![b'['; 1 << 20]).is_err());
    }
}
