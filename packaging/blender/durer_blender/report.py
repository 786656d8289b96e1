"""Messages about parts of the scene that are not translated, each reported once."""


class Report:
    """Collects messages in order, without repetitions."""

    def __init__(self):
        self.messages = []
        self._known = set()

    def add(self, message):
        """Adds a message unless it is known."""
        if message not in self._known:
            self._known.add(message)
            self.messages.append(message)

    def lines(self, most=20):
        """Returns the messages, of which all beyond the first `most` become one line."""
        rest = len(self.messages) - most
        return self.messages[:most] + ([f"and {rest} more such messages"] if rest > 0 else [])
