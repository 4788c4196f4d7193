// One viewer's view of the server: which scene is loaded, the stream of its pictures, and changes of its light.
import {Connection} from "./protocol.js";
import {freshWishes} from "./link.js";
import {mediaFor} from "./fog.js";
import {changesOf, lightShown} from "./light.js";

const restTime = 400;          // ms without a touch after which pictures get all pixels
const hastyMilliseconds = 150; // for a picture until then
const pollTime = {loading: 300, watching: 2000}; // ms between questions for statistics
const longestRetry = 30000;    // ms until a scene that failed, or a light without room, is asked for again
const lightRetry = 2000;       // ms until a light that found no room is asked for again, the first time
const loadKeys = ["scene", "vdb", "file", "quality", "own", "g", "newFog"]; // wishes that need the scene to be loaded

// `page` is told what happens: connected(isOpen), tokenWanted(), loading({name} or null), loaded(isOther), framed(message),
// statistics(json), and lightLost() where the server gave the viewer's light up. It has `notices`, and view(): {camera, width, height, exposure}.
export class Viewing {
    constructor(url, wishes, page) {
        this.page = page;
        this.wishes = wishes;
        this.token = "";
        this.welcome = null;
        this.scene = null;  // the reply to load_scene
        this.light = null;  // that the last frame showed
        this.held = null;   // the wishes that loaded `scene`
        this.loads = 0;
        this.isLoading = false;
        this.touched = 0;
        this.frameAsked = false;
        this.fogSent = false;    // and not answered
        this.fogUnseen = false;  // nor seen in a frame since
        this.unsent = new Set(); // changes of light: "sun", "fog", or the cloud of an extinction
        this.retry = 1000;
        this.lightRetry = lightRetry;
        this.isLightLost = false; // the wishes are not what the server draws, until a frame tells
        this.url = url;
    }

    connect(token) {
        this.token = token;
        if (this.connection) {
            this.connection.release();
            return;
        }
        this.connection = new Connection(this.url, {
            opened: () => this.greet(),
            closed: () => this.page.connected(false),
            refused: (error) => this.page.notices.set("connection", error.message),
            framed: (message) => this.framed(message),
            streamFailed: (error) => this.streamFailed(error),
        });
        this.poll();
    }

    async greet() {
        try {
            const hello = {version: 1, token: this.token, client: "viewer"};
            this.welcome = (await this.connection.ask("hello", hello)).json;
        } catch (error) {
            if (error.code === "unauthorized") {
                this.connection.hold();
                this.page.tokenWanted();
            } else if (error.code !== "closed") {
                this.page.notices.set("connection", error.message);
            }
            return;
        }
        this.page.connected(true);
        if (await this.hasScene().catch(() => false)) this.load();
    }

    // Whether there is something to load: where the server has no default scene, the first of its folder.
    async hasScene() {
        if (this.wishes.scene || this.wishes.vdb || this.welcome.scene) return true;
        this.wishes.scene = (await this.sceneNames())[0] ?? "";
        if (!this.wishes.scene) this.page.notices.set("scene", "There is no scene here: drop a .vdb file.", "warning");
        return this.wishes.scene !== "";
    }

    // Names of the scenes in the server's folder.
    async sceneNames() {
        return (await this.connection.ask("list_scenes", {})).json.scenes;
    }

    sceneName() {
        return this.wishes.file || this.wishes.scene || this.welcome.scene;
    }

    // Whether others see what this viewer changes.
    get sharesLight() {
        return this.welcome.shared_light && !this.wishes.own;
    }

    sceneRequest() {
        const {scene, vdb, quality, own, g, newFog} = this.wishes;
        const set = [...g].map(([cloud, value]) => `cloud.${cloud}.phase.g=${value}`);
        if (newFog !== null) set.push(`fog.media=[{visibility=${newFog}, bottom=-1000, top=1000}]`);
        const name = scene || (vdb ? "" : this.welcome.scene);
        const chosen = quality ?? this.welcome.quality;
        return {
            ...(name ? {name} : {}),
            ...(vdb ? {vdb} : {}),
            ...(chosen ? {quality: chosen} : {}),
            ...(own ? {private: true} : {}),
            set,
        };
    }

