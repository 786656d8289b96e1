//! Handles a WebSocket connection between a page and its sessions.

use crate::Shared;
use durer_session::{Clock, Host};
use std::io;
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::time::{Duration, Instant};
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

/// Maximum size of a message from the page in bytes. The limit is large enough for a model that is
/// dropped onto the page.
const MAX_MESSAGE: usize = 360 << 20;
/// Time to wait for a message when there is nothing to do.
const IDLE_WAIT: Duration = Duration::from_millis(250);
/// Time after which a page is disconnected if it does not read its messages.
const WRITE_TIMEOUT: Duration = Duration::from_secs(20);

/// Handles messages from the page, and renders between them, until the page disconnects.
pub(crate) fn serve(stream: TcpStream, rest: Vec<u8>, shared: &Shared) {
    // Ignore errors, because a connection can end at any time.
    let _ = run_session(stream, rest, shared);
}

fn run_session(stream: TcpStream, rest: Vec<u8>, shared: &Shared) -> Result<(), Error> {
    stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
    let config = WebSocketConfig::default().max_message_size(Some(MAX_MESSAGE)).max_frame_size(Some(MAX_MESSAGE));
    let mut socket = WebSocket::from_partially_read(stream, rest, Role::Server, Some(config));
    let start = Instant::now();
    let clock: Clock = Arc::new(move || 1000.0 * start.elapsed().as_secs_f64());
    let mut host = Host::new(shared.start.clone(), clock);
    let mut looked = Instant::now();
    while !shared.stop.load(Relaxed) {
        let mut failed = None;
        while let Some(message) = next(&mut socket, host.is_busy())? {
            match message {
                Message::Text(text) => host.receive(text.as_str(), &mut |bytes| send(&mut socket, bytes, &mut failed)),
                Message::Close(_) => return Ok(()),
                _ => {}
            }
            if let Some(error) = failed {
                return Err(error);
            }
        }
        host.step(&mut |bytes| send(&mut socket, bytes, &mut failed));
        if looked.elapsed() > IDLE_WAIT {
            looked = Instant::now();
            host.check_disk(&mut |bytes| send(&mut socket, bytes, &mut failed));
        }
        if let Some(error) = failed {
            return Err(error);
        }
    }
    Ok(())
}

/// Returns the next message, or `None` if none arrives in time. If `at_once` is true, the function
/// does not wait.
fn next(socket: &mut WebSocket<TcpStream>, at_once: bool) -> Result<Option<Message>, Error> {
    if at_once {
        socket.get_ref().set_nonblocking(true)?;
    } else {
        socket.get_ref().set_read_timeout(Some(IDLE_WAIT))?;
    }
    let read = socket.read();
    if at_once {
        socket.get_ref().set_nonblocking(false)?;
    }
    match read {
        Ok(message) => Ok(Some(message)),
        Err(Error::Io(error)) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

fn send(socket: &mut WebSocket<TcpStream>, bytes: Vec<u8>, failed: &mut Option<Error>) {
    if failed.is_none() {
        *failed = socket.send(Message::Binary(bytes.into())).err();
    }
}
