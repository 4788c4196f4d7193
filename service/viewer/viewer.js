// The page: joins the controls to the view of the server.
import {buttons, fill} from "./controls.js";
import {figuresOf, ownerOfLight, writeFigures} from "./figures.js";
import {freshWishes, keepToken, linkOf, readLink, takeToken} from "./link.js";
import {Notices} from "./notices.js";
import {cameraPresets, Orbit} from "./orbit.js";
import {Panel} from "./panel.js";
import {Picture} from "./picture.js";
import {copyText, savePicture} from "./save.js";
import {upload} from "./upload.js";
import {Viewing} from "./viewing.js";

const followTime = 3000; // ms without a touch after which the sliders follow what others change
const linkTime = 300;    // ms without a change after which the address holds the view

const element = (id) => document.getElementById(id);
const notices = new Notices(element("notices"));
const picture = new Picture(element("picture"));

let last = null;         // the last frame's reply, and when it came
let sceneState = null;   // what the statistics say of the scene
let loadingSince = null; // while a scene loads
let sceneNames = [];
let linkTimer = 0;

function view() {
    const [width, height] = picture.size();
    return {camera: orbit.camera(width, height), width, height, exposure: panel.exposure};
}

function changed() {
    viewing.ask();
    keepLink();
}

// The address follows the view, so that reloading or copying it brings the view back.
function keepLink() {
    clearTimeout(linkTimer);
    linkTimer = setTimeout(() => {
        if (viewing.scene) history.replaceState(null, "", linkNow());
    }, linkTime);
}

function linkNow() {
    const {azimuth, elevation, distance, center} = orbit;
    return linkOf({...viewing.wishes, camera: {azimuth, elevation, distance, center}});
}

// A scene is there. `isOther`: not the one of before with other settings.
function loaded(isOther) {
    const {scene, wishes} = viewing;
    if (isOther) orbit.setBall(scene.center, scene.radius);
    if (wishes.camera) Object.assign(orbit, wishes.camera);
    wishes.camera = null;
    panel.show();
    showScenes();
    document.title = `${viewing.sceneName()} – Lumulus`;
    keepLink();
}

function showScenes() {
    const {wishes, welcome} = viewing;
    const options = sceneNames.map((name) => [name, name.replace(/\.toml$/, "").replaceAll("-", " ")]);
    if (wishes.file) options.push(["", wishes.file]);
    fill(element("scene"), options, wishes.file ? "" : wishes.scene || welcome.scene);
}

async function listScenes() {
    try {
        sceneNames = await viewing.sceneNames();
        showScenes();
        notices.clear("list");
    } catch (error) {
        if (error.code !== "closed") notices.set("list", error.message);
    }
}

// Opens a scene of the list, or an upload: all but quality and owner of the light begins anew.
function openScene(what) {
    const {quality, own} = viewing.wishes;
    viewing.wishes = Object.assign(freshWishes(), {quality, own}, what);
    viewing.load();
}

function connected(isOpen) {
    element("status").textContent = isOpen ? "" : "reconnecting";
    if (!isOpen) return;
    element("ask").hidden = true;
    notices.clear("connection");
    listScenes();
}

function tokenWanted() {
    element("ask").hidden = false;
    element("refused").hidden = viewing.token === "";
    element("token").focus();
}

function loading(what) {
    if (!what) loadingSince = null;
    else loadingSince ??= performance.now();
    showProgress(what ? `Loading ${what.name}` : "", null);
}

// `share`: 0 to 1, or null where it is not known. No text: nothing is under way.
function showProgress(text, share) {
    element("loading").hidden = text === "";
    element("loading-text").textContent = text;
    if (share === null) element("progress").removeAttribute("value");
    else element("progress").value = share;
}

function statistics(json) {
    sceneState = json.scene ?? null;
    const seconds = loadingSince === null ? 0 : Math.floor((performance.now() - loadingSince) / 1000);
    const step = json.loading ? `: ${json.loading.step}` : "";
    if (seconds > 0) showProgress(`Loading ${viewing.sceneName()}${step}, ${seconds} s`, null);
    showFigures();
}

function showFigures() {
    if (!last) return;
    // a scene that nobody else may load counts as a light of one's own
    const owner = viewing.wishes.own ? "own" : ownerOfLight(sceneState, viewing.sharesLight);
    writeFigures(element("figures"), figuresOf(last.json, (performance.now() - last.at) / 1000, owner));
}

