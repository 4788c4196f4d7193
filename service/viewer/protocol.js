// The frame service's protocol over a WebSocket: docs/protocol.md.

export const types = {
    hello: 1, load_scene: 2, upload: 3, frame: 4, start_stream: 5, stop_stream: 6, statistics: 9, change: 11,
    list_scenes: 14, error: 0x8000,
};
const reply = 0x8000;

const headerBytes = 32;
const magic = 0x534C4D4C;
const version = 1;
const stream = 1; // id of the one stream; requests have ids from 2 on

export function encode(type, id, json, payload = new Uint8Array(0)) {
    const text = new TextEncoder().encode(JSON.stringify(json));
    const bytes = new Uint8Array(headerBytes + text.length + payload.length);
    const view = new DataView(bytes.buffer);
    view.setUint32(0, magic, true);
    view.setUint16(4, version, true);
    view.setUint16(6, type, true);
    view.setBigUint64(8, BigInt(id), true);
    view.setUint32(16, text.length, true);
    view.setBigUint64(24, BigInt(payload.length), true);
    bytes.set(text, headerBytes);
    bytes.set(payload, headerBytes + text.length);
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

// What the server refuses; `code` is one of docs/protocol.md, or "closed" where the connection ended first.
export class ServiceError extends Error {
    constructor(code, message) {
        super(message);
        this.code = code;
    }
}

// A connection that comes back by itself. Calls opened(), closed(), refused(error) where the server ends it, framed(message)
// for each picture of the stream and streamFailed(error) where the stream ends.
export class Connection {
    constructor(url, handlers) {
        this.url = url;
        this.handlers = handlers;
        this.delay = 250; // ms, until the next attempt
        this.held = false;
        this.next = stream + 1;
        this.waiting = new Map();
        this.open();
    }

    open() {
        this.socket = new WebSocket(this.url);
        this.socket.binaryType = "arraybuffer";
        this.socket.onopen = () => this.handlers.opened();
        this.socket.onmessage = (event) => this.received(decode(event.data));
        this.socket.onclose = () => {
            for (const {reject} of this.waiting.values()) reject(new ServiceError("closed", "the connection was lost"));
            this.waiting.clear();
            this.handlers.closed();
            if (!this.held) setTimeout(() => this.open(), this.delay);
            this.delay = Math.min(2 * this.delay, 4000);
        };
    }

    // No new attempt to connect until release().
    hold() {
        this.held = true;
    }

    // Ends the connection until release().
    leave() {
        this.hold();
        this.socket.close();
    }

    release() {
        if (!this.held) return;
        this.held = false;
        if (this.socket.readyState === WebSocket.CLOSED) this.open();
    }

    get isOpen() {
        return this.socket.readyState === WebSocket.OPEN;
    }

    // Sends a request. The promise gets the reply's {json, payload}, or a ServiceError.
    ask(name, json, payload) {
        if (!this.isOpen) return Promise.reject(new ServiceError("closed", "there is no connection"));
        const id = this.next++;
        const answer = new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
        this.socket.send(encode(types[name], id, json, payload));
        return answer;
    }

    // Starts the stream, or gives it new wishes.
    stream(wishes) {
        if (this.isOpen) this.socket.send(encode(types.start_stream, stream, wishes));
    }

    received(message) {
        const failure = message.type === types.error ? new ServiceError(message.json.code, message.json.message) : null;
        if (!failure) this.delay = 250;
        const asked = this.waiting.get(message.id);
        this.waiting.delete(message.id);
        if (message.id === 0 && failure) this.handlers.refused(failure);
        else if (message.id === stream && failure) this.handlers.streamFailed(failure);
        else if (message.id === stream && message.type === (types.start_stream | reply)) this.handlers.framed(message);
        else if (asked && failure) asked.reject(failure);
        else if (asked) asked.resolve(message);
    }
}
