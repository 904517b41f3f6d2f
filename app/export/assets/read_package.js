// Runs a package that `halation export` wrote, on WebGL 2. `document` is `passes.json`; the README of its folder says
// what it means. `loadBlob(n)` returns the bytes of blob n; `programs[n]` has the texts `fragment` and `vertex`, and
// `programs.cover` is the vertex shader of those that have none. `render` returns a texture with the picture.

const ATTRIBUTES = {place: 3, normal: 3, uv: 2, albedo: 3, emission: 3, metal_rough: 2, object_material_moving: 3};
const SETTERS = {FLOAT: "fv", INT: "iv", UNSIGNED_INT: "uiv"}, SIZES = ["", "_VEC2", "_VEC3", "_VEC4"];
const FIRST_TABLE = 16, WEIGHTS = 4096; // the unit of the first table, and the numbers of the block `Weights`

// The row of numbers at x: between two rows, or the nearest one.
function interpolate(x, at, rows, snap = at.length < 2) {
    if (snap) return rows[at.reduce((best, place, k) => Math.abs(place - x) < Math.abs(at[best] - x) ? k : best, 0)];
    const after = at.findIndex((place, k) => k > 0 && place >= x), k = after < 0 ? at.length - 1 : after;
    const t = Math.min(Math.max((x - at[k - 1]) / (at[k] - at[k - 1]), 0), 1);
    return rows[k - 1].map((a, n) => a + t * (rows[k][n] - a));
}

// The numbers of a slot at values of knobs: its base, the curve of each knob, and what two knobs change together.
export function readSlot({base, curves = [], grids = [], mode, whole}, knobs) {
    let numbers = base;
    for (const {knob, at, values, snap} of curves) {
        const row = interpolate(knobs[knob], at, values, snap);
        numbers = numbers.map((number, n) =>
            mode === "multiply" && base[n] !== 0 ? number * row[n] / base[n] : number + row[n] - base[n]);
    }
    for (const {knobs: [first, second], at, values} of grids) {
        const row = interpolate(knobs[first], at[0], values.map(line => interpolate(knobs[second], at[1], line)));
        numbers = numbers.map((number, n) => number + row[n]);
    }
    return whole ? numbers.map(Math.round) : numbers;
}

export class PackageReader {
    constructor(gl, document, programs, loadBlob) {
        Object.assign(this, {gl, document, programs, loadBlob, history: {}, weights: gl.createBuffer()});
        this.made = new Map(); // textures, programs and meshes by name
        this.setters = {[gl.SAMPLER_2D]: "uniform1iv", [gl.SAMPLER_3D]: "uniform1iv"};
        for (const [scalar, end] of Object.entries(SETTERS))
            SIZES.forEach((size, at) => { this.setters[gl[scalar + size]] = `uniform${at + 1}${end}`; });
        this.extensions = ["EXT_color_buffer_float", "OES_texture_float_linear"].map(name => gl.getExtension(name));
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    }

    remember(name, make) {
        if (!this.made.has(name)) this.made.set(name, make());
        return this.made.get(name);
    }

    // The texture of the picture at values of knobs. Of a graph that remembers, frames follow each other.
    render(values, frame, isFirst) {
        const knobs = {...values, frame}, plan = this.plan(knobs, isFirst);
        const surfaces = plan.surfaces.map(surface => this.surface(surface, knobs));
        for (const pass of plan.passes) {
            const [reads, writes] = [pass.textures, pass.targets].map(list => list.map(at => surfaces[at]));
            const uniforms = Object.entries(pass.uniforms).map(([name, slot]) => [name, this.numbers(slot, knobs)]);
            const weights = pass.weights === undefined ? [] : this.numbers(pass.weights, knobs);
            this.draw(pass, reads, writes, uniforms, weights);
        }
        this.history = Object.fromEntries(Object.entries(plan.memories).map(([port, at]) => [port, surfaces[at]]));
        return surfaces[plan.output];
    }

    // Variants are in the order of the axes, the last one changes fastest.
    plan(knobs, isFirst, {axes, plans} = this.document) {
        return plans[isFirst ? 0 : plans.length - 1][axes.reduce((index, {knob, edges}) =>
            index * (edges.length + 1) + edges.filter(edge => knobs[knob] > edge).length, 0)];
    }

    numbers(slot, knobs) { return readSlot(this.document.slots[slot], knobs); }

    // Surfaces of one slot share a texture, but for one that holds what the frame before has left.
    surface({source, numbers, history, slot, format, size}, knobs, copy = 0) {
        if (source !== undefined) return this.load(`source ${source}`, this.document.sources[source]);
        if (numbers !== undefined) return this.numberTable(numbers, format, knobs);
        if (history !== undefined) return this.history[history];
        const texture = this.remember(`slot ${[slot, format, size, copy]}`, () => this.makeTexture(size, format));
        const isKept = Object.values(this.history).includes(texture);
        return isKept ? this.surface({slot, format, size}, knobs, copy + 1) : texture;
    }

    // The texture of a source or of a table of a color library.
    load(name, {size, format, blob, linear}) {
        const Numbers = format.endsWith("16f") ? Uint16Array : Float32Array;
        return this.remember(name, () => this.makeTexture(size, format, new Numbers(this.loadBlob(blob)), linear));
    }

    // A table that a node made of its values: height, width, channels, and the numbers.
    numberTable(slot, format, knobs) {
        const [height, width, channels, ...numbers] = this.numbers(slot, knobs), components = format.length - 3;
        const pixels = new Float32Array(width * height * components);
        numbers.forEach((number, at) => { pixels[Math.floor(at / channels) * components + at % channels] = number; });
        return this.makeTexture([width, height], format, pixels);
    }

