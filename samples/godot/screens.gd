## What one reads: a start screen, how it stands, what is announced, and an end screen with medal and score.
extends CanvasLayer

signal chosen(which: int)
signal play
signal again
signal other

const Score := preload("score.gd")

var _words: PackedStringArray = []
var _announced: Tween


func _ready() -> void:
	$Start.hide()
	$End.hide()
	$Announce.modulate.a = 0
	%Play.pressed.connect(_on_play)
	%Again.pressed.connect(again.emit)
	for button: Button in [%Other, %EndOther]:
		button.pressed.connect(other.emit)
	%Choices.item_selected.connect(_on_chosen)


## `choices`: [name, one line on it] each.
func show_start(game: String, task: String, choices: Array, choice: int) -> void:
	%Title.text = game
	%Task.text = task
	%Choices.clear()
	for one: Array in choices:
		var best := Score.best(game, one[0])
		%Choices.add_item("%s (best: %s, %d)" % [one[0], Score.words(best.y as Score.Medal), best.x] if best.x > 0 else one[0])
		_words.append(one[1])
	%Choices.select(choice)
	%About.text = _words[choice]
	$Start.show()
	$Hud.hide()
	%Play.grab_focus()


func _on_chosen(which: int) -> void:
	%About.text = _words[which]
	chosen.emit(which)


func _on_play() -> void:
	$Start.hide()
	$Hud.show()
	play.emit()


## How it stands: seconds of the world, of how many, one line, and how full the bucket is, 0 to 1.
func say(time: float, duration: float, line: String, full: float) -> void:
	%Line.text = line
	%Clock.text = "%.0f s" % maxf(duration - time, 0)
	%Time.value = time / duration
	%Bucket.value = full


## Large words that fade.
func announce(what: String) -> void:
	$Announce.text = what
	if _announced != null:
		_announced.kill()
	$Announce.modulate.a = 1
	_announced = create_tween()
	_announced.tween_interval(2.5)
	_announced.tween_property($Announce, "modulate:a", 0.0, 1.0)


## `best`: points and medal of the best game so far.
func show_end(won: bool, medal: Score.Medal, points: int, best: Vector2i, record: bool, line: String) -> void:
	%Result.text = "Won!" if won else "Lost"
	%Disc.self_modulate = Score.COLOURS[medal]
	%Medal.text = Score.words(medal)
	%Points.text = "%d points%s" % [points, ", your best" if record else ""] if won else line
	%Best.text = "Best so far: %s, %d points" % [Score.words(best.y as Score.Medal), best.x] if best.x > 0 else "No game won so far"
	$Start.hide()
	$End.show()
	%Again.grab_focus()
