// One frame: ground, sky and water into a picture. Nothing here waits for the world, and nothing is read back.
#pragma once
#include "../common/platform.hpp"
#include "mesh.hpp"
#include "world.hpp"

struct Scene { // scene.glsl says what each is
    glm::mat4 to_screen, from_screen;
    glm::vec4 eye, sun, lod;
    glm::ivec4 grid, rows[5];
};

class Drawing {
  public:
    explicit Drawing(const common::Gpu& gpu) : target(gpu), gpu_(gpu) {
        const std::vector<uint32_t> indices = Mesh::indices();
        index_count_ = static_cast<uint32_t>(indices.size());
        indices_ = gpu.make_buffer(indices.size() * sizeof(uint32_t), VK_BUFFER_USAGE_INDEX_BUFFER_BIT, undo_);
        std::memcpy(indices_.mapped, indices.data(), indices.size() * sizeof(uint32_t));
        scene_ = gpu.make_buffer(sizeof(Scene), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, undo_);
        chunks_ = gpu.make_buffer(MOST_CHUNKS * sizeof(Chunk), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, undo_);
        set_ = gpu.make_buffer_set(BINDINGS, undo_);
        const auto from = common::executable_path().parent_path() / "mesh_shaders", surface = from / "surface.vert.spv";
        ground_ = gpu.make_pipeline(set_, surface, from / "ground.frag.spv", {0, Mesh::SIDE}, false, true, undo_);
        sky_ = gpu.make_pipeline(set_, from / "sky.vert.spv", from / "sky.frag.spv", {}, false, false, undo_);
        water_ = gpu.make_pipeline(set_, surface, from / "water.frag.spv", {1, Mesh::SIDE}, true, true, undo_);
        commands = gpu.make_commands(undo_);
    }
    ~Drawing() { vkDeviceWaitIdle(gpu_.device); }

    common::Target target;
    common::Commands commands;

    /// Records a picture. It is to be submitted before the world's next update. The last one must be done.
    void record(VkExtent2D size, const Scene& scene, const World::Sources& sources, const std::vector<Chunk>& chunks) {
        if (chunks.size() > MOST_CHUNKS) throw std::logic_error("more chunks than there is room for");
        const auto count = static_cast<uint32_t>(chunks.size());
        std::memcpy(chunks_.mapped, chunks.data(), count * sizeof(Chunk));
        std::memcpy(scene_.mapped, &scene, sizeof scene);
        std::vector<VkBuffer> buffers{scene_.handle, chunks_.handle};
        for (const World::Source& source : sources) buffers.push_back(source.buffer); // the plugin's own
        gpu_.point(set_, BINDINGS, buffers);

        gpu_.begin(commands);
        const VkCommandBuffer c = commands.buffer;
        // What the world has written on this queue is seen from here on.
        const VkPipelineStageFlags world = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                                   draws = VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
        VkMemoryBarrier written{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
        written.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
        written.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
        vkCmdPipelineBarrier(c, world, draws, 0, 1, &written, 0, nullptr, 0, nullptr);
        target.begin(c, size, {{1, 0, 1, 1}}); // loud: where nothing is drawn is a hole in the mesh
        vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_GRAPHICS, set_.layout, 0, 1, &set_.set, 0, nullptr);
        vkCmdBindIndexBuffer(c, indices_.handle, 0, VK_INDEX_TYPE_UINT32);
        vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS, ground_);
        vkCmdDrawIndexed(c, index_count_, count, 0, 0, 0);
        vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS, sky_);
        vkCmdDraw(c, 3, 1, 0, 0);
        vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS, water_);
        vkCmdDrawIndexed(c, index_count_, count, 0, 0, 0);
        target.end(c);
        // The world's next update writes the interpolated outputs anew: behind what reads them here.
        vkCmdPipelineBarrier(c, draws, world, 0, 0, nullptr, 0, nullptr, 0, nullptr);
    }

  private:
    static constexpr std::size_t MOST_CHUNKS = 65536;
    static constexpr std::array<uint32_t, 3> BINDINGS = {1, 1, World::OUTPUTS.size()}; // scene, chunks, outputs
    const common::Gpu& gpu_;
    common::Undo undo_;
    common::Buffer indices_, scene_, chunks_;
    common::BufferSet set_;
    VkPipeline ground_ = VK_NULL_HANDLE, sky_ = VK_NULL_HANDLE, water_ = VK_NULL_HANDLE;
    uint32_t index_count_ = 0;
};
