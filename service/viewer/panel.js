// The sliders and fields that say how the scene looks: they show the light of the scene, and what the viewer wishes of it.
import {buttons, fill, Sliders} from "./controls.js";
import {visibilityOf} from "./fog.js";
import {sunPreset} from "./light.js";

const visibilities = [50, 5e4]; // metres, of the slider in fog
const clearAir = 1e5;           // at which there is none, in scenes without fog
const isClear = (metres) => metres > 0.99 * clearAir; // sliders have steps

const element = (id) => document.getElementById(id);

function distance(metres) {
    if (isClear(metres)) return "clear";
    return metres < 999.5 ? `${Math.round(metres)} m` : `${(metres / 1000).toFixed(metres < 1e4 ? 1 : 0)} km`;
}

// Metres of the slider, without figures that nobody sees.
const visibilityAt = (value) => Number((10 ** value).toPrecision(4));

const shows = {
    azimuth: (v) => `${Math.round(v)}°`,
    elevation: (v) => `${Math.round(v)}°`,
    exposure: (v) => `${v > 0 ? "+" : ""}${v.toFixed(1)}`,
    extinction: (v) => `${(10 ** v).toPrecision(2)} /m`,
    g: (v) => v.toFixed(2),
    fog: (v) => distance(10 ** v),
};

// `changed()` is called where the viewer has changed wishes; `azimuth()` gives the camera's.
export class Panel {
    constructor(viewing, azimuth, changed) {
        this.viewing = viewing;
        this.changed = changed;
        this.sliders = new Sliders(shows, (name, value) => this.moved(name, value),
                                   (name, value) => this.released(name, value));
        buttons("sun", (name) => this.moveSun(sunPreset(name, azimuth())));
        element("cloud").addEventListener("change", () => this.showLight(this.wishedLight()));
        element("quality").addEventListener("change", (event) => this.reload({quality: event.target.value}));
        element("own").addEventListener("change", (event) => this.reload({own: event.target.checked}));
    }

    get exposure() {
        return this.sliders.value("exposure");
    }

    // Which cloud the sliders mean: "all", or an index.
    chosenCloud() {
        const chosen = element("cloud").value;
        return chosen === "" || chosen === "all" ? "all" : Number(chosen);
    }

    chosenClouds() {
        const chosen = this.chosenCloud();
        return chosen === "all" ? this.viewing.scene.original.clouds.map((_, i) => i) : [chosen];
    }

    moved(name, value) {
        const {viewing, sliders} = this;
        if (!viewing.scene) return;
        viewing.touched = performance.now();
        if (name === "azimuth" || name === "elevation")
            viewing.changeSun([sliders.value("azimuth"), sliders.value("elevation")]);
        if (name === "extinction") viewing.changeExtinction(this.chosenCloud(), Number((10 ** value).toPrecision(4)));
        if (name === "exposure") viewing.wishes.exposure = value;
        if (name === "fog" && viewing.hasFog) viewing.changeFog(visibilityAt(value));
        if (name !== "g" && (name !== "fog" || viewing.hasFog)) this.changed();
    }

    // g needs a scene of its own, and so does fog where there is none; the photons begin anew.
    released(name, value) {
        const {scene, wishes, hasFog} = this.viewing;
        if (!scene || (name !== "g" && (name !== "fog" || hasFog))) return;
        if (name === "fog") {
            if (isClear(10 ** value)) return;
            wishes.newFog = wishes.fog = visibilityAt(value);
        }
        if (name === "g")
            for (const i of this.chosenClouds())
                if (scene.original.clouds[i].g !== undefined) wishes.g.set(i, value);
        this.reload({});
    }

    reload(wishes) {
        Object.assign(this.viewing.wishes, wishes);
        this.viewing.load();
    }

    moveSun(angles) {
        this.viewing.changeSun(angles);
        this.sliders.set("azimuth", angles[0]);
        this.sliders.set("elevation", angles[1]);
        this.changed();
    }

    // Brings the sliders to a light: {sun: [azimuth, elevation], extinction: [of each cloud], fog: metres or null}.
    showLight(light) {
        const {sliders} = this;
        const {clouds} = this.viewing.scene.original;
        const chosen = this.chosenClouds();
        sliders.set("azimuth", light.sun[0]);
        sliders.set("elevation", light.sun[1]);
        this.showFog(light.fog);
        const extinction = chosen.length > 0 ? light.extinction[chosen[0]] : 0;
        sliders.enable("extinction", extinction > 0);
        if (extinction > 0) sliders.set("extinction", Math.log10(extinction));
        const scattering = chosen.find((i) => clouds[i].g !== undefined);
        sliders.enable("g", scattering !== undefined);
        if (scattering !== undefined)
            sliders.set("g", this.viewing.wishes.g.get(scattering) ?? clouds[scattering].g);
    }

    // `visibility`: null where there is no fog.
    showFog(visibility) {
        const {scene, hasFog} = this.viewing;
        const own = hasFog ? visibilityOf(scene.original.media) : clearAir; // can be reached again
        const [low, high] = visibilities;
        const steps = 1000; // of the slider in a factor of ten: its ends lie on them, so that round numbers do
        this.sliders.range("fog", Math.floor(steps * Math.log10(Math.min(low, own))) / steps,
            Math.ceil(steps * Math.log10(Math.max(high, own))) / steps);
        this.sliders.set("fog", Math.log10(hasFog ? visibility : clearAir));
    }

    // The light of the last frame, with what this viewer wishes.
    wishedLight() {
        const {light, wishes: {sun, extinction, fog}} = this.viewing;
        return {
            sun: sun ?? light.sun,
            extinction: light.extinction.map((value, i) => extinction.get(i) ?? extinction.get("all") ?? value),
            fog: light.fog === null ? null : fog ?? light.fog,
        };
    }

    // Shows a scene that was loaded, or the wishes after they changed as a whole.
    show() {
        const {wishes, scene, welcome} = this.viewing;
        this.showClouds(scene.original.clouds);
        element("quality").value = wishes.quality ?? welcome.quality;
        element("own").checked = wishes.own;
        element("own").parentElement.hidden = !welcome.shared_light;
        this.sliders.set("exposure", wishes.exposure ?? scene.exposure);
        this.showLight(this.wishedLight());
    }

    showClouds(clouds) {
        const before = element("cloud").value;
        const names = clouds.map(({name}, i) => [String(i), name === String(i) ? `cloud ${i + 1}` : name]);
        fill(element("cloud"), [["all", "all clouds"], ...names], names.some(([value]) => value === before) ? before : "all");
        element("which").hidden = clouds.length < 2;
        const values = clouds.map(({extinction}) => extinction).filter((x) => x > 0);
        const middle = values.length > 0 ? Math.round(Math.log10(values[0])) : -1;
        this.sliders.range("extinction", middle - 2, middle + 1.5);
    }
}