async function framed({json, payload}) {
    const {offset, bytes} = json.views[0];
    if (!await picture.draw(payload.subarray(offset, offset + bytes))) return;
    const data = document.body.dataset;
    data.frames = Number(data.frames ?? 0) + 1;
    data.firstPicture ??= Math.round(performance.now()); // ms since the page was asked for
    last = {json, at: performance.now()};
    showFigures();
}

// The server gave the light up that the viewer wished for.
function lightLost() {
    panel.show();
    keepLink();
}

// Sliders that nobody uses show the light that the picture has, whoever changed it.
function follow() {
    if (viewing.scene && performance.now() - viewing.touched > followTime) panel.showLight(viewing.lightToCome);
}

async function openFile(file) {
    try {
        showProgress(`Sending ${file.name}`, 0);
        const vdb = await upload(file, viewing.connection, viewing.welcome.limits,
                                 (share) => showProgress(`Sending ${file.name}, ${Math.round(100 * share)} %`, share));
        notices.clear("upload");
        openScene({vdb, file: file.name});
    } catch (error) {
        showProgress("", null);
        notices.set("upload", error.message);
    }
}

async function save(encoding) {
    const name = viewing.sceneName().replace(/\.(toml|vdb)$/, "");
    try {
        await savePicture(viewing.connection, encoding, view(), name);
        notices.clear("save");
    } catch (error) {
        notices.set("save", error.message);
    }
}

function reset() {
    if (!viewing.scene) return;
    viewing.reset();
    orbit.goHome();
    element("cloud").value = "all";
    panel.show();
    keepLink();
}

async function copyLink() {
    const address = new URL(linkNow(), location.href).href;
    if (await copyText(address, element("address"))) element("link").textContent = "Copied";
    setTimeout(() => (element("link").textContent = "Copy link"), 2000);
}

function fullScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else element("stage").requestFullscreen().then(() => notices.clear("full screen"),
                                                   (error) => notices.set("full screen", error.message));
}

function fold(open) {
    element("panel").hidden = !open;
    element("fold").setAttribute("aria-expanded", open);
}

// Files are dropped anywhere on the page.
function acceptDrops() {
    const isFile = (event) => event.dataTransfer?.types.includes("Files");
    document.addEventListener("dragover", (event) => {
        if (!isFile(event)) return;
        event.preventDefault();
        element("drop").hidden = false;
    });
    document.addEventListener("dragleave", (event) => {
        if (!event.relatedTarget) element("drop").hidden = true;
    });
    document.addEventListener("drop", (event) => {
        element("drop").hidden = true;
        if (!isFile(event)) return;
        event.preventDefault();
        if (event.dataTransfer.files[0]) openFile(event.dataTransfer.files[0]);
    });
}

function wire() {
    buttons("camera", (name) => (name === "home" ? orbit.goHome() : orbit.look(cameraPresets[name])));
    buttons("save", save);
    element("reset").addEventListener("click", reset);
    element("link").addEventListener("click", copyLink);
    element("fullscreen").addEventListener("click", fullScreen);
    element("fold").addEventListener("click", () => fold(element("panel").hidden));
    element("open").addEventListener("click", () => element("file").click());
    element("scene").addEventListener("change", (event) => openScene({scene: event.target.value}));
    element("file").addEventListener("change", (event) => {
        if (event.target.files[0]) openFile(event.target.files[0]);
        event.target.value = "";
    });
    element("ask").addEventListener("submit", (event) => {
        event.preventDefault();
        keepToken(element("token").value);
        viewing.connect(element("token").value);
    });
    // browsers keep pages for the way back, with their connections
    window.addEventListener("pagehide", () => viewing.connection.leave());
    window.addEventListener("pageshow", (event) => event.persisted && viewing.connection.release());
    window.addEventListener("hashchange", () => {
        viewing.wishes = readLink(location.hash);
        viewing.load();
    });
    new ResizeObserver(() => viewing.ask()).observe(element("picture"));
    setInterval(() => {
        showFigures();
        follow();
    }, 1000);
}

const token = takeToken();
const url = new URL("frames", document.baseURI);
url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
url.hash = "";
const viewing = new Viewing(url.href, readLink(location.hash), {
    notices, view, connected, tokenWanted, loading, loaded, framed, statistics, lightLost,
});
const orbit = new Orbit(element("picture"), changed);
const panel = new Panel(viewing, () => orbit.azimuth, changed);
if (matchMedia("(max-width: 600px), (max-height: 480px)").matches) fold(false);
acceptDrops();
wire();
viewing.connect(token);
