// A client in another language, written from docs/protocol.md alone: Node's standard library and the package ws.
//
//     NODE_PATH=/usr/share/nodejs node node_client.js tcp|ws HOST:PORT FILE.vdb
//
// Talks to a server with the tests' small scene, and fails where an answer is not what the document says.
"use strict";

const assert = require("node:assert/strict");
const crypto = require("node:crypto");
const fs = require("node:fs");
const net = require("node:net");

const MAGIC = 0x534C4D4C, VERSION = 1, HEADER = 32, REPLY = 0x8000, ERROR = 0x8000;
const TYPES = {
    hello: 1, load_scene: 2, upload: 3, frame: 4, start_stream: 5, stop_stream: 6, composite: 7, cancel: 8, statistics: 9,
    ping: 10, change: 11, list_uploads: 12, delete_upload: 13, query: 15,
};

function encode(type, id, json, payload = Buffer.alloc(0)) {
    const text = Buffer.from(typeof json === "string" ? json : JSON.stringify(json));
    const header = Buffer.alloc(HEADER);
    header.writeUInt32LE(MAGIC, 0);
    header.writeUInt16LE(VERSION, 4);
    header.writeUInt16LE(TYPES[type], 6);
    header.writeBigUInt64LE(id, 8);
    header.writeUInt32LE(text.length, 16);
    header.writeBigUInt64LE(BigInt(payload.length), 24);
    return Buffer.concat([header, text, payload]);
}

const sha256 = (bytes) => "sha256:" + crypto.createHash("sha256").update(bytes).digest("hex");

/** One connection. Messages are found in the stream of bytes, whatever carries it. */
class Client {
    constructor() {
        this.bytes = Buffer.alloc(0);
        this.waiting = new Map(); // by id: those who wait for a message
        this.early = new Map();   // by id: messages for which nobody waited
        this.nextId = 1n;
    }

    static async overTcp(address) {
        const client = new Client(), [host, port] = address.split(":");
        const socket = net.connect(Number(port), host);
        await new Promise((done, failed) => socket.on("connect", done).on("error", failed));
        socket.on("data", (data) => client.received(data));
        client.write = (data) => socket.write(data);
        client.close = () => socket.end();
        return client;
    }

    static async overWebSocket(address) {
        const client = new Client(), WebSocket = require("ws");
        const socket = new WebSocket(`ws://${address}/frames`);
        await new Promise((done, failed) => socket.on("open", done).on("error", failed));
        socket.on("message", (data) => client.received(data));
        client.write = (data) => socket.send(data);
        client.close = () => socket.close();
        return client;
    }

    received(data) {
        this.bytes = Buffer.concat([this.bytes, data]);
        while (this.bytes.length >= HEADER) {
            assert.equal(this.bytes.readUInt32LE(0), MAGIC);
            const jsonBytes = this.bytes.readUInt32LE(16), payloadBytes = Number(this.bytes.readBigUInt64LE(24));
            const end = HEADER + jsonBytes + payloadBytes;
            if (this.bytes.length < end) return;
            this.deliver({
                type: this.bytes.readUInt16LE(6),
                id: this.bytes.readBigUInt64LE(8),
                json: JSON.parse(this.bytes.subarray(HEADER, HEADER + jsonBytes)),
                payload: Buffer.from(this.bytes.subarray(HEADER + jsonBytes, end)),
            });
            this.bytes = Buffer.from(this.bytes.subarray(end));
        }
    }

    deliver(message) {
        const taker = (this.waiting.get(message.id) ?? []).shift();
        if (taker) taker(message);
        else this.early.set(message.id, [...this.early.get(message.id) ?? [], message]);
    }

    next(id) {
        const message = (this.early.get(id) ?? []).shift();
        if (message) return Promise.resolve(message);
        return new Promise((taker) => this.waiting.set(id, [...this.waiting.get(id) ?? [], taker]));
    }

    send(type, json = {}, payload = undefined, id = this.nextId++) {
        this.write(encode(type, id, json, payload));
        return id;
    }

    async ask(type, json = {}, payload = undefined) {
        const message = await this.next(this.send(type, json, payload));
        if (message.type === ERROR) throw Object.assign(new Error(message.json.message), message.json);
        assert.equal(message.type, TYPES[type] + REPLY);
        return message;
    }
}

function halfToNumber(bits) {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction);
}

/** A product as numbers. */
function values(message, name, view = 0) {
    const product = message.json.views[view].products.find((one) => one.name === name);
    const data = message.payload.subarray(product.offset, product.offset + product.bytes);
    const half = product.type === "half", count = data.length / (half ? 2 : 4);
    return Array.from({length: count}, (_, i) => (half ? halfToNumber(data.readUInt16LE(2 * i)) : data.readFloatLE(4 * i)));
}

const refusal = (promise) => promise.then(() => "taken", (error) => error.code);

async function checkHello(client) {
    const {json} = await client.ask("hello", {version: 1, client: "node"});
    assert.equal(json.version, 1);
    assert.equal(json.shared_light, false);
    for (const limit of ["json_bytes", "payload_bytes", "pixels", "views", "upload_bytes", "streams", "queued_frames"])
        assert.ok(Number.isInteger(json.limits[limit]), limit);
    return json;
}

