// The page around a package: controls, the visitor's own picture, comparison, time, and saving.

const $ = name => document.getElementById(name);

const COVER = `#version 300 es
void main() { gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0); }`;

// Shows two pictures side by side, over black where they are transparent. Row 0 of a picture is at the top.
const PRESENT = `#version 300 es
precision highp float;
uniform highp sampler2D t0;
uniform highp sampler2D t1;
uniform vec2 room;
uniform float wipe;
out vec4 color;
void main() {
    vec2 at = vec2(gl_FragCoord.x, room.y - gl_FragCoord.y) / room;
    vec4 shown = at.x < wipe ? texture(t1, at) : texture(t0, at);
    color = vec4(shown.rgb * shown.a, 1.0);
}`;

// A picture of the visitor as light, premultiplied: the inverse of the curve of sRGB (IEC 61966-2-1).
const DECODE = `#version 300 es
precision highp float;
uniform highp sampler2D t0;
out vec4 light;
void main() {
    vec4 code = texelFetch(t0, ivec2(gl_FragCoord.xy), 0);
    vec3 bright = pow((code.rgb + 0.055) / 1.055, vec3(2.4));
    light = vec4(mix(code.rgb / 12.92, bright, greaterThan(code.rgb, vec3(0.04045))) * code.a, code.a);
}`;

// Programs of the page beside those of the look.
const OWN_PROGRAMS = {cover: COVER, present: {fragment: PRESENT}, decode: {fragment: DECODE}};

async function inflate(text, stride) {
    const letters = atob(text), bytes = new Uint8Array(letters.length);
    for (let at = 0; at < bytes.length; ++at) bytes[at] = letters.charCodeAt(at);
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const planes = new Uint8Array(await new Response(stream).arrayBuffer());
    if (!stride) return planes.buffer;
    const whole = new Uint8Array(planes.length), count = planes.length / stride;
    for (let k = 0; k < stride; ++k)
        for (let at = 0; at < count; ++at) whole[at * stride + k] = planes[k * count + at];
    return whole.buffer;
}

const encode = light => light <= 0.0031308 ? 12.92 * light : 1.055 * Math.pow(light, 1 / 2.4) - 0.055;
const decode = code => code <= 0.04045 ? code / 12.92 : Math.pow((code + 0.055) / 1.055, 2.4);
const hex = parts => "#" + parts.map(part =>
    Math.round(255 * encode(Math.min(Math.max(part, 0), 1))).toString(16).padStart(2, "0")).join("");

class Page {
    constructor(content, blobs) {
        this.content = content; this.blobs = blobs; this.package = content.document;
        this.canvas = $("picture");
        this.rest = Object.fromEntries(this.package.controls.flatMap(control =>
            control.knobs.map(knob => [knob.name, knob.rest])));
        this.knobs = {...this.rest};
        this.frame = this.package.frames[0];
        this.isFirst = this.isDirty = true; this.isPlaying = false; this.wipe = 0;
        this.sheet = null; this.camera = null; // the picture of the visitor, and what makes it
        this.buildControls(); this.buildSources(); this.buildTime();
        this.canvas.addEventListener("webglcontextlost", event => { event.preventDefault(); this.reader = null; });
        this.canvas.addEventListener("webglcontextrestored", () => this.start());
        this.start();
        requestAnimationFrame(time => this.tick(time));
    }

    start() {
        const gl = this.canvas.getContext("webgl2", {alpha: false, antialias: false, preserveDrawingBuffer: true});
        if (!gl) throw new Error("this browser has no WebGL 2");
        this.gl = gl;
        this.fence = null;
        const programs = Object.assign(this.content.programs, OWN_PROGRAMS);
        this.reader = new PageReader(gl, this.package, programs, number => this.blobs[number]);
        if (this.sheet) this.replaceMain();
        const {surfaces, output} = this.package.plans[0][0];
        [this.canvas.width, this.canvas.height] = this.size = surfaces[output].size;
        this.canvas.style.setProperty("--aspect", this.size[0] / this.size[1]);
        this.restart();
    }

