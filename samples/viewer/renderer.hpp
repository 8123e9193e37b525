// Draws the height fields by compute passes: from the plugin's outputs to an encoded picture.
#pragma once
#include "gpu.hpp"
#include "look.hpp"
#include "simulation.hpp"
#include <functional>
#include <optional>

namespace viewer {

struct Milliseconds {
    double grid = 0, see = 0, shade = 0, finish = 0, after = 0; // on the device
    double all() const { return grid + see + shade + finish + after; }
};
Milliseconds operator+(const Milliseconds& a, const Milliseconds& b);

/// An image and where it belongs in the picture [pixels].
struct PlacedImage {
    const Image* image;
    int left, top, width, height;
};

class Renderer {
  public:
    /// `usage`: of the picture, beside being written and copied from.
    Renderer(const Gpu& gpu, uint32_t width, uint32_t height, VkImageUsageFlags usage = 0);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    void resize(uint32_t width, uint32_t height);
    uint32_t width() const { return picture_.width; }
    uint32_t height() const { return picture_.height; }
    const Image& picture() const { return picture_; } // sRGB-encoded, RGBA8

    /// Waits until the last picture is there and its command buffer free; reads its times.
    void wait();
    /// Submits a picture. `after` may add commands that use the picture; it lies in layout GENERAL before and after them.
    void draw(const Picture& what, const Grid& grid, const Sources& sources, bool foreign_memory, const Submission& submission,
              const std::function<void(VkCommandBuffer)>& after);
    /// Submits a picture of images on a dark ground, instead of a world.
    void draw_images(const std::vector<PlacedImage>& images, const Submission& submission,
                     const std::function<void(VkCommandBuffer)>& after);
    Milliseconds times() const { return times_; }
    bool timed() const { return gpu_.nanoseconds_per_tick > 0; }

    /// Waits. Pixels as RGBA, first row on top.
    std::vector<uint8_t> read_picture();
    /// Waits. The place that a pixel of the last picture shows; none for sky and plinth.
    std::optional<glm::vec3> place_at(uint32_t x, uint32_t y);

  private:
    static constexpr uint32_t MARKS = 6;
    const Gpu& gpu_;
    VkImageUsageFlags usage_;
    VkSampler sampler_ = VK_NULL_HANDLE, tiling_sampler_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout pipeline_layout_ = VK_NULL_HANDLE;
    VkPipeline prepare_ = VK_NULL_HANDLE, slopes_pass_ = VK_NULL_HANDLE, reduce_ = VK_NULL_HANDLE, summit_pass_ = VK_NULL_HANDLE,
               light_pass_ = VK_NULL_HANDLE, bake_ = VK_NULL_HANDLE, see_ = VK_NULL_HANDLE, shade_ = VK_NULL_HANDLE,
               finish_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence done_ = VK_NULL_HANDLE;
    VkQueryPool marks_ = VK_NULL_HANDLE;
    bool under_way_ = false, drawn_ = false;
    bool marked_ = false;                         // the commands under way write all marks
    uint32_t drawn_width_ = 0, drawn_height_ = 0; // of what finish_ brings to the picture's size
    Milliseconds times_;

    Buffer params_;
    VkDeviceSize params_stride_ = 0;
    int nx_ = 0, ny_ = 0;
    uint32_t levels_ = 0, base_width_ = 0, base_height_ = 0; // of the pyramid
    Image heights_, slopes_, matter_, flow_, light_, pyramid_, summit_;
    Image seen_, colour_, picture_;
    Image noise_; // baked with the first picture
    bool baked_ = false;

    void make_layouts();
    void make_grid_images(const Grid& grid);
    void make_descriptor_set();
    void begin_commands();
    void submit(const Submission& submission, const std::function<void(VkCommandBuffer)>& after);
    void bind_sources(const Sources& sources);
    void barrier() const;
    void mark(uint32_t n) const;
    void dispatch(VkPipeline pipeline, uint32_t across, uint32_t down, uint32_t params, uint32_t level = 0) const;
};

} // namespace viewer
