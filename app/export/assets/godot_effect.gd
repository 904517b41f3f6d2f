@tool
extends CompositorEffect
## Draws a look that Halation exported over what a camera of Godot sees. Written for Godot 4.4, Forward+.
##
## `passes.json` beside this script says which programs run in which order, what they read and write, and how numbers
## follow the controls. The script that extends this one has the controls of the look.
## Not run by Godot where it was written: its text was parsed by the grammar of gdtoolkit, and the programs in `shaders`
## were compiled by glslang, the compiler that Godot has.

const Numbers := preload("halation_numbers.gd")
const FORMATS := {
	"r16f": RenderingDevice.DATA_FORMAT_R16_SFLOAT,
	"rg16f": RenderingDevice.DATA_FORMAT_R16G16_SFLOAT,
	"rgba16f": RenderingDevice.DATA_FORMAT_R16G16B16A16_SFLOAT,
	"r32f": RenderingDevice.DATA_FORMAT_R32_SFLOAT,
	"rg32f": RenderingDevice.DATA_FORMAT_R32G32_SFLOAT,
	"rgba32f": RenderingDevice.DATA_FORMAT_R32G32B32A32_SFLOAT,
}
## The bytes of the block of weights that programs declare.
const WEIGHTS_SIZE := 16384
## The bindings of both blocks of numbers, and of the first picture.
const NUMBERS_BINDING := 0
const WEIGHTS_BINDING := 1
const FIRST_PICTURE := 2

var _device: RenderingDevice
var _document: Dictionary
var _shaders := {}
var _pipelines := {}
var _textures := {}
var _samplers := {}
## By view: the textures that the next frame reads, by the port that they come from.
var _histories := {}


func _init() -> void:
	effect_callback_type = EFFECT_CALLBACK_TYPE_POST_TRANSPARENT
	access_resolved_color = true
	access_resolved_depth = true
	needs_normal_roughness = true
	RenderingServer.call_on_render_thread(_open)


func _notification(what: int) -> void:
	if what != NOTIFICATION_PREDELETE or _device == null:
		return
	for table: Dictionary in [_textures, _samplers, _shaders]:  # pipelines end with their shaders
		for resource: RID in table.values():
			_device.free_rid(resource)


## The values of the controls by the names of their knobs.
func list_knobs() -> Dictionary:
	return {}


## The frame that is shown, or a negative number for the one of the moment.
func choose_frame() -> int:
	return -1


func _open() -> void:
	_device = RenderingServer.get_rendering_device()
	_document = JSON.parse_string(FileAccess.get_file_as_string(_find_folder() + "/passes.json"))


func _find_folder() -> String:
	return (get_script() as Script).resource_path.get_base_dir()


func _render_callback(_type: int, data: RenderData) -> void:
	var buffers := data.get_render_scene_buffers() as RenderSceneBuffersRD
	if _device == null or buffers == null or _document.is_empty():
		return
	for view in buffers.get_view_count():
		var scene := data.get_render_scene_data()
		_draw_view(buffers, scene.get_view_projection(view), view)


func _draw_view(buffers: RenderSceneBuffersRD, projection: Projection, view: int) -> void:
	var knobs := list_knobs()
	knobs["frame"] = float(_find_frame())
	var remembers := not (_document["plans"][0][0]["memories"] as Dictionary).is_empty()
	var history: Dictionary = _histories.get(view, {})
	var plan := Numbers.choose_plan(_document, knobs, history.is_empty() or not remembers)
	var surfaces: Array[RID] = []
	for surface: Dictionary in plan["surfaces"]:
		surfaces.append(_find_surface(surface, knobs, history, view))
	for at in surfaces.size():
		var surface: Dictionary = plan["surfaces"][at]
		if surface.has("source"):
			_take(str(int(surface["source"])), surfaces[at], surface["size"], buffers, projection, view)
	for record: Dictionary in plan["passes"]:
		_run_pass(record, surfaces, knobs)
	for port: String in plan["memories"]:
		var number := int(plan["memories"][port])
		history[port] = _copy(surfaces[number], plan["surfaces"][number], "memory %d %s" % [view, port])
	_histories[view] = history
	var output := int(plan["output"])
	var is_single: bool = (plan["surfaces"][output]["format"] as String).length() == "r32f".length()
	var size := buffers.get_internal_size()
	var numbers := PackedFloat32Array([size.x, size.y, 1.0 if is_single else 0.0, 0.0])
	_draw_own("show_picture", surfaces[output], buffers.get_color_layer(view), numbers)


func _find_frame() -> int:
	var first := int(_document["frames"][0])
	var count := int(_document["frames"][1]) - first + 1
	var held := choose_frame()
	if held >= first:
		return mini(held, first + count - 1)
	return first + int(Time.get_ticks_msec() * 0.001 * float(_document["rate"])) % count


# --- textures ---------------------------------------------------------------------------------------------------------


