// Runs a package that `halation export` wrote, on WebGL 2. All numbers and passes are in `document`; see the README of
// the folder for their meaning. `loadBlob(n)` returns the bytes of blob n; `programs[n]` has `fragment` and `vertex`,
// and `programs.cover` is the vertex shader of those that have none.
import {Package} from "./package_values.js";

const ATTRIBUTES = [["place", 3], ["normal", 3], ["uv", 2], ["albedo", 3], ["emission", 3], ["metal_rough", 2],
                    ["object_material_moving", 3]];
const STRIDE = 4 * ATTRIBUTES.reduce((sum, [, count]) => sum + count, 0), FIRST_TABLE = 16, WEIGHTS = 4096;

export class PackageReader extends Package {
    constructor(gl, document, programs, loadBlob) {
        super(document, loadBlob);
        Object.assign(this, {gl, programs});
        this.canStoreFloats = !!gl.getExtension("EXT_color_buffer_float");
        this.canFilterFloats = !!gl.getExtension("OES_texture_float_linear");
        if (!this.canStoreFloats && !gl.getExtension("EXT_color_buffer_half_float"))
            throw new Error("this browser cannot draw into pictures of floats, which the look needs");
        this.notes = this.canStoreFloats ? [] : ["this device has half floats only: dark gradients may show steps"];
        this.made = new Map(); // textures, programs and meshes by name
        this.weights = gl.createBuffer();
        this.setters = {[gl.SAMPLER_2D]: "uniform1iv", [gl.SAMPLER_3D]: "uniform1iv"};
        for (const [type, letters] of [["FLOAT", "f"], ["INT", "i"], ["UNSIGNED_INT", "ui"]])
            ["", "_VEC2", "_VEC3", "_VEC4"].forEach((length, at) => {
                this.setters[gl[type + length]] = `uniform${at + 1}${letters}v`;
            });
        gl.disable(gl.DITHER);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    }

    remember(name, make) {
        if (!this.made.has(name)) this.made.set(name, make());
        return this.made.get(name);
    }

    forget(name) {
        this.gl.deleteTexture(this.made.get(name) || null);
        this.made.delete(name);
    }

    layout(channels, half) {
        const gl = this.gl, internal = gl[["R", "RG", "RGB", "RGBA"][channels - 1] + (half ? "16F" : "32F")];
        return [internal, [gl.RED, gl.RG, gl.RGB, gl.RGBA][channels - 1]];
    }

    makeTexture(size, format, pixels = null) {
        const gl = this.gl, texture = gl.createTexture();
        const [internal, layout] = this.layout(format.length - 3, format.endsWith("16f") || !this.canStoreFloats);
        const type = pixels instanceof Uint16Array ? gl.HALF_FLOAT : gl.FLOAT;
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.texImage2D(gl.TEXTURE_2D, 0, internal, ...size, 0, layout, type, pixels);
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

    // A table of a color library. Where floats cannot be interpolated, halves stand for them.
    table({sampler, shape, linear, blob}) {
        const gl = this.gl, [channels, ...size] = shape.slice().reverse(), isDeep = size.length === 3;
        const target = isDeep ? gl.TEXTURE_3D : gl.TEXTURE_2D, upload = isDeep ? "texImage3D" : "texImage2D";
        const texture = this.remember(`table ${sampler}`, () => {
            const made = gl.createTexture(), pixels = new Float32Array(this.loadBlob(blob));
            const [internal, layout] = this.layout(channels, linear && !this.canFilterFloats);
            gl.bindTexture(target, made);
            gl[upload](target, 0, internal, ...size, 0, layout, gl.FLOAT, pixels);
            this.setSampling(target, linear);
            return made;
        });
        return {target, texture};
    }

    // A copy that the next frame may read while it draws into the same slots.
    copy(texture, format, name) {
        const gl = this.gl, target = this.remember(name, () => this.makeTexture(texture.size, format));
        this.drawInto([texture], () => {
            gl.bindTexture(gl.TEXTURE_2D, target);
            gl.copyTexSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 0, 0, ...texture.size);
        });
        return target;
    }

    // Nobody asks yet how the programs come out, so the driver may compile many at once.
    prepare(passes) { passes.forEach(pass => this.link(pass.program)); }

