// The frame service's protocol over a WebSocket: docs/protocol.md.

export const types = {hello: 1, loadScene: 2, startStream: 5, error: 0x8000};
export const reply = 0x8000;

const headerBytes = 32;
const magic = 0x534C4D4C;
const version = 1;

export function encode(type, id, json) {
    const text = new TextEncoder().encode(JSON.stringify(json));
    const bytes = new Uint8Array(headerBytes + text.length);
    const view = new DataView(bytes.buffer);
    view.setUint32(0, magic, true);
    view.setUint16(4, version, true);
    view.setUint16(6, type, true);
    view.setBigUint64(8, BigInt(id), true);
    view.setUint32(16, text.length, true);
    view.setBigUint64(24, 0n, true);
    bytes.set(text, headerBytes);
    return bytes;
}

// One message of the server is one message of the WebSocket.
export function decode(buffer) {
    const view = new DataView(buffer);
    if (view.getUint32(0, true) !== magic) throw new Error("not a message of the frame service");
    const jsonBytes = view.getUint32(16, true);
    const text = new TextDecoder().decode(new Uint8Array(buffer, headerBytes, jsonBytes));
    return {
        type: view.getUint16(6, true),
        id: Number(view.getBigUint64(8, true)),
        json: JSON.parse(text),
        payload: new Uint8Array(buffer, headerBytes + jsonBytes),
    };
}

// A connection that comes back by itself. Calls opened(), received(message) and closed().
export class Connection {
    constructor(url, handlers) {
        this.url = url;
        this.handlers = handlers;
        this.delay = 250;
        this.open();
    }

    open() {
        this.socket = new WebSocket(this.url);
        this.socket.binaryType = "arraybuffer";
        this.socket.onopen = () => {
            this.delay = 250;
            this.handlers.opened();
        };
        this.socket.onmessage = (event) => this.handlers.received(decode(event.data));
        this.socket.onclose = () => {
            this.handlers.closed();
            setTimeout(() => this.open(), this.delay);
            this.delay = Math.min(2 * this.delay, 4000);
        };
    }

    send(type, id, json) {
        if (this.socket.readyState === WebSocket.OPEN) this.socket.send(encode(type, id, json));
    }
}