func _find_surface(surface: Dictionary, knobs: Dictionary, history: Dictionary, view: int) -> RID:
	var size: Array = surface["size"]
	if surface.has("history"):
		return history[surface["history"]]
	if surface.has("numbers"):
		return _fill_numbers(int(surface["numbers"]), surface["format"], knobs)
	if surface.has("source"):
		var number := str(int(surface["source"]))
		if _document["roles"].has(number):
			return _remember("role %d %s" % [view, number], size, surface["format"])
		var source: Dictionary = _document["sources"][int(surface["source"])]
		return _remember("source " + number, size, source["format"], _read_blob(int(source["blob"])))
	return _remember("slot %d %d" % [view, int(surface["slot"])], size, surface["format"])


## A texture by its name, its size and its format, made once.
func _remember(name: String, size: Array, format: String, pixels := PackedByteArray(), depth := 1) -> RID:
	var key := "%s %d %d %s" % [name, int(size[0]), int(size[1]), format]
	if not _textures.has(key):
		_textures[key] = _make_texture(size, format, pixels, depth)
	return _textures[key]


func _make_texture(size: Array, format: String, pixels: PackedByteArray, depth: int) -> RID:
	var made := RDTextureFormat.new()
	made.width = int(size[0])
	made.height = int(size[1])
	made.depth = depth
	made.texture_type = RenderingDevice.TEXTURE_TYPE_3D if depth > 1 else RenderingDevice.TEXTURE_TYPE_2D
	made.format = FORMATS[format]
	made.usage_bits = RenderingDevice.TEXTURE_USAGE_SAMPLING_BIT | RenderingDevice.TEXTURE_USAGE_CAN_UPDATE_BIT
	if depth == 1:
		made.usage_bits |= RenderingDevice.TEXTURE_USAGE_COLOR_ATTACHMENT_BIT \
				| RenderingDevice.TEXTURE_USAGE_CAN_COPY_FROM_BIT | RenderingDevice.TEXTURE_USAGE_CAN_COPY_TO_BIT
	var content: Array[PackedByteArray] = []
	if not pixels.is_empty():
		content.append(pixels)
	return _device.texture_create(made, RDTextureView.new(), content)


## A table that a node made of its values: height, width, channels, and the numbers.
func _fill_numbers(slot: int, format: String, knobs: Dictionary) -> RID:
	var numbers := Numbers.find_numbers(_document, slot, knobs)
	var size := [roundi(numbers[1]), roundi(numbers[0])]
	var channels := roundi(numbers[2])
	var given := format.length() - 3
	var is_half := format.ends_with("16f")
	var step := 2 if is_half else 4
	var pixels := PackedByteArray()
	pixels.resize(size[0] * size[1] * given * step)
	for pixel in size[0] * size[1]:
		for channel in channels:
			var place: int = (pixel * given + channel) * step
			var number: float = numbers[3 + pixel * channels + channel]
			if is_half:
				pixels.encode_half(place, number)
			else:
				pixels.encode_float(place, number)
	var texture := _remember("numbers %d" % slot, size, format)
	_device.texture_update(texture, 0, pixels)
	return texture


## A copy that the next frame may read while it draws into the same textures.
func _copy(texture: RID, surface: Dictionary, name: String) -> RID:
	var size := Vector3(int(surface["size"][0]), int(surface["size"][1]), 1)
	var copy := _remember(name, surface["size"], surface["format"])
	_device.texture_copy(texture, copy, Vector3.ZERO, Vector3.ZERO, size, 0, 0, 0, 0)
	return copy


func _find_table(record: Dictionary) -> RID:
	var shape: Array = record["shape"]
	var format: String = {1: "r32f", 2: "rg32f", 4: "rgba32f"}[int(shape[-1])]
	var depth := int(shape[0]) if shape.size() == 4 else 1
	return _remember("table " + record["sampler"], [shape[-2], shape[-3]], format, _read_blob(int(record["blob"])), depth)


func _read_blob(number: int) -> PackedByteArray:
	return FileAccess.get_file_as_bytes("%s/pixels/%d.bin" % [_find_folder(), number])


func _find_sampler(is_linear: bool) -> RID:
	if not _samplers.has(is_linear):
		var state := RDSamplerState.new()
		var way := RenderingDevice.SAMPLER_FILTER_LINEAR if is_linear else RenderingDevice.SAMPLER_FILTER_NEAREST
		state.min_filter = way
		state.mag_filter = way
		_samplers[is_linear] = _device.sampler_create(state)
	return _samplers[is_linear]


# --- passes -----------------------------------------------------------------------------------------------------------


## Fill a texture with what the game gives: its picture, its depth, or its normals.
func _take(
	number: String, target: RID, size: Array, buffers: RenderSceneBuffersRD, projection: Projection, view: int
) -> void:
	var numbers := PackedFloat32Array([size[0], size[1], projection.get_z_near(), projection.get_z_far()])
	match _document["roles"].get(number, ""):
		"picture":
			_draw_own("take_picture", buffers.get_color_layer(view), target, numbers)
		"depth":
			var name := "take_flat_depth" if projection.is_orthogonal() else "take_depth"
			_draw_own(name, buffers.get_depth_layer(view), target, numbers)
		"normal":
			var normals := buffers.get_texture_slice("forward_clustered", "normal_roughness", view, 0, 1, 1)
			_draw_own("take_normal", normals, target, numbers)