    restart() {
        this.frame = this.package.frames[0];
        this.isFirst = this.isDirty = true;
        $("fault").hidden = true;
    }

    // --- drawing -------------------------------------------------------------------------------------------------

    tick(time) {
        const [first, last] = this.package.frames;
        try {
            if (this.camera) this.readCamera();
            if (this.isPlaying && time - (this.shownAt || 0) >= 1000 / this.package.rate) {
                this.shownAt = time;
                if (this.frame >= last) this.restart(); else ++this.frame;
                $("frame").value = this.frame;
                this.isDirty = true;
            }
            if (this.isDirty && this.reader && !this.gl.isContextLost())
                if (this.package.draft && !this.firstPictureAt) this.showDraft();
                else if (this.isDraftSeen()) this.show();
        } catch (fault) { fail(fault); }
        requestAnimationFrame(next => this.tick(next));
    }

    // Renders the picture of this frame; of a graph that remembers, all frames since the last one.
    show() {
        this.isDirty = false;
        const reader = this.reader, first = this.package.frames[0];
        if (reader.remembers && this.camera) { // a camera has no earlier frames to begin from again
            this.picture = reader.render(this.knobs, this.frame, this.isFirst);
            this.rendered = first - 1;
        } else if (reader.remembers) {
            if (this.isFirst || this.frame < this.rendered) this.rendered = first - 1;
            if (this.frame === this.rendered) this.rendered = first - 1;
            for (let at = this.rendered + 1; at <= this.frame; ++at)
                this.picture = reader.render(this.knobs, at, at === first);
            this.rendered = this.frame;
        } else this.picture = reader.render(this.knobs, this.frame, true);
        this.isFirst = false;
        this.reveal();
    }

    // Shows a small picture at once: on a slow device the whole one, which follows, takes seconds.
    showDraft() {
        this.picture = this.reader.renderDraft(this.rest, this.frame);
        this.reveal();
        this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        this.framesToWait = 2; // of the screen, or the whole picture keeps the draft from it
    }

    isDraftSeen() {
        if (this.fence && this.gl.getSyncParameter(this.fence, this.gl.SYNC_STATUS) !== this.gl.SIGNALED) return false;
        this.fence = null;
        return !(this.framesToWait-- > 0);
    }

    reveal() {
        this.shown = this.view(this.picture, "view");
        this.present();
        if (!this.firstPictureAt) {
            this.firstPictureAt = performance.now();
            document.body.classList.add("ready");
            $("frame").value = this.frame;
        }
    }

    // The picture as codes of a screen.
    view(picture, name) {
        const target = this.reader.makeCodes(name, picture.size);
        this.reader.draw(this.package.display, [picture], [target]);
        return target;
    }

    present() {
        const reader = this.reader, uniforms = [["room", this.size], ["wipe", [this.wipe]]];
        let before = this.shown;
        if (this.wipe > 0 && this.compared >= 0) before = this.view(reader.source(this.compared), "before");
        reader.draw({program: "present"}, [this.shown, before], [], uniforms);
    }

    // --- controls ------------------------------------------------------------------------------------------------

    set(name, number) { this.knobs[name] = number; this.isDirty = true; }

    buildControls() {
        this.refreshers = [];
        for (const control of this.package.controls) {
            const row = document.createElement("div");
            row.className = `control ${control.kind}`;
            row.title = control.doc;
            const build = {switch: "addSwitch", choice: "addChoice", color: "addColor"}[control.kind] || "addSliders";
            this[build](row, control);
            $("controls").append(row);
        }
        $("reset").onclick = () => {
            this.knobs = {...this.rest};
            this.refreshers.forEach(refresh => refresh());
            this.isDirty = true;
        };
        addHeldControls($("controls"), this.package.held);
        $("reset").hidden = this.package.controls.length === 0;
        this.refreshers.forEach(refresh => refresh());
    }

    label(row, text, id) {
        const label = document.createElement("label");
        label.textContent = text;
        label.htmlFor = id;
        row.append(label);
    }

