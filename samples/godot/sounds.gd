## Short sounds, made of noise and sines as the scene loads: no file of sound is needed. M switches them off and on.
extends Node

const RATE := 16000  # samples a second
const VOICES := 3  # of one sound at a time

## Seconds for which a sound is not begun again.
const PAUSES := {&"dig": 0.11, &"pour": 0.13, &"splash": 0.5}

static var silent := false

var _players := {}  # name: Array[AudioStreamPlayer]
var _next := {}  # name: voice whose turn it is
var _free_at := {}  # name: time from which it may begin again [ms]
var _surf: AudioStreamPlayer
var _loudness := 0.0
var _noise := RandomNumberGenerator.new()


func _ready() -> void:
	_noise.seed = 7
	_surf = _player(_surf_stream(), -60)
	_add(&"dig", _scrape(0.16, 0.5, 30), -9)
	_add(&"pour", _scrape(0.2, 0.8, 14), -16)
	_add(&"splash", _scrape(0.9, 0.25, 6), -7)
	_add(&"bell", _tones([523.25], 1.6, 2.2), -12)
	_add(&"win", _tones([523.25, 659.26, 783.99, 1046.5], 1.4, 4), -10)
	_add(&"lose", _tones([392.0, 349.23, 311.13, 233.08], 1.6, 3), -10)
	_add(&"click", _tones([880.0], 0.08, 60), -16)
	AudioServer.set_bus_mute(0, silent)
	_surf.play()


## Silence, and time for the mixer to let go: what sounds at the engine's end would be left over.
func end() -> void:
	set_process(false)
	for player: AudioStreamPlayer in get_children():
		player.stop()
	for n in 6:
		OS.delay_msec(20)
		await get_tree().process_frame


func play(what: StringName, louder := 0.0) -> void:
	var now := Time.get_ticks_msec()
	if now < _free_at.get(what, 0):
		return
	_free_at[what] = now + int(1000 * PAUSES.get(what, 0.0))
	var voices: Array = _players[what]
	var player: AudioStreamPlayer = voices[_next[what]]
	_next[what] = (_next[what] + 1) % voices.size()
	player.volume_db = player.get_meta("own") + louder
	player.pitch_scale = _noise.randf_range(0.92, 1.08) if PAUSES.has(what) else 1.0
	player.play()


## How loud the water is, 0 to 1.
func set_surf(loudness: float) -> void:
	_loudness = loudness


func switch() -> void:
	silent = not silent
	AudioServer.set_bus_mute(0, silent)


func _process(delta: float) -> void:
	var wanted := linear_to_db(clampf(0.04 + 0.5 * _loudness, 0.001, 0.6))
	_surf.volume_db = lerpf(maxf(_surf.volume_db, -40), wanted, minf(3 * delta, 1))


func _add(what: StringName, stream: AudioStreamWAV, decibels: float) -> void:
	_next[what] = 0
	_players[what] = []
	for n in VOICES:
		_players[what].append(_player(stream, decibels))


func _player(stream: AudioStreamWAV, decibels: float) -> AudioStreamPlayer:
	var player := AudioStreamPlayer.new()
	player.stream = stream
	player.volume_db = decibels
	player.set_meta("own", decibels)
	add_child(player)
	return player


## Sand or water in motion: noise through a low pass that lets `bright` of each step by, which fades by e in 1 / `fall` seconds.
func _scrape(seconds: float, bright: float, fall: float) -> AudioStreamWAV:
	var count := int(seconds * RATE)
	var samples := PackedFloat32Array()
	samples.resize(count)
	var low := 0.0
	for n in count:
		var time := n / float(RATE)
		low += bright * (_noise.randf_range(-1, 1) - low)
		samples[n] = low * minf(time * 60, 1) * exp(-fall * time)
	return _stream(samples)


## Tones one after the other, like a marimba's, each with its octave; the last one rings on.
func _tones(tones: Array, seconds: float, fall: float) -> AudioStreamWAV:
	var count := int(seconds * RATE)
	var samples := PackedFloat32Array()
	samples.resize(count)
	var every := 0.16
	for k in tones.size():
		var begin := int(k * every * RATE)
		var turn: float = TAU * tones[k] / RATE
		for n in range(begin, count):
			var time := (n - begin) / float(RATE)
			samples[n] += (sin(turn * (n - begin)) + 0.35 * sin(2.01 * turn * (n - begin))) * minf(time * 200, 1) * exp(-fall * time)
	return _stream(samples)


## The sea from afar: brown noise that swells once, its end laid over its beginning so that it goes round without a click.
func _surf_stream() -> AudioStreamWAV:
	var count := 4 * RATE
	@warning_ignore("integer_division")
	var over := RATE / 2
	var raw := PackedFloat32Array()
	raw.resize(count + over)
	var low := 0.0
	for n in raw.size():
		low += 0.12 * (_noise.randf_range(-1, 1) - low)
		raw[n] = low * (0.75 - 0.25 * cos(TAU * n / float(count)))
	for n in over:
		raw[n] = lerpf(raw[count + n], raw[n], n / float(over))
	var stream := _stream(raw.slice(0, count))
	stream.loop_mode = AudioStreamWAV.LOOP_FORWARD
	stream.loop_end = count
	return stream


## Samples of any size as a stream whose largest is 0.9 of what fits.
static func _stream(samples: PackedFloat32Array) -> AudioStreamWAV:
	var largest := 1e-6
	for sample in samples:
		largest = maxf(largest, absf(sample))
	var data := PackedByteArray()
	data.resize(2 * samples.size())
	for n in samples.size():
		data.encode_s16(2 * n, int(29490 * samples[n] / largest))
	var stream := AudioStreamWAV.new()
	stream.format = AudioStreamWAV.FORMAT_16_BITS
	stream.mix_rate = RATE
	stream.data = data
	return stream
