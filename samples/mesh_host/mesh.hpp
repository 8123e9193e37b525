// The mesh: squares of SIDE x SIDE quads with vertices 1, 2, 4 ... cells apart, finer near the eye. The device moves the vertices
// (surface.vert); here is which squares a picture needs. Heights are not asked for, so that nothing has to be read back.
#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

struct Chunk {
    int32_t x, y, level, away; // south-west vertex [cells]; its vertices are 2^level cells apart; distance from the eye [cells]
};

class Mesh {
  public:
    static constexpr int SIDE = 32;
    Mesh(int nx, int ny, float dx, float low, float high) : last_(nx - 1, ny - 1), dx_(dx), low_(low), high_(2 * high - low) {
        while (root() < std::max(nx, ny)) ++levels_;
    }
    /// Cells of a chunk of the coarsest level: one holds the whole grid.
    int root() const { return SIDE << levels_; }

    /// Triangles of a chunk. Vertex n is in column n % (SIDE + 1) and row n / (SIDE + 1).
    static std::vector<uint32_t> indices() {
        std::vector<uint32_t> made;
        for (uint32_t n = 0; n < (SIDE + 1) * SIDE; ++n) {
            const uint32_t east = n + 1, north = n + SIDE + 1;
            if (east % (SIDE + 1) != 0) made.insert(made.end(), {n, east, north + 1, n, north + 1, north});
        }
        return made;
    }
    /// What the camera may see, near ones first. eye: in cells, z above the relief's middle. Of the three differences between a
    /// vertex and the eye the largest counts as its distance. A chunk is split while some of it is nearer than reach << (its
    /// level - 1). With a reach of 4 * SIDE or more neighbours differ by one level, and where they meet the finer one has become
    /// the coarser.
    std::vector<Chunk> choose(const glm::mat4& to_screen, glm::vec3 eye, float reach) const {
        std::vector<Chunk> chosen;
        for (int n = 0; n < 9; ++n) // the grid, and the land around it
            visit({(n % 3 - 1) * root(), (n / 3 - 1) * root(), levels_, 0}, to_screen, eye, reach, chosen);
        std::sort(chosen.begin(), chosen.end(), [](const Chunk& a, const Chunk& b) { return a.away < b.away; });
        return chosen;
    }

  private:
    glm::ivec2 last_;       // cell
    float dx_, low_, high_; // waves may rise above the relief
    int levels_ = 0;

    // Where a vertex of the mesh is [cells]: all beyond the grid's rim lies `far` away from it, so that the rim goes on to the
    // horizon.
    float on_grid(int v, int axis, float far) const {
        const auto last = static_cast<float>(last_[axis]);
        return v < 0 ? -far : v > root() ? last + far : std::min(static_cast<float>(v), last);
    }
    bool seen(glm::vec2 low, glm::vec2 high, const glm::mat4& to_screen) const {
        int left = 0, right = 0, below = 0, above = 0;
        for (int n = 0; n < 8; ++n) {
            const glm::vec3 corner((n & 1) != 0 ? high.x : low.x, (n & 2) != 0 ? high.y : low.y, (n & 4) != 0 ? high_ : low_);
            const glm::vec4 at = to_screen * glm::vec4(corner, 1);
            left += at.x<-at.w, right += at.x> at.w, below += at.y<-at.w, above += at.y> at.w;
        }
        return left < 8 && right < 8 && below < 8 && above < 8;
    }
    void visit(Chunk chunk, const glm::mat4& to_screen, glm::vec3 eye, float reach, std::vector<Chunk>& chosen) const {
        const int from[2] = {chunk.x, chunk.y}, side = SIDE << chunk.level, half = side / 2, finer = chunk.level - 1;
        glm::vec2 low, high;
        float away = eye.z;
        for (int axis = 0; axis < 2; ++axis) {
            const float a = on_grid(from[axis], axis, 1), b = on_grid(from[axis] + side, axis, 1);
            if (a == b) return; // no width: wholly between the last cell and the root's end, or wholly beyond
            away = std::max({away, a - eye[axis], eye[axis] - b});
            const float far = 64.0f * static_cast<float>(std::max(last_.x, last_.y) + 1);
            low[axis] = dx_ * (on_grid(from[axis], axis, far) + 0.5f);
            high[axis] = dx_ * (on_grid(from[axis] + side, axis, far) + 0.5f);
        }
        if (!seen(low, high, to_screen)) return;
        if (chunk.level > 0 && away < reach * static_cast<float>(1 << finer)) {
            for (int n = 0; n < 4; ++n)
                visit({chunk.x + n % 2 * half, chunk.y + n / 2 * half, finer, 0}, to_screen, eye, reach, chosen);
        } else {
            chunk.away = static_cast<int32_t>(away);
            chosen.push_back(chunk);
        }
    }
};
