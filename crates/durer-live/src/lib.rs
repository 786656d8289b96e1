//! Server of `durer live`, which provides the web page and a WebSocket to a
//! [`durer_session::Host`].
//!
//! The server listens only on the loopback interface. Every path must begin with a random token,
//! `Host` and `Origin` must name the loopback interface, and only the files of the page are served.

mod connection;
mod head;
mod page;
mod socket;

pub use durer_session::SessionFiles;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::time::Duration;

/// Maximum number of connections that may be open at once.
const MAX_CONNECTIONS: usize = 48;
/// Interval at which the server checks if it should stop.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// The web server of `durer live`, which listens on the loopback interface.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    shared: Arc<Shared>,
}

/// State that the connections of a [`Server`] share: the token, the scene to be opened, and the
/// number of open connections.
#[derive(Debug)]
pub(crate) struct Shared {
    pub token: String,
    pub start: SessionFiles,
    pub open: AtomicUsize,
    pub stop: AtomicBool,
}

impl Server {
    /// Listens on a port; 0 selects any free port. Pages that connect start with the scene in
    /// `start`.
    ///
    /// # Errors
    ///
    /// Returns an error if the port is in use, or if the system provides no random numbers.
    pub fn bind(port: u16, start: SessionFiles) -> io::Result<Server> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let mut random = [0_u8; 16];
        getrandom::fill(&mut random).map_err(io::Error::other)?;
        let token = random.iter().map(|byte| format!("{byte:02x}")).collect();
        let shared = Shared { token, start, open: AtomicUsize::new(0), stop: AtomicBool::new(false) };
        Ok(Server { listener, shared: Arc::new(shared) })
    }

    /// Returns the URL of the page.
    ///
    /// # Errors
    ///
    /// Returns an error if the system does not report the port.
    pub fn address(&self) -> io::Result<String> {
        let SocketAddr::V4(address) = self.listener.local_addr()? else { return Err(io::ErrorKind::Other.into()) };
        Ok(format!("http://{address}/{}/", self.shared.token))
    }

    /// Serves requests until `stop` returns true.
    ///
    /// # Errors
    ///
    /// Returns the errors of the listening socket.
    pub fn run(&self, stop: impl Fn() -> bool) -> io::Result<()> {
        let address = self.listener.local_addr()?;
        std::thread::scope(|scope| {
            let acceptor = scope.spawn(|| self.accept());
            while !stop() && !acceptor.is_finished() {
                std::thread::sleep(POLL_INTERVAL);
            }
            self.shared.stop.store(true, Relaxed);
            // Wake the thread that waits for a connection.
            let _ = TcpStream::connect(address);
            acceptor.join().unwrap_or_else(|_| Err(io::Error::other("the server failed")))
        })
    }

    /// Accepts connections until the server stops.
    fn accept(&self) -> io::Result<()> {
        loop {
            let accepted = self.listener.accept();
            if self.shared.stop.load(Relaxed) {
                return Ok(());
            }
            match accepted {
                Ok((stream, _)) => {
                    let shared = self.shared.clone();
                    let held = ConnectionSlot::new(&shared);
                    if held.is_none() {
                        connection::refuse(&stream);
                        continue;
                    }
                    // If no thread can be started, close the connection; the browser will try
                    // again.
                    let _ =
                        std::thread::Builder::new().name("durer-live".into()).stack_size(64 << 20).spawn(move || {
                            let _held = held;
                            connection::serve(stream, &shared);
                        });
                }
                // The client closed the connection before it was accepted.
                Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => {}
                Err(error) => return Err(error),
            }
        }
    }
}

/// Counts as one open connection of the server until it is dropped.
struct ConnectionSlot(Arc<Shared>);

impl ConnectionSlot {
    fn new(shared: &Arc<Shared>) -> Option<ConnectionSlot> {
        let held = ConnectionSlot(shared.clone());
        (shared.open.fetch_add(1, Relaxed) < MAX_CONNECTIONS).then_some(held)
    }
}

impl Drop for ConnectionSlot {
    fn drop(&mut self) {
        self.0.open.fetch_sub(1, Relaxed);
    }
}
