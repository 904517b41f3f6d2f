extends RefCounted
## Which passes of a package run, and the numbers that they are given: all that follows the controls of a look.


## The passes for these values: plans are in the order of the axes, the last one changes fastest.
static func choose_plan(document: Dictionary, knobs: Dictionary, is_first: bool) -> Dictionary:
	var index := 0
	for axis: Dictionary in document["axes"]:
		var span := 0
		for edge: float in axis["edges"]:
			span += 1 if knobs[axis["knob"]] > edge else 0
		index = index * ((axis["edges"] as Array).size() + 1) + span
	return document["plans"][0 if is_first else -1][index]


## The numbers of a slot: its base, and the curve of each knob that changes it.
static func find_numbers(document: Dictionary, slot: int, knobs: Dictionary) -> Array:
	var record: Dictionary = document["slots"][slot]
	var base: Array = record["base"]
	var numbers := base.duplicate()
	for curve: Dictionary in record.get("curves", []):
		var x: float = knobs[curve["knob"]]
		var row := _find_nearest(x, curve["at"], curve["values"]) if curve.get("snap", false) \
				else _interpolate(x, curve["at"], curve["values"])
		for at in base.size():
			if record.get("mode", "") == "multiply" and base[at] != 0.0:
				numbers[at] *= row[at] / base[at]
			else:
				numbers[at] += row[at] - base[at]
	for grid: Dictionary in record.get("grids", []):
		var lines := []
		for line: Array in grid["values"]:
			lines.append(_interpolate(knobs[grid["knobs"][1]], grid["at"][1], line))
		var row := _interpolate(knobs[grid["knobs"][0]], grid["at"][0], lines)
		for at in base.size():
			numbers[at] += row[at]
	if record.get("whole", false):
		for at in base.size():
			numbers[at] = roundf(numbers[at])
	return numbers


## The row of numbers at x, between two rows; beyond the ends the last one.
static func _interpolate(x: float, places: Array, rows: Array) -> Array:
	if x <= places[0]:
		return rows[0]
	for after in range(1, places.size()):
		if x <= places[after]:
			var share: float = (x - places[after - 1]) / (places[after] - places[after - 1])
			var row := []
			for at in rows[0].size():
				row.append(lerpf(rows[after - 1][at], rows[after][at], share))
			return row
	return rows[-1]


static func _find_nearest(x: float, places: Array, rows: Array) -> Array:
	var best := 0
	for at in places.size():
		if absf(places[at] - x) < absf(places[best] - x):
			best = at
	return rows[best]


## The bytes of a block: `layout` gives the first byte, the kind and the numbers in a row of each uniform.
static func pack(layout: Dictionary, size: int, uniforms: Dictionary) -> PackedByteArray:
	var block := PackedByteArray()
	block.resize(size)
	for name: String in uniforms:
		if not layout.has(name):
			continue
		var numbers: Array = uniforms[name]
		var start := int(layout[name][0])
		var width := int(layout[name][2])
		for at in numbers.size():
			@warning_ignore("integer_division")
			var place := start + (16 * (at / width) + 4 * (at % width) if width > 0 else 4 * at)
			if place + 4 > size:  # the program reads fewer of them
				break
			match layout[name][1]:
				"float":
					block.encode_float(place, numbers[at])
				"int":
					block.encode_s32(place, int(numbers[at]))
				_:
					block.encode_u32(place, int(numbers[at]))
	return block
