// Figures of the picture: what a frame's reply says of its light, in words.

const count = (n) => (n >= 1e6 ? `${(n / 1e6).toFixed(2)} M` : n >= 1e3 ? `${(n / 1e3).toFixed(0)} k` : String(n));

export function duration(seconds) {
    if (seconds < 60) return `${Math.floor(seconds)} s`;
    if (seconds < 3600) return `${Math.floor(seconds / 60)} min`;
    return `${Math.floor(seconds / 3600)} h`;
}

// `scene`: what the server's statistics say of it, null where that is not known; `isShared`: viewers change the light of
// each other.
export function ownerOfLight(scene, isShared) {
    if (scene?.own) return "own";
    const others = (scene?.clients ?? 1) - 1;
    const they = others === 1 ? "one other" : `${others} others`;
    if (!isShared) return others < 1 ? "the scene’s" : `the scene’s, ${they} here`;
    return others < 1 ? "shared, nobody else here" : `shared with ${they}`;
}

// [what, text] pairs for a frame's reply that came `since` seconds ago.
export function figuresOf(json, since, owner) {
    const {current_generations: current, generations, milliseconds, noise, bias, reduction} = json;
    const traced = current < generations ? `${current} of ${generations} in this light` : String(generations);
    const reduced = reduction > 1 ? ` at 1/${reduction} size` : "";
    return [
        ["samples", `${count(json.photons)} photons`],
        ["generations", traced],
        ["noise", noise === null ? "not known yet" : `${(100 * Math.sqrt(noise)).toFixed(1)} %`],
        ["bias", bias ? `${(100 * bias.value).toFixed(1)} ± ${(100 * bias.sigma).toFixed(1)} %` : "where it rests"],
        ["age of light", duration(json.oldest_seconds + since)],
        ["frame", `${Math.round(milliseconds.draw + milliseconds.encode)} ms${reduced}`],
        ["light", owner],
    ];
}

// Writes the pairs into a <dl>.
export function writeFigures(list, pairs) {
    const texts = pairs.flat();
    if (list.children.length !== pairs.length)
        list.replaceChildren(...pairs.map(() => {
            const pair = document.createElement("div");
            pair.append(document.createElement("dt"), document.createElement("dd"));
            return pair;
        }));
    list.querySelectorAll("dt, dd").forEach((one, i) => {
        if (one.textContent !== texts[i]) one.textContent = texts[i];
    });
}
