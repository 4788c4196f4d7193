// What a viewer wishes to see, and the link that brings it back: the part of the address behind #.

// Wishes that nobody has changed yet: null and empty maps leave things as the server has them.
export function freshWishes() {
    return {
        scene: "",             // name in the server's folder; "": the server's own, or none where there is an upload
        vdb: "",               // SHA-256 of an upload, and `file`, what it was called
        file: "",
        quality: null,         // draft, interactive, final, or "" for what the scene says
        own: false,            // where viewers share light: a scene that no other viewer shares
        sun: null,             // [azimuth, elevation], degrees
        exposure: null,        // stops
        extinction: new Map(), // 1/m by the cloud's index, or by "all"
        g: new Map(),          // by the cloud's index
        fog: null,             // visibility in metres
        newFog: null,          // visibility of fog that the scene is loaded with: its file has none
        camera: null,          // {azimuth, elevation, distance, center}
    };
}

const qualities = ["", "draft", "interactive", "final"];

const brief = (x) => String(Number(x.toPrecision(6)));

// The finite numbers of a list, or null where it is not that.
function numbers(text, count) {
    const values = (text ?? "").split(",").map((one) => (one.trim() === "" ? NaN : Number(one)));
    return values.length === count && values.every((x) => Number.isFinite(x) && Math.abs(x) <= 1e9) ? values : null;
}

const inside = (value, low, high) => value !== null && value >= low && value <= high;

function oneNumber(text, low, high) {
    const value = numbers(text, 1)?.[0] ?? null;
    return inside(value, low, high) ? value : null;
}

function readSun(text) {
    const angles = numbers(text, 2);
    return angles && inside(angles[0], -360, 360) && inside(angles[1], -90, 90) ? angles : null;
}

function readCamera(text) {
    const values = numbers(text, 6);
    if (!values || !inside(values[1], -89, 89) || !(values[2] > 0)) return null;
    return {azimuth: values[0], elevation: values[1], distance: values[2], center: values.slice(3)};
}

// Wishes of a link. What it holds that is no wish, or out of range, is left out.
export function readLink(hash) {
    const fields = new URLSearchParams(hash.replace(/^#/, ""));
    const wishes = freshWishes();
    wishes.scene = fields.get("scene") ?? "";
    if (/^[0-9a-f]{64}$/.test(fields.get("vdb") ?? "")) {
        wishes.vdb = fields.get("vdb");
        wishes.file = (fields.get("file") ?? "upload.vdb").slice(0, 100);
    }
    if (qualities.includes(fields.get("quality"))) wishes.quality = fields.get("quality");
    wishes.own = fields.get("own") === "1";
    wishes.sun = readSun(fields.get("sun"));
    wishes.camera = readCamera(fields.get("camera"));
    wishes.exposure = oneNumber(fields.get("exposure"), -64, 64);
    wishes.fog = oneNumber(fields.get("fog"), 1, 1e6);
    for (const [key, text] of fields) {
        const [, name, cloud] = /^(extinction|g)(?:\.(\d{1,5}))?$/.exec(key) ?? [];
        const value = name === "g" ? oneNumber(text, -0.99, 0.99) : oneNumber(text, 1e-9, 1e6);
        if (name && value !== null && (cloud || name === "extinction"))
            wishes[name].set(cloud === undefined ? "all" : Number(cloud), value);
    }
    return wishes;
}

// The link of wishes: readLink() of it gives them back.
export function linkOf(wishes) {
    const fields = new URLSearchParams();
    if (wishes.scene) fields.set("scene", wishes.scene);
    if (wishes.vdb) {
        fields.set("vdb", wishes.vdb);
        fields.set("file", wishes.file);
    }
    if (wishes.quality !== null) fields.set("quality", wishes.quality);
    if (wishes.own) fields.set("own", "1");
    if (wishes.sun) fields.set("sun", wishes.sun.map(brief).join(","));
    if (wishes.exposure !== null) fields.set("exposure", brief(wishes.exposure));
    for (const name of ["extinction", "g"])
        for (const [cloud, value] of wishes[name])
            fields.set(cloud === "all" ? name : `${name}.${cloud}`, brief(value));
    const fog = wishes.fog ?? wishes.newFog;
    if (fog !== null) fields.set("fog", brief(fog));
    if (wishes.camera) {
        const {azimuth, elevation, distance, center} = wishes.camera;
        fields.set("camera", [azimuth, elevation, distance, ...center].map(brief).join(","));
    }
    return `#${fields.toString().replaceAll("%2C", ",")}`;
}

const tokenKey = "lumulus token";

// The token of an address `…#token=…`. It is kept for this tab and taken out of the address, so that links that are
// given on do not hold it.
export function takeToken() {
    const fields = new URLSearchParams(location.hash.slice(1));
    if (fields.has("token")) {
        keepToken(fields.get("token"));
        fields.delete("token");
        history.replaceState(null, "", `#${fields}`);
    }
    return sessionStorage.getItem(tokenKey) ?? "";
}

export function keepToken(token) {
    sessionStorage.setItem(tokenKey, token);
}
