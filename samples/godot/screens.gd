## What one reads: a start screen, how it stands, what is announced, and an end screen with medal and score.
## Without containers: those of Debian's release build of the engine report errors as it ends.
extends CanvasLayer

signal chosen(which: int)
signal play
signal again
signal other

const Score := preload("score.gd")
const GAP := 10.0  # between buttons

var _announced: Tween


func _ready() -> void:
	$Start.hide()
	$End.hide()
	$Announce.modulate.a = 0
	%Play.pressed.connect(_on_play)
	%Again.pressed.connect(again.emit)
	for button: Button in [%Other, %EndOther]:
		button.pressed.connect(other.emit)


## `choices`: [name, one line on it] each.
func show_start(game: String, task: String, choices: Array, choice: int) -> void:
	%Title.text = game
	%Task.text = task
	var group := ButtonGroup.new()
	var wide: float = (%Choices.size.x + GAP) / choices.size()
	for n in choices.size():
		var best := Score.best(game, choices[n][0])
		var button := Button.new()
		button.toggle_mode = true
		button.button_group = group
		button.button_pressed = n == choice
		button.position.x = n * wide
		button.size = Vector2(wide - GAP, %Choices.size.y)
		button.text = "%s\n%s, %d" % [choices[n][0], Score.words(best.y as Score.Medal), best.x] if best.x > 0 else choices[n][0]
		button.pressed.connect(_on_chosen.bind(n, choices[n][1]))
		%Choices.add_child(button)
	%About.text = choices[choice][1]
	$Start.show()
	$Hud.hide()
	%Play.grab_focus()


func _on_chosen(which: int, about: String) -> void:
	%About.text = about
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