    link(number, texts = this.programs[number]) {
        return this.remember(`program ${number}`, () => {
            const gl = this.gl, program = gl.createProgram();
            for (const [kind, text] of [[gl.VERTEX_SHADER, texts.vertex || this.programs.cover],
                                        [gl.FRAGMENT_SHADER, texts.fragment]]) {
                const shader = gl.createShader(kind);
                gl.shaderSource(shader, text);
                gl.compileShader(shader);
                gl.attachShader(program, shader);
            }
            ATTRIBUTES.forEach(([name], place) => gl.bindAttribLocation(program, place, name));
            gl.linkProgram(program);
            return {program, uniforms: null};
        });
    }

    use(number, texts) {
        const gl = this.gl, linked = this.link(number, texts), program = linked.program;
        if (!linked.uniforms && !gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
            throw new Error(`program ${number}: ${gl.getAttachedShaders(program).map(gl.getShaderInfoLog, gl)}`);
        const length = linked.uniforms ? 0 : gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
        linked.uniforms ||= new Map(Array.from({length}, (_, at) => {
            const {name, type} = gl.getActiveUniform(program, at);
            return [name.replace("[0]", ""), {type, place: gl.getUniformLocation(program, name)}];
        }));
        gl.useProgram(program);
        return linked;
    }

    setUniform({uniforms}, name, numbers) {
        const gl = this.gl, {type, place = null} = uniforms.get(name) || {};
        if (place === null) return;
        if (type === gl.FLOAT_MAT3) gl.uniformMatrix3fv(place, false, numbers);
        else gl[this.setters[type]](place, numbers);
    }

    // Textures are bound as t0, t1, ..., tables by the names of their samplers.
    bind(linked, textures, tables = []) {
        const gl = this.gl, all = textures.map((texture, at) => [at, `t${at}`, {target: gl.TEXTURE_2D, texture}]);
        tables.forEach((record, at) => all.push([FIRST_TABLE + at, record.sampler, this.table(record)]));
        for (const [unit, name, {target, texture}] of all) {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(target, texture);
            this.setUniform(linked, name, [unit]);
        }
        gl.activeTexture(gl.TEXTURE0);
    }

    draw({program, tables, mesh}, reads, writes, uniforms, weights) {
        const gl = this.gl, linked = this.use(program);
        this.bind(linked, reads, tables);
        for (const [name, numbers] of uniforms) this.setUniform(linked, name, numbers);
        if (weights) {
            const block = new Float32Array(WEIGHTS);
            block.set(weights);
            gl.uniformBlockBinding(linked.program, gl.getUniformBlockIndex(linked.program, "Weights"), 0);
            gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.weights);
            gl.bufferData(gl.UNIFORM_BUFFER, block, gl.DYNAMIC_DRAW);
        }
        if (mesh) this.drawMesh(writes, mesh); else this.cover(writes);
    }

    drawInto(targets, work) {
        const gl = this.gl, framebuffer = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        targets.forEach((texture, at) =>
            gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + at, gl.TEXTURE_2D, texture, 0));
        gl.drawBuffers(targets.map((_, at) => gl.COLOR_ATTACHMENT0 + at));
        gl.viewport(0, 0, ...targets[0].size);
        work();
        gl.deleteFramebuffer(framebuffer);
    }

    // One triangle over all pixels.
    cover(targets) { this.drawInto(targets, () => this.gl.drawArrays(this.gl.TRIANGLES, 0, 3)); }

    // The triangles of a mesh with a depth buffer, over 0.
    drawMesh(targets, {vertices, indices}) {
        const gl = this.gl, depth = gl.createRenderbuffer();
        const {array, count} = this.remember(`mesh ${vertices}`, () => this.makeMesh(vertices, indices));
        gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
        gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, ...targets[0].size);
        gl.bindVertexArray(array);
        gl.enable(gl.DEPTH_TEST);
        this.drawInto(targets, () => {
            gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
            gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
            gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
        });
        gl.disable(gl.DEPTH_TEST);
        gl.bindVertexArray(null);
        gl.deleteRenderbuffer(depth);
    }

    makeMesh(vertices, indices) {
        const gl = this.gl, array = gl.createVertexArray(), numbers = new Uint32Array(this.loadBlob(indices));
        gl.bindVertexArray(array);
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ARRAY_BUFFER, this.loadBlob(vertices), gl.STATIC_DRAW);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
        let offset = 0;
        ATTRIBUTES.forEach(([, count], place) => {
            gl.enableVertexAttribArray(place);
            gl.vertexAttribPointer(place, count, gl.FLOAT, false, STRIDE, offset);
            offset += 4 * count;
        });
        return {array, count: numbers.length};
    }
}
