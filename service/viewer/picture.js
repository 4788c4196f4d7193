// The canvas: pictures come as JPEG and are drawn in the order in which they came.

const mostWidth = 1280; // pixels of a picture

export class Picture {
    constructor(canvas) {
        this.canvas = canvas;
        this.arrived = 0;
        this.shown = 0;
    }

    // Width and height in pixels that a picture should have: those of the screen, up to a limit.
    size() {
        const {clientWidth, clientHeight} = this.canvas;
        const ratio = Math.min(window.devicePixelRatio, 1.5);
        const scale = Math.min(ratio, mostWidth / Math.max(1, clientWidth));
        return [clientWidth, clientHeight].map((length) => Math.max(16, Math.round(length * scale)));
    }

    // Draws a JPEG. Returns false where a later one was there first.
    async draw(bytes) {
        const number = ++this.arrived;
        const bitmap = await createImageBitmap(new Blob([bytes], {type: "image/jpeg"}));
        if (number < this.shown) return false;
        this.shown = number;
        this.canvas.width = bitmap.width;
        this.canvas.height = bitmap.height;
        this.canvas.getContext("2d").drawImage(bitmap, 0, 0);
        return true;
    }
}