    // A texture of two or three dimensions: the format is as GLSL spells it, such as rgba32f.
    makeTexture(size, format, pixels = null, linear = false) {
        const gl = this.gl, texture = gl.createTexture(), letters = format.slice(0, -3).toUpperCase();
        const [target, upload] = size.length > 2 ? [gl.TEXTURE_3D, "texImage3D"] : [gl.TEXTURE_2D, "texImage2D"];
        const layout = letters === "R" ? gl.RED : gl[letters];
        const type = pixels instanceof Uint16Array ? gl.HALF_FLOAT : gl.FLOAT;
        gl.bindTexture(target, texture);
        gl[upload](target, 0, gl[format.toUpperCase()], ...size, 0, layout, type, pixels);
        for (const side of ["S", "T", "R"]) gl.texParameteri(target, gl[`TEXTURE_WRAP_${side}`], gl.CLAMP_TO_EDGE);
        for (const end of ["MIN", "MAG"])
            gl.texParameteri(target, gl[`TEXTURE_${end}_FILTER`], linear ? gl.LINEAR : gl.NEAREST);
        return Object.assign(texture, {size, target});
    }

    // A program with functions that set its uniforms, by name.
    program(number) {
        return this.remember(`program ${number}`, () => {
            const gl = this.gl, program = this.link(number);
            if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
                throw new Error(`program ${number}: ${gl.getAttachedShaders(program).map(gl.getShaderInfoLog, gl)}`);
            program.setters = {};
            for (let at = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; at >= 0; --at) {
                const {name, type} = gl.getActiveUniform(program, at), place = gl.getUniformLocation(program, name);
                const set = type === gl.FLOAT_MAT3 ? numbers => gl.uniformMatrix3fv(place, false, numbers)
                            : numbers => gl[this.setters[type]](place, numbers);
                if (place) program.setters[name.replace("[0]", "")] = set; // members of the block `Weights` have none
            }
            return program;
        });
    }

    link(number) {
        const gl = this.gl, program = gl.createProgram(), {vertex, fragment} = this.programs[number];
        [vertex || this.programs.cover, fragment].forEach((text, at) => {
            const shader = gl.createShader(at === 0 ? gl.VERTEX_SHADER : gl.FRAGMENT_SHADER);
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
        });
        Object.keys(ATTRIBUTES).forEach((name, place) => gl.bindAttribLocation(program, place, name));
        gl.linkProgram(program);
        return program;
    }

    // Textures are bound as t0, t1, ..., tables by the names of their samplers.
    draw({program: number, tables = [], mesh}, reads, writes, uniforms = [], weights = []) {
        const gl = this.gl, program = this.program(number), samplers = tables.map((table, at) =>
            [FIRST_TABLE + at, table.sampler, this.load(`table ${table.sampler}`, table)]);
        reads.forEach((texture, at) => samplers.push([at, `t${at}`, texture]));
        gl.useProgram(program);
        for (const [unit, name, texture] of samplers) {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(texture.target, texture);
            program.setters[name]?.([unit]);
        }
        for (const [name, numbers] of uniforms) program.setters[name]?.(numbers);
        if (weights.length) {
            const block = Float32Array.from({length: WEIGHTS}, (_, at) => weights[at] || 0);
            gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.weights);
            gl.bufferData(gl.UNIFORM_BUFFER, block, gl.DYNAMIC_DRAW);
        }
        this.drawInto(writes, mesh);
    }

    // One triangle over all pixels, or the triangles of a mesh with a depth buffer, over 0.
    drawInto(targets, mesh) {
        const gl = this.gl, framebuffer = gl.createFramebuffer();
        const places = targets.map((_, at) => gl.COLOR_ATTACHMENT0 + at);
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        places.forEach((place, at) => gl.framebufferTexture2D(gl.FRAMEBUFFER, place, gl.TEXTURE_2D, targets[at], 0));
        gl.drawBuffers(places);
        gl.viewport(0, 0, ...targets[0].size);
        if (mesh) this.drawMesh(targets[0].size, mesh); else gl.drawArrays(gl.TRIANGLES, 0, 3);
        gl.deleteFramebuffer(framebuffer);
    }

    drawMesh(size, {vertices, indices}) {
        const gl = this.gl, depth = gl.createRenderbuffer();
        const {array, count} = this.remember(`mesh ${vertices}`, () => this.makeMesh(vertices, indices));
        gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
        gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, ...size);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
        gl.enable(gl.DEPTH_TEST);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        gl.bindVertexArray(array);
        gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
        gl.bindVertexArray(null);
        gl.disable(gl.DEPTH_TEST);
        gl.deleteRenderbuffer(depth);
    }

    makeMesh(vertices, indices) {
        const gl = this.gl, array = gl.createVertexArray(), bytes = [vertices, indices].map(this.loadBlob);
        gl.bindVertexArray(array);
        [gl.ARRAY_BUFFER, gl.ELEMENT_ARRAY_BUFFER].forEach((kind, at) => {
            gl.bindBuffer(kind, gl.createBuffer());
            gl.bufferData(kind, bytes[at], gl.STATIC_DRAW);
        });
        const lengths = Object.values(ATTRIBUTES), stride = 4 * lengths.reduce((sum, length) => sum + length);
        lengths.reduce((offset, length, place) => {
            gl.enableVertexAttribArray(place);
            gl.vertexAttribPointer(place, length, gl.FLOAT, false, stride, offset);
            return offset + 4 * length;
        }, 0);
        return {array, count: bytes[1].byteLength / 4};
    }
}
