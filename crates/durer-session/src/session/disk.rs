//! The scene file on disk. The session saves it and notices when other programs change it.

use super::Session;
#[cfg(feature = "fs")]
use super::{Message, read};
use crate::protocol::Event;

impl Session {
    #[cfg(feature = "fs")]
    pub(super) fn save(&mut self, force: bool) -> Result<Event, String> {
        use durer::format::folder::stamp_of;
        let document = self
            .document
            .as_ref()
            .filter(|_| self.on_disk)
            .ok_or("this scene was not opened from a file on the server")?;
        if !force && stamp_of(&document.path) != self.stamp {
            return Ok(Event::Conflict);
        }
        durer::image::save(&document.path, &document.bytes).map_err(|error| error.to_string())?;
        self.stamp = stamp_of(&document.path);
        Ok(Event::Saved)
    }

    #[cfg(not(feature = "fs"))]
    pub(super) fn save(&mut self, _: bool) -> Result<Event, String> {
        Err("files cannot be saved here".into())
    }

    /// Reads the scene file again if it has changed on disk. If the text was also edited in the
    /// session, the edited text is kept, and the page is notified of the conflict when it saves the
    /// text.
    #[cfg(feature = "fs")]
    pub(crate) fn check_disk(&mut self, send_message: &mut dyn FnMut(Message)) {
        let Some(document) = self.document.as_ref().filter(|_| self.on_disk) else { return };
        let stamp = durer::format::folder::stamp_of(&document.path);
        if stamp == self.stamp || stamp == self.reported || stamp.is_none() {
            return;
        }
        let Ok(bytes) = read(&document.path) else { return };
        if bytes != document.bytes {
            let Ok(text) = std::str::from_utf8(&bytes) else { return };
            send_message((Event::Text { text: text.into(), from_disk: true }, Vec::new()));
            self.reported = stamp;
        } else {
            self.stamp = stamp;
        }
    }

    /// If the scene file contains `text`, records the current version of the file as the one that
    /// was read.
    #[cfg(feature = "fs")]
    pub(crate) fn accept_disk_version(&mut self, text: &str) {
        if let Some(document) = self.document.as_ref().filter(|_| self.on_disk)
            && read(&document.path).is_ok_and(|bytes| *bytes == *text.as_bytes())
        {
            self.stamp = durer::format::folder::stamp_of(&document.path);
        }
    }
}
