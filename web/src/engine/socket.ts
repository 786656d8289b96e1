import type { RequestMessage } from "../protocol";
import type { Transport, TransportEvents } from "./engine";

/** WebSocket transport to the page's server. The token is part of the page's address. */
export function socket(address: string, events: TransportEvents): Transport {
  const socket = new WebSocket(address);
  const early: string[] = [];
  socket.binaryType = "arraybuffer";
  socket.onopen = () => {
    for (const text of early) socket.send(text);
    early.length = 0;
  };
  socket.onmessage = (message) => events.message(message.data as ArrayBuffer);
  socket.onclose = () => events.closed("the server has stopped");
  return {
    send(ask: RequestMessage) {
      const text = JSON.stringify(ask);
      if (socket.readyState === WebSocket.CONNECTING) early.push(text);
      else if (socket.readyState === WebSocket.OPEN) socket.send(text);
    },
    close: () => socket.close(),
  };
}