    addSliders(row, {name, label, kind, knobs, unit}) {
        knobs.forEach((knob, at) => {
            const slider = document.createElement("input"), number = document.createElement("input");
            const id = `control-${knob.name}`, isWhole = kind === "whole";
            this.label(row, knobs.length > 1 ? `${label} ${"xyzw"[at]}` : label, id);
            number.type = "number"; slider.type = "range"; slider.id = id;
            slider.setAttribute("aria-label", label);
            for (const input of [slider, number]) {
                input.min = knob.low; input.max = knob.high; input.step = isWhole ? 1 : "any";
                input.oninput = () => {
                    const value = Math.min(Math.max(parseFloat(input.value), knob.low), knob.high);
                    if (isNaN(value)) return;
                    this.set(knob.name, isWhole ? Math.round(value) : value);
                    (input === slider ? refresh : fill)();
                };
            }
            number.title = unit;
            const fill = () => {
                slider.value = this.knobs[knob.name];
                slider.style.setProperty("--at", (slider.value - knob.low) / (knob.high - knob.low || 1));
            };
            const refresh = () => { number.value = +this.knobs[knob.name].toPrecision(4); fill(); };
            slider.ondblclick = () => { this.set(knob.name, knob.rest); refresh(); };
            this.refreshers.push(refresh);
            row.append(number, slider);
        });
    }

    addSwitch(row, {name, label, knobs: [knob]}) {
        const box = document.createElement("input");
        box.type = "checkbox"; box.id = `control-${name}`;
        box.onchange = () => this.set(knob.name, box.checked ? 1 : 0);
        this.refreshers.push(() => { box.checked = this.knobs[knob.name] > 0.5; });
        this.label(row, label, box.id);
        row.append(box);
    }

    addChoice(row, {name, label, choices, knobs: [knob]}) {
        const list = document.createElement("select");
        list.id = `control-${name}`;
        choices.forEach((choice, at) => list.add(new Option(choice, at)));
        list.onchange = () => this.set(knob.name, +list.value);
        this.refreshers.push(() => { list.value = this.knobs[knob.name]; });
        this.label(row, label, list.id);
        row.append(list);
    }

    addColor(row, {name, label, knobs}) {
        const field = document.createElement("input");
        field.type = "color"; field.id = `control-${name}`;
        field.oninput = () => [1, 3, 5].forEach((place, at) =>
            knobs[at] && this.set(knobs[at].name, decode(parseInt(field.value.slice(place, place + 2), 16) / 255)));
        this.refreshers.push(() => { field.value = hex(knobs.slice(0, 3).map(knob => this.knobs[knob.name])); });
        this.label(row, label, field.id);
        row.append(field);
    }

    // --- pictures ------------------------------------------------------------------------------------------------

