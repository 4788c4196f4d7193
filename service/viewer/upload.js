// A VDB file on its way to the server.

const magic = [0x20, 0x42, 0x44, 0x56]; // with which an OpenVDB file begins
const chunkBytes = 1 << 20;

const megabytes = (bytes) => `${(bytes / 2 ** 20).toFixed(bytes < 10 * 2 ** 20 ? 1 : 0)} MB`;

function hexadecimal(buffer) {
    return Array.from(new Uint8Array(buffer), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

async function checked(file, limits) {
    if (file.size > limits.upload_bytes)
        throw new Error(`${file.name} has ${megabytes(file.size)}, the server takes ${megabytes(limits.upload_bytes)}`);
    const begin = new Uint8Array(await file.slice(0, magic.length).arrayBuffer());
    if (!magic.every((byte, i) => begin[i] === byte)) throw new Error(`${file.name} is no OpenVDB file`);
    if (!globalThis.crypto?.subtle)
        throw new Error("browsers compute the hash that an upload needs for https or localhost only");
}

// Sends a file and returns its SHA-256. `progress` is told the share that is done, 0 to 1. Errors: Error with words for
// the viewer.
export async function upload(file, connection, limits, progress) {
    await checked(file, limits);
    const bytes = new Uint8Array(await file.arrayBuffer());
    const hash = hexadecimal(await crypto.subtle.digest("SHA-256", bytes));
    const send = async (offset, end) =>
        (await connection.ask("upload", {hash, size: file.size, offset}, bytes.subarray(offset, end))).json;
    let {complete} = await send(0, 0); // it may be there already
    const most = Math.min(chunkBytes, limits.payload_bytes);
    for (let offset = 0; !complete; offset += most) {
        if (offset >= bytes.length) throw new Error(`${file.name} did not arrive`);
        progress(offset / bytes.length);
        complete = (await send(offset, Math.min(offset + most, bytes.length))).complete;
    }
    progress(1);
    return hash;
}
