//! Parses and checks the heads of HTTP requests.

use std::io::{self, Read};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Maximum size of the head of a request in bytes.
const MAX_HEAD: usize = 8 << 10;

/// Time within which the whole head of a request must arrive. A limit for each byte would allow a
/// slow client to hold a connection forever.
const HEAD_TIMEOUT: Duration = Duration::from_secs(3);

/// Request line and relevant headers of an HTTP request to the server. The body of a request is not
/// read.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct RequestHead {
    pub method: String,
    pub path: String,
    pub host: Option<String>,
    pub origin: Option<String>,
    pub upgrade: bool,
    pub key: Option<String>,
    /// Bytes that were received after the end of the head.
    pub rest: Vec<u8>,
}

/// Reads the head of a request from a connection.
pub(crate) fn read(stream: &mut TcpStream) -> io::Result<RequestHead> {
    let (mut bytes, mut some, start) = (Vec::new(), [0_u8; 1024], Instant::now());
    loop {
        let left = HEAD_TIMEOUT.checked_sub(start.elapsed()).filter(|left| !left.is_zero());
        stream.set_read_timeout(Some(left.ok_or(io::ErrorKind::TimedOut)?))?;
        let count = stream.read(&mut some)?;
        if count == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        bytes.extend_from_slice(&some[..count]);
        if let Some(head) = parse(&bytes)? {
            return Ok(head);
        }
        if bytes.len() > MAX_HEAD {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "the request header is too long"));
        }
    }
}

/// Parses the head of a request; returns `None` if the head is incomplete.
pub(crate) fn parse(bytes: &[u8]) -> io::Result<Option<RequestHead>> {
    let invalid = |error| io::Error::new(io::ErrorKind::InvalidData, error);
    let mut headers = [httparse::EMPTY_HEADER; 64];
    let mut request = httparse::Request::new(&mut headers);
    let httparse::Status::Complete(length) = request.parse(bytes).map_err(invalid)? else { return Ok(None) };
    let mut head = RequestHead {
        method: request.method.unwrap_or_default().into(),
        path: request.path.unwrap_or_default().into(),
        rest: bytes[length..].to_vec(),
        ..RequestHead::default()
    };
    for header in request.headers {
        let value = String::from_utf8_lossy(header.value).into_owned();
        match header.name.to_ascii_lowercase().as_str() {
            // Reject a second `Host` header, because proxies do not agree on which of them counts.
            "host" if head.host.is_some() => return Err(io::ErrorKind::InvalidData.into()),
            "host" => head.host = Some(value),
            "origin" => head.origin = Some(value),
            "upgrade" => head.upgrade = value.eq_ignore_ascii_case("websocket"),
            "sec-websocket-key" => head.key = Some(value),
            _ => {}
        }
    }
    Ok(Some(head))
}

impl RequestHead {
    /// Returns true if the request comes from a page on this machine. After DNS rebinding, a
    /// foreign name resolves to the loopback interface, but the browser still sends the foreign
    /// name. The port is ignored, because it is a different one behind `ssh -L`.
    pub fn is_local(&self) -> bool {
        let Some(host) = &self.host else { return false };
        let same = |origin: &String| origin.strip_prefix("http://").is_some_and(|origin| origin == host);
        is_loopback(host) && self.origin.as_ref().is_none_or(same)
    }

    /// Returns the path that follows the token, or `None` if the token is wrong.
    pub fn path_after_token(&self, token: &str) -> Option<&str> {
        let path = self.path.split(['?', '#']).next()?.strip_prefix('/')?;
        let (found, rest) = path.split_once('/')?;
        // Compare all bytes, so that the time taken does not depend on the token.
        let differ = found.bytes().zip(token.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
        (found.len() == token.len() && differ == 0).then_some(rest)
    }
}

fn is_loopback(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if !port.is_empty() && port.bytes().all(|digit| digit.is_ascii_digit()) => name,
        _ => host,
    };
    ["localhost", "127.0.0.1", "[::1]"].contains(&name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(lines: &str) -> RequestHead {
        parse(format!("GET /secret/socket HTTP/1.1\r\n{lines}\r\n").as_bytes()).unwrap().unwrap()
    }

    #[test]
    fn only_loopback_hosts_and_origins_are_local() {
        assert!(head("Host: 127.0.0.1:8000\r\n").is_local());
        assert!(head("Host: localhost:9\r\nOrigin: http://localhost:9\r\n").is_local());
        for lines in [
            "",
            "Host: evil.example\r\n",
            "Host: localhost.evil.example\r\n",
            "Host: 127.0.0.1:8000\r\nOrigin: http://evil.example\r\n",
            "Host: 127.0.0.1:8000\r\nOrigin: http://127.0.0.1:8001\r\n",
            "Host: 127.0.0.1:8000\r\nOrigin: null\r\n",
            "Host: 127.0.0.1.evil.example:80\r\n",
        ] {
            assert!(!head(lines).is_local(), "{lines:?}");
        }
    }

    #[test]
    fn path_needs_the_whole_token() {
        let head = head("Host: localhost\r\n");
        assert_eq!(head.path_after_token("secret"), Some("socket"));
        for token in ["secre", "secret1", "sfcret", ""] {
            assert_eq!(head.path_after_token(token), None, "{token:?}");
        }
    }

    #[test]
    fn invalid_heads_are_refused() {
        assert_eq!(parse(b"GET / HTTP/1.1\r\nHost: a").unwrap(), None);
        assert!(parse(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03").is_err());
        assert!(parse(b"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n").is_err());
    }
}
