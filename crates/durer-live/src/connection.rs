//! Handles one HTTP connection, which either receives one file or is upgraded to a WebSocket.

use crate::head::{self, RequestHead};
use crate::{Shared, page, socket};
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::Duration;

/// Time limit for reading the request, and for sending the response.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(10);

/// Limits on the time and the number of bytes for reading from a client after its response has been
/// sent.
const DRAIN_TIMEOUT: Duration = Duration::from_secs(1);
const MAX_DRAINED: u64 = 1 << 20;

/// Content security policy that is sent with every response.
const POLICY: &str = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; \
                      connect-src 'self' ws://127.0.0.1:* ws://localhost:*; worker-src 'self'; base-uri 'none'; \
                      form-action 'none'; frame-ancestors 'none'";

/// Sends an error response if too many connections are open.
pub(crate) fn refuse(mut stream: &TcpStream) {
    // Do not let a slow client block the server.
    let _ = stream.set_nonblocking(true);
    let _ = stream.write_all(b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
}

/// Answers the only request of a connection.
pub(crate) fn serve(mut stream: TcpStream, shared: &Shared) {
    // Ignore errors, because they mean that the client has disconnected or sent an invalid request.
    let _ = answer(&mut stream, shared);
}

fn answer(stream: &mut TcpStream, shared: &Shared) -> io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(REQUEST_TIMEOUT))?;
    let head = match head::read(stream) {
        Ok(head) => head,
        Err(error) if error.kind() == io::ErrorKind::InvalidData => {
            return send(stream, "400 Bad Request", "text/plain", b"invalid request\n");
        }
        Err(error) => return Err(error),
    };
    stream.set_read_timeout(Some(REQUEST_TIMEOUT))?;
    if !head.is_local() {
        return send(stream, "403 Forbidden", "text/plain", b"this server answers only pages from localhost\n");
    }
    let Some(path) = head.path_after_token(&shared.token) else {
        return send(stream, "404 Not Found", "text/plain", b"not found\n");
    };
    if head.method != "GET" {
        return send(stream, "405 Method Not Allowed", "text/plain", b"\n");
    }
    if path == "socket" {
        return upgrade(stream, &head, shared);
    }
    match page::file(path) {
        Some((_, kind)) if path.is_empty() || path == "index.html" => send(stream, "200 OK", kind, &page::index()),
        Some((bytes, kind)) => send(stream, "200 OK", kind, bytes),
        None => send(stream, "404 Not Found", "text/plain", b"not found\n"),
    }
}

fn upgrade(stream: &mut TcpStream, head: &RequestHead, shared: &Shared) -> io::Result<()> {
    // Browsers always send `Origin` with WebSocket requests, so clients that do not send it are
    // rejected.
    let (true, Some(key), Some(_)) = (head.upgrade, &head.key, &head.origin) else {
        return send(stream, "426 Upgrade Required", "text/plain", b"this path needs a WebSocket\n");
    };
    let accept = tungstenite::handshake::derive_accept_key(key.as_bytes());
    let answer = format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accept}\r\n\r\n"
    );
    stream.write_all(answer.as_bytes())?;
    socket::serve(stream.try_clone()?, head.rest.clone(), shared);
    Ok(())
}

fn send(stream: &mut TcpStream, status: &str, kind: &str, body: &[u8]) -> io::Result<()> {
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nContent-Security-Policy: {POLICY}\r\n\
         Connection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body)?;
    stream.flush()?;
    // If unread bytes were left when the connection is closed, the connection would be reset, and
    // the client could lose the response. Therefore, read these bytes first.
    stream.shutdown(Shutdown::Write)?;
    stream.set_read_timeout(Some(DRAIN_TIMEOUT))?;
    io::copy(&mut stream.take(MAX_DRAINED), &mut io::sink()).map(|_| ())
}
