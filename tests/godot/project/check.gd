# Counts checks; done() ends the program with 1 where one failed.
class_name Check extends RefCounted

var passed := 0
var failed := 0

func that(good: bool, what: String) -> void:
	if good:
		passed += 1
	else:
		failed += 1
		print("FAIL: ", what)

func same(got: Variant, expected: Variant, what: String) -> void:
	that(typeof(got) == typeof(expected) and got == expected, "%s: %s, expected %s" % [what, got, expected])

func done(tree: SceneTree) -> void:
	print("%d checks passed, %d failed" % [passed, failed])
	tree.quit(1 if failed > 0 else 0)
