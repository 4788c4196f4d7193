// How far one sees in a scene's fog, and what changes that.

const koschmieder = 3.912; // optical depth at the visibility

// Metres of visibility in all media together, where the density of each is 1. Infinite without fog.
export function visibilityOf(media) {
    const depth = media.reduce((sum, medium) => sum + (medium.visibility > 0 ? koschmieder / medium.visibility : 0), 0);
    return koschmieder / depth;
}

// Changes of media for another visibility of all together: their colours, albedos and shapes stay. `original`: those of
// the scene's file.
export function mediaFor(original, visibility) {
    const factor = visibilityOf(original) / visibility;
    const times = (numbers) => numbers.map((one) => one * factor);
    return original.map((own, medium) => {
        const [red, green, blue] = own.scattering;
        const grey = red === green && green === blue && own.absorption.every((one) => one === 0);
        if (grey && own.visibility > 0) return {medium, visibility: own.visibility / factor};
        return {medium, scattering: times(own.scattering), absorption: times(own.absorption), g: own.g};
    });
}

// Metres of visibility that a frame shows, by its `repeat`; null where it is the scene's own, or was changed otherwise.
export function visibilityShown(original, repeat) {
    const first = original.findIndex((medium) => medium.visibility > 0);
    for (const line of repeat) {
        const [, list] = new RegExp(`^fog\\.media\\.${first}\\.scattering=\\[(.*)\\]$`).exec(line) ?? [];
        const own = original[first]?.scattering[1];
        if (list && own > 0) return visibilityOf(original) * own / Number(list.split(",")[1]);
        const [, metres] = new RegExp(`^fog\\.media\\.${first}\\.visibility=(.*)$`).exec(line) ?? [];
        if (metres) return visibilityOf(original) * Number(metres) / original[first].visibility;
    }
    return null;
}
