// Errors and warnings over the picture, one a topic: the next success of a topic takes its notice away.

export class Notices {
    constructor(list) {
        this.list = list;
        this.shown = new Map();
    }

    set(topic, text, kind = "error") {
        if (this.shown.get(topic)?.querySelector("span").textContent === text) return; // it is not announced twice
        this.clear(topic);
        const item = document.createElement("li");
        item.className = kind;
        item.dataset.topic = topic;
        const words = document.createElement("span");
        words.textContent = text;
        const close = document.createElement("button");
        close.type = "button";
        close.textContent = "×";
        close.setAttribute("aria-label", "dismiss");
        close.addEventListener("click", () => this.clear(topic));
        item.append(words, close);
        this.list.append(item);
        this.shown.set(topic, item);
    }

    clear(topic) {
        this.shown.get(topic)?.remove();
        this.shown.delete(topic);
    }
}
