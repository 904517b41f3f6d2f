// Lets the search work where the manual is opened as a file: browsers start no workers there, so the script of the
// worker runs in a hidden frame. Material looks for the name IFrameWorker.
if (location.protocol === "file:") {
  window.IFrameWorker = window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      document.body.append(frame);
      const inner = frame.contentWindow;
      const reply = data => this.dispatchEvent(new MessageEvent("message", { data }));
      const load = address => new Promise(done => {
        const script = inner.document.createElement("script");
        script.src = address;
        script.onload = done;
        inner.document.body.append(script);
      });
      inner.postMessage = data => setTimeout(() => reply(data));
      inner.importScripts = (...addresses) => Promise.all(addresses.map(load));
      this.inner = inner;
      this.ready = load(url);
    }
    postMessage(data) {
      this.ready.then(() => this.inner.dispatchEvent(new MessageEvent("message", { data })));
    }
    terminate() {}
  };
}
