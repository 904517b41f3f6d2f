// Runs a package that `halation export` wrote, on WebGL 2. All numbers and passes are in `document`; see the README of
// the folder for their meaning. `loadBlob(n)` returns the bytes of blob n, `programs[n]` has `fragment` and `vertex`.

const ATTRIBUTES = [["place", 3], ["normal", 3], ["uv", 2], ["albedo", 3], ["emission", 3], ["metal_rough", 2],
                    ["object_material_moving", 3]];
const FIRST_TABLE = 16;
const WEIGHTS = 4096;

function interpolate(x, at, rows, snap) {
    if (snap || at.length < 2) {
        let best = 0;
        at.forEach((place, k) => { if (Math.abs(place - x) < Math.abs(at[best] - x)) best = k; });
        return rows[best].slice();
    }
    let k = 1;
    while (k < at.length - 1 && at[k] < x) ++k;
    const t = Math.min(Math.max((x - at[k - 1]) / (at[k] - at[k - 1]), 0), 1);
    return rows[k - 1].map((a, n) => a + t * (rows[k][n] - a));
}

// The numbers of a slot at values of knobs: its base, and the curve of each knob that changes it.
export function readSlot(record, knobs) {
    let numbers = record.base.slice();
    for (const curve of record.curves || []) {
        const row = interpolate(knobs[curve.knob], curve.at, curve.values, curve.snap);
        numbers = numbers.map((number, n) => {
            const base = record.base[n];
            if (record.mode === "multiply" && base !== 0) return number * row[n] / base;
            return number + row[n] - base;
        });
    }
    for (const grid of record.grids || []) {
        const [x, y] = grid.knobs.map(name => knobs[name]);
        const lines = grid.values.map(line => interpolate(y, grid.at[1], line));
        interpolate(x, grid.at[0], lines).forEach((number, n) => { numbers[n] += number; });
    }
    return record.whole ? numbers.map(Math.round) : numbers;
}

export class PackageReader {
    constructor(gl, document, programs, loadBlob) {
        Object.assign(this, {gl, document, programs, loadBlob});
        this.canStoreFloats = !!gl.getExtension("EXT_color_buffer_float");
        this.canFilterFloats = !!gl.getExtension("OES_texture_float_linear");
        if (!this.canStoreFloats && !gl.getExtension("EXT_color_buffer_half_float"))
            throw new Error("this browser cannot draw into pictures of floats, which the look needs");
        this.notes = this.canStoreFloats ? [] : ["this device has half floats only: dark gradients may show steps"];
        this.linked = new Map(); this.textures = new Map(); this.frames = new Map(); this.history = {};
        this.replaced = new Map();
        this.weights = gl.createBuffer();
        gl.disable(gl.DITHER);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    }

    // --- textures ------------------------------------------------------------------------------------------------

    texel(format) {
        const gl = this.gl, channels = format.length - 3, half = format.endsWith("16f") || !this.canStoreFloats;
        const [names, layouts] = [half ? ["R16F", "RG16F", "", "RGBA16F"] : ["R32F", "RG32F", "", "RGBA32F"],
                                  [gl.RED, gl.RG, gl.RGB, gl.RGBA]];
        return {internal: gl[names[channels - 1]], layout: layouts[channels - 1]};
    }

