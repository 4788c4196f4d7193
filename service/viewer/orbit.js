// A camera that orbits a point: drag with mouse or finger, zoom with the wheel or two fingers, or with the arrow keys
// and + and -.

const radians = Math.PI / 180;

export class Orbit {
    constructor(element, changed) {
        this.center = [0, 0, 0];
        this.distance = 1;
        this.azimuth = 20; // degrees, from +Z towards +X, as the scene's own camera
        this.elevation = -5;
        this.changed = changed;
        this.pointers = new Map();
        element.addEventListener("pointerdown", (event) => {
            element.setPointerCapture(event.pointerId);
            this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
        });
        element.addEventListener("pointermove", (event) => this.move(event));
        for (const name of ["pointerup", "pointercancel"])
            element.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
        element.addEventListener("wheel", (event) => {
            event.preventDefault();
            this.zoom(Math.exp(event.deltaY * 0.001));
        }, {passive: false});
        element.addEventListener("keydown", (event) => this.key(event));
    }

    // Looks at a ball so that it fills a view of `fov` degrees.
    frame(center, radius, fov) {
        this.center = center;
        this.distance = radius / Math.sin(0.5 * fov * radians);
    }

    position() {
        const across = Math.cos(this.elevation * radians);
        const direction = [across * Math.sin(this.azimuth * radians), Math.sin(this.elevation * radians),
                           across * Math.cos(this.azimuth * radians)];
        return this.center.map((x, i) => x + this.distance * direction[i]);
    }

    turn(dx, dy) {
        this.azimuth -= 0.3 * dx;
        this.elevation = Math.max(-89, Math.min(89, this.elevation + 0.3 * dy));
        this.changed();
    }

    zoom(factor) {
        this.distance *= Math.max(0.2, Math.min(5, factor));
        this.changed();
    }

    move(event) {
        const before = this.pointers.get(event.pointerId);
        if (!before) return;
        const now = [event.clientX, event.clientY];
        if (this.pointers.size === 1) {
            this.turn(now[0] - before[0], now[1] - before[1]);
        } else {
            const [other] = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
            const span = (a) => Math.max(1, Math.hypot(a[0] - other[0], a[1] - other[1]));
            this.zoom(span(before) / span(now));
        }
        this.pointers.set(event.pointerId, now);
    }

    key(event) {
        const turns = {ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20]};
        if (turns[event.key]) this.turn(...turns[event.key]);
        if (event.key === "+") this.zoom(0.8);
        if (event.key === "-") this.zoom(1.25);
    }
}