    // Loads the scene of the wishes; of several that are under way the last one counts. `instead`: of one that failed,
    // whose notice stays.
    async load(instead = false) {
        const number = ++this.loads;
        if (!this.welcome.shared_light) this.wishes.own = false; // who changes light gets its own there anyway
        this.isLoading = true;
        this.page.loading({name: this.sceneName()});
        try {
            const request = this.sceneRequest();
            // a file alone stands in a scene of defaults
            const toml = request.name ? undefined : new TextEncoder().encode("# an uploaded cloud\n");
            const {json} = await this.connection.ask("load_scene", request, toml);
            if (number !== this.loads) return;
            if (this.wishes.fog !== null && json.original.media.length === 0 && this.wishes.newFog === null) {
                this.wishes.newFog = this.wishes.fog; // of a link: the scene needs some to change it
                await this.load(instead);
                return;
            }
            if (!instead) this.page.notices.clear("scene");
            this.loaded(json);
        } catch (error) {
            if (number === this.loads && error.code !== "closed") this.loadFailed(error);
        } finally {
            if (number === this.loads) {
                this.isLoading = false;
                this.page.loading(null);
            }
        }
    }

    loaded(json) {
        const before = this.held;
        this.scene = json;
        this.light = lightShown(json.original, []);
        this.held = Object.fromEntries(loadKeys.map((key) => [key, this.wishes[key]]));
        this.held.g = new Map(this.wishes.g);
        const {notices} = this.page;
        notices.clear("warnings");
        notices.clear("light");
        clearTimeout(this.lightTimer);
        this.lightRetry = lightRetry;
        this.isLightLost = false;
        if (json.warnings.length > 0) notices.set("warnings", json.warnings.join(" "), "warning");
        this.page.loaded(before?.scene !== this.held.scene || before?.vdb !== this.held.vdb);
        this.sendAllLight();
        this.ask();
    }

    // The view stays with the scene that is there; where there is none, the server's own takes its place.
    loadFailed(error) {
        this.page.notices.set("scene", `${this.sceneName()}: ${error.message}`);
        const stays = this.held ?? freshWishes();
        const otherwise = loadKeys.some((key) => key !== "g" && this.wishes[key] !== stays[key]) || this.wishes.g.size > 0;
        for (const key of loadKeys) this.wishes[key] = stays[key];
        this.wishes.g = new Map(stays.g);
        if (stays.newFog === null && !this.hasFog) this.wishes.fog = null;
        if (this.scene) this.page.loaded(false);
        else if (otherwise && this.welcome.scene) this.load(true);
    }

    frameWishes() {
        const hasty = performance.now() - this.touched < restTime;
        return {
            ...this.page.view(),
            encoding: "jpeg",
            quality: 88,
            when: "change",
            ...(hasty ? {budget: {milliseconds: hastyMilliseconds}} : {}),
        };
    }

    // Asks for the view of now and sends changes of light, at most once a picture of the screen, and once more at rest.
    ask() {
        this.touched = performance.now();
        if (this.frameAsked || !this.scene) return;
        this.frameAsked = true;
        requestAnimationFrame(() => {
            this.frameAsked = false;
            this.connection.stream(this.frameWishes());
            this.sendLight();
            clearTimeout(this.rest);
            this.rest = setTimeout(() => this.connection.stream(this.frameWishes()), restTime + 20);
        });
    }

    // Light is changed for once, not again by every frame: others who share it may change it too.
    changeSun(angles) {
        this.wishes.sun = angles;
        this.lightRetry = lightRetry;
        this.unsent.add("sun");
        this.ask();
    }

    // `cloud`: an index, or "all".
    changeExtinction(cloud, value) {
        if (cloud === "all") this.wishes.extinction.clear();
        this.wishes.extinction.set(cloud, value);
        this.lightRetry = lightRetry;
        this.unsent.add(cloud);
        this.ask();
    }

    // Whether the scene has fog that can change in place.
    get hasFog() {
        return this.light !== null && this.light.fog !== null && Number.isFinite(this.light.fog);
    }

    // The light of the last frame, with fog that the server has been asked for and has not yet.
    get lightToCome() {
        return this.fogSent || this.fogUnseen ? {...this.light, fog: this.wishes.fog ?? this.light.fog} : this.light;
    }

    changeFog(metres) {
        this.wishes.fog = metres;
        this.lightRetry = lightRetry;
        this.unsent.add("fog");
        this.ask();
    }

    sendAllLight() {
        if (this.wishes.fog !== null && this.hasFog) this.unsent.add("fog");
        if (this.wishes.sun) this.unsent.add("sun");
        for (const cloud of this.wishes.extinction.keys()) this.unsent.add(cloud);
    }

