// Search also works where pages are opened as files: the index comes as a script, and where a browser gives files no worker a frame does the work.
var __search = {
    index: new Promise(function (found) {
        window.wadi_search_index = found;
        window.addEventListener("load", function () {
            var script = document.createElement("script");
            script.src = JSON.parse(document.getElementById("__config").textContent).base + "/search/search_index.js";
            document.head.appendChild(script);
        });
    }),
};
if (location.protocol === "file:") {
    window.Worker = class extends EventTarget {
        constructor(address) {
            super();
            var frame = document.createElement("iframe");
            frame.hidden = true;
            document.body.appendChild(frame);
            this.inside = frame.contentWindow;
            var waiting = (this.waiting = []);
            window.addEventListener("message", (event) => {
                if (event.source !== this.inside) return;
                if (event.data === "wadi: ready") {
                    this.waiting = null;
                    waiting.forEach((data) => this.postMessage(data));
                } else this.dispatchEvent(new MessageEvent("message", { data: event.data }));
            });
            this.inside.document.open();
            this.inside.document.write(
                "<script>postMessage = function (data) { parent.postMessage(data, '*'); };</" + "script><script src='" + address + "'></" +
                "script><script>postMessage('wadi: ready');</" + "script>");
            this.inside.document.close();
        }
        postMessage(data) {
            if (this.waiting) this.waiting.push(data);
            else window.postMessage.call(this.inside, data, "*"); // the frame's own leads out of it
        }
    };
}
