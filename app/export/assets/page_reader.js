// The reader of a package as a page needs it: also on devices with half floats alone, and for sliders that are dragged.

// A page has a column for each number of a curve, or the number itself where it stays the same; the reader takes rows.
function turnCurves(curve) {
    if (curve.columns)
        curve.values = curve.at.map((_, row) => curve.columns.map(column => column.length ? column[row] : column));
}

class PageReader extends PackageReader {
    constructor(gl, document, programs, loadBlob) {
        document.slots.forEach(({curves = []}) => curves.forEach(turnCurves));
        super(gl, document, programs, loadBlob);
        [this.canStoreFloats, this.canFilterFloats] = this.extensions.map(Boolean);
        if (!this.canStoreFloats && !gl.getExtension("EXT_color_buffer_half_float"))
            throw new Error("this browser cannot draw into pictures of floats, which the look needs");
        this.notes = this.canStoreFloats ? [] : ["this device has half floats only: dark gradients may show steps"];
        this.linked = new Map(); // programs that the driver compiles, by number
        this.tables = []; // those that nodes made of their values for the last frame
        gl.disable(gl.DITHER);
    }

    get remembers() { return Object.keys(this.document.plans[0][0].memories).length > 0; }

    // Halves stand for floats that the device cannot draw into, or cannot interpolate.
    makeTexture(size, format, pixels, linear = false) {
        const canHold = linear ? this.canFilterFloats : this.canStoreFloats;
        return super.makeTexture(size, canHold ? format : format.replace("32f", "16f"), pixels, linear);
    }

    // A texture of codes of a screen, in which pixels are interpolated.
    makeCodes(name, size) {
        return this.remember(`${name} ${size}`, () => {
            const gl = this.gl, texture = gl.createTexture();
            gl.bindTexture(gl.TEXTURE_2D, texture);
            gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, ...size, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
            for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
                gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
            return Object.assign(texture, {size, target: gl.TEXTURE_2D});
        });
    }

    // The plan of knobs, or while `isDraft`, that of the small picture with which a page begins.
    plan(knobs, isFirst) { return this.isDraft ? this.document.draft : super.plan(knobs, isFirst); }

    // The picture of the graph as it is, small.
    renderDraft(values, frame) {
        this.isDraft = true;
        const picture = this.render(values, frame, true);
        this.isDraft = false;
        this.history = {};
        return picture;
    }

    // Nobody asks yet how the programs come out, so the driver may compile many at once.
    render(values, frame, isFirst) {
        for (const {program} of this.plan({...values, frame}, isFirst).passes)
            if (!this.linked.has(program)) this.linked.set(program, super.link(program));
        this.tables.forEach(texture => this.gl.deleteTexture(texture));
        this.tables = [];
        return super.render(values, frame, isFirst);
    }

    link(number) { return this.linked.get(number) || super.link(number); }

    numberTable(slot, format, knobs) {
        const texture = super.numberTable(slot, format, knobs);
        this.tables.push(texture);
        return texture;
    }

    // Without targets, into the canvas of the page.
    drawInto(targets, mesh) {
        if (targets.length > 0) return super.drawInto(targets, mesh);
        const gl = this.gl;
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    source(number) { return this.surface({source: number}); }

    // Puts a texture in the place of a source; without one, the source itself comes back.
    replace(number, texture = null) {
        if (texture) this.made.set(`source ${number}`, texture); else this.made.delete(`source ${number}`);
    }
}