    buildSources() {
        const inputs = this.package.sources.flatMap((source, number) => source.is_input ? [{...source, number}] : []);
        const main = this.main = inputs.find(each => each.name === "beauty") || inputs[0];
        this.compared = main ? main.number : -1;
        $("own").hidden = $("compare").hidden = !main;
        if (!main) return;
        $("file").onchange = () => $("file").files[0] && this.load($("file").files[0]).catch(fail);
        for (const name of ["dragover", "drop"])
            window.addEventListener(name, event => {
                event.preventDefault();
                const file = event.dataTransfer.files[0];
                if (name === "drop" && file) this.load(file).catch(fail);
            });
        $("camera").hidden = !navigator.mediaDevices;
        $("camera").onclick = () => this.camera ? this.showOriginal() : this.openCamera().catch(fail);
        $("back").onclick = () => this.showOriginal();
        const move = event => {
            const box = this.canvas.getBoundingClientRect();
            this.setWipe(Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1));
        };
        this.canvas.onpointerdown = event => {
            if (!$("comparing").checked) return;
            this.canvas.setPointerCapture(event.pointerId);
            this.canvas.onpointermove = move;
            move(event);
        };
        this.canvas.onpointerup = () => { this.canvas.onpointermove = null; };
        $("comparing").onchange = () => this.setWipe($("comparing").checked ? 0.5 : 0);
    }

    setWipe(place) {
        this.wipe = place;
        $("handle").hidden = !$("comparing").checked;
        $("handle").style.left = `${100 * place}%`;
        if (this.reader && this.shown) this.present();
    }

    async load(file) {
        const bitmap = await createImageBitmap(file).catch(() => { throw new Error(`${file.name} is no picture`); });
        this.closeCamera();
        this.draw(bitmap, bitmap.width, bitmap.height);
        this.restart();
    }

    async openCamera() {
        const [width, height] = this.main.size, wish = {width: {ideal: width}, height: {ideal: height}};
        const stream = await navigator.mediaDevices.getUserMedia({video: wish}).catch(fault => {
            throw new Error(`there is no picture of a camera: ${fault.message}`);
        });
        const video = Object.assign(document.createElement("video"), {srcObject: stream, muted: true});
        await video.play();
        this.camera = video;
        this.restart();
        $("camera").textContent = "Stop camera";
    }

    closeCamera() {
        if (this.camera) this.camera.srcObject.getTracks().forEach(track => track.stop());
        this.camera = null;
        $("camera").textContent = "Camera";
    }

    readCamera() {
        const video = this.camera;
        if (!this.reader || video.currentTime === video.shownAt) return;
        video.shownAt = video.currentTime;
        this.draw(video, video.videoWidth, video.videoHeight);
        this.isDirty = true;
    }

    // A picture of the visitor, cropped to the shape of the main input.
    draw(picture, width, height) {
        const [across, down] = this.main.size, scale = Math.max(across / width, down / height);
        this.sheet ||= Object.assign(document.createElement("canvas"), {width: across, height: down});
        const pen = this.sheet.getContext("2d");
        pen.imageSmoothingQuality = "high";
        pen.clearRect(0, 0, across, down);
        const [w, h] = [width * scale, height * scale];
        pen.drawImage(picture, (across - w) / 2, (down - h) / 2, w, h);
        if (this.reader) this.replaceMain();
        $("back").hidden = false;
    }

    // Puts the picture of the visitor in the place of the main input.
    replaceMain() {
        const gl = this.gl, reader = this.reader, {size, format, number} = this.main;
        const codes = reader.makeCodes("own codes", size);
        const light = reader.remember("own light", () => reader.makeTexture(size, format.replace("16f", "32f")));
        gl.bindTexture(gl.TEXTURE_2D, codes);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, this.sheet);
        reader.draw({program: "decode"}, [codes], [light]);
        reader.replace(number, light);
    }

    showOriginal() {
        this.closeCamera();
        this.sheet = null;
        if (this.reader) this.reader.replace(this.main.number);
        $("back").hidden = true;
        this.restart();
    }

    // --- time and saving -----------------------------------------------------------------------------------------

    buildTime() {
        const [first, last] = this.package.frames;
        $("time").hidden = first === last;
        Object.assign($("frame"), {min: first, max: last, step: 1, value: first});
        $("frame").oninput = () => { this.frame = +$("frame").value; this.isDirty = true; };
        $("play").onclick = () => {
            this.isPlaying = !this.isPlaying;
            $("play").textContent = this.isPlaying ? "Pause" : "Play";
        };
        $("save").onclick = () => {
            const [wipe, link] = [this.wipe, document.createElement("a")];
            this.wipe = 0; this.present();
            this.canvas.toBlob(blob => {
                link.href = URL.createObjectURL(blob);
                link.download = `${this.package.name}.png`;
                link.click();
                URL.revokeObjectURL(link.href);
                this.wipe = wipe; this.present();
            });
        };
    }
}

function fail(fault) {
    $("fault").hidden = false;
    $("fault").textContent = `The picture cannot be shown: ${fault.message}`;
    document.body.classList.add("ready");
}

async function open() {
    const parts = JSON.parse($("package").textContent);
    const content = JSON.parse(new TextDecoder().decode(await inflate(parts.content, 0)));
    const blobs = await Promise.all(parts.blobs.map(([stride, text]) => inflate(text, stride)));
    window.halation = new Page(content, blobs);
    for (const note of listNotes(content, window.halation.reader)) {
        const line = document.createElement("li");
        line.textContent = `${note[0].toUpperCase()}${note.slice(1)}.`;
        $("notes").append(line);
    }
}

open().catch(fail);