    async sendLight() {
        const changes = [];
        const {sun, extinction} = this.wishes;
        if (this.unsent.has("sun") && sun) changes.push({sun: {azimuth: sun[0], elevation: sun[1]}});
        for (const [cloud, value] of extinction)
            if (this.unsent.has(cloud))
                changes.push({extinction: value, ...(cloud === "all" ? {} : {cloud})});
        // one change of fog at a time: it takes the server a while, and of those that come meanwhile the last one counts
        const fog = this.unsent.has("fog");
        this.unsent.clear();
        if (fog && this.fogSent) this.unsent.add("fog");
        else if (fog) this.sendFog();
        if (changes.length > 0) await this.change(changes);
    }

    async sendFog() {
        this.fogSent = true;
        await this.change([{media: mediaFor(this.scene.original.media, this.wishes.fog)}]);
        this.fogSent = false;
        this.fogUnseen = true;
        if (this.unsent.has("fog")) this.sendLight();
    }

    async change(changes) {
        try {
            await Promise.all(changes.map((one) => this.connection.ask("change", one)));
            this.page.notices.clear("light");
            clearTimeout(this.lightTimer);
        } catch (error) {
            if (error.code === "busy") this.waitForLight(error);
            else if (error.code !== "closed" && error.code !== "superseded") this.page.notices.set("light", error.message);
        }
    }

    // The server has no room for another light: the wishes stay, and are sent again, less and less often, until it has.
    waitForLight(error) {
        const text = `Your light waits: ${error.message}. The page asks again until there is room.`;
        this.page.notices.set("light", text, "warning");
        clearTimeout(this.lightTimer);
        this.lightTimer = setTimeout(() => {
            this.sendAllLight();
            this.sendLight();
        }, this.lightRetry);
        this.lightRetry = Math.min(2 * this.lightRetry, longestRetry);
    }

    // All wishes but the scene's name are forgotten, and the light is the one of the scene's file again.
    reset() {
        const {scene, vdb, file, own} = this.wishes;
        this.wishes = Object.assign(freshWishes(), {scene, vdb, file, own});
        const changed = this.held && (this.held.g.size > 0 || this.held.newFog !== null || this.held.quality !== null);
        const other = this.isLoading || changed; // a load under way may show another scene any moment
        const {sun, clouds, media} = this.scene.original;
        // clouds without extinction have none to go back to
        const changes = [{sun}, ...clouds.map(({extinction}, cloud) => ({cloud, extinction})).filter((one) => one.extinction > 0)];
        if (media.length > 0) changes.push({media: media.map((_, medium) => ({medium, original: true}))});
        this.light = lightShown(this.scene.original, []);
        this.unsent.clear();
        if (!this.welcome.shared_light) this.load(); // which gives a light of the viewer's own up
        else if (other) this.load().then(() => this.change(changes));
        else this.change(changes);
        this.ask();
    }

    framed(message) {
        this.page.notices.clear("stream");
        this.retry = 1000;
        if (this.isLoading) return; // it shows the scene of before
        this.light = lightShown(this.scene.original, message.json.repeat);
        this.fogUnseen = false;
        if (this.isLightLost) {
            this.isLightLost = false;
            Object.assign(this.wishes, changesOf(this.light, lightShown(this.scene.original, [])));
            this.page.lightLost();
        }
        this.page.framed(message);
    }

    // A scene that failed is gone: it is loaded again, less and less often. Light that takes too long to trace, or has
    // no room, is gone too, and the stream goes on with the light of before.
    streamFailed(error) {
        const {code, message} = error;
        if (code === "superseded" || code === "closed") return;
        if (code === "busy") this.waitForLight(error);
        else if (code === "too_large") this.page.notices.set("light", `The light of before is back: ${message}`);
        else this.page.notices.set("stream", message);
        if (code === "too_large") this.isLightLost = true;
        if (code === "too_large" || code === "busy")
            setTimeout(() => this.connection.stream(this.frameWishes()), this.retry);
        else if (code === "internal" || code === "no_scene")
            setTimeout(() => this.load(), this.retry);
        else
            return;
        this.retry = Math.min(2 * this.retry, longestRetry);
    }

    async poll() {
        if (this.welcome && this.connection.isOpen && !document.hidden) {
            try {
                this.page.statistics((await this.connection.ask("statistics", {})).json);
            } catch {
                // it comes back with the connection
            }
        }
        setTimeout(() => this.poll(), this.isLoading ? pollTime.loading : pollTime.watching);
    }
}