    makeTexture(size, format, pixels) {
        const gl = this.gl, {internal, layout} = this.texel(format), texture = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, texture);
        const type = pixels instanceof Uint16Array ? gl.HALF_FLOAT : gl.FLOAT;
        gl.texImage2D(gl.TEXTURE_2D, 0, internal, size[0], size[1], 0, layout, pixels ? type : gl.FLOAT, pixels || null);
        this.setSampling(gl.TEXTURE_2D, false);
        return Object.assign(texture, {size});
    }

    setSampling(target, linear) {
        const gl = this.gl;
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
            gl.texParameteri(target, name, linear ? gl.LINEAR : gl.NEAREST);
        for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
            gl.texParameteri(target, name, gl.CLAMP_TO_EDGE);
    }

    remember(key, make) {
        if (!this.textures.has(key)) this.textures.set(key, make());
        return this.textures.get(key);
    }

    source(number) {
        if (this.replaced.has(number)) return this.replaced.get(number);
        const {size, format, blob} = this.document.sources[number];
        return this.remember(`source ${number}`, () => {
            const bytes = this.loadBlob(blob), half = format.endsWith("16f");
            return this.makeTexture(size, format, half ? new Uint16Array(bytes) : new Float32Array(bytes));
        });
    }

    // Another picture in place of a source: light as floats, four channels.
    replaceSource(number, pixels) {
        const {size, format} = this.document.sources[number];
        this.dropSource(number);
        this.replaced.set(number, this.makeTexture(size, format.replace("16f", "32f"), pixels));
    }

    dropSource(number) {
        if (this.replaced.has(number)) this.gl.deleteTexture(this.replaced.get(number));
        this.replaced.delete(number);
    }

    // A table that a node made of its values: height, width, channels, and the numbers.
    numberTable(slot, format, knobs) {
        const numbers = this.numbers(slot, knobs), [height, width, channels] = numbers.slice(0, 3).map(Math.round);
        const components = format.length - 3, pixels = new Float32Array(width * height * components);
        for (let at = 0; at < width * height; ++at)
            for (let c = 0; c < channels; ++c) pixels[at * components + c] = numbers[3 + at * channels + c];
        const key = `numbers ${slot}`;
        if (this.textures.has(key)) this.gl.deleteTexture(this.textures.get(key));
        this.textures.set(key, this.makeTexture([width, height], format, pixels));
        return this.textures.get(key);
    }

    // A table of a color library. Where floats cannot be interpolated, halves stand for them.
    table({sampler, shape, linear, blob}) {
        const gl = this.gl, deep = shape.length === 4, [channels, width, height, depth] = shape.slice().reverse();
        const target = deep ? gl.TEXTURE_3D : gl.TEXTURE_2D;
        const texture = this.remember(`table ${sampler}`, () => {
            const made = gl.createTexture(), half = linear && !this.canFilterFloats;
            const internal = gl[["R", "RG", "RGB", "RGBA"][channels - 1] + (half ? "16F" : "32F")];
            const layout = [gl.RED, gl.RG, gl.RGB, gl.RGBA][channels - 1], pixels = new Float32Array(this.loadBlob(blob));
            gl.bindTexture(target, made);
            if (deep) gl.texImage3D(target, 0, internal, width, height, depth, 0, layout, gl.FLOAT, pixels);
            else gl.texImage2D(target, 0, internal, width, height, 0, layout, gl.FLOAT, pixels);
            this.setSampling(target, linear);
            return made;
        });
        return {target, texture};
    }

    // --- programs and passes -------------------------------------------------------------------------------------

    program(number, vertex = "", fragment = "") {
        if (this.linked.has(number)) return this.linked.get(number);
        const gl = this.gl, program = gl.createProgram();
        const texts = fragment ? {vertex, fragment} : this.programs[number];
        for (const [kind, text] of [[gl.VERTEX_SHADER, texts.vertex || this.programs.cover],
                                    [gl.FRAGMENT_SHADER, texts.fragment]]) {
            const shader = gl.createShader(kind);
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
            gl.deleteShader(shader);
        }
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
            const logs = gl.getAttachedShaders(program).map(shader => gl.getShaderInfoLog(shader)).join("\n");
            throw new Error(`program ${number}: ${logs || gl.getProgramInfoLog(program)}`);
        }
        const uniforms = new Map(), count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
        for (let at = 0; at < count; ++at) {
            const {name, type} = gl.getActiveUniform(program, at);
            uniforms.set(name.replace("[0]", ""), {type, place: gl.getUniformLocation(program, name)});
        }
        const block = gl.getUniformBlockIndex(program, "Weights");
        if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, block, 0);
        this.linked.set(number, {program, uniforms});
        return this.linked.get(number);
    }

    setUniform({uniforms}, name, numbers) {
        const gl = this.gl, uniform = uniforms.get(name);
        if (!uniform || uniform.place === null) return;
        const setters = {
            [gl.FLOAT]: "uniform1fv", [gl.FLOAT_VEC2]: "uniform2fv", [gl.FLOAT_VEC3]: "uniform3fv",
            [gl.FLOAT_VEC4]: "uniform4fv", [gl.INT]: "uniform1iv", [gl.INT_VEC2]: "uniform2iv",
            [gl.INT_VEC3]: "uniform3iv", [gl.INT_VEC4]: "uniform4iv", [gl.UNSIGNED_INT]: "uniform1uiv",
            [gl.UNSIGNED_INT_VEC2]: "uniform2uiv", [gl.UNSIGNED_INT_VEC3]: "uniform3uiv",
            [gl.UNSIGNED_INT_VEC4]: "uniform4uiv", [gl.SAMPLER_2D]: "uniform1iv", [gl.SAMPLER_3D]: "uniform1iv",
        };
        if (uniform.type === gl.FLOAT_MAT3) gl.uniformMatrix3fv(uniform.place, false, numbers);
        else gl[setters[uniform.type]](uniform.place, numbers);
    }

    numbers(slot, knobs) { return readSlot(this.document.slots[slot], knobs); }

    // Variants are in the order of the axes, the last one changes fastest.
    plan(knobs, isFirst) {
        let index = 0;
        for (const {knob, edges} of this.document.axes)
            index = index * (edges.length + 1) + edges.filter(edge => knobs[knob] > edge).length;
        const plans = this.document.plans;
        return plans[isFirst ? 0 : plans.length - 1][index];
    }

    run(plan, knobs) {
        const gl = this.gl;
        const surfaces = plan.surfaces.map(surface => {
            if ("source" in surface) return this.source(surface.source);
            if ("numbers" in surface) return this.numberTable(surface.numbers, surface.format, knobs);
            if ("history" in surface) return this.history[surface.history];
            const key = `slot ${surface.slot} ${surface.format} ${surface.size}`;
            return this.remember(key, () => this.makeTexture(surface.size, surface.format));
        });
        for (const pass of plan.passes) {
            const linked = this.program(pass.program);
            gl.useProgram(linked.program);
            this.bindTextures(linked, pass.textures.map(number => surfaces[number]), pass.tables || []);
            for (const [name, slot] of Object.entries(pass.uniforms))
                this.setUniform(linked, name, this.numbers(slot, knobs));
            if ("weights" in pass) {
                const weights = new Float32Array(WEIGHTS);
                weights.set(this.numbers(pass.weights, knobs));
                gl.bindBuffer(gl.UNIFORM_BUFFER, this.weights);
                gl.bufferData(gl.UNIFORM_BUFFER, weights, gl.DYNAMIC_DRAW);
                gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.weights);
            }
            this.draw(linked, pass.targets.map(number => surfaces[number]), pass.mesh);
        }
        return surfaces;
    }

    bindTextures(linked, textures, tables) {
        const gl = this.gl;
        textures.forEach((texture, unit) => {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(gl.TEXTURE_2D, texture);
            this.setUniform(linked, `t${unit}`, [unit]);
        });
        tables.forEach((record, number) => {
            gl.activeTexture(gl.TEXTURE0 + FIRST_TABLE + number);
            const {target, texture} = this.table(record);
            gl.bindTexture(target, texture);
            this.setUniform(linked, record.sampler, [FIRST_TABLE + number]);
        });
        gl.activeTexture(gl.TEXTURE0);
    }

    framebuffer(targets, deep) {
        const gl = this.gl, framebuffer = gl.createFramebuffer(), [width, height] = targets[0].size;
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        targets.forEach((texture, number) =>
            gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + number, gl.TEXTURE_2D, texture, 0));
        gl.drawBuffers(targets.map((_, number) => gl.COLOR_ATTACHMENT0 + number));
        if (deep) {
            const depth = gl.createRenderbuffer();
            gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
            gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
            gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
            framebuffer.depth = depth;
        }
        gl.viewport(0, 0, width, height);
        return framebuffer;
    }

    release(framebuffer) {
        if (framebuffer.depth) this.gl.deleteRenderbuffer(framebuffer.depth);
        this.gl.deleteFramebuffer(framebuffer);
    }

    draw(linked, targets, mesh) {
        const gl = this.gl, framebuffer = this.framebuffer(targets, !!mesh);
        gl.disable(gl.BLEND);
        if (mesh) this.drawMesh(linked, mesh);
        else gl.drawArrays(gl.TRIANGLES, 0, 3);
        this.release(framebuffer);
    }

    drawMesh(linked, mesh) {
        const gl = this.gl, stride = 4 * ATTRIBUTES.reduce((sum, [, count]) => sum + count, 0);
        const made = this.remember(`mesh ${mesh.vertices}`, () => {
            const [vertices, indices, array] = [gl.createBuffer(), gl.createBuffer(), gl.createVertexArray()];
            const numbers = new Uint32Array(this.loadBlob(mesh.indices));
            gl.bindVertexArray(array);
            gl.bindBuffer(gl.ARRAY_BUFFER, vertices);
            gl.bufferData(gl.ARRAY_BUFFER, this.loadBlob(mesh.vertices), gl.STATIC_DRAW);
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
            gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
            let offset = 0;
            for (const [name, count] of ATTRIBUTES) {
                const place = gl.getAttribLocation(linked.program, name);
                if (place >= 0) {
                    gl.enableVertexAttribArray(place);
                    gl.vertexAttribPointer(place, count, gl.FLOAT, false, stride, offset);
                }
                offset += 4 * count;
            }
            gl.bindVertexArray(null);
            return {array, count: numbers.length};
        });
        gl.clearColor(0, 0, 0, 0);
        gl.enable(gl.DEPTH_TEST);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        gl.bindVertexArray(made.array);
        gl.drawElements(gl.TRIANGLES, made.count, gl.UNSIGNED_INT, 0);
        gl.bindVertexArray(null);
        gl.disable(gl.DEPTH_TEST);
    }

    // --- frames --------------------------------------------------------------------------------------------------

    // The texture of the picture at values of knobs. Of a graph that remembers, frames follow each other.
    render(knobs, frame, isFirst) {
        const at = {...knobs, frame}, plan = this.plan(at, isFirst), surfaces = this.run(plan, at);
        const history = {};
        for (const [port, number] of Object.entries(plan.memories))
            history[port] = this.copy(surfaces[number], plan.surfaces[number].format, `history ${port} ${frame % 2}`);
        this.history = history;
        return surfaces[plan.output];
    }

    get remembers() { return Object.keys(this.document.plans[0][0].memories).length > 0; }

    // A copy that the next frame may read while it draws into the same slots.
    copy(texture, format, key) {
        const gl = this.gl, target = this.remember(key, () => this.makeTexture(texture.size, format));
        const [width, height] = texture.size, framebuffer = this.framebuffer([texture], false);
        gl.bindTexture(gl.TEXTURE_2D, target);
        gl.copyTexSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 0, 0, width, height);
        this.release(framebuffer);
        return target;
    }
}
