// What a viewer takes along: the picture as a file, or the link of the view.

const types = {png: "image/png", exr: "image/x-exr"};
const products = ["color", "cloud", "transmittance", "depth", "front"];

function download(name, blob) {
    const anchor = document.createElement("a");
    anchor.href = URL.createObjectURL(blob);
    anchor.download = name;
    anchor.click();
    setTimeout(() => URL.revokeObjectURL(anchor.href), 60000);
}

// Saves the view with the photons that are there now: `view` has camera, width, height and exposure. Errors:
// ServiceError.
export async function savePicture(connection, encoding, view, name) {
    const {exposure, ...place} = view;
    const wishes = {...place, encoding, queue: true, budget: {photons: 0}};
    if (encoding === "png") wishes.exposure = exposure;
    else wishes.products = products;
    const {json, payload} = await connection.ask("frame", wishes);
    const {offset, bytes} = json.views[0];
    download(`${name}.${encoding}`, new Blob([payload.slice(offset, offset + bytes)], {type: types[encoding]}));
}

// Copies text. Browsers that refuse (pages without https) get a field in which it is selected.
export async function copyText(text, field) {
    try {
        await navigator.clipboard.writeText(text);
        return true;
    } catch {
        field.hidden = false;
        field.value = text;
        field.focus();
        field.select();
        return false;
    }
}
