// What Material leaves to others.

// Whatever can be scrolled can be scrolled by keys: Material makes no place for them in wide tables, nor in code where
// fingers point. Its buttons beside code are no navigation.
new MutationObserver(() => {
  for (const place of document.querySelectorAll(".md-typeset__scrollwrap, pre > code")) {
    if (place.tabIndex < 0) place.tabIndex = 0;
  }
  for (const place of document.querySelectorAll(".md-code__nav:not([role])")) place.role = "none";
}).observe(document.documentElement, { subtree: true, childList: true, attributeFilter: ["tabindex"] });

// The index of the search is larger than all else together, and most visitors never search: where a server sends it, it
// is loaded when the search is opened, or when a page is opened from its results.
{
  const { open, send } = XMLHttpRequest.prototype;
  const isOpen = new Promise(done => {
    if (/[?&][qh]=/.test(location.search)) done();
    document.addEventListener("focusin", event => event.target.matches("[data-md-component=search-query]") && done());
  });
  XMLHttpRequest.prototype.open = function (method, address, ...rest) {
    this.isIndex = /\/search_index\.json$/.test(address);
    return open.call(this, method, address, ...rest);
  };
  XMLHttpRequest.prototype.send = function (...content) {
    if (this.isIndex) isOpen.then(() => send.apply(this, content));
    else send.apply(this, content);
  };
}

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
