// A camera that orbits a point. Mouse: drag to orbit, with Shift or the right button to move, wheel to zoom. Touch: one
// finger orbits, two move and zoom. Keys: arrows, with Shift to move, + and -, Home.

const radians = Math.PI / 180;
const home = {azimuth: 20, elevation: -5}; // degrees, as the scene's own camera
const leastFov = 40;                       // degrees, of the picture's shorter side
const keyStep = 20;                        // pixels of a drag that an arrow key stands for

// Directions from which the cloud can be seen, degrees.
export const cameraPresets = {
    front: {azimuth: 0, elevation: 0},
    left: {azimuth: -90, elevation: 0},
    right: {azimuth: 90, elevation: 0},
    above: {azimuth: 20, elevation: 70},
    below: {azimuth: 20, elevation: -60},
};

const clamp = (x, low, high) => Math.max(low, Math.min(high, x));

export class Orbit {
    constructor(element, changed) {
        this.element = element;
        this.changed = changed;
        this.center = [0, 0, 0];
        this.distance = 1;
        this.radius = 1;
        this.middle = [0, 0, 0];
        Object.assign(this, home);
        this.pointers = new Map();
        element.addEventListener("pointerdown", (event) => this.press(event));
        element.addEventListener("pointermove", (event) => this.move(event));
        for (const name of ["pointerup", "pointercancel"])
            element.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
        element.addEventListener("contextmenu", (event) => event.preventDefault());
        element.addEventListener("dblclick", () => this.goHome());
        element.addEventListener("wheel", (event) => {
            event.preventDefault();
            this.zoom(Math.exp(clamp(event.deltaY, -200, 200) * 0.001));
        }, {passive: false});
        element.addEventListener("keydown", (event) => this.key(event));
    }

    // Takes the ball of a new scene, and looks at it.
    setBall(middle, radius) {
        this.middle = middle;
        this.radius = radius > 0 ? radius : 1;
        Object.assign(this, home, this.wholeView());
    }

    wholeView() {
        return {center: [...this.middle], distance: 0.8 * this.radius / Math.sin(0.5 * leastFov * radians)};
    }

    goHome() {
        this.look(home);
    }

    // Looks at the whole ball from a direction.
    look(direction) {
        Object.assign(this, direction, this.wholeView());
        this.changed();
    }

    // The camera as docs/protocol.md has it, for a picture of a size.
    camera(width, height) {
        const narrow = Math.min(1, width / height);
        const verticalFov = 2 * Math.atan(Math.tan(0.5 * leastFov * radians) / narrow) / radians;
        const towards = this.direction();
        return {
            position: this.center.map((x, i) => x + this.distance * towards[i]),
            target: this.center,
            vertical_fov: Math.min(verticalFov, 120),
        };
    }

    // From the centre to the camera.
    direction() {
        const across = Math.cos(this.elevation * radians);
        return [across * Math.sin(this.azimuth * radians), Math.sin(this.elevation * radians),
                across * Math.cos(this.azimuth * radians)];
    }

    turn(dx, dy) {
        this.azimuth = ((this.azimuth - 0.3 * dx + 540) % 360 + 360) % 360 - 180;
        this.elevation = clamp(this.elevation + 0.3 * dy, -89, 89);
        this.changed();
    }

    // Moves the centre with the pointer, in the plane that faces the camera.
    pan(dx, dy) {
        const side = Math.min(this.element.clientWidth, this.element.clientHeight);
        const metres = 2 * this.distance * Math.tan(0.5 * leastFov * radians) / Math.max(1, side);
        const [a, e] = [this.azimuth * radians, this.elevation * radians];
        const right = [Math.cos(a), 0, -Math.sin(a)];
        const up = [-Math.sin(e) * Math.sin(a), Math.cos(e), -Math.sin(e) * Math.cos(a)];
        this.center = this.center.map((x, i) => x + metres * (dy * up[i] - dx * right[i]));
        this.changed();
    }

    zoom(factor) {
        this.distance = clamp(this.distance * clamp(factor, 0.2, 5), 0.01 * this.radius, 100 * this.radius);
        this.changed();
    }

    press(event) {
        this.element.setPointerCapture(event.pointerId);
        this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    }

    move(event) {
        const before = this.pointers.get(event.pointerId);
        if (!before) return;
        const now = [event.clientX, event.clientY];
        const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
        this.pointers.set(event.pointerId, now);
        if (this.pointers.size === 1) {
            if (event.shiftKey || (event.buttons & 2) !== 0) this.pan(dx, dy);
            else this.turn(dx, dy);
            return;
        }
        const [other] = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
        const span = (place) => Math.max(1, Math.hypot(place[0] - other[0], place[1] - other[1]));
        this.pan(0.5 * dx, 0.5 * dy); // what the middle of the two fingers moves
        this.zoom(span(before) / span(now));
    }

    key(event) {
        const steps = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
        const zooms = {"+": 0.8, "=": 0.8, "-": 1.25}[event.key];
        if (!steps && !zooms && event.key !== "Home") return;
        event.preventDefault();
        if (steps && event.shiftKey) this.pan(-keyStep * steps[0], -keyStep * steps[1]);
        else if (steps) this.turn(keyStep * steps[0], keyStep * steps[1]);
        else if (zooms) this.zoom(zooms);
        else this.goHome();
    }
}
