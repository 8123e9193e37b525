# Every method, property, signal and constant of the classes is documented, with its type, and nothing else is. Arguments: DOC_FOLDER.
extends SceneTree

# What a class's XML file names: "method NAME", "param METHOD NAME", "member NAME DEFAULT" and so on.
func documented(file: String) -> PackedStringArray:
	var found := PackedStringArray()
	var parser := XMLParser.new()
	parser.open(file)
	var of := ""
	while parser.read() == OK:
		if parser.get_node_type() != XMLParser.NODE_ELEMENT:
			continue
		var kind := parser.get_node_name()
		match kind:
			"method", "signal":
				of = parser.get_named_attribute_value("name")
				found.append(kind + " " + of)
			"param":
				found.append("param %s %s" % [of, parser.get_named_attribute_value("name")])
			"member", "constant":
				found.append(kind + " " + parser.get_named_attribute_value("name"))
	found.sort()
	return found

func registered(name: String) -> PackedStringArray:
	var found := PackedStringArray()
	var accessors := PackedStringArray()
	for property in ClassDB.class_get_property_list(name, true):
		if property["usage"] & PROPERTY_USAGE_EDITOR:
			found.append("member " + property["name"])
			accessors.append_array(["set_" + property["name"], "get_" + property["name"]])
	for method in ClassDB.class_get_method_list(name, true):
		if method["name"] in accessors or method["name"].begins_with("_"):
			continue
		found.append("method " + method["name"])
		for argument in method["args"]:
			found.append("param %s %s" % [method["name"], argument["name"]])
	for emitted in ClassDB.class_get_signal_list(name, true):
		found.append("signal " + emitted["name"])
		for argument in emitted["args"]:
			found.append("param %s %s" % [emitted["name"], argument["name"]])
	for constant in ClassDB.class_get_integer_constant_list(name, true):
		found.append("constant " + constant)
	found.sort()
	return found

func _initialize() -> void:
	var check := Check.new()
	for name: String in ["WadiLevel", "WadiTerrain3D", "WadiFloat3D"]:
		var file := Scene.argument(0) + "/" + name + ".xml"
		var expected := registered(name)
		var got := documented(file)
		check.that(expected.size() > 8, name + " is registered")
		for what in expected:
			check.that(what in got, "%s: %s is documented" % [name, what])
		for what in got:
			check.that(what in expected, "%s: documented %s exists" % [name, what])
	# Defaults as the documentation has them.
	for name: String in ["WadiLevel", "WadiTerrain3D", "WadiFloat3D"]:
		var parser := XMLParser.new()
		parser.open(Scene.argument(0) + "/" + name + ".xml")
		while parser.read() == OK:
			if parser.get_node_type() != XMLParser.NODE_ELEMENT or parser.get_node_name() != "member":
				continue
			if parser.has_attribute("default"):
				var member := parser.get_named_attribute_value("name")
				var value: Variant = ClassDB.class_get_property_default_value(name, member)
				check.that(value == str_to_var(parser.get_named_attribute_value("default").xml_unescape()), "%s.%s has the default %s" % [name, member, value])
	check.done(self)
