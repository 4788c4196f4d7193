// The live cloud: one stream over a WebSocket, whose wishes follow the camera and the sliders.
import {Connection, reply, types} from "./protocol.js";
import {Orbit} from "./orbit.js";

const stream = 1, hello = 2; // ids of requests
let lastLoad = 2; // each has one of its own: several can be under way
const fov = 40;
const restTime = 400;          // ms without a touch after which pictures get all pixels
const hastyMilliseconds = 150; // for a picture until then
const clearAir = 1e6;          // metres of visibility at which there is no fog

const element = (id) => document.getElementById(id);
const canvas = element("picture");
const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";

const sliders = {
    azimuth: {show: (v) => `${v}°`},
    elevation: {show: (v) => `${v}°`},
    exposure: {show: (v) => v.toFixed(1)},
    extinction: {show: (v) => (10 ** v).toPrecision(2)},
    g: {show: (v) => v.toFixed(2)},
    fog: {show: (v) => (10 ** v >= clearAir ? "none" : `${Math.round(10 ** v)} m`)},
};

let welcome = null;  // the server's reply to hello
let scene = null;    // its reply to load_scene
let original = null; // the first of these
const moved = new Set(); // sliders: what nobody touched stays as others have it
let touched = 0;     // when the user last moved something
let pending = false;

const value = (name) => Number(element(name).value);

function setSlider(name, number) {
    element(name).value = number;
    showSlider(name);
}

function showSlider(name) {
    element(name).nextElementSibling.textContent = sliders[name].show(value(name));
}

function wishes() {
    const ratio = Math.min(window.devicePixelRatio, 1.5);
    const scale = Math.min(1, 1280 / (canvas.clientWidth * ratio)) * ratio;
    const hasty = performance.now() - touched < restTime;
    return {
        camera: {position: orbit.position(), target: orbit.center, vertical_fov: fov},
        width: Math.max(16, Math.round(canvas.clientWidth * scale)),
        height: Math.max(16, Math.round(canvas.clientHeight * scale)),
        ...(moved.has("azimuth") || moved.has("elevation") ?
            {sun: {azimuth: value("azimuth"), elevation: value("elevation")}} : {}),
        ...(moved.has("extinction") ? {extinction: 10 ** value("extinction")} : {}),
        exposure: value("exposure"),
        encoding: "jpeg",
        quality: 88,
        when: "change",
        ...(hasty ? {budget: {milliseconds: hastyMilliseconds}} : {}),
    };
}

// The stream's wishes, at most once a picture of the screen, and once more at rest.
function changed() {
    touched = performance.now();
    if (pending || !scene) return;
    pending = true;
    requestAnimationFrame(() => {
        pending = false;
        connection.send(types.startStream, stream, wishes());
        setTimeout(() => {
            if (performance.now() - touched >= restTime) connection.send(types.startStream, stream, wishes());
        }, restTime + 20);
    });
}

// g and fog need a scene of their own; the photons begin anew.
function loadScene() {
    const set = [];
    if (original?.g !== undefined && moved.has("g")) set.push(`cloud.0.phase.g=${value("g")}`);
    const visibility = 10 ** value("fog");
    if (visibility < clearAir) set.push(`fog.media=[{kind="homogeneous", visibility=${visibility}}]`);
    const quality = welcome.quality ? {quality: welcome.quality} : {};
    connection.send(types.loadScene, ++lastLoad, {name: welcome.scene, set, ...quality});
}

function sceneLoaded(json) {
    const first = original === null;
    scene = json;
    original ??= json;
    element("message").textContent = json.warnings.join(" ");
    if (first) {
        orbit.frame(json.center, json.radius * 0.8, fov);
        const [x, y, z] = json.sun.direction_to;
        setSlider("azimuth", Math.round(Math.atan2(x, -z) * 180 / Math.PI));
        setSlider("elevation", Math.round(Math.asin(y) * 180 / Math.PI));
        setSlider("exposure", json.exposure);
        if (json.extinction > 0) setSlider("extinction", Math.log10(json.extinction));
        if (json.g !== undefined) setSlider("g", json.g);
        showSlider("fog");
    }
    changed();
}

async function show({json, payload}) {
    const view = json.views[0];
    const bytes = payload.subarray(view.offset, view.offset + view.bytes);
    const bitmap = await createImageBitmap(new Blob([bytes], {type: "image/jpeg"}));
    canvas.width = bitmap.width;
    canvas.height = bitmap.height;
    canvas.getContext("2d").drawImage(bitmap, 0, 0);
    document.body.dataset.frames = Number(document.body.dataset.frames ?? 0) + 1;
    const noise = json.noise === null ? "–" : `${(100 * Math.sqrt(json.noise)).toFixed(1)} %`;
    const reduced = json.reduction > 1 ? `, 1/${json.reduction} of the pixels' sides` : "";
    element("figures").textContent = `${(json.photons / 1e6).toFixed(2)} M photons, noise ${noise}, ` +
        `${Math.round(json.milliseconds.draw + json.milliseconds.encode)} ms${reduced}`;
}

function received(message) {
    if (message.type === types.error) {
        if (message.json.code !== "superseded") element("message").textContent = message.json.message;
    } else if (message.type === (types.startStream | reply)) {
        show(message);
    } else if (message.type === (types.hello | reply)) {
        welcome = message.json;
        loadScene();
    } else if (message.type === (types.loadScene | reply)) {
        sceneLoaded(message.json);
    }
}

const orbit = new Orbit(canvas, changed);
const connection = new Connection(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/frames`, {
    opened() {
        element("status").className = "live";
        connection.send(types.hello, hello, {version: 1, token, client: "viewer"});
    },
    received,
    closed() {
        element("status").className = "";
        element("status").textContent = "reconnecting";
    },
});

for (const name of Object.keys(sliders)) {
    element(name).addEventListener("input", () => {
        moved.add(name);
        showSlider(name);
        if (name !== "g" && name !== "fog") changed();
    });
}
for (const name of ["g", "fog"]) element(name).addEventListener("change", loadScene);
new ResizeObserver(changed).observe(canvas);
if (matchMedia("(max-width: 600px)").matches) element("panel").open = false;
