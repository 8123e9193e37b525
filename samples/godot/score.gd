## The best results of a player, kept in the user's folder. The file may be deleted.
extends RefCounted

enum Medal { NONE, BRONZE, SILVER, GOLD }

const COLOURS := [Color(0.45, 0.45, 0.45), Color(0.75, 0.46, 0.22), Color(0.78, 0.8, 0.84), Color(0.98, 0.78, 0.2)]

static var file := "user://scores.cfg"


## Points and medal of the best game so far; of none: (0, NONE).
static func best(game: String, choice: String) -> Vector2i:
	var scores := ConfigFile.new()
	if FileAccess.file_exists(file):
		scores.load(file)
	var kept: Variant = scores.get_value(game, choice, Vector2i.ZERO)  # a file that somebody changed may hold anything
	return kept.clamp(Vector2i.ZERO, Vector2i(1000000, Medal.GOLD)) if kept is Vector2i else Vector2i.ZERO


## Keeps a result where it is better than the best so far, and says whether it was.
static func keep(game: String, choice: String, points: int, medal: Medal) -> bool:
	if points <= best(game, choice).x:
		return false
	var scores := ConfigFile.new()
	if FileAccess.file_exists(file):
		scores.load(file)
	scores.set_value(game, choice, Vector2i(points, medal))
	var error := scores.save(file)
	if error != OK:
		push_error("cannot keep the score in %s: %s" % [file, error_string(error)])
	return error == OK


static func words(medal: Medal) -> String:
	return ["No medal", "Bronze", "Silver", "Gold"][medal]
