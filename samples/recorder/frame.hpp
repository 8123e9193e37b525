// A frame: caption, map, legend; and the contact sheet of a whole recording.
#pragma once
#include "render.hpp"
#include <string>
#include <vector>

namespace recorder {

struct Caption {
    std::string level;
    int nx = 0, ny = 0; // of the simulation's grid
    double dx = 0;      // [m]
    bool square = true; // the same scale along x and y
};

/// Seconds as frames, sheets and the progress line write them.
std::string format_time(double seconds);

/// `map` between a caption line and a colour key with a scale bar; `metres_per_pixel` is the map's along x.
Image compose_frame(const Image& map, const Look& look, const Caption& caption, double time, double metres_per_pixel);

/// Collects reduced maps while a recording runs; holds at most the frames that the sheet shows.
class ContactSheet {
  public:
    static constexpr int MOST_TILES = 12;
    /// `frame_count`: frames that the recording will have; the sheet shows evenly spaced ones, first and last included.
    explicit ContactSheet(std::size_t frame_count);
    /// Must be called with every frame in order; `last` makes sure that a recording that ends early shows its end.
    void add(const Image& map, double time, bool last);
    bool empty() const { return tiles_.empty(); }
    Image compose(const Look& look, const Caption& caption, double metres_per_pixel) const;

  private:
    struct Tile {
        Image map;
        double time;
    };
    std::size_t frame_count_;
    std::size_t added_ = 0;
    int factor_ = 1;
    std::vector<Tile> tiles_;
};

} // namespace recorder
