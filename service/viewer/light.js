// Angles of the sun, and what of a scene's light differs from its file.

import {visibilityOf, visibilityShown} from "./fog.js";

const degrees = 180 / Math.PI;

// Degrees in -180 to 180.
export const wrapped = (angle) => ((angle + 540) % 360 + 360) % 360 - 180;

// Azimuth and elevation (degrees, docs/scene-format.md) of a direction towards the sun.
export function sunAngles([x, y, z]) {
    return [wrapped(Math.atan2(x, -z) * degrees), Math.asin(Math.max(-1, Math.min(1, y))) * degrees];
}

// Places of the sun, degrees: the azimuth as seen from the camera (0 behind it, 180 behind the cloud), and the elevation.
const places = {front: [0, 30], side: [90, 30], back: [180, 20], noon: [45, 85], dusk: [90, 4]};

// The sun of a preset for a camera at an azimuth (degrees from +Z towards +X).
export function sunPreset(name, cameraAzimuth) {
    const [from, elevation] = places[name];
    return [Math.round(wrapped(180 - cameraAzimuth + from)), elevation];
}

// The light that a frame shows: `original`, that of the scene's file, with what the frame's `repeat` says is different.
export function lightShown(original, repeat) {
    let sun = original.sun.direction_to;
    const extinction = original.clouds.map((cloud) => cloud.extinction);
    for (const line of repeat) {
        const direction = /^sun\.direction_to=\[(.*)\]$/.exec(line);
        if (direction) sun = direction[1].split(",").map(Number);
        const cloud = /^cloud\.(\d+)\.extinction=(.*)$/.exec(line);
        if (cloud) extinction[Number(cloud[1])] = Number(cloud[2]);
    }
    const {media} = original;
    const fog = media.length > 0 ? visibilityShown(media, repeat) ?? visibilityOf(media) : null;
    return {sun: sunAngles(sun), extinction, fog};
}

// What a viewer has to wish, {sun, extinction, fog}, to see a light where the scene's own is `original`.
export function changesOf(light, original) {
    const sun = light.sun.some((angle, i) => Math.abs(angle - original.sun[i]) > 0.01) ? light.sun : null;
    const extinction = new Map([...light.extinction.entries()].filter(([i, value]) => value !== original.extinction[i]));
    const fog = light.fog !== null && Math.abs(light.fog / original.fog - 1) > 1e-3 ? light.fog : null;
    return {sun, extinction, fog};
}
