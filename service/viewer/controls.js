// Sliders with their figures, and groups of buttons.

const element = (id) => document.getElementById(id);

// `shows`: by the id of an <input type="range">, what to write for its value. Calls moved(name, value) while the user
// moves one, and released(name, value) when it is let go.
export class Sliders {
    constructor(shows, moved, released) {
        this.shows = shows;
        for (const name of Object.keys(shows)) {
            element(name).addEventListener("input", () => {
                this.show(name);
                moved(name, this.value(name));
            });
            element(name).addEventListener("change", () => released(name, this.value(name)));
        }
    }

    value(name) {
        return Number(element(name).value);
    }

    set(name, number) {
        element(name).value = number;
        this.show(name);
    }

    range(name, low, high) {
        element(name).min = low;
        element(name).max = high;
    }

    enable(name, enabled) {
        element(name).disabled = !enabled;
        this.show(name);
    }

    show(name) {
        const text = element(name).disabled ? "–" : this.shows[name](this.value(name));
        element(name).parentElement.querySelector("output").textContent = text;
        element(name).setAttribute("aria-valuetext", text);
    }
}

// Calls chosen(value) for a click on a button of the page with `data-NAME="value"`.
export function buttons(name, chosen) {
    for (const button of document.querySelectorAll(`button[data-${name}]`))
        button.addEventListener("click", () => chosen(button.dataset[name]));
}

// Fills a <select> with [value, text] pairs, and chooses one.
export function fill(select, options, value) {
    select.replaceChildren(...options.map(([one, text]) => new Option(text, one, false, one === value)));
    if (!options.some(([one]) => one === value)) select.selectedIndex = -1;
}
