//! Several sessions on one connection.

use crate::protocol::{Event, EventMessage, Request, RequestMessage};
use crate::session::{Clock, Session, SessionFiles};
use crate::share::ReceivedPart;
use durer::render::PartialRender;
use std::collections::BTreeMap;

/// Maximum number of sessions. The number is limited because each session keeps a scene in memory.
const MAX_SESSIONS: usize = 64;

/// The sessions of one connection from a web page. The host passes messages to the sessions and
/// divides the time between them.
pub struct Host {
    start: SessionFiles,
    clock: Clock,
    sessions: BTreeMap<u32, Session>,
    /// Session that received the latest request. Its coarse pictures have priority.
    latest: u32,
    /// Session that worked most recently. It is stored so that the sessions take turns.
    worked: u32,
}

impl Host {
    /// Creates a host without sessions.
    pub fn new(start: SessionFiles, clock: Clock) -> Self {
        Host { start, clock, sessions: BTreeMap::new(), latest: 0, worked: 0 }
    }

    /// Answers a message that contains the JSON of a [`RequestMessage`].
    pub fn receive(&mut self, message: &str, send: &mut dyn FnMut(Vec<u8>)) {
        let RequestMessage { session, id, request } = match serde_json::from_str(message) {
            Ok(ask) => ask,
            Err(error) => {
                // Truncate the error message, because it can quote a long message.
                let why: String = format!("invalid request: {error}").chars().take(200).collect();
                let event = Event::Refused { why };
                return send(EventMessage { session: 0, id: 0, event }.encode(&[]));
            }
        };
        if matches!(request, Request::Close) {
            self.sessions.remove(&session);
            return;
        }
        let mut send_message =
            |(event, payload): (Event, Vec<u8>)| send(EventMessage { session, id, event }.encode(&payload));
        if !self.sessions.contains_key(&session) && self.sessions.len() >= MAX_SESSIONS {
            return send_message((Event::Refused { why: "too many sessions are open".into() }, Vec::new()));
        }
        self.latest = session;
        let (start, clock) = (&self.start, &self.clock);
        let found = self.sessions.entry(session).or_insert_with(|| Session::new(start.clone(), clock.clone()));
        #[cfg(feature = "fs")]
        if let Request::Edit { text } = &request {
            found.accept_disk_version(text);
        }
        found.handle(request, &mut send_message);
    }

    /// Receives an [`Event::Part`] that the host of another worker has sent. Ignores messages that
    /// contain no valid part of a picture.
    pub fn receive_part(&mut self, message: &[u8]) {
        let Some((answer, payload)) = EventMessage::decode(message) else { return };
        let Event::Part { revision, index, finished } = answer.event else { return };
        if let (Some(session), Ok(part)) = (self.sessions.get_mut(&answer.session), PartialRender::read(payload)) {
            session.receive(ReceivedPart { revision, index, finished, part });
        }
    }

    /// Returns true if there is work for [`Host::step`].
    pub fn is_busy(&self) -> bool {
        self.sessions.values().any(Session::is_busy)
    }

    /// Works for a few milliseconds. Sessions that have not shown their latest change yet have
    /// priority. Among these, the session that received the latest request comes first. The other
    /// sessions take turns.
    pub fn step(&mut self, send: &mut dyn FnMut(Vec<u8>)) {
        let Some(session) = self.next() else { return };
        self.worked = session;
        let Some(found) = self.sessions.get_mut(&session) else { return };
        found.step(&mut |(event, payload)| send(EventMessage { session, id: 0, event }.encode(&payload)));
    }

    /// Returns the session that works next.
    fn next(&self) -> Option<u32> {
        let urgent = |id: &u32| self.sessions.get(id).is_some_and(Session::is_urgent);
        let first = [self.latest].into_iter().chain(self.sessions.keys().copied()).find(urgent);
        let turns = self.sessions.range(self.worked.saturating_add(1)..).chain(self.sessions.range(..=self.worked));
        first.or_else(|| turns.filter(|(_, session)| session.is_busy()).map(|(id, _)| *id).next())
    }

    /// Notifies the page about scene files that have changed on disk.
    #[cfg(feature = "fs")]
    pub fn check_disk(&mut self, send: &mut dyn FnMut(Vec<u8>)) {
        for (&session, found) in &mut self.sessions {
            found.check_disk(&mut |(event, payload)| send(EventMessage { session, id: 0, event }.encode(&payload)));
        }
    }
}