func _draw_own(program: String, picture: RID, target: RID, numbers: PackedFloat32Array) -> void:
	var linear := program == "take_picture" or program == "show_picture"
	_draw(program, [_bind_picture(FIRST_PICTURE, picture, linear)], numbers.to_byte_array(), PackedByteArray(), [target])


func _run_pass(record: Dictionary, surfaces: Array[RID], knobs: Dictionary) -> void:
	var interface: Dictionary = _document["interfaces"][int(record["program"])]
	var pictures: Array[RDUniform] = []
	var places: Dictionary = interface["pictures"]
	for unit in (record["textures"] as Array).size():
		if places.has("t%d" % unit):
			var texture := surfaces[int(record["textures"][unit])]
			pictures.append(_bind_picture(int(places["t%d" % unit]), texture, false))
	for table: Dictionary in record.get("tables", []):
		if places.has(table["sampler"]):
			pictures.append(_bind_picture(int(places[table["sampler"]]), _find_table(table), table["linear"]))
	var uniforms := {}
	for name: String in record["uniforms"]:
		uniforms[name] = Numbers.find_numbers(_document, int(record["uniforms"][name]), knobs)
	var weights := PackedByteArray()
	if record.has("weights"):
		weights = PackedFloat32Array(Numbers.find_numbers(_document, int(record["weights"]), knobs)).to_byte_array()
		weights.resize(WEIGHTS_SIZE)
	var targets: Array[RID] = []
	for number: float in record["targets"]:
		targets.append(surfaces[int(number)])
	var block := Numbers.pack(interface["numbers"], int(interface["size"]), uniforms)
	_draw(str(int(record["program"])), pictures, block, weights, targets)


func _bind_picture(binding: int, texture: RID, is_linear: bool) -> RDUniform:
	var uniform := RDUniform.new()
	uniform.uniform_type = RenderingDevice.UNIFORM_TYPE_SAMPLER_WITH_TEXTURE
	uniform.binding = binding
	uniform.add_id(_find_sampler(is_linear))
	uniform.add_id(texture)
	return uniform


func _bind_block(binding: int, buffer: RID) -> RDUniform:
	var uniform := RDUniform.new()
	uniform.uniform_type = RenderingDevice.UNIFORM_TYPE_UNIFORM_BUFFER
	uniform.binding = binding
	uniform.add_id(buffer)
	return uniform


## Draw one triangle over all pixels of the targets.
func _draw(
	program: String, pictures: Array, numbers: PackedByteArray, weights: PackedByteArray, targets: Array
) -> void:
	var bindings: Array[RDUniform] = []
	bindings.assign(pictures)
	var buffers: Array[RID] = []
	for part: Array in [[NUMBERS_BINDING, numbers], [WEIGHTS_BINDING, weights]]:
		var content: PackedByteArray = part[1]
		if not content.is_empty():
			buffers.append(_device.uniform_buffer_create(content.size(), content))
			bindings.append(_bind_block(part[0], buffers[-1]))
	var attachments: Array[RID] = []
	attachments.assign(targets)
	var framebuffer := _device.framebuffer_create(attachments)
	var shader := _find_shader(program)
	var pipeline := _find_pipeline(program, shader, framebuffer, targets.size())
	var uniform_set := RID() if bindings.is_empty() else _device.uniform_set_create(bindings, shader, 0)
	var list := _device.draw_list_begin(framebuffer)
	_device.draw_list_bind_render_pipeline(list, pipeline)
	if uniform_set.is_valid():
		_device.draw_list_bind_uniform_set(list, uniform_set, 0)
	_device.draw_list_draw(list, false, 1, 3)
	_device.draw_list_end()
	for resource: RID in [uniform_set, framebuffer] + buffers:
		if resource.is_valid():
			_device.free_rid(resource)


func _find_shader(program: String) -> RID:
	if not _shaders.has(program):
		var file: RDShaderFile = load("%s/shaders/%s.glsl" % [_find_folder(), program])
		_shaders[program] = _device.shader_create_from_spirv(file.get_spirv())
	return _shaders[program]


func _find_pipeline(program: String, shader: RID, framebuffer: RID, count: int) -> RID:
	var format := _device.framebuffer_get_format(framebuffer)
	var key := "%s %d" % [program, format]
	if not _pipelines.has(key):
		var blend := RDPipelineColorBlendState.new()
		for at in count:
			blend.attachments.append(RDPipelineColorBlendStateAttachment.new())
		_pipelines[key] = _device.render_pipeline_create(
			shader, format, RenderingDevice.INVALID_FORMAT_ID, RenderingDevice.RENDER_PRIMITIVE_TRIANGLES,
			RDPipelineRasterizationState.new(), RDPipelineMultisampleState.new(),
			RDPipelineDepthStencilState.new(), blend
		)
	return _pipelines[key]
