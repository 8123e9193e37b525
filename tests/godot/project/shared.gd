# On the renderer's own device: hashes are the C host's, and textures, read by a shader, are its outputs in every value; they may be
# shown while their terrain ends. Arguments: FOLDER.
extends SceneTree

const SHADER := "#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1, std430) buffer writeonly restrict Values { float values[]; };
layout(push_constant, std430) uniform Constants { int channels; };
void main() {
	ivec2 size = textureSize(image, 0), at = ivec2(gl_GlobalInvocationID.xy);
	if (any(greaterThanEqual(at, size))) return;
	vec4 texel = texelFetch(image, at, 0);
	for (int c = 0; c < channels; ++c) values[(at.y * size.x + at.x) * channels + c] = texel[c];
}"

var rd := RenderingServer.get_rendering_device()
var rids: Array[RID] = []

func keep(rid: RID) -> RID:
	rids.push_front(rid)
	return rid

# What a shader reads from the texture.
func read(texture: Texture2D, channels: int) -> PackedFloat32Array:
	var source := RDShaderSource.new()
	source.source_compute = SHADER
	var shader := keep(rd.shader_create_from_spirv(rd.shader_compile_spirv_from_source(source)))
	var size := Vector2i(texture.get_size())
	var values := keep(rd.storage_buffer_create(size.x * size.y * channels * 4))
	var image := RDUniform.new()
	image.uniform_type = RenderingDevice.UNIFORM_TYPE_SAMPLER_WITH_TEXTURE
	image.add_id(keep(rd.sampler_create(RDSamplerState.new())))
	image.add_id(RenderingServer.texture_get_rd_texture(texture.get_rid()))
	var buffer := RDUniform.new()
	buffer.uniform_type = RenderingDevice.UNIFORM_TYPE_STORAGE_BUFFER
	buffer.binding = 1
	buffer.add_id(values)
	var uniforms := keep(rd.uniform_set_create([image, buffer], shader, 0))
	var list := rd.compute_list_begin()
	rd.compute_list_bind_compute_pipeline(list, keep(rd.compute_pipeline_create(shader)))
	rd.compute_list_bind_uniform_set(list, uniforms, 0)
	rd.compute_list_set_push_constant(list, PackedInt32Array([channels, 0, 0, 0]).to_byte_array(), 16)
	rd.compute_list_dispatch(list, (size.x + 7) / 8, (size.y + 7) / 8, 1)
	rd.compute_list_end()
	var result := rd.buffer_get_data(values).to_float32_array()
	for rid in rids:
		if rd.uniform_set_is_valid(rid) or rid != uniforms:
			rd.free_rid(rid)
	rids.clear()
	return result

static func channels_of(output: int) -> int:
	match output:
		WadiTerrain3D.OUTPUT_FLOW, WadiTerrain3D.OUTPUT_SAND_VELOCITY:
			return 2
		WadiTerrain3D.OUTPUT_NORMAL, WadiTerrain3D.OUTPUT_PACKED, WadiTerrain3D.OUTPUT_PACKED_HALF:
			return 4
	return 1

static func host_values(output: int) -> PackedFloat32Array:
	var bytes := Scene.host_bytes("output_%d.bin" % output)
	if output != WadiTerrain3D.OUTPUT_PACKED_HALF:
		return bytes.to_float32_array()
	var values := PackedFloat32Array()
	for n in bytes.size() / 2:
		values.append(bytes.decode_half(2 * n))
	return values

func _initialize() -> void:
	var check := Check.new()
	var terrain := Scene.terrain(self, Scene.level("castle"), "auto")
	terrain.share_device = true
	terrain.outputs = (1 << (WadiTerrain3D.OUTPUT_PACKED_HALF + 1)) - 1
	check.same(terrain.start(), OK, "start")
	check.same(terrain.get_stats()["backend"], "vulkan", "backend")
	var kept := terrain.get_texture(WadiTerrain3D.OUTPUT_PACKED)
	check.that(kept is Texture2DRD, "the texture is the device's own")
	var hashes := Scene.run(terrain)
	check.same(hashes, Scene.host_hashes(), "hashes")
	check.same(terrain.sync_textures(), OK, "sync_textures")
	check.that(kept == terrain.get_texture(WadiTerrain3D.OUTPUT_PACKED), "the texture stays the same object")
	for output in WadiTerrain3D.OUTPUT_PACKED_HALF + 1:
		var values := read(terrain.get_texture(output), channels_of(output))
		check.that(values == host_values(output), "texture of output %d has the host's values" % output)
	var heights := terrain.get_heights(Rect2i(Vector2i.ZERO, terrain.get_cells()))
	check.that(heights == Scene.host_bytes("heights.bin").to_float32_array(), "heights")
	terrain.step(1)
	terrain.sync_textures()
	check.that(read(kept, 4) != host_values(WadiTerrain3D.OUTPUT_PACKED), "control: a step later the texture differs")

	# Shown by the renderer while it runs, while the world starts anew, and after it has ended.
	var picture := TextureRect.new()
	picture.texture = kept
	root.add_child(picture)
	terrain.running = true
	for n in 5:
		await process_frame
	check.that(terrain.get_step() > 96, "runs by itself")
	terrain.stop()
	for n in 3:
		await process_frame
	check.same(terrain.start(), OK, "start anew")
	picture.texture = terrain.get_texture(WadiTerrain3D.OUTPUT_PACKED)
	for n in 3:
		await process_frame
	terrain.free()
	for n in 3:
		await process_frame
	picture.free()
	check.done(self)