async function checkFrames(client) {
    const frame = await client.ask("frame", {width: 32, height: 24, products: ["color", "transmittance", "depth"]});
    assert.equal(frame.json.hash, sha256(frame.payload));
    const color = values(frame, "color"), transmittance = values(frame, "transmittance"), depth = values(frame, "depth");
    assert.deepEqual([color.length, transmittance.length, depth.length], [32 * 24 * 4, 32 * 24 * 3, 32 * 24]);
    const middle = 12 * 32 + 16;
    assert.ok(color[4 * middle + 3] > 0.5 && color[4 * middle] > 0);
    assert.ok(transmittance[3 * middle] < 0.5, "the cloud is in the middle");
    assert.ok(depth[0] >= 1e10 && depth[middle] < 1e10, "depth is 10^10 where there is no cloud");
    // azimuth 90 is +X, elevation 90 the zenith
    await client.ask("frame", {width: 16, height: 12, sun: {azimuth: 90, elevation: 0}});
    const light = (await client.ask("statistics", {})).json.scene;
    assert.ok(light.own, "light that a client has changed is its own");
    light.sun.direction_to.forEach((x, axis) => assert.ok(Math.abs(x - [1, 0, 0][axis]) < 1e-9));
    const scene = (await client.ask("load_scene", {name: "small.toml"})).json;
    assert.deepEqual(scene.sun, scene.original.sun, "who loads a scene sees it as it was loaded");
    // a panorama that looks north (-Z) from the west of the cloud has it in the east: three quarters from the left
    const [x, y, z] = scene.center, west = x - 4 * scene.radius;
    const camera = {position: [west, y, z], target: [west, y, z - 1], projection: "panorama"};
    const around = values(await client.ask("frame", {width: 64, height: 32, camera, products: ["transmittance"]}),
        "transmittance");
    let weight = 0, column = 0, row = 0;
    for (let pixel = 0; pixel < 64 * 32; ++pixel) {
        const covered = 1 - around[3 * pixel];
        weight += covered;
        column += covered * (pixel % 64 + 0.5);
        row += covered * (Math.floor(pixel / 64) + 0.5);
    }
    assert.ok(weight > 1 && Math.abs(column / weight - 48) < 1 && Math.abs(row / weight - 16) < 1, `${column / weight}`);
}

async function checkQueries(client) {
    const {json: {center: [x, y, z], radius}} = await client.ask("load_scene", {name: "small.toml"});
    const row = Buffer.alloc(48);
    [x - 2 * radius, y, z, x + 2 * radius, y, z].forEach((number, i) => row.writeDoubleLE(number, 8 * i));
    const {json, payload} = await client.ask("query", {products: ["segments"]}, row);
    assert.deepEqual([json.width, json.height, json.channels, payload.length], [1, 1, 6, 24]);
    const [share, depth] = [payload.readFloatLE(0), payload.readFloatLE(12)];
    assert.ok(depth > 1 && Math.abs(share - Math.exp(-depth)) < 1e-5, `${share} ${depth}`);
    assert.equal(await refusal(client.ask("query", {products: ["segments"]}, Buffer.alloc(8))), "bad_request");
}

async function checkStreams(client) {
    const id = 2n ** 63n + 5n;  // no number of JavaScript's
    client.send("start_stream", {width: 16, height: 12, max_rate: 100}, undefined, id);
    for (let number = 0; number < 3; ++number) {
        const frame = await client.next(id);
        assert.equal(frame.type, TYPES.start_stream + REPLY);
        assert.equal(frame.json.number, number);
    }
    assert.equal((await client.ask("stop_stream", {stream: id.toString()})).json.found, true);
    assert.equal((await client.ask("stop_stream", `{"stream": ${id}}`)).json.found, false);
    assert.equal((await client.ask("cancel", {request: "18446744073709551615"})).json.found, false);
}

async function checkUploads(client, path) {
    const file = fs.readFileSync(path), hash = sha256(file), half = file.length >> 1;
    const piece = (offset, end) => client.ask("upload", {hash, size: file.length, offset}, file.subarray(offset, end));
    assert.deepEqual((await piece(0, half)).json, {received: half, complete: false});
    assert.deepEqual((await piece(half)).json, {received: file.length, complete: true});
    const listed = (await client.ask("list_uploads")).json;
    assert.deepEqual(listed.uploads.map((one) => [one.hash, one.bytes]), [[hash, file.length]]);
    assert.ok(listed.uploads[0].seconds_left > 0 && listed.bytes <= listed.most_bytes);
    const scene = (await client.ask("load_scene", {name: "small.toml", vdb: hash})).json;
    assert.ok(scene.radius > 0 && scene.generations > 0);
    assert.equal((await client.ask("delete_upload", {hash})).json.found, true);
    assert.equal((await client.ask("delete_upload", {hash})).json.found, false);
    assert.equal(await refusal(client.ask("load_scene", {name: "small.toml", vdb: hash, private: true})), "not_found");
}

async function checkErrors(client) {
    assert.equal(await refusal(client.ask("frame", {widht: 8})), "bad_request");
    assert.equal(await refusal(client.ask("frame", '{"width": 8, "width": 9}')), "bad_request");
    assert.equal(await refusal(client.ask("load_scene", {name: "absent.toml"})), "not_found");
    assert.equal((await client.ask("ping")).json.constructor, Object);
    assert.ok((await client.ask("statistics")).json.frames_total > 0);
}

async function main([how, address, file]) {
    const client = await (how === "ws" ? Client.overWebSocket(address) : Client.overTcp(address));
    await checkHello(client);
    await checkFrames(client);
    await checkQueries(client);
    await checkStreams(client);
    await checkUploads(client, file);
    await checkErrors(client);
    client.close();
}

main(process.argv.slice(2)).then(() => console.log("ok"), (error) => {
    console.error(error);
    process.exit(1);
});
